// Seeds given in a file.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/error.hpp"
#include "mesh/polycrystal.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

struct Seed {
  Vec3 position;
  int line;
};

double number(const std::string& word, const std::string& place) {
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(x))
    throw core::InputError(fmt::format("{}: '{}' is no number", place, word));
  return x;
}

std::vector<Seed> read_lines(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw core::InputError(fmt::format("{}: cannot be read", path));
  std::vector<Seed> seeds;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    std::istringstream words(text.substr(0, text.find('#')));
    std::vector<std::string> entries;
    for (std::string word; words >> word;) entries.push_back(word);
    if (entries.empty()) continue;
    const std::string place = fmt::format("{}:{}", path, line);
    if (entries.size() != 3)
      throw core::InputError(fmt::format("{}: {} entries; a seed is x y z", place, entries.size()));
    seeds.push_back(
        {{number(entries[0], place), number(entries[1], place), number(entries[2], place)}, line});
  }
  if (seeds.empty()) throw core::InputError(path + ": holds no seed; one a line: x y z");
  return seeds;
}

/// Closer than this, in mean grain sizes, seeds are as good as one.
constexpr double same_seed = 1e-6;

void check_distances(const std::vector<Seed>& seeds, double scale, const std::string& path) {
  const Vec3 direction = Vec3(0.5377, 0.6423, 0.5461).normalized();
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    order.push_back({scale * direction.dot(seeds[i].position), i});
  std::sort(order.begin(), order.end());
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a + 1; b < order.size() && order[b].first - order[a].first < same_seed;
         ++b) {
      const auto [first, second] = std::minmax(order[a].second, order[b].second);
      if (scale * (seeds[first].position - seeds[second].position).norm() < same_seed)
        throw core::InputError(
            fmt::format("{}:{}: seed {} coincides with seed {} (line {}); remove one of them", path,
                        seeds[second].line, second + 1, first + 1, seeds[first].line));
    }
}

}  // namespace

void read_seeds(const std::string& path, PolycrystalOptions& options) {
  const auto seeds = read_lines(path);
  options.grains = static_cast<int>(seeds.size());
  const Domain domain = polycrystal_domain(options);
  options.seeds.clear();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3& given = seeds[i].position;
    const Vec3 x = domain.scale * (given - domain.origin);
    for (const auto& face : domain.faces)
      if (!(face.plane.normal.dot(x) <= face.plane.offset))
        throw core::InputError(fmt::format(
            "{}:{}: seed {} at ({}, {}, {}) lies outside the domain, beyond its face {}", path,
            seeds[i].line, i + 1, given.x(), given.y(), given.z(), face.name));
    options.seeds.push_back(given);
  }
  check_distances(seeds, domain.scale, path);
}

}  // namespace polyslip::mesh
