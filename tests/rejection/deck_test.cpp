// Wrong decks: one clear line, exit code 2, the disk as it was, whatever verb reads them.

#include <gtest/gtest.h>

#include "support/program.hpp"

namespace polyslip::tests {
namespace {

struct WrongDeck {
  const char* name;
  const char* text;
  const char* line;
};

void PrintTo(const WrongDeck& deck, std::ostream* out) { *out << deck.name; }

class Deck : public ::testing::TestWithParam<WrongDeck> {};

TEST_P(Deck, IsRejectedByRunMeshAndCheck) {
  const WrongDeck& deck = GetParam();
  Sandbox sandbox;
  sandbox.write("deck.toml", deck.text);
  expect_rejection(sandbox, {"check", "deck.toml"}, deck.line);
  expect_rejection(sandbox, {"run", "deck.toml", "--out", "out"}, deck.line);
  expect_rejection(sandbox, {"mesh", "deck.toml", "--out", "out"}, deck.line);
}

TEST(PolycrystalDeck, ARunTakesABoxOnly) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "[polycrystal]\nshape = \"cylinder\"\n");
  expect_rejection(sandbox, {"run", "deck.toml", "--out", "out"},
                   "deck.toml:2:9: [polycrystal] shape = \"cylinder\" is for `polyslip mesh` only: "
                   "loads act on the faces of a box");
}

TEST(PolycrystalDeck, ASeedIsRefusedWithItsLine) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "[polycrystal]\nseeds = \"seeds.txt\"\n");
  sandbox.write("seeds.txt", "0.5 0.5 0.5\n0.5 0.5 1.5\n");
  for (const char* verb : {"run", "mesh"})
    expect_rejection(sandbox, {verb, "deck.toml", "--out", "out"},
                     "seeds.txt:2: seed 2 at (0.5, 0.5, 1.5) lies outside the domain, beyond its "
                     "face z1");
}

const WrongDeck wrong_decks[] = {
    {"NoRuleOfSoManyPoints", "[solver]\nquadrature_points = 5\n",
     "deck.toml:2:21: [solver] quadrature_points = 5 must be one of 4, 8, 14, 15"},
    {"UnknownKey", "[material]\nh_0 = 4.0\n",
     "deck.toml:2:1: [material] unknown key 'h_0'; did you mean 'h0'?"},
    {"KeyOfAnotherTable", "[mesh]\nfinal_strain = 0.5\n",
     "deck.toml:2:1: [mesh] unknown key 'final_strain'; it belongs in [loading]"},
    {"UnknownTable", "[materials]\nh0 = 4.0\n",
     "deck.toml:1:2: unknown table [materials]; did you mean [material]?"},
    {"KeyOutsideTables", "grains = 4\n",
     "deck.toml:1:1: unknown key 'grains'; it belongs in [polycrystal]"},
    {"WrongType", "[polycrystal]\ngrains = \"thirty\"\n",
     "deck.toml:2:10: [polycrystal] grains = \"thirty\" must be an integer"},
    {"FractionOfAGrain", "[polycrystal]\ngrains = 30.5\n",
     "deck.toml:2:10: [polycrystal] grains = 30.5 must be an integer"},
    {"NoGrains", "[polycrystal]\ngrains = 0\n",
     "deck.toml:2:10: [polycrystal] grains = 0 must be >= 1 and <= 1000000"},
    {"NegativeSize", "[mesh]\nelement_size = -0.5\n",
     "deck.toml:2:16: [mesh] element_size = -0.5 must be >= 0.01 and <= 10"},
    {"NotANumber", "[loading]\nstrain_rate = nan\n",
     "deck.toml:2:15: [loading] strain_rate = nan must be finite"},
    {"FlatBox", "[polycrystal]\ndomain = [1.0, 1.0, 0.0]\n",
     "deck.toml:2:21: [polycrystal] domain: entry 3 = 0.0 must be > 0"},
    {"TwoLengths", "[polycrystal]\ndomain = [1.0, 1.0]\n",
     "deck.toml:2:10: [polycrystal] domain = [1.0, 1.0] must be a list of three numbers"},
    {"UnknownShape", "[polycrystal]\nshape = \"ball\"\n",
     "deck.toml:2:9: [polycrystal] shape = \"ball\" must be \"box\", \"cylinder\", \"sphere\" or "
     "\"half-spaces\""},
    {"FacetsOfABox", "[polycrystal]\nfaceting_error = 0.01\n",
     "deck.toml:2:18: [polycrystal] faceting_error is not used with shape = \"box\"; remove it"},
    {"NoFacets", "[polycrystal]\nfaceting_error = 0\nshape = \"sphere\"\n",
     "deck.toml:2:18: [polycrystal] faceting_error = 0 must be >= 0.001 and <= 0.2"},
    {"AxisOfABox", "[polycrystal]\naxis = \"x\"\n",
     "deck.toml:2:8: [polycrystal] axis is not used with shape = \"box\" and morphology = "
     "\"voronoi\"; remove it"},
    {"HalfSpaceOfThreeNumbers",
     "[polycrystal]\nhalf_spaces = [[1, 0, 0]]\nshape = \"half-spaces\"\n",
     "deck.toml:2:16: [polycrystal] half_spaces: entry 1 = [1, 0, 0] must be a list of 4 numbers"},
    {"HalfSpacesWithoutEnd",
     "[polycrystal]\nhalf_spaces = [[-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 1]]\n"
     "shape = \"half-spaces\"\n",
     "deck.toml:2:15: [polycrystal] the half-spaces enclose no body: it has no end along "
     "half-space "
     "1 (-1 x + 0 y + 0 z <= 0); add half-spaces"},
    {"HalfSpacesOfABox", "[polycrystal]\nhalf_spaces = [[1, 0, 0, 1]]\n",
     "deck.toml:2:15: [polycrystal] half_spaces is not used with shape = \"box\"; remove it"},
    {"UnknownMorphology", "[polycrystal]\nmorphology = \"bambo\"\n",
     "deck.toml:2:14: [polycrystal] morphology = \"bambo\" must be \"voronoi\", \"columnar\", "
     "\"bamboo\", \"columnar-equiaxed\", \"cubes\", \"truncated-octahedra\", "
     "\"rhombic-dodecahedra\", \"laguerre\" or \"grain-growth\"; did you mean \"bamboo\"?"},
    {"SphericityOfVoronoi", "[polycrystal]\nsphericity_mean = 0.85\n",
     "deck.toml:2:19: [polycrystal] sphericity_mean is not used with morphology = \"voronoi\"; "
     "remove it"},
    {"RounderThanCanBe", "[polycrystal]\nmorphology = \"laguerre\"\nsphericity_mean = 0.99\n",
     "deck.toml:3:19: [polycrystal] sphericity_mean = 0.99 must be > 0.5 and < 0.95"},
    {"LaguerreOfOneGrain", "[polycrystal]\nmorphology = \"grain-growth\"\ngrains = 1\n",
     "deck.toml:3:10: [polycrystal] grains: a Laguerre polycrystal needs 2 grains or more"},
    {"PeriodicColumns", "[polycrystal]\nmorphology = \"columnar\"\nperiodic = [\"x\"]\n",
     "deck.toml:3:12: [polycrystal] periodic polycrystals are Voronoi cells of a box, not of "
     "morphology = \"columnar\""},
    {"PeriodicStretch", "[polycrystal]\nstretch = [2.0, 1.0, 1.0]\nperiodic = [\"x\"]\n",
     "deck.toml:3:12: [polycrystal] periodic is not used with stretch; remove one of them"},
    {"FlatStretch", "[polycrystal]\nstretch = [1.0, 0.0, 1.0]\n",
     "deck.toml:2:17: [polycrystal] stretch: entry 2 = 0.0 must be > 0"},
    {"ShareOfNoColumns", "[polycrystal]\ncolumnar_share = 0.5\n",
     "deck.toml:2:18: [polycrystal] columnar_share is not used with morphology = \"voronoi\"; "
     "remove it"},
    {"GrainsOfNoGrid", "[polycrystal]\ngrains = 30\nmorphology = \"cubes\"\n",
     "deck.toml:2:10: [polycrystal] 30 grains do not fill the domain with cubes: give cells = [3, "
     "3, 3] (27 grains), or others, instead"},
    {"HalfACube", "[polycrystal]\ncells = [1, 2, 2.5]\nmorphology = \"cubes\"\n",
     "deck.toml:2:9: [polycrystal] cells: entry 3 = 2.5 must be an integer"},
    {"TwoCells", "[polycrystal]\ncells = [1, 2]\nmorphology = \"cubes\"\n",
     "deck.toml:2:9: [polycrystal] cells = [1, 2] must be a list of 3 numbers"},
    {"CellsAndGrains", "[polycrystal]\ngrains = 8\ncells = [2, 2, 2]\nmorphology = \"cubes\"\n",
     "deck.toml:2:10: [polycrystal] grains is not used with cells; remove one of them"},
    {"CellsOfRandomSeeds", "[polycrystal]\ncells = [2, 2, 2]\n",
     "deck.toml:2:9: [polycrystal] cells is not used with morphology = \"voronoi\"; remove it"},
    {"NoSeeds", "[polycrystal]\nseeds = \"none.txt\"\n",
     "deck.toml:2:9: [polycrystal] none.txt: no such file"},
    {"UnknownMesher", "[mesh]\nmeshers = [\"gmsh\"]\n",
     "deck.toml:2:12: [mesh] meshers: entry 1 = \"gmsh\" must be \"gmsh-hxt\", \"gmsh-delaunay\", "
     "\"netgen\", \"gmsh-hxt-plain\", \"gmsh-delaunay-plain\", \"paper-1\" or \"paper-2\""},
    {"OuterSizeOfNothing", "[mesh]\nelement_size_outer = 0\n",
     "deck.toml:2:22: [mesh] element_size_outer = 0 must be >= 0.01 and <= 10"},
    {"GrainSizeOfNothing", "[mesh]\ngrain_element_sizes = [0.5, -1]\n",
     "deck.toml:2:29: [mesh] grain_element_sizes: entry 2 = -1 must be >= 0.01 and <= 10"},
    {"GrainSizesOfOthers", "[polycrystal]\ngrains = 5\n[mesh]\ngrain_element_sizes = [0.5, 1]\n",
     "deck.toml:4:23: [mesh] grain_element_sizes: 2 numbers for 5 grains; give one a grain"},
    {"NoMesher", "[mesh]\nmeshers = []\n",
     "deck.toml:2:11: [mesh] meshers = [] must name at least one"},
    {"RightAngleOfAFace", "[regularisation]\nmax_flatness_fault = 90\n",
     "deck.toml:2:22: [regularisation] max_flatness_fault = 90 must be >= 0 and < 90"},
    {"UnknownDirection", "[polycrystal]\nperiodic = [\"w\"]\n",
     "deck.toml:2:13: [polycrystal] periodic: entry 1 = \"w\" must be \"x\", \"y\" or \"z\""},
    {"SearchBelowOne", "[regularisation]\nposition_search = 0.5\n",
     "deck.toml:2:19: [regularisation] position_search = 0.5 must be >= 1 and <= 4"},
    {"NegativeSweeps", "[regularisation]\nflattening_sweeps = -1\n",
     "deck.toml:2:21: [regularisation] flattening_sweeps = -1 must be >= 0 and <= 10"},
    {"OrderThree", "[mesh]\norder = 3\n", "deck.toml:2:9: [mesh] order = 3 must be >= 1 and <= 2"},
    {"FinalStrainBelowARemeshingStrain",
     "[loading]\nfinal_strain = 0.2\n[remeshing]\nat_strains = [0.3]\n",
     "deck.toml:4:14: [remeshing] at_strains: 0.3 must be < final_strain = 0.2 (deck.toml:2:16)"},
    {"RemeshingStrainsFall", "[remeshing]\nat_strains = [0.3, 0.2]\n",
     "deck.toml:2:20: [remeshing] at_strains: entry 2 = 0.2 must be larger than the entry before "
     "it"},
    {"OutputBeyondTheEnd", "[output]\nat_strains = [0.7]\n",
     "deck.toml:2:14: [output] at_strains: 0.7 must be <= final_strain = 0.6 (default)"},
    {"UnstableCrystal", "[material]\nc11 = 50e3\n",
     "deck.toml:2:7: [material] c11 = 50000 must be > c12 = 60900 (default): the crystal would be "
     "unstable in shear"},
    {"VoceExponentOfNothing", "[material]\nvoce_exponent = 0\n",
     "deck.toml:2:17: [material] voce_exponent = 0 must be >= 0.1 and <= 10"},
    {"NegativeLatentRatio", "[material]\nlatent_ratio = -1\n",
     "deck.toml:2:16: [material] latent_ratio = -1 must be >= 0 and <= 5"},
    {"TooSharpAPowerLaw", "[material]\nrate_sensitivity = 0.001\n",
     "deck.toml:2:20: [material] rate_sensitivity = 0.001 must be >= 0.003 and <= 1"},
    {"SaturationBelowStart", "[material]\ngs = 7.0\n",
     "deck.toml:2:6: [material] gs = 7 must be > g0 = 8 (default)"},
    {"MissingOrientationFile", "[orientations]\ndistribution = \"file\"\nfile = \"ori.txt\"\n",
     "deck.toml:3:8: [orientations] ori.txt: no such file"},
    {"OrientationFileNotUsed", "[orientations]\nfile = \"ori.txt\"\n",
     "deck.toml:2:8: [orientations] file is not used with distribution = \"uniform\"; remove it, "
     "or set distribution = \"file\""},
    {"TwoMeshFilesOfOneName", "[output]\nmesh_formats = [\"msh\", \"vtu\", \"msh4\"]\n",
     "deck.toml:2:16: [output] mesh_formats names 2 of Gmsh's formats; must be one of msh, "
     "msh-binary, msh4 and msh4-binary, and any others"},
    {"NoMeshFileToRead", "[output]\nmesh_formats = [\"vtu\"]\n",
     "deck.toml:2:16: [output] mesh_formats names 0 of Gmsh's formats; must be one of msh, "
     "msh-binary, msh4 and msh4-binary, and any others"},
    {"ComponentsMissing", "[orientations]\ndistribution = \"components\"\n",
     "deck.toml:2:16: [orientations] distribution = \"components\" needs a table "
     "[[orientations.component]] at least"},
    {"ComponentsNotUsed", "[[orientations.component]]\nname = \"cube\"\n",
     "deck.toml:1:1: [orientations.component 1] components are not used with distribution = "
     "\"uniform\"; remove them, or set distribution = \"components\""},
    {"ComponentUnknown",
     "[orientations]\ndistribution = \"components\"\n[[orientations.component]]\n"
     "name = \"cube\"\n[[orientations.component]]\nname = \"bras\"\n",
     "deck.toml:6:8: [orientations.component 2] name = \"bras\" must be \"cube\", \"goss\", "
     "\"brass\", \"copper\", \"s\", \"dillamore\" or \"rotated-cube\"; did you mean \"brass\"?"},
    {"FibreWithoutDirection",
     "[orientations]\ndistribution = \"components\"\n[[orientations.component]]\n"
     "type = \"fibre\"\ncrystal = [1, 1, 1]\n",
     "deck.toml:4:8: [orientations.component 1] type = \"fibre\" needs crystal and sample, and no "
     "name, plane, direction or euler"},
    {"ParallelMillerIndices",
     "[orientations]\ndistribution = \"components\"\n[[orientations.component]]\n"
     "plane = [1, 1, 1]\ndirection = [2, 2, 2]\n",
     "deck.toml:4:9: [orientations.component 1] a plane and a direction must not be zero or "
     "parallel"},
    {"LoadingUnknown", "[loading]\ntype = \"tension\"\n",
     "deck.toml:2:8: [loading] type = \"tension\" must be \"plane-strain-compression\", "
     "\"uniaxial-tension\", \"uniaxial-compression\", \"simple-shear\", \"velocity-gradient\" or "
     "\"faces\""},
    {"AxisTwice", "[loading]\nconstrained_axis = \"z\"\n",
     "deck.toml:2:20: [loading] constrained_axis must differ from axis"},
    {"ShearAlongItsNormal", "[loading]\ntype = \"simple-shear\"\ndirection = \"z\"\n",
     "deck.toml:3:13: [loading] direction must differ from axis"},
    {"KeyOfAnotherLoad", "[loading]\ntype = \"uniaxial-tension\"\nx0 = \"fixed\"\n",
     "deck.toml:3:6: [loading] x0 is not used with type = \"uniaxial-tension\"; remove it"},
    {"GradientWithTrace",
     "[loading]\ntype = \"velocity-gradient\"\nvelocity_gradient = [1, 0, 0, 0, 0, 0, 0, 0, 0]\n",
     "deck.toml:3:21: [loading] velocity_gradient has the trace 1, must be 0: plastic flow keeps "
     "volumes"},
    {"RotationOnly",
     "[loading]\ntype = \"velocity-gradient\"\nvelocity_gradient = [0, 1, 0, -1, 0, 0, 0, 0, 0]\n",
     "deck.toml:3:21: [loading] velocity_gradient strains nothing: D = 0"},
    {"NothingMoves", "[loading]\ntype = \"faces\"\nz0 = \"fixed\"\n",
     "deck.toml:2:8: [loading] type = \"faces\": no face has a velocity or a traction"},
    {"NothingHolds",
     "[loading]\ntype = \"faces\"\nz0 = \"sliding\"\nz1 = \"sliding\"\nz1_velocity = [0, 0, 1]\n",
     "deck.toml:2:8: [loading] type = \"faces\": nothing holds the box along x; fix a face or hold "
     "a corner"},
    {"SlidingSideways",
     "[loading]\ntype = \"faces\"\nz0 = \"fixed\"\nz1 = \"sliding\"\nz1_velocity = [1, 0, 0]\n",
     "deck.toml:5:15: [loading] z1_velocity: a sliding face has a normal velocity only; set z1 = "
     "\"moving\""},
    {"NoCorner",
     "[loading]\ntype = \"faces\"\nheld = [\"x0y0:x\"]\nz0 = \"fixed\"\nz1 = \"sliding\"\n"
     "z1_velocity = [0, 0, 1]\n",
     "deck.toml:3:8: [loading] held: \"x0y0:x\" must name a corner and directions, such as "
     "\"x0y0z0:xy\""},
    {"StageWithoutTarget", "[[loading.stage]]\nstrain_rate = 2\n",
     "deck.toml:1:1: [loading.stage 1] a stage needs a target: strain, time or stress"},
    {"StageKeyUnknown", "[[loading.stage]]\nstrian = 0.1\n",
     "deck.toml:2:1: [loading.stage 1] unknown key 'strian'; did you mean 'strain'?"},
    {"StagesAndFinalStrain", "[loading]\nfinal_strain = 1\n[[loading.stage]]\nstrain = 0.1\n",
     "deck.toml:2:16: [loading] final_strain is not used with [[loading.stage]]; remove it"},
    {"StageAgainstItsRate", "[[loading.stage]]\nstrain = 0.1\nstrain_rate = -1\n",
     "deck.toml:2:10: [loading.stage 1] strain = 0.1 lies ahead of 0, but strain_rate is negative"},
    {"StageBackInTime", "[[loading.stage]]\ntime = 0.1\n[[loading.stage]]\ntime = 0.05\n",
     "deck.toml:4:8: [loading.stage 2] time = 0.05 must be > 0.1, the end of the stage before"},
};

INSTANTIATE_TEST_SUITE_P(Wrong, Deck, ::testing::ValuesIn(wrong_decks),
                         [](const auto& deck) { return std::string(deck.param.name); });

TEST(DeckFile, MissingOrAFolder) {
  Sandbox sandbox;
  expect_rejection(sandbox, {"check", "deck.toml"}, "deck.toml: no such file");
  expect_rejection(sandbox, {"run", "a/deck.toml", "--out", "out"}, "a/deck.toml: no such file");
  expect_rejection(sandbox, {"check", "."}, ".: cannot read: Is a directory");
}

TEST(DeckFile, SyntaxIsOneLineWithItsPlace) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "[mesh]\norder = 2\norder = 2\n");
  const Outcome outcome = run_polyslip({"check", "deck.toml"}, sandbox.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.rfind("deck.toml:3:", 0), 0u) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
}

TEST(DeckFile, LinearElementsAreForMeshingOnly) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "[mesh]\norder = 1\n");
  const std::string line =
      "deck.toml:2:9: [mesh] order = 1 is for `polyslip mesh` only; a run needs order = 2";
  expect_rejection(sandbox, {"check", "deck.toml"}, line);
  expect_rejection(sandbox, {"run", "deck.toml", "--out", "out"}, line);
}

TEST(OrientationFile, WrongLines) {
  Sandbox sandbox;
  sandbox.write("deck.toml",
                "[polycrystal]\ngrains = 2\n[orientations]\ndistribution = \"file\"\n"
                "file = \"ori.txt\"\n");
  const auto rejected = [&](const std::string& text, const std::string& line) {
    sandbox.write("ori.txt", text);
    expect_rejection(sandbox, {"run", "deck.toml", "--out", "out"}, line);
  };
  rejected("1 0 0 0\n", "ori.txt:1: ends after 1 of 2 orientations, one a grain");
  rejected("1 0 0 0\n1 0 0 0\n1 0 0 0\n",
           "ori.txt:3: more orientations than the 2 grains of the deck");
  rejected("1 0 0 0\n1 0 0 nan\n", "ori.txt:2: nan is not finite");
  rejected("1 0 0 0\n0.1 0.2 0.3\n", "ori.txt:2: 3 numbers, must be 4 (quaternion: w x y z)");
}

TEST(CorrectDeck, Passes) {
  Sandbox sandbox;
  sandbox.write("deck.toml", "");
  const auto before = tree(sandbox.path());
  const Outcome outcome = run_polyslip({"check", "deck.toml"}, sandbox.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(tree(sandbox.path()), before);
}

}  // namespace
}  // namespace polyslip::tests
