#include "system/small_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "results/state_file.hpp"

namespace polyslip::tests {

namespace fs = std::filesystem;

namespace {

std::string deck_of(const std::string& loading, const std::string& solver) {
  return R"([polycrystal]
grains = 8
seed = 1
[mesh]
element_size = 0.8
meshers = ["gmsh-hxt"]
[loading]
final_strain = 0.06
max_strain_increment = 0.01
)" + loading +
         R"([remeshing]
at_strains = [0.03]
[solver]
)" + solver +
         R"([output]
at_strains = [0.02]
checkpoint_every_strain = 0.01
)";
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

std::string small_deck(const std::string& loading, const std::string& solver) {
  return deck_of(loading, solver);
}

std::string tight_deck() {
  return deck_of("fixed_increment = true\n",
                 "newton_tolerance = 1e-9\nlinear_tolerance = 1e-9\n"
                 "max_newton_iterations = 50\n");
}

double MacroRow::von_mises() const {
  const auto& s = stress;
  const double normal =
      std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
  return std::sqrt(normal / 2 + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

std::vector<MacroRow> read_macro(const fs::path& run) {
  std::istringstream text(slurp(run / "macro.csv"));
  std::vector<MacroRow> rows;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    if (v.size() != 32u || line.back() == ',') {
      ADD_FAILURE() << run / "macro.csv"
                    << ": '" << line << "'";
      return rows;
    }
    rows.push_back({v[0],
                    v[1],
                    v[2],
                    {v.begin() + 3, v.begin() + 9},
                    v[9],
                    v[10],
                    v[11],
                    static_cast<int>(v[12]),
                    static_cast<int>(v[13]),
                    static_cast<int>(v[14])});
  }
  EXPECT_FALSE(rows.empty()) << run;
  return rows;
}

double stress_at(const std::vector<MacroRow>& rows, double strain) {
  double from = 0, below = 0;
  for (const MacroRow& row : rows) {
    if (row.remeshed) below = 0;
    const double here = row.von_mises();
    if (row.strain >= strain) return below + (here - below) * (strain - from) / (row.strain - from);
    from = row.strain;
    below = here;
  }
  return below;
}

long line_count(const fs::path& file) {
  const std::string text = slurp(file);
  return std::count(text.begin(), text.end(), '\n');
}

std::size_t state_count(const fs::path& run) {
  return results::StateSeries(run.string()).states().size();
}

mesh::Snapshot state_of(const fs::path& run, std::size_t number) {
  const results::StateSeries series(run.string());
  return results::read_state(series.path(series.states().at(number)));
}

mesh::Snapshot last_state(const fs::path& run) { return state_of(run, state_count(run) - 1); }

void expect_identical(const mesh::Snapshot& a, const mesh::Snapshot& b) {
  EXPECT_EQ(a.strain, b.strain);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.mesh_number, b.mesh_number);
  EXPECT_GT(a.mesh.element_count(), 0);
  EXPECT_EQ(a.mesh.tetrahedra, b.mesh.tetrahedra);
  EXPECT_EQ(a.mesh.tetrahedron_cell, b.mesh.tetrahedron_cell);
  EXPECT_TRUE(a.mesh.nodes == b.mesh.nodes);
  EXPECT_FALSE(a.fields.empty());
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    EXPECT_EQ(a.fields[i].name, b.fields[i].name);
    EXPECT_TRUE(same_bits(a.fields[i].values, b.fields[i].values)) << a.fields[i].name;
  }
  ASSERT_EQ(a.history.size(), b.history.size());
  for (const auto& [name, values] : a.history) {
    ASSERT_EQ(b.history.count(name), 1u) << name;
    EXPECT_TRUE(same_bits(values, b.history.at(name))) << name;
  }
}

void run_deck(const Sandbox& sandbox, int ranks, const std::string& deck, const std::string& folder,
              const std::vector<std::string>& options) {
  sandbox.write(folder + ".toml", deck);
  std::vector<std::string> arguments{"run", folder + ".toml", "--out", folder};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_program(on_ranks(ranks, arguments), sandbox.path());
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

}  // namespace polyslip::tests
