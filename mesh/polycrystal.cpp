#include "mesh/polycrystal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "mesh/domain_shapes.hpp"

namespace polyslip::mesh {
namespace {

using core::Vec3;

int seeds_a_cube(Morphology morphology) {
  if (morphology == Morphology::truncated_octahedra) return 2;
  return morphology == Morphology::rhombic_dodecahedra ? 4 : 1;
}

/// Random points of a convex domain, above a height along the axis, or in a plane across it.
class Sampler {
 public:
  Sampler(const Domain& domain, std::uint64_t seed)
      : domain_(domain), random_(seed, core::Stream::seeds) {}

  Vec3 anywhere() {
    return accept([&](Vec3&) { return true; });
  }
  Vec3 above(int axis, double height) {
    return accept([&](Vec3& x) { return x[axis] >= height; });
  }
  Vec3 across(int axis, double height) {
    return accept([&](Vec3& x) {
      x[axis] = height;
      return true;
    });
  }
  double uniform() { return random_.uniform(); }

 private:
  template <class Condition>
  Vec3 accept(Condition&& condition) {
    constexpr int patience = 10'000'000;
    for (int i = 0; i < patience; ++i) {
      const double x = random_.uniform(), y = random_.uniform(), z = random_.uniform();
      Vec3 point = Vec3(x, y, z).cwiseProduct(domain_.size);
      if (condition(point) && domain_.contains(point)) return point;
    }
    throw core::InputError("polycrystal: the domain has no room for seeds: it is too thin there");
  }

  const Domain& domain_;
  core::Random random_;
};

/// Seeds on a line along the axis, at least half their mean distance apart: slabs between half and
/// a few times the mean thickness.
std::vector<Vec3> bamboo_seeds(const Domain& domain, int grains, int axis, Sampler& sampler) {
  constexpr double least = 0.5;
  const double spacing = domain.size[axis] / grains;
  std::vector<double> at;
  for (int i = 0; i < grains; ++i) at.push_back(sampler.uniform());
  std::sort(at.begin(), at.end());
  Vec3 centre = Vec3::Zero();
  for (const Vec3& x : domain.vertices) centre += x / static_cast<double>(domain.vertices.size());
  std::vector<Vec3> seeds;
  for (int i = 0; i < grains; ++i) {
    Vec3 x = centre;
    x[axis] = spacing * (least * (i + 0.5) + (1 - least) * grains * at[i]);
    if (!domain.contains(x))
      throw core::InputError(fmt::format(
          "bamboo: the body's middle line along {} leaves the body; choose another axis "
          "or shape",
          "xyz"[axis]));
    seeds.push_back(x);
  }
  return seeds;
}

/// Columns up to a share of the height, as wide as the equiaxed grains above them. The columns'
/// seeds lie in a plane below which nothing else comes: equiaxed seeds keep 0.6 of a width away.
std::vector<Vec3> columnar_equiaxed_seeds(const Domain& domain, const PolycrystalOptions& o,
                                          Sampler& sampler) {
  if (o.grains < 2)
    throw core::InputError("columnar-equiaxed: 1 grain is too few; it takes 2 at least");
  const double height = domain.size[o.axis], area = domain.volume / height;
  const double equiaxed_volume = (1 - o.columnar_share) * domain.volume;
  int equiaxed = 1;
  const auto width_of = [&](int n) { return std::cbrt(equiaxed_volume / n); };
  while (equiaxed + 1 < o.grains &&
         equiaxed + 1 + area / std::pow(width_of(equiaxed + 1), 2) <= o.grains)
    ++equiaxed;
  const int columns = o.grains - equiaxed;
  const double gap = 0.6 * std::sqrt(area / std::max(columns, 1));
  const double front = o.columnar_share * height;
  const double low = std::max(front - gap / 2, 0.05 * height);
  const double high = std::min(front + gap / 2, 0.95 * height);
  std::vector<Vec3> seeds;
  for (int i = 0; i < columns; ++i) seeds.push_back(sampler.across(o.axis, low));
  for (int i = 0; i < equiaxed; ++i) seeds.push_back(sampler.above(o.axis, high));
  return seeds;
}

std::vector<Vec3> regular_seeds(const Domain& domain, const PolycrystalOptions& o) {
  const auto n = grid_of(o);
  std::vector<Vec3> places{{0.5, 0.5, 0.5}};
  if (o.morphology == Morphology::truncated_octahedra)
    places = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}};
  if (o.morphology == Morphology::rhombic_dodecahedra)
    places = {{0.25, 0.25, 0.25}, {0.25, 0.75, 0.75}, {0.75, 0.25, 0.75}, {0.75, 0.75, 0.25}};
  std::vector<Vec3> seeds;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        for (const Vec3& place : places)
          seeds.push_back((Vec3(i, j, k) + place)
                              .cwiseQuotient(Vec3(n[0], n[1], n[2]))
                              .cwiseProduct(domain.size));
  return seeds;
}

std::vector<Vec3> seeds_in(const Domain& domain, const PolycrystalOptions& o) {
  Sampler sampler(domain, o.seed);
  std::vector<Vec3> seeds;
  switch (o.morphology) {
    case Morphology::voronoi:
      for (int i = 0; i < o.grains; ++i) seeds.push_back(sampler.anywhere());
      return seeds;
    case Morphology::columnar:
      for (int i = 0; i < o.grains; ++i)
        seeds.push_back(sampler.across(o.axis, domain.size[o.axis] / 2));
      return seeds;
    case Morphology::bamboo:
      return bamboo_seeds(domain, o.grains, o.axis, sampler);
    case Morphology::columnar_equiaxed:
      return columnar_equiaxed_seeds(domain, o, sampler);
    default:
      return regular_seeds(domain, o);
  }
}

/// Factors of the grains' stretch, of product 1.
Vec3 stretch_of(const PolycrystalOptions& options) {
  return options.stretch / std::cbrt(options.stretch.prod());
}

Domain unstretched(const Domain& domain, const Vec3& stretch) {
  if (domain.is_box()) return box_domain(domain.size.cwiseQuotient(stretch));
  std::vector<Plane> planes;
  std::vector<std::string> names;
  for (const auto& face : domain.faces) {
    planes.push_back({face.plane.normal.cwiseProduct(stretch), face.plane.offset});
    names.push_back(face.name);
  }
  return convex_domain(domain.shape, planes, names);
}

/// From the unstretched body to the one that was asked for.
void stretch_to(Tessellation& t, const Domain& domain, const Vec3& stretch) {
  t.domain = domain;
  t.size = domain.size;
  for (Vec3& x : t.seeds) x = x.cwiseProduct(stretch);
  for (Vec3& x : t.vertices) x = x.cwiseProduct(stretch).cwiseMin(t.size);
  const auto on_faces = domain_faces_of_vertices(t.topology);
  std::vector<Plane> planes;
  for (std::size_t v = 0; v < t.vertices.size(); ++v) {
    planes.clear();
    for (const int d : on_faces[v]) planes.push_back(domain.faces[d].plane);
    if (!planes.empty()) put_on_planes(planes, t.vertices[v]);
  }
  for (std::size_t f = 0; f < t.face_planes.size(); ++f) {
    Plane& plane = t.face_planes[f];
    const int d = t.topology.faces[f].domain_face;
    plane.normal = plane.normal.cwiseQuotient(stretch);
    plane.offset /= plane.normal.norm();
    plane.normal.normalize();
    if (d >= 0) plane = domain.faces[d].plane;
  }
}

std::array<double, 3> grid_that_fits(const PolycrystalOptions& o) {
  const Vec3 box = o.domain.cwiseQuotient(o.stretch);
  const double side = std::cbrt(box.prod() * seeds_a_cube(o.morphology) / o.grains);
  return {box[0] / side, box[1] / side, box[2] / side};
}

}  // namespace

const std::vector<std::string>& morphology_names() {
  static const std::vector<std::string> names{"voronoi",
                                              "columnar",
                                              "bamboo",
                                              "columnar-equiaxed",
                                              "cubes",
                                              "truncated-octahedra",
                                              "rhombic-dodecahedra",
                                              "laguerre",
                                              "grain-growth"};
  return names;
}

bool is_regular(Morphology morphology) {
  return morphology == Morphology::cubes || morphology == Morphology::truncated_octahedra ||
         morphology == Morphology::rhombic_dodecahedra;
}

int regular_grain_count(const PolycrystalOptions& options) {
  const auto n = grid_of(options);
  return n[0] * n[1] * n[2] * seeds_a_cube(options.morphology);
}

std::array<int, 3> grid_of(const PolycrystalOptions& options) {
  if (options.cells) return *options.cells;
  constexpr double tolerance = 1e-6;
  const auto n = grid_that_fits(options);
  std::array<int, 3> cells{};
  bool fits = true;
  for (int i = 0; i < 3; ++i) {
    cells[i] = std::max(1, static_cast<int>(std::lround(n[i])));
    fits = fits && std::abs(cells[i] - n[i]) <= tolerance * n[i];
  }
  if (fits) return cells;
  throw core::InputError(fmt::format(
      "{} grains do not fill the domain with {}: give cells = [{}, {}, {}] ({} grains), or others, "
      "instead",
      options.grains, morphology_names()[static_cast<int>(options.morphology)], cells[0], cells[1],
      cells[2], cells[0] * cells[1] * cells[2] * seeds_a_cube(options.morphology)));
}

Domain polycrystal_domain(const PolycrystalOptions& options) {
  PolycrystalOptions o = options;
  if (is_regular(o.morphology)) {
    const auto n = grid_of(o);
    if (o.shape != "box")
      throw core::InputError(fmt::format("{} fill a box only, no {}",
                                         morphology_names()[static_cast<int>(o.morphology)],
                                         o.shape));
    o.grains = regular_grain_count(o);
    if (o.cells) o.domain = Vec3(n[0], n[1], n[2]).cwiseProduct(o.stretch);
  }
  if (o.shape == "half-spaces") {
    std::vector<Plane> planes;
    std::vector<std::string> names;
    for (const auto& h : o.half_spaces) {
      planes.push_back({{h[0], h[1], h[2]}, h[3]});
      names.push_back(fmt::format("f{}", planes.size()));
    }
    return convex_domain("half-spaces", planes, names, o.grains);
  }
  const Vec3 size = box_size(o);
  if (o.shape == "cylinder") return cylinder_domain(o.domain, o.axis, o.faceting_error, o.grains);
  if (o.shape == "sphere") return sphere_domain(o.domain, o.faceting_error, o.grains);
  Domain box = box_domain(size);
  box.scale = size[0] / o.domain[0];
  box.periodic = o.periodic;
  return box;
}

bool is_laguerre(Morphology morphology) {
  return morphology == Morphology::laguerre || morphology == Morphology::grain_growth;
}

Tessellation laguerre_tessellation(const PolycrystalOptions& options, LaguerreReport& report,
                                   const std::function<void(double)>& progress) {
  LaguerreOptions o;
  o.seed = options.seed;
  if (options.morphology == Morphology::laguerre) o.distributions = options.distributions;
  const Domain domain = polycrystal_domain(options);
  const PowerSeeds seeds = laguerre_seeds(options.grains, o, domain, report, progress);
  return laguerre_tessellation(seeds.positions, seeds.weights, domain);
}

Tessellation voronoi_tessellation(const PolycrystalOptions& options) {
  const Domain domain = polycrystal_domain(options);
  const Vec3 stretch = stretch_of(options);
  const bool stretched = (stretch - Vec3::Ones()).cwiseAbs().maxCoeff() > 1e-12;
  const Domain body = stretched ? unstretched(domain, stretch) : domain;
  std::vector<Vec3> seeds;
  for (const Vec3& x : options.seeds)
    seeds.push_back((domain.scale * (x - domain.origin)).cwiseQuotient(stretch));
  if (seeds.empty()) seeds = seeds_in(body, options);
  Tessellation t = voronoi_tessellation(seeds, body);
  if (stretched) stretch_to(t, domain, stretch);
  return t;
}

}  // namespace polyslip::mesh
