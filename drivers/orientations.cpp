#include "drivers/orientations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/random.hpp"
#include "core/rotation.hpp"

namespace polyslip::drivers {

namespace {

// A file written with four digits has unit quaternions to 1e-4 or so.
constexpr double unit_tolerance = 1e-3;

struct Convention {
  const char* name;
  std::size_t numbers;
  const char* format;
};
constexpr Convention conventions[] = {{"quaternion", 4, "w x y z"},
                                      {"rodrigues", 3, "r1 r2 r3"},
                                      {"euler-bunge", 3, "phi1 Phi phi2 in degrees"}};

const Convention& find_convention(const std::string& name) {
  for (const auto& convention : conventions)
    if (name == convention.name) return convention;
  throw core::InternalError("orientation convention " + name);
}

double parse_number(const std::string& word, const std::string& place) {
  const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
  const char* end = word.data() + word.size();
  double x = 0;
  const auto [stop, error] = std::from_chars(begin, end, x);
  if (error != std::errc{} || stop != end)
    throw core::InputError(fmt::format("{}: '{}' is not a number", place, word));
  if (!std::isfinite(x)) throw core::InputError(fmt::format("{}: {} is not finite", place, word));
  return x;
}

std::vector<double> parse_line(const std::string& line, const std::string& place) {
  std::vector<double> numbers;
  std::istringstream words(line.substr(0, line.find('#')));
  for (std::string word; words >> word;) numbers.push_back(parse_number(word, place));
  return numbers;
}

core::Quaternion unit_quaternion(const std::vector<double>& x, const std::string& place) {
  const core::Quaternion q(x[0], x[1], x[2], x[3]);
  if (!(std::abs(q.norm() - 1) <= unit_tolerance))
    throw core::InputError(fmt::format("{}: the quaternion's length is {:.6g}, must be 1 within {}",
                                       place, q.norm(), unit_tolerance));
  return q.normalized();
}

core::Quaternion orientation(const std::vector<double>& x, const Convention& convention,
                             const std::string& place) {
  const std::string name = convention.name;
  if (name == "quaternion") return unit_quaternion(x, place);
  const core::Vec3 v(x[0], x[1], x[2]);
  return name == "rodrigues" ? core::from_rodrigues(v) : core::from_bunge(v);
}

}  // namespace

std::vector<core::Quaternion> uniform_orientations(std::uint64_t seed, int count) {
  core::Random random(seed, core::Stream::orientations);
  std::vector<core::Quaternion> orientations;
  for (int i = 0; i < count; ++i) orientations.push_back(random.rotation());
  return orientations;
}

std::vector<core::Quaternion> read_orientations(const std::string& path,
                                                const std::string& convention_name, int count) {
  const Convention& convention = find_convention(convention_name);
  std::istringstream lines(core::read_text(path));
  std::vector<core::Quaternion> orientations;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = fmt::format("{}:{}", path, ++number);
    const std::vector<double> x = parse_line(line, place);
    if (x.empty()) continue;
    if (x.size() != convention.numbers)
      throw core::InputError(fmt::format("{}: {} numbers, must be {} ({}: {})", place, x.size(),
                                         convention.numbers, convention.name, convention.format));
    if (static_cast<int>(orientations.size()) == count)
      throw core::InputError(
          fmt::format("{}: more orientations than the {} grains of the deck", place, count));
    orientations.push_back(orientation(x, convention, place));
  }
  if (static_cast<int>(orientations.size()) < count)
    throw core::InputError(fmt::format("{}:{}: ends after {} of {} orientations, one a grain", path,
                                       std::max(number, 1), orientations.size(), count));
  return orientations;
}

WeightedOrientations read_weighted_orientations(const std::string& path,
                                                const std::string& convention_name) {
  const Convention& convention = find_convention(convention_name);
  std::istringstream lines(core::read_text(path));
  WeightedOrientations read;
  int number = 0;
  std::size_t columns = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = fmt::format("{}:{}", path, ++number);
    const std::vector<double> x = parse_line(line, place);
    if (x.empty()) continue;
    if (columns == 0) columns = x.size();
    const bool weighted = columns == convention.numbers + 1;
    if (x.size() != columns || (columns != convention.numbers && !weighted))
      throw core::InputError(
          fmt::format("{}: {} numbers, must be {} ({}: {}), and a weight in all "
                      "lines or none",
                      place, x.size(), convention.numbers, convention.name, convention.format));
    read.orientations.push_back(orientation(x, convention, place));
    read.weights.push_back(weighted ? x.back() : 1);
    if (!(read.weights.back() >= 0))
      throw core::InputError(fmt::format("{}: the weight {} must be >= 0", place, x.back()));
  }
  if (std::none_of(read.weights.begin(), read.weights.end(), [](double w) { return w > 0; }))
    throw core::InputError(path + ": holds no orientation with a weight");
  return read;
}

std::string convention_of_file(const std::string& path) {
  const std::string text = core::read_text(path);
  const bool bunge = text.substr(0, text.find('\n')).find("phi1") != std::string::npos;
  return bunge ? "euler-bunge" : "quaternion";
}

std::vector<core::Quaternion> grain_orientations(const Options& options) {
  const int grains = options.polycrystal.grains;
  if (options.orientations.distribution == "components") {
    core::Random random(options.polycrystal.seed, core::Stream::texture);
    return core::random_texture(random, options.orientations.components, grains);
  }
  if (!options.orientations.file) return uniform_orientations(options.polycrystal.seed, grains);
  return read_orientations(*options.orientations.file, options.orientations.convention, grains);
}

}  // namespace polyslip::drivers
