// Remeshing without a solver: polycrystals moved by plane strain and random flows, remeshed again
// and again (docs/theory-polycrystal.md). remeshing_geometry --help
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <ctime>

#include "core/error.hpp"
#include "mesh/curved_elements.hpp"
#include "mesh/geometry.hpp"
#include "mesh/volume_correction.hpp"
#include "remap/remesh.hpp"
#include "results/state_file.hpp"
#include "results/state_series.hpp"
#include "support/grain_flow.hpp"

namespace {

using namespace polyslip;
using core::Vec3;

struct Options {
  int grains = 30, polycrystals = 1, worst = 0;
  std::uint64_t seed = 1;
  double interval = 0.3, end = 2.5;
  remap::RemeshingOptions remeshing;
  test::GrainFlow::Options flow;
  mesh::MeshingOptions meshing;
  std::string from, run;
  std::vector<int> only;
};

Vec3 isotropic(double strain) { return {std::exp(-strain), 1, std::exp(strain)}; }

double cpu(const mesh::MesherPool& pool) {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC + pool.cpu_seconds();
}

struct Changes {
  double rms = 0, worst = 0;
};

Changes changes(const std::vector<double>& before, const std::vector<double>& after) {
  Changes c;
  for (std::size_t g = 0; g < before.size(); ++g) {
    const double d = after[g] / before[g] - 1;
    c.rms += d * d / static_cast<double>(before.size());
    c.worst = std::max(c.worst, std::abs(d));
  }
  c.rms = std::sqrt(c.rms);
  return c;
}

int inverted(const mesh::Mesh& mesh) {
  int count = 0;
  for (int e = 0; e < mesh.element_count(); ++e)
    count += !(mesh::least_jacobian_ratio(mesh, e) > 0);
  return count;
}

/// The worst elements, in the frame of sizes: radius ratio, grain, and for each corner v(ertex),
/// e(dge), f(ace), i(nside).
void list_worst(const mesh::Mesh& mesh, const Vec3& scale, int count) {
  std::vector<char> kind(mesh.nodes.size(), 'i');
  std::vector<int> owner(mesh.nodes.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const int n : mesh.triangles[i]) kind[n] = 'f', owner[n] = mesh.triangle_face[i];
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
    for (const int n : mesh.lines[i]) kind[n] = 'e', owner[n] = mesh.line_edge[i];
  for (std::size_t v = 0; v < mesh.vertex_nodes.size(); ++v) {
    kind[mesh.vertex_nodes[v]] = 'v';
    owner[mesh.vertex_nodes[v]] = static_cast<int>(v);
  }
  std::vector<std::pair<double, int>> order;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto& t = mesh.tetrahedra[e];
    const auto at = [&](int i) -> Vec3 { return mesh.nodes[t[i]].cwiseProduct(scale); };
    order.push_back({mesh::radius_ratio(at(0), at(1), at(2), at(3)), e});
  }
  std::sort(order.begin(), order.end());
  for (int i = 0; i < std::min(count, mesh.element_count()); ++i) {
    const auto& t = mesh.tetrahedra[order[i].second];
    std::string corners;
    for (int k = 0; k < 4; ++k) {
      const Vec3 x = mesh.nodes[t[k]].cwiseProduct(scale);
      corners += fmt::format(" {}{} ({:.3f} {:.3f} {:.3f})", kind[t[k]], owner[t[k]] + 1, x[0],
                             x[1], x[2]);
    }
    fmt::print("    {:.4f} grain {}{}\n", order[i].first,
               mesh.tetrahedron_cell[order[i].second] + 1, corners);
  }
}

/// Whether it got a new mesh.
bool remesh(const Options& o, double strain, mesh::Mesh& mesh, mesh::MesherPool& pool) {
  const int bad = inverted(mesh);
  const Vec3 frame = remap::meshing_scale(mesh, o.remeshing);
  const auto worn = test::scaled_quality(mesh, frame);
  const auto before = mesh::grain_volumes(mesh);
  const double start = cpu(pool);
  mesh::MeshingReport report;
  mesh::DeformedRegularisation regular;
  try {
    mesh = mesh::mesh_geometry(remap::regularised_geometry(mesh, o.remeshing, regular), o.meshing,
                               frame, pool, report);
    mesh::check(mesh);
  } catch (const std::exception& e) {
    fmt::print(
        "  {:.2f} worn {:.3f} ({} inverted, {} -> {} thin, {} moved by {:.3f}): FAILED: {}\n",
        strain, worn.min_radius_ratio, bad, regular.elements_before, regular.elements_after,
        regular.moved, regular.largest_move, e.what());
    for (const auto& f : report.faults) fmt::print("    {}\n", f);
    return false;
  }
  const auto c = changes(before, mesh::grain_volumes(mesh));
  const auto iso = test::scaled_quality(mesh, isotropic(strain));
  const auto sized = test::scaled_quality(mesh, frame);
  fmt::print(
      "  {:.2f} worn {:.3f} ({} inverted, {} -> {} thin, {} moved by {:.3f}) -> {:6} elements, iso "
      "{:.3f} {:.3f}, sized {:.3f} "
      "{:.3f}, maps {} {}, copied {} of {}, pulled {}, nearest {}, volumes {:.1e} {:.1e}, {} "
      "faults, opened {} -> {} thin, {} by {:.3f}, {:.1f} s\n",
      strain, worn.min_radius_ratio, bad, regular.elements_before, regular.elements_after,
      regular.moved, regular.largest_move, mesh.element_count(), iso.min_radius_ratio,
      iso.mean_radius_ratio, sized.min_radius_ratio, sized.mean_radius_ratio,
      report.conformal_faces, report.circle_faces, report.copied_faces.size(),
      mesh.topology.faces.size(), report.straightened, report.nearest_points, c.rms, c.worst,
      report.faults.size(), report.opened.elements_before, report.opened.elements_after,
      report.opened.moved, report.opened.largest_move, cpu(pool) - start);
  for (std::size_t i = 0; i < report.copied_faces.size() && o.worst > 0; ++i)
    fmt::print("    face {} copied: {}\n", report.copied_faces[i] + 1, report.why_copied[i]);
  list_worst(mesh, frame, o.worst);
  std::fflush(stdout);
  return true;
}

/// Remeshes each state before a remeshing of a run; whether all got a new mesh.
bool redo(const Options& o, const std::string& folder, mesh::MesherPool& pool) {
  const results::StateSeries series(folder);
  const auto& states = series.states();
  bool all = true;
  for (std::size_t i = 1; i < states.size(); ++i) {
    if (states[i].mesh_number == states[i - 1].mesh_number) continue;
    if (!o.only.empty() &&
        std::find(o.only.begin(), o.only.end(), states[i].mesh_number) == o.only.end())
      continue;
    auto old = results::read_state(series.path(states[i - 1]));
    all &= remesh(o, old.strain, old.mesh, pool);
  }
  return all;
}

/// Whether it came to the end.
bool run(const Options& o, std::uint64_t seed, mesh::MesherPool& pool) {
  auto tessellation = mesh::voronoi_tessellation({.grains = o.grains, .seed = seed});
  mesh::regularise(tessellation, {});
  mesh::MeshingReport first;
  mesh::Mesh mesh =
      mesh::mesh_geometry(mesh::geometry_of(tessellation), o.meshing, Vec3::Ones(), pool, first);
  auto q = test::scaled_quality(mesh, Vec3::Ones());
  fmt::print("seed {}: {} elements, radius ratio {:.3f} worst, {:.3f} mean\n", seed,
             mesh.element_count(), q.min_radius_ratio, q.mean_radius_ratio);
  auto flow_options = o.flow;
  flow_options.seed = seed;
  const test::GrainFlow flow(mesh.size, flow_options);
  double strain = 0;
  for (int i = 1; strain < o.end - 1e-9; ++i) {
    const double to = std::min(o.end, i * o.interval);
    flow.move(mesh, strain, to);
    strain = to;
    if (!remesh(o, strain, mesh, pool)) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  auto pool = mesh::MesherPool::start(POLYSLIP_BINARY_DIR "/polyslip-mesher");
  Options o;
  o.meshing.jobs = 1;
  CLI::App app{"Remeshing without a solver: a line for each remeshing."};
  app.add_option("--grains", o.grains);
  app.add_option("--polycrystals", o.polycrystals, "so many, of consecutive seeds");
  app.add_option("--seed", o.seed, "of the first");
  app.add_option("--interval", o.interval, "of strain between remeshings");
  app.add_option("--end", o.end, "strain");
  app.add_option("--share", o.remeshing.orthotropic_share,
                 "of the shortening that element sizes follow");
  app.add_option("--long-share", o.remeshing.lengthening_share,
                 "of the lengthening that they follow");
  app.add_option("--strength", o.flow.strength, "of the random flow");
  app.add_option("--wavelength", o.flow.wavelength, "of the random flow");
  app.add_option("--element-size", o.meshing.element_size);
  app.add_option("--target", o.meshing.mesher_target);
  app.add_option("--worst", o.worst, "elements to be listed, and why faces were copied");
  app.add_option("--from", o.from, "remesh the mesh of this state instead");
  app.add_option("--run", o.run, "redo the remeshings of this run folder instead");
  app.add_option("--only", o.only, "of them, those to the meshes of these numbers");
  CLI11_PARSE(app, argc, argv);
  if (!o.run.empty()) return redo(o, o.run, *pool) ? 0 : 1;
  if (!o.from.empty()) {
    auto snapshot = results::read_state(o.from);
    return remesh(o, snapshot.strain, snapshot.mesh, *pool) ? 0 : 1;
  }
  int done = 0;
  for (int i = 0; i < o.polycrystals; ++i)
    done += run(o, o.seed + static_cast<std::uint64_t>(i), *pool);
  fmt::print("{} of {} came to the end\n", done, o.polycrystals);
  return done == o.polycrystals ? 0 : 1;
}
