#include "drivers/options.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::drivers {
namespace {

const std::string quickstart = POLYSLIP_SOURCE_DIR "/inputs/quickstart.toml";

std::string error_of(const std::string& text, Purpose purpose = Purpose::run,
                     const std::string& path = "deck.toml") {
  try {
    core::Deck deck = core::Deck::from_text(text, path);
    read_options(deck, purpose);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The keys that every version reads.
const char* first_deck = R"([polycrystal]
grains = 30
seed = 1                       # same seed, same polycrystal: own generator and distributions, no thread or rank dependence
domain = [1.0, 1.0, 1.0]       # shape of the box (RD, TD, ND): scaled so that grains have unit mean volume
[regularisation]
max_edge_length = 0.13         # l_max; lengths are for grains of unit mean volume
max_flatness_fault = 20.0      # degrees, f_max
[mesh]
element_size = 0.5             # c_l
progression_factor = 2.0       # p_l
order = 2                      # 2 for a run; 1 may be asked of `polyslip mesh`
meshers = ["gmsh-hxt", "gmsh-delaunay", "netgen"]   # the best mesh of each grain wins
[orientations]
distribution = "uniform"       # or "file": file = "...", convention = "quaternion" | "rodrigues" | "euler-bunge"
[material]
c11 = 107.3e3                  # MPa
c12 = 60.9e3
c44 = 28.3e3
reference_slip_rate = 1.0      # 1/s
rate_sensitivity = 0.12        # m; slip rate ~ |tau/g|^(1/m)
g0 = 8.0
gs = 12.0
h0 = 4.0
[loading]
type = "plane-strain-compression"
strain_rate = 1.0              # 1/s, true strain rate
final_strain = 0.6             # ln(h0/h)
max_strain_increment = 0.02
[remeshing]
at_strains = [0.3]
[solver]
newton_tolerance = 1e-3        # stated in docs: relative to what, in which norm
linear_tolerance = 1e-2
[output]
at_strains = [0.1, 0.2, 0.3]   # besides start, end and both sides of each remeshing
checkpoint_every_strain = 0.1
)";

/// That deck with some text replaced.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = first_deck;
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the deck has no " + from);
  return text.replace(at, from.size(), to);
}

TEST(Options, QuickstartIsTheFirstDeck) {
  core::Deck deck = core::Deck::from_file(quickstart);
  read_options(deck);
  core::Deck first = core::Deck::from_text(first_deck, "deck.toml");
  read_options(first);
  EXPECT_EQ(deck.resolved(), first.resolved());
}

TEST(Options, TheFirstDeckIsRead) {
  core::Deck deck = core::Deck::from_text(first_deck, "deck.toml");
  const Options o = read_options(deck);
  EXPECT_EQ(o.polycrystal.grains, 30);
  EXPECT_EQ(o.polycrystal.seed, 1u);
  EXPECT_EQ(o.polycrystal.domain, core::Vec3(1, 1, 1));
  EXPECT_EQ(o.regularisation.max_edge_length, 0.13);
  EXPECT_EQ(o.regularisation.max_flatness_fault, 20);
  EXPECT_EQ(o.mesh.element_size, 0.5);
  EXPECT_EQ(o.mesh.progression_factor, 2);
  EXPECT_EQ(o.mesh.order, 2);
  EXPECT_EQ(o.mesh.meshers, (std::vector<std::string>{"gmsh-hxt", "gmsh-delaunay", "netgen"}));
  EXPECT_EQ(o.orientations.distribution, "uniform");
  EXPECT_FALSE(o.orientations.file);
  EXPECT_EQ(o.material.c11, 107.3e3);
  EXPECT_EQ(o.material.c12, 60.9e3);
  EXPECT_EQ(o.material.c44, 28.3e3);
  EXPECT_EQ(o.material.reference_slip_rate, 1);
  EXPECT_EQ(o.material.rate_sensitivity, 0.12);
  EXPECT_EQ(o.material.g0, 8);
  EXPECT_EQ(o.material.gs, 12);
  EXPECT_EQ(o.material.h0, 4);
  EXPECT_EQ(o.loading.type, "plane-strain-compression");
  EXPECT_EQ(o.loading.strain_rate, 1);
  EXPECT_EQ(o.loading.final_strain, 0.6);
  EXPECT_EQ(o.loading.max_strain_increment, 0.02);
  EXPECT_FALSE(o.loading.fixed_increment);
  EXPECT_EQ(o.remeshing.at_strains, std::vector<double>{0.3});
  EXPECT_EQ(o.solver.newton_tolerance, 1e-3);
  EXPECT_EQ(o.solver.linear_tolerance, 1e-2);
  EXPECT_EQ(o.output.at_strains, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(o.output.checkpoint_every_strain, 0.1);
}

/// Values other than the defaults for every key that can have one.
const char* other_values = R"([polycrystal]
grains = 2
seed = 9223372036854775807
domain = [1, 2, 3]
[regularisation]
max_edge_length = 0.26
max_flatness_fault = 10
polyline_share = 0
min_corner_angle = 5
position_search = 1.1
flattening_sweeps = 2
[mesh]
length_unit = "file"
element_size = 0.3
element_size_outer = 0.6
grain_element_sizes = [0.2, 0.3]
slide_boundary = false
mesher_target = 0.8
progression_factor = 1.5
meshers = ["netgen"]
face_meshers = ["gmsh-frontal"]
mesher_timeout = 30
[orientations]
convention = "rodrigues"
[material]
c11 = 1
c12 = 0.1
c44 = 0.3
reference_slip_rate = 1e-3
rate_sensitivity = 0.05
g0 = 9
gs = 13
h0 = 5
voce_exponent = 1.5
latent_ratio = 1.4
[loading]
strain_rate = 0.01
final_strain = 0.7
max_strain_increment = 0.01
initial_strain_increment = 1e-3
increment_growth = 2
min_strain_increment = 1e-6
fixed_increment = true
final_time = 300
final_stress = 40
[remeshing]
at_strains = [0.2, 0.4]
automatic = false
radius_ratio_share = 0.4
jacobian_share = 0.3
poor_radius_ratio = 0.15
poor_share_increase = 0.05
inversion_strain = 0.04
min_interval = 0.07
transport = "corrected"
stress = "carried"
max_grain_rotation = 4
max_grain_spread_change = 1.5
max_grain_g_change = 0.03
orthotropic_share = 0.5
lengthening_share = 0.25
max_grain_volume_change = 0.01
[solver]
element = "displacement"
quadrature_points = 8
newton_tolerance = 1e-9
velocity_tolerance = 1e-5
max_newton_iterations = 30
linear_tolerance = 1e-8
max_linear_iterations = 400
[output]
at_strains = [0, 0.7]
checkpoint_every_strain = 0
mesh_formats = ["msh4", "vtu"]
report = false
[taylor]
orientations = 500
[texture]
half_width = 7.5
sample_symmetry = "orthorhombic"
)";

/// Keys that have a meaning for some types of load only; loading_test.cpp has them.
bool of_one_type(const core::Declaration& d) {
  if (d.section == "loading.stage") return true;
  if (d.section == "polycrystal") {
    for (const char* key : {"shape", "axis", "faceting_error", "half_spaces", "morphology",
                            "periodic", "stretch", "columnar_share", "diameter_deviation",
                            "sphericity_mean", "sphericity_deviation", "cells", "seeds"})
      if (d.key == key) return true;
    return false;
  }
  if (d.section != "loading") return false;
  for (const char* key : {"control", "axis", "constrained_axis", "direction", "lateral",
                          "velocity_gradient", "held", "traction_strain"})
    if (d.key == key) return true;
  return d.key[1] == '0' || d.key[1] == '1';
}

TEST(Options, PeriodicDirectionsAreForMeshing) {
  core::Deck deck =
      core::Deck::from_text("[polycrystal]\nperiodic = [\"z\", \"x\"]\n", "deck.toml");
  EXPECT_EQ(read_options(deck, Purpose::mesh).polycrystal.periodic,
            (std::array{true, false, true}));
  core::Deck again = core::Deck::from_text("[polycrystal]\nperiodic = [\"z\"]\n", "deck.toml");
  try {
    read_options(again, Purpose::run);
    FAIL() << "a periodic run was not rejected";
  } catch (const core::InputError& e) {
    EXPECT_STREQ(e.what(),
                 "deck.toml:2:12: [polycrystal] periodic is for `polyslip mesh` only: there are no "
                 "periodic loads; remove it");
  }
}

TEST(Options, EveryKeyReachesItsOption) {
  core::Deck deck = core::Deck::from_text(other_values, "deck.toml");
  const Options o = read_options(deck);
  EXPECT_EQ(o.input.length_unit, mesh::LengthUnit::file);
  EXPECT_EQ(o.polycrystal.grains, 2);
  EXPECT_EQ(o.polycrystal.seed, 9223372036854775807u);
  EXPECT_EQ(o.polycrystal.domain, core::Vec3(1, 2, 3));
  EXPECT_EQ(o.regularisation.max_edge_length, 0.26);
  EXPECT_EQ(o.regularisation.max_flatness_fault, 10);
  EXPECT_EQ(o.regularisation.polyline_share, 0);
  EXPECT_EQ(o.regularisation.min_corner_angle, 5);
  EXPECT_EQ(o.regularisation.position_search, 1.1);
  EXPECT_EQ(o.regularisation.flattening_sweeps, 2);
  EXPECT_EQ(o.mesh.element_size, 0.3);
  EXPECT_EQ(o.mesh.outer_element_size, 0.6);
  EXPECT_EQ(o.mesh.grain_element_sizes, (std::vector<double>{0.2, 0.3}));
  EXPECT_FALSE(o.mesh.slide_boundary);
  EXPECT_EQ(o.mesh.mesher_target, 0.8);
  EXPECT_EQ(o.mesh.progression_factor, 1.5);
  EXPECT_EQ(o.mesh.meshers, std::vector<std::string>{"netgen"});
  EXPECT_EQ(o.mesh.face_meshers, std::vector<std::string>{"gmsh-frontal"});
  EXPECT_EQ(o.mesh.mesher_timeout, 30);
  EXPECT_EQ(o.orientations.convention, "rodrigues");
  EXPECT_EQ(o.material.c11, 1);
  EXPECT_EQ(o.material.c12, 0.1);
  EXPECT_EQ(o.material.c44, 0.3);
  EXPECT_EQ(o.material.reference_slip_rate, 1e-3);
  EXPECT_EQ(o.material.rate_sensitivity, 0.05);
  EXPECT_EQ(o.material.g0, 9);
  EXPECT_EQ(o.material.gs, 13);
  EXPECT_EQ(o.material.h0, 5);
  EXPECT_EQ(o.material.voce_exponent, 1.5);
  EXPECT_EQ(o.material.latent_ratio, 1.4);
  EXPECT_EQ(o.loading.strain_rate, 0.01);
  EXPECT_EQ(o.loading.final_strain, 0.7);
  EXPECT_EQ(o.loading.max_strain_increment, 0.01);
  EXPECT_EQ(o.loading.initial_strain_increment, 1e-3);
  EXPECT_EQ(o.loading.increment_growth, 2);
  EXPECT_EQ(o.loading.min_strain_increment, 1e-6);
  EXPECT_TRUE(o.loading.fixed_increment);
  EXPECT_EQ(o.loading.final_time, 300);
  EXPECT_EQ(o.loading.final_stress, 40);
  EXPECT_EQ(o.remeshing.at_strains, (std::vector<double>{0.2, 0.4}));
  EXPECT_FALSE(o.remeshing.automatic);
  EXPECT_EQ(o.remeshing.wear.radius_ratio_share, 0.4);
  EXPECT_EQ(o.remeshing.wear.jacobian_share, 0.3);
  EXPECT_EQ(o.remeshing.wear.poor_radius_ratio, 0.15);
  EXPECT_EQ(o.remeshing.wear.poor_share_increase, 0.05);
  EXPECT_EQ(o.remeshing.wear.inversion_strain, 0.04);
  EXPECT_EQ(o.remeshing.min_interval, 0.07);
  EXPECT_EQ(o.remeshing.transport.state, "corrected");
  EXPECT_EQ(o.remeshing.transport.stress, "carried");
  EXPECT_EQ(o.remeshing.max_grain_rotation, 4);
  EXPECT_EQ(o.remeshing.max_grain_spread_change, 1.5);
  EXPECT_EQ(o.remeshing.max_grain_g_change, 0.03);
  EXPECT_EQ(o.remeshing.orthotropic_share, 0.5);
  EXPECT_EQ(o.remeshing.lengthening_share, 0.25);
  EXPECT_EQ(o.remeshing.max_grain_volume_change, 0.01);
  EXPECT_EQ(o.solver.element, "displacement");
  EXPECT_EQ(o.solver.quadrature_points, 8);
  EXPECT_EQ(o.solver.newton_tolerance, 1e-9);
  EXPECT_EQ(o.solver.velocity_tolerance, 1e-5);
  EXPECT_EQ(o.solver.max_newton_iterations, 30);
  EXPECT_EQ(o.solver.linear_tolerance, 1e-8);
  EXPECT_EQ(o.solver.max_linear_iterations, 400);
  EXPECT_EQ(o.output.at_strains, (std::vector<double>{0, 0.7}));
  EXPECT_EQ(o.output.checkpoint_every_strain, 0);
  EXPECT_EQ(o.output.mesh_formats, (std::vector<std::string>{"msh4", "vtu"}));
  EXPECT_FALSE(o.output.report);
  EXPECT_EQ(o.taylor.orientations, 500);
  EXPECT_EQ(o.texture.half_width, 7.5);
  EXPECT_EQ(o.texture.sample_symmetry, "orthorhombic");
  // The deck above would miss a key that is added later: each declared one is in it, but for those
  // that have a single value or exclude another.
  for (const auto& d : deck.declarations())
    EXPECT_TRUE(deck.given(d.section, d.key) || d.key == "periodic" || d.key == "order" ||
                d.key == "type" || d.key == "distribution" || d.key == "file" || of_one_type(d))
        << d.section << "." << d.key;
}

TEST(Options, ResolvedDeckReadsBack) {
  for (const std::string& text :
       {core::read_text(quickstart), std::string(other_values), std::string()}) {
    core::Deck deck = core::Deck::from_text(text, "deck.toml");
    read_options(deck);
    core::Deck again = core::Deck::from_text(deck.resolved(), "deck.resolved.toml");
    read_options(again);
    EXPECT_EQ(deck.resolved(), again.resolved());
    EXPECT_EQ(deck.fingerprint(), again.fingerprint());
    EXPECT_EQ(deck.resolved().find("nan"), std::string::npos);
  }
}

TEST(Options, EveryKeyHasUnitDefaultAndSentence) {
  core::Deck deck = core::Deck::from_text("", "deck.toml");
  read_options(deck);
  EXPECT_GT(deck.declarations().size(), 30u);
  for (const auto& d : deck.declarations()) {
    EXPECT_FALSE(d.help.empty()) << d.key;
    EXPECT_EQ(d.help.back(), '.') << d.key;
    EXPECT_TRUE(!d.fallback.empty() || d.optional) << d.key;
    if (d.type == "number" || d.type == "integer" || d.type == "list of numbers") {
      EXPECT_FALSE(d.unit.empty()) << d.key;
      EXPECT_TRUE(!d.bounds.empty() || d.key == "c12" || of_one_type(d) || d.key == "strain_rate")
          << d.key;  // bounded by c11 alone
    }
  }
}

TEST(Options, TheReferencePageIsFresh) {
  EXPECT_EQ(core::read_text(POLYSLIP_SOURCE_DIR "/docs/deck.md"), deck_reference())
      << "run build/polyslip reference > docs/deck.md";
}

TEST(Options, TheFirstStepIsNoLongerThanTheLargest) {
  core::Deck deck = core::Deck::from_text("[loading]\nmax_strain_increment = 1e-4\n", "deck.toml");
  EXPECT_EQ(read_options(deck).loading.initial_strain_increment, 1e-4);
}

TEST(Options, OneWrongValueOneLine) {
  EXPECT_EQ(error_of(changed("h0 = 4.0", "h_0 = 4.0")),
            "deck.toml:23:1: [material] unknown key 'h_0'; did you mean 'h0'?");
  EXPECT_EQ(error_of(changed("element_size = 0.5", "element_size = -0.5")),
            "deck.toml:9:16: [mesh] element_size = -0.5 must be >= 0.01 and <= 10");
  EXPECT_EQ(error_of(changed("grains = 30", "grains = 30.5")),
            "deck.toml:2:10: [polycrystal] grains = 30.5 must be an integer");
  EXPECT_EQ(
      error_of(changed("\"gmsh-hxt\"", "\"gmsh-htx\"")),
      "deck.toml:12:12: [mesh] meshers: entry 1 = \"gmsh-htx\" must be \"gmsh-hxt\", "
      "\"gmsh-delaunay\", \"netgen\", \"gmsh-hxt-plain\", \"gmsh-delaunay-plain\", \"paper-1\" "
      "or \"paper-2\"; did you mean \"gmsh-hxt\"?");
  EXPECT_EQ(error_of(changed("type = \"plane-strain-compression\"", "type = \"tension\"")),
            "deck.toml:25:8: [loading] type = \"tension\" must be "
            "\"plane-strain-compression\", \"uniaxial-tension\", \"uniaxial-compression\", "
            "\"simple-shear\", \"velocity-gradient\" or \"faces\"");
  EXPECT_EQ(error_of(changed("seed = 1", "seed = -1")),
            "deck.toml:3:8: [polycrystal] seed = -1 must be >= 0");
  EXPECT_EQ(error_of(changed("at_strains = [0.3]", "at_strains = [0.3, 0.2]")),
            "deck.toml:30:20: [remeshing] at_strains: entry 2 = 0.2 must be larger than the entry "
            "before it");
}

TEST(Options, ChecksBetweenKeys) {
  EXPECT_EQ(error_of(changed("final_strain = 0.6", "final_strain = 0.25")),
            "deck.toml:30:14: [remeshing] at_strains: 0.3 must be < final_strain = 0.25 "
            "(deck.toml:27:16)");
  EXPECT_EQ(error_of("[remeshing]\nat_strains = [0.6]\n"),
            "deck.toml:2:14: [remeshing] at_strains: 0.6 must be < final_strain = 0.6 (default)");
  EXPECT_EQ(error_of("[output]\nat_strains = [0.1, 0.6, 0.61]\n"),
            "deck.toml:2:14: [output] at_strains: 0.61 must be <= final_strain = 0.6 (default)");
  EXPECT_EQ(error_of(changed("gs = 12.0", "gs = 7")),
            "deck.toml:22:6: [material] gs = 7 must be > g0 = 8 (deck.toml:21:6)");
  EXPECT_EQ(error_of(changed("gs = 12.0", "gs = 8")),
            "deck.toml:22:6: [material] gs = 8 must be > g0 = 8 (deck.toml:21:6); for no hardening "
            "set h0 = 0");
  EXPECT_EQ(error_of("[material]\nh0 = 0\ng0 = 8\ngs = 8\n"), "no error");
  EXPECT_EQ(error_of("[material]\nh0 = 0\ng0 = 8\ngs = 7\n"),
            "deck.toml:4:6: [material] gs = 7 must be >= g0 = 8 (deck.toml:3:6)");
  EXPECT_EQ(error_of("[material]\nc12 = 2e5\n"),
            "deck.toml:1:2: [material] c11 = 107300 must be > c12 = 200000 (deck.toml:2:7): the "
            "crystal would be unstable in shear");
  EXPECT_EQ(error_of("[material]\nc12 = -6e4\n"),
            "deck.toml:2:7: [material] c12 = -60000 must be > -c11/2, c11 = 107300 (default): the "
            "bulk modulus would not be positive");
  EXPECT_EQ(error_of("[material]\nc44 = 0\n"), "deck.toml:2:7: [material] c44 = 0 must be > 0");
  EXPECT_EQ(error_of("[loading]\nmin_strain_increment = 0.001\n"),
            "deck.toml:2:24: [loading] min_strain_increment = 0.001 must be below the first step, "
            "0.0002");
}

TEST(Options, LinearElementsAreForMeshingOnly) {
  const std::string text = changed("order = 2", "order = 1");
  EXPECT_EQ(error_of(text, Purpose::mesh), "no error");
  EXPECT_EQ(error_of(text),
            "deck.toml:11:9: [mesh] order = 1 is for `polyslip mesh` only; a run needs order = 2");
}

TEST(Options, OrientationFiles) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("polyslip_options_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  core::write_file((folder / "ori.txt").string(), "1 0 0 0\n");

  const std::string path = (folder / "deck.toml").string();
  const std::string section = "[orientations]\ndistribution = \"file\"\n";
  const std::string one_grain = "[polycrystal]\ngrains = 1\n";
  EXPECT_EQ(error_of(section + "file = \"ori.txt\"\n" + one_grain, Purpose::run, path), "no error");
  EXPECT_EQ(error_of(section + "file = \"ori.txt\"\n", Purpose::run, path),
            (folder / "ori.txt").string() + ":1: ends after 1 of 30 orientations, one a grain");
  EXPECT_EQ(error_of(section + "file = \"none.txt\"\n", Purpose::run, path),
            path + ":3:8: [orientations] " + (folder / "none.txt").string() + ": no such file");
  EXPECT_EQ(error_of(section + "file = \"/\"\n", Purpose::run, path),
            path + ":3:8: [orientations] /: is not a file");
  EXPECT_EQ(error_of(section),
            "deck.toml:2:16: [orientations] distribution = \"file\" needs the key file");
  EXPECT_EQ(
      error_of("[orientations]\nfile = \"ori.txt\"\n"),
      "deck.toml:2:8: [orientations] file is not used with distribution = \"uniform\"; remove "
      "it, or set distribution = \"file\"");

  core::Deck deck = core::Deck::from_text(section + "file = \"ori.txt\"\n" + one_grain, path);
  read_options(deck);
  core::Deck resolved = core::Deck::from_text(deck.resolved(), "elsewhere/deck.resolved.toml");
  EXPECT_EQ(read_options(resolved).orientations.file, (folder / "ori.txt").string());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace polyslip::drivers
