// Other loads than the quickstart's cross a remeshing: their curve goes on, and the boundary is
// where the load puts it. The decks in inputs/ are these loads at more grains and strain.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "mesh/mesh.hpp"
#include "system/small_run.hpp"

namespace polyslip::tests {
namespace {

namespace fs = std::filesystem;

constexpr double final_strain = 0.16;

/// Eight grains, remeshed at half way.
void run_path(const Sandbox& sandbox, const std::string& loading) {
  run_deck(sandbox, 0,
           "[polycrystal]\ngrains = 8\nseed = 1\n[mesh]\nelement_size = 0.8\n"
           "meshers = [\"gmsh-hxt\"]\n[loading]\nfinal_strain = 0.16\n" +
               loading + "[remeshing]\nat_strains = [0.08]\n",
           "run");
}

/// The last state, after the checks that hold for every load.
mesh::Snapshot end_of(const Sandbox& sandbox) {
  const fs::path run = sandbox.path() / "run";
  const auto summary = nlohmann::json::parse(slurp(run / "summary.json"));
  const auto& remeshing = summary.at("remeshings").at(0);
  EXPECT_EQ(remeshing.at("copied_faces"), 0);
  // 400 elements for eight grains: twice as far from the curve as the quickstart's is after 0.01.
  EXPECT_NEAR(remeshing.at("reloaded_stress_ratio").get<double>(), 1, 0.015);
  EXPECT_LT(remeshing.at("max_grain_volume_change").get<double>(), 1e-3);
  EXPECT_EQ(summary.at("remeshings").size(), 1u);
  const mesh::Snapshot end = last_state(run);
  EXPECT_EQ(end.strain, final_strain);
  EXPECT_EQ(end.mesh_number, 1);
  EXPECT_NO_THROW(mesh::check(end.mesh));
  return end;
}

/// Largest distance of the corners (or, with 6, of all nodes) of the triangles on a domain face
/// from where `place` says that the face is.
template <class Place>
double distance(const mesh::Mesh& mesh, int face, const Place& place, std::size_t nodes = 6) {
  double largest = -1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.topology.faces[mesh.triangle_face[t]].domain_face == face)
      for (std::size_t k = 0; k < nodes; ++k)
        largest = std::max(largest, std::abs(place(mesh.nodes[mesh.triangles[t][k]])));
  return largest < 0 ? NAN : largest;
}

/// Of a face at rest, or moved, along its own axis.
double distance_from(const mesh::Mesh& mesh, int face, double position) {
  return distance(mesh, face, [&](const core::Vec3& x) { return x[face / 2] - position; });
}

constexpr double exact = 1e-9;  // rounding, through a remeshing's interpolation of displacements

TEST(Paths, UniaxialTensionCrossesARemeshing) {
  const Sandbox sandbox;
  run_path(sandbox, "type = \"uniaxial-tension\"\naxis = \"x\"\n");
  const mesh::Mesh mesh = end_of(sandbox).mesh;
  EXPECT_LT(distance_from(mesh, 1, mesh.size[0] * std::exp(final_strain)), exact);
  for (const int face : {0, 2, 4}) EXPECT_LT(distance_from(mesh, face, 0), exact);
  EXPECT_GT(read_macro(sandbox.path() / "run").back().stress[0], 20);  // MPa, it pulls
}

TEST(Paths, UniaxialCompressionCrossesARemeshing) {
  const Sandbox sandbox;
  run_path(sandbox, "type = \"uniaxial-compression\"\n");
  const mesh::Mesh mesh = end_of(sandbox).mesh;
  EXPECT_LT(distance_from(mesh, 5, mesh.size[2] * std::exp(-final_strain)), exact);
  for (const int face : {0, 2, 4}) EXPECT_LT(distance_from(mesh, face, 0), exact);
  EXPECT_LT(read_macro(sandbox.path() / "run").back().stress[2], -20);
}

/// The x faces lean: x - gamma z is what it was. Mid nodes of a face that is not across an axis
/// take part in giving grains their volumes back (docs/theory-polycrystal.md, section 6), which
/// moved them by 1.3e-5 here; corners are exact.
TEST(Paths, SimpleShearCrossesARemeshing) {
  const Sandbox sandbox;
  run_path(sandbox, "type = \"simple-shear\"\n");
  const mesh::Mesh mesh = end_of(sandbox).mesh;
  for (const int face : {0, 1}) {
    const auto off = [&](const core::Vec3& x) {
      return x[0] - final_strain * x[2] - face * mesh.size[0];
    };
    EXPECT_LT(distance(mesh, face, off, 3), exact);
    EXPECT_LT(distance(mesh, face, off), 1e-4);
  }
  for (const int face : {2, 3, 4, 5})
    EXPECT_LT(distance_from(mesh, face, face % 2 * mesh.size[face / 2]), exact);
}

TEST(Paths, PlaneStrainWithAPlanarFaceCrossesARemeshing) {
  const Sandbox sandbox;
  run_path(sandbox, "lateral = \"planar\"\n");
  const mesh::Mesh mesh = end_of(sandbox).mesh;
  double at = NAN;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.topology.faces[mesh.triangle_face[t]].domain_face == 1)
      at = mesh.nodes[mesh.triangles[t][0]][0];
  EXPECT_GT(at, mesh.size[0] * 1.1);
  EXPECT_LT(distance_from(mesh, 1, at), exact);
  EXPECT_LT(distance_from(mesh, 5, mesh.size[2] * std::exp(-final_strain)), exact);
  const MacroRow last = read_macro(sandbox.path() / "run").back();
  EXPECT_LT(std::abs(last.fx_x1), 1e-3 * std::abs(last.fz_z1));
}

/// Between dies that stick the free sides roll onto them: the run ends there with the reason, and
/// again when it is restarted.
TEST(Paths, EndWhereABodyFlowsPastADie) {
  const Sandbox sandbox;
  sandbox.write("run.toml",
                "[polycrystal]\ngrains = 4\ndomain = [1.0, 1.0, 0.5]\n[mesh]\nelement_size = 0.8\n"
                "meshers = [\"gmsh-hxt\"]\n[loading]\ntype = \"faces\"\nz0 = \"fixed\"\n"
                "z1 = \"moving\"\nz1_velocity = [0.0, 0.0, -1.0]\nfinal_strain = 0.8\n"
                "max_strain_increment = 0.02\n[remeshing]\nautomatic = false\n");
  const fs::path run = sandbox.path() / "run";
  constexpr int exit_stopped = 3;
  std::string last;
  for (const auto& call : {std::vector<std::string>{"run", "run.toml", "--out", "run"},
                           std::vector<std::string>{"run", "--restart", "run"}}) {
    const Outcome outcome = run_polyslip(call, sandbox.path());
    EXPECT_EQ(outcome.code, exit_stopped) << outcome.err;
    const auto at = outcome.err.find("error: strain 0.");
    ASSERT_NE(at, std::string::npos) << outcome.err;
    const std::string reason = outcome.err.substr(at, outcome.err.find('\n', at) - at);
    EXPECT_NE(reason.find("a free face has flowed past the plane of the flat face z"),
              std::string::npos);
    EXPECT_NE(reason.find("keep the free face flat with zero mean force: \"planar\" in [loading]"),
              std::string::npos);
    if (!last.empty()) {
      EXPECT_EQ(reason, last);
    }
    last = reason;
  }
  const std::string log = slurp(run / "log.txt"), warning = "at 5 % the run stops";
  const auto warned = log.find(warning);
  ASSERT_NE(warned, std::string::npos) << log;
  EXPECT_EQ(log.find(warning, warned + 1), std::string::npos);
  const auto summary = nlohmann::json::parse(slurp(run / "summary.json"));
  EXPECT_FALSE(summary.at("completed").get<bool>());
  EXPECT_EQ(summary.at("final_strain").get<double>(), last_state(run).strain);
}

}  // namespace
}  // namespace polyslip::tests
