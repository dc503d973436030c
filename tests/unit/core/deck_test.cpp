#include "core/deck.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/error.hpp"
#include "core/toml.hpp"

namespace polyslip::core {
namespace {

/// What a small program of our own would read.
struct Read {
  double h0, g0, size;
  std::int64_t grains;
  bool fixed;
  std::string kind;
  std::vector<double> strains;
  std::vector<std::string> meshers;
  Vec3 domain;
  std::optional<double> limit;
  std::optional<std::string> file;
};

Read read(Deck& deck) {
  Read r;
  auto material = deck.table("material", "The crystals.");
  r.h0 = material.number("h0", {.unit = "MPa", .fallback = 4, .min = 0, .help = "Hardening."});
  r.g0 = material.number(
      "g0", {.unit = "MPa", .min = 0, .exclusive_min = true, .help = "Initial slip resistance."});
  auto mesh = deck.table("mesh", "The mesh.");
  r.size = mesh.number("element_size", {.fallback = 0.1 + 0.2,
                                        .min = 0,
                                        .exclusive_min = true,
                                        .max = 5,
                                        .help = "Size | of elements."});
  r.grains = mesh.integer("grains", {.fallback = 30, .min = 1, .max = 100, .help = "Number."});
  r.fixed = mesh.boolean("fixed", {.fallback = false, .help = "Fixed."});
  r.kind = mesh.text("kind", {.fallback = "uniform", .choices = {"uniform", "file"}, .help = "K."});
  r.strains = mesh.numbers("strains", {.fallback = std::vector<double>{0.1},
                                       .min = 0,
                                       .exclusive_min = true,
                                       .increasing = true,
                                       .help = "S."});
  r.meshers = mesh.texts("meshers", {.fallback = std::vector<std::string>{"a", "b"},
                                     .choices = {"a", "b", "netgen"},
                                     .unique = true,
                                     .not_empty = true,
                                     .help = "M."});
  r.domain = mesh.vector3(
      "domain",
      {.fallback = std::vector<double>{1, 1, 1}, .min = 0, .exclusive_min = true, .help = "D."});
  r.limit = mesh.optional_number("limit", {.unit = "s", .help = "L."});
  r.file = mesh.optional_file("file", {.help = "F."});
  return r;
}

std::string error_of(const std::string& text) {
  try {
    Deck deck = Deck::from_text(text, "deck.toml");
    read(deck);
    deck.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The error of a deck that is right but for these lines of [mesh], which start at line 3.
std::string mesh_error(const std::string& lines) {
  return error_of("material.g0 = 8\n[mesh]\n" + lines + "\n");
}

TEST(Deck, GivesValuesAndDefaults) {
  Deck deck = Deck::from_text(
      "[material]\ng0 = 8\n[mesh]\ngrains = 7\nfixed = true\nkind = \"file\"\n"
      "strains = [0.1, 1]\nmeshers = [\"netgen\"]\ndomain = [1, 2.5, 3]\nfile = \"a/ori.txt\"\n",
      "some/deck.toml");
  const Read r = read(deck);
  EXPECT_NO_THROW(deck.finish());
  EXPECT_EQ(r.g0, 8);
  EXPECT_EQ(r.h0, 4);
  EXPECT_EQ(r.grains, 7);
  EXPECT_TRUE(r.fixed);
  EXPECT_EQ(r.kind, "file");
  EXPECT_EQ(r.strains, (std::vector<double>{0.1, 1}));
  EXPECT_EQ(r.meshers, std::vector<std::string>{"netgen"});
  EXPECT_EQ(r.domain, Vec3(1, 2.5, 3));
  EXPECT_FALSE(r.limit);
  EXPECT_EQ(r.file, "some/a/ori.txt");
}

TEST(Deck, UnknownKeysNameTheNearest) {
  EXPECT_EQ(error_of("[material]\ng0 = 8\n  h_0 = 3\n"),
            "deck.toml:3:3: [material] unknown key 'h_0'; did you mean 'h0'?");
  EXPECT_EQ(mesh_error("elementsize = 1"),
            "deck.toml:3:1: [mesh] unknown key 'elementsize'; did you mean 'element_size'?");
  EXPECT_EQ(mesh_error("h0 = 1"),
            "deck.toml:3:1: [mesh] unknown key 'h0'; it belongs in [material]");
  EXPECT_EQ(error_of("[material]\ng0 = 8\ncolour = 3\n"),
            "deck.toml:3:1: [material] unknown key 'colour'; known: h0, g0");
}

TEST(Deck, UnknownTablesAndLooseKeys) {
  EXPECT_EQ(error_of("[materials]\ng0 = 8\n"),
            "deck.toml:1:2: unknown table [materials]; did you mean [material]?");
  EXPECT_EQ(error_of("[material]\ng0 = 8\n[colour]\n"),
            "deck.toml:3:2: unknown table [colour]; known: [material], [mesh]");
  EXPECT_EQ(error_of("grains = 8\n[material]\ng0 = 8\n"),
            "deck.toml:1:1: unknown key 'grains'; it belongs in [mesh]");
  EXPECT_EQ(error_of("colour = 8\n[material]\ng0 = 8\n"),
            "deck.toml:1:1: unknown key 'colour'; keys belong in tables: [material], [mesh]");
  EXPECT_EQ(error_of("mesh = 8\n[material]\ng0 = 8\n"), "deck.toml:1:1: [mesh] must be one table");
  EXPECT_EQ(error_of("[[mesh]]\n[material]\ng0 = 8\n"), "deck.toml:1:3: [mesh] must be one table");
  EXPECT_EQ(error_of("[material]\ng0 = 8\n[mesh.grains]\nx = 1\n"),
            "deck.toml:3:1: [mesh] grains = (table, date or time) must be an integer");
}

TEST(Deck, WrongTypes) {
  EXPECT_EQ(error_of("[material]\ng0 = \"eight\"\n"),
            "deck.toml:2:6: [material] g0 = \"eight\" must be a number");
  EXPECT_EQ(mesh_error("grains = 3.0"), "deck.toml:3:10: [mesh] grains = 3.0 must be an integer");
  EXPECT_EQ(mesh_error("fixed = 1"), "deck.toml:3:9: [mesh] fixed = 1 must be true or false");
  EXPECT_EQ(mesh_error("kind = 1"), "deck.toml:3:8: [mesh] kind = 1 must be a text in quotes");
  EXPECT_EQ(mesh_error("strains = 1"),
            "deck.toml:3:11: [mesh] strains = 1 must be a list of numbers");
  EXPECT_EQ(mesh_error("meshers = [\"a\", 1]"),
            "deck.toml:3:17: [mesh] meshers: entry 2 = 1 must be a text in quotes");
  EXPECT_EQ(mesh_error("domain = [1, 2]"),
            "deck.toml:3:10: [mesh] domain = [1, 2] must be a list of three numbers");
  EXPECT_EQ(mesh_error("domain = 1"),
            "deck.toml:3:10: [mesh] domain = 1 must be a list of three numbers");
}

TEST(Deck, BoundsAndChoices) {
  EXPECT_EQ(mesh_error("element_size = -0.5"),
            "deck.toml:3:16: [mesh] element_size = -0.5 must be > 0 and <= 5");
  EXPECT_EQ(mesh_error("element_size = 0"),
            "deck.toml:3:16: [mesh] element_size = 0 must be > 0 and <= 5");
  EXPECT_EQ(mesh_error("element_size = nan"),
            "deck.toml:3:16: [mesh] element_size = nan must be finite");
  EXPECT_EQ(mesh_error("limit = inf"), "deck.toml:3:9: [mesh] limit = inf must be finite");
  EXPECT_EQ(mesh_error("grains = 0"), "deck.toml:3:10: [mesh] grains = 0 must be >= 1 and <= 100");
  EXPECT_EQ(mesh_error("strains = [0.2, 0]"),
            "deck.toml:3:17: [mesh] strains: entry 2 = 0 must be > 0");
  EXPECT_EQ(
      mesh_error("strains = [0.2, 0.2]"),
      "deck.toml:3:17: [mesh] strains: entry 2 = 0.2 must be larger than the entry before it");
  EXPECT_EQ(mesh_error("domain = [1, -1, 1]"),
            "deck.toml:3:14: [mesh] domain: entry 2 = -1 must be > 0");
  EXPECT_EQ(
      mesh_error("kind = \"unifrom\""),
      "deck.toml:3:8: [mesh] kind = \"unifrom\" must be \"uniform\" or \"file\"; did you mean "
      "\"uniform\"?");
  EXPECT_EQ(mesh_error("meshers = []"),
            "deck.toml:3:11: [mesh] meshers = [] must name at least one");
  EXPECT_EQ(mesh_error("meshers = [\"a\", \"a\"]"),
            "deck.toml:3:17: [mesh] meshers: entry 2 = \"a\" is there twice");
}

TEST(Deck, BoundsThemselvesAreAllowed) {
  EXPECT_EQ(mesh_error("element_size = 5\ngrains = 100"), "no error");
  EXPECT_EQ(mesh_error("grains = 1\nstrains = []"), "no error");
}

TEST(Deck, MissingKeys) {
  EXPECT_EQ(error_of("[mesh]\n[material]\n"), "deck.toml:2:2: [material] missing key 'g0'");
  EXPECT_EQ(error_of(""), "deck.toml: [material] missing key 'g0'");
}

TEST(Deck, TheFirstFaultOfTheTextIsGiven) {
  EXPECT_EQ(error_of("[mesh]\nx = 1\ngrains = 0\n[material]\ng0 = 0\n"),
            "deck.toml:2:1: [mesh] unknown key 'x'; known: element_size, grains, fixed, kind, "
            "strains, meshers, domain, limit, file");
  EXPECT_EQ(error_of("[mesh]\ngrains = 0\nx = 1\n[material]\ng0 = 0\n").substr(0, 16),
            "deck.toml:2:10: ");
}

TEST(Deck, SyntaxIsOneLine) {
  for (const char* text : {"[material]\ng0 = \n", "[material\n", "[material]\ng0 = 8\ng0 = 9\n",
                           "[material]\ng0 = \"a\n", "\xff\xfe"}) {
    const std::string error = error_of(text);
    EXPECT_EQ(error.rfind("deck.toml:", 0), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_EQ(error_of("[material]\ng0 = 8\ng0 = 9\n").rfind("deck.toml:3:", 0), 0u)
      << error_of("[material]\ng0 = 8\ng0 = 9\n");
}

TEST(Deck, AMissingFileIsNamed) {
  try {
    Deck::from_file("no/deck.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "no/deck.toml: no such file");
  }
}

TEST(Deck, FaultsBetweenKeysComeAfterThoseOfKeys) {
  const auto check = [](const std::string& text) -> std::string {
    Deck deck = Deck::from_text(text, "deck.toml");
    read(deck);
    auto t = deck.table("loading");
    const double last = t.number("final_strain", {.fallback = 0.6});
    if (last < 1)
      t.fault("final_strain", fmt::format("final_strain = {} is below what {} asks", last,
                                          t.where("final_strain")));
    try {
      deck.finish();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(check("material.g0 = 8\n[loading]\nfinal_strain = 0.5"),
            "deck.toml:3:16: [loading] final_strain = 0.5 is below what deck.toml:3:16 asks");
  EXPECT_EQ(check("material.g0 = 8\n"),
            "deck.toml: [loading] final_strain = 0.6 is below what deck.toml asks");
  EXPECT_EQ(check("[loading]\nfinal_strain = 0.5\n[material]\ng0 = 0\n"),
            "deck.toml:4:6: [material] g0 = 0 must be > 0");
}

TEST(Deck, ResolvedReadsBackToTheSameValues) {
  const std::string text =
      "[material]\ng0 = 0.1000000000000000055511151231257827\nh0 = 1e-300\n"
      "[mesh]\nelement_size = 0.30000000000000004\ndomain = [1, 2.0000000000000004, 1e22]\n"
      "file = \"a \\\"b\\\" \\\\ \\u0001.txt\"\n";
  Deck deck = Deck::from_text(text, "/folder/deck.toml");
  const Read a = read(deck);
  deck.finish();
  const std::string resolved = deck.resolved();
  Deck again = Deck::from_text(resolved, "/elsewhere/deck.resolved.toml");
  const Read b = read(again);
  again.finish();
  EXPECT_EQ(a.g0, b.g0);
  EXPECT_EQ(a.h0, b.h0);
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.domain, b.domain);
  EXPECT_EQ(a.strains, b.strains);
  EXPECT_EQ(a.meshers, b.meshers);
  EXPECT_EQ(a.file, b.file);
  EXPECT_EQ(a.file, "/folder/a \"b\" \\ \x01.txt");
  EXPECT_EQ(resolved, again.resolved());
  EXPECT_EQ(deck.fingerprint(), again.fingerprint());
  EXPECT_NE(resolved.find("h0 = 1e-300"), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("# [MPa] Hardening."), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("# limit is not set"), std::string::npos) << resolved;
}

TEST(Deck, FingerprintSeesValuesOnly) {
  const auto fingerprint = [](const std::string& text) {
    Deck deck = Deck::from_text(text, "deck.toml");
    read(deck);
    return deck.fingerprint();
  };
  EXPECT_EQ(fingerprint("[material]\ng0 = 8"),
            fingerprint("# hello\n[mesh]\n[material]\ng0 = 8.0"));
  EXPECT_NE(fingerprint("[material]\ng0 = 8"), fingerprint("[material]\ng0 = 8.000000000000002"));
}

TEST(Deck, ReferenceListsEveryKey) {
  Deck deck = Deck::from_text("", "deck.toml");
  read(deck);
  const std::string reference = deck.reference();
  EXPECT_NE(reference.find("## [material]\n\nThe crystals.\n"), std::string::npos) << reference;
  EXPECT_NE(reference.find("| `h0` | number | MPa | `4.0` | >= 0 | Hardening. |\n"),
            std::string::npos)
      << reference;
  EXPECT_NE(reference.find("| `g0` | number | MPa | required | > 0 |"), std::string::npos);
  EXPECT_NE(reference.find("| `limit` | number | s | none |"), std::string::npos);
  EXPECT_NE(reference.find("| Size \\| of elements. |"), std::string::npos);
  for (const auto& d : deck.declarations())
    EXPECT_NE(reference.find("| `" + d.key + "` |"), std::string::npos) << d.key;
  EXPECT_EQ(deck.declarations().size(), 11u);
}

TEST(Deck, AKeyIsDeclaredOnce) {
  Deck deck = Deck::from_text("", "deck.toml");
  auto t = deck.table("a");
  t.number("b", {.fallback = 1});
  EXPECT_THROW(t.integer("b", {.fallback = 1}), InternalError);
}

TEST(Deck, GivenTellsDefaultsApart) {
  Deck deck = Deck::from_text("[a]\nb = 1\n", "deck.toml");
  auto t = deck.table("a");
  EXPECT_TRUE(t.given("b"));
  EXPECT_FALSE(t.given("c"));
}

TEST(EditDistance, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("h_0", "h0"), 1);
  EXPECT_EQ(edit_distance("unifrom", "uniform"), 1);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(nearest_name("xyz", {"grains", "seed"}), "");
}

TEST(Toml, NumbersKeepTheirValueAndKind) {
  EXPECT_EQ(toml_text(107.3e3), "107300.0");
  EXPECT_EQ(toml_text(0.1), "0.1");
  EXPECT_EQ(toml_text(1e22), "1e+22");
  EXPECT_EQ(toml_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(toml_text(-0.0), "-0.0");
}

std::vector<double> weights(Deck& deck) {
  deck.table("meal", "A meal.");
  std::vector<double> found;
  for (auto& course : deck.tables("meal.course", "A course."))
    found.push_back(course.number("weight", {.fallback = 1, .min = 0, .help = "Weight."}));
  return found;
}

TEST(Deck, ReadsListsOfTables) {
  Deck deck = Deck::from_text(
      "[meal]\n[[meal.course]]\nweight = 2\n[[meal.course]]\n[[meal.course]]\nweight = 3\n", "d");
  EXPECT_EQ(weights(deck), (std::vector<double>{2, 1, 3}));
  EXPECT_NO_THROW(deck.finish());
  EXPECT_EQ(deck.where("meal.course 3", "weight"), "d:6:10");
  Deck again = Deck::from_text(deck.resolved(), "d");
  EXPECT_EQ(weights(again), (std::vector<double>{2, 1, 3}));
  EXPECT_EQ(again.resolved(), deck.resolved());
  EXPECT_NE(deck.reference().find("## [[meal.course]]"), std::string::npos);
  Deck none = Deck::from_text("", "d");
  EXPECT_TRUE(weights(none).empty());
}

TEST(Deck, FaultsOfListsNameTheTable) {
  const auto fault = [](const std::string& text) -> std::string {
    Deck deck = Deck::from_text(text, "d");
    weights(deck);
    try {
      deck.finish();
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(fault("[[meal.course]]\n[[meal.course]]\nweigth = 2\n"),
            "d:3:1: [meal.course 2] unknown key 'weigth'; did you mean 'weight'?");
  EXPECT_EQ(fault("[[meal.course]]\nweight = -2\n"),
            "d:2:10: [meal.course 1] weight = -2 must be >= 0");
  EXPECT_NE(fault("[[meal.curse]]\nweight = 2\n"), "");
  EXPECT_NE(fault("[meal]\ncourse = 3\n"), "");
}

}  // namespace
}  // namespace polyslip::core
