#include "mesh/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "mesh/assembly.hpp"
#include "mesh/boundary_mesh.hpp"
#include "mesh/boundary_sliding.hpp"
#include "mesh/candidate.hpp"
#include "mesh/curved_elements.hpp"
#include "mesh/deformed_regularisation.hpp"
#include "mesh/facet_bound.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/tetrahedral_optimiser.hpp"
#include "mesh/volume_correction.hpp"

namespace polyslip::mesh {

namespace {

using core::Vec3;

/// Rounds in which faces of grains that could not be meshed are copied (section 2.3.3).
constexpr int copy_rounds = 5;
/// Of them, those in which of faces that meet a grain gets one copied.
constexpr int single_rounds = 2;
constexpr int volume_corrections = 5;
/// Radius ratio below which elements of a new mesh of a deformed polycrystal are opened: above half
/// of what first meshes have at worst (0.18 to 0.31).
constexpr double least_after = 0.2;

/// The grains of an undeformed polycrystal fill its domain, but for rounding.
void check_domain(const Mesh& mesh, int threads) {
  constexpr double rounding = 1e-12;
  double sum = 0;
  for (double v : grain_volumes(mesh, threads)) sum += v;
  const double domain = mesh.domain.volume;
  if (!(std::abs(sum - domain) <= rounding * domain))
    throw core::InternalError(fmt::format(
        "meshing: the grains' volumes add up to {:.17g}, the domain has {:.17g}", sum, domain));
}

/// State of the rounds: boundary, and each grain's best mesh so far.
class Pipeline {
 public:
  Pipeline(const Geometry& geometry, const MeshingOptions& options, const Vec3& scale,
           const GrainMeshers& meshers, MeshingReport& report, const MeshingProgress& progress,
           const TurnsOfMeshers& turns, const FaceMeshers& face_meshers)
      : geometry_(geometry),
        options_(options),
        scale_(scale),
        meshers_(meshers),
        turns_(turns),
        report_(report),
        progress_(progress),
        threads_(core::thread_count(options.jobs)),
        boundary_(geometry, options, scale, face_meshers),
        results_(geometry.topology.cell_count()) {}

  Mesh run() {
    mesh_until_all_are();
    if (options_.slide_boundary) slide();
    if (options_.slide_boundary) raise_worst_elements();
    if (options_.slide_boundary) mesh_worst_grains();
    if (options_.slide_boundary && turns_.first) mesh_poor_grains();
    tell("assembling", 0);
    const auto measure = report_.times.measure("assembly");
    Mesh mesh = assemble(geometry_, boundary_, take_volumes(), scale_, options_.order, threads_);
    check_progression();
    tell("assembling", 0.5);
    report_.straightened = mend_curved_elements(mesh, threads_);
    if (geometry_.from_mesh && options_.order == 2) {
      open_thin(mesh);
      keep_volumes(mesh);
    }
    fill_report();
    if (!geometry_.from_mesh) check_domain(mesh, threads_);
    tell("assembling", 1);
    return mesh;
  }

 private:
  void tell(const char* stage, double fraction) const {
    if (progress_) progress_(stage, fraction);
  }

  /// Meshes of the boundary and of all grains, copying faces as long as some grain has none.
  void mesh_until_all_are() {
    for (int round = 0;; ++round) {
      tell("meshing faces", 0);
      const auto changed = [&] {
        const auto measure = report_.times.measure("faces");
        return boundary_.update();
      }();
      const auto measure = report_.times.measure("meshing");
      mesh_grains(changed);
      const auto failed = failed_grains();
      if (failed.empty()) return;
      if (round == copy_rounds || !copy_faces(failed, round)) give_up(failed.front());
    }
  }

  GrainSurface surface(int grain) const {
    const auto numbers = boundary_.numbers();
    return grain_surface(geometry_.topology, boundary_, numbers, boundary_.positions(numbers),
                         grain, scale_);
  }

  std::vector<VolumeMesh> take_volumes() {
    std::vector<VolumeMesh> volumes;
    volumes.reserve(results_.size());
    for (auto& r : results_) volumes.push_back(std::move(r.mesh));
    return volumes;
  }

  void slide() {
    tell("sliding nodes", 0);
    const auto measure = report_.times.measure("sliding");
    auto volumes = take_volumes();
    slide_boundary(boundary_, volumes, options_.progression_factor, threads_);
    give_volumes(volumes);
    if (!unoptimised_.empty()) optimise_in_other_order();
  }

  /// Grains as their mesher left them, optimised where nodes are now only, take the place of those
  /// optimised before and after if they are better (mesh/candidate.hpp).
  void optimise_in_other_order() {
    const auto numbers = boundary_.numbers();
    const auto positions = boundary_.positions(numbers);
    core::parallel_for(threads_, results_.size(), [&](std::size_t i) {
      VolumeMesh other = std::move(unoptimised_[i]);
      if (other.tetrahedra.empty()) return;
      const auto grain = request(static_cast<int>(i), numbers, positions);
      std::copy(grain.surface.nodes.begin(), grain.surface.nodes.end(), other.nodes.begin());
      if (!(min_radius_ratio(other) > 0)) return;
      other = optimise_inside(grain.surface, other);
      const double O = mesh_quality_O(other, grain.element_size);
      GrainResult& now = results_[i];
      if (rank_of_slid(min_radius_ratio(other), O) <=
          rank_of_slid(min_radius_ratio(now.mesh), now.O))
        return;
      now.mesh = std::move(other);
      now.O = O;
    });
    unoptimised_.clear();
  }

  void raise_worst_elements() {
    const auto measure = report_.times.measure("sliding");
    auto volumes = take_volumes();
    raise_worst(boundary_, volumes, options_.progression_factor, threads_);
    give_volumes(volumes);
  }

  void give_volumes(std::vector<VolumeMesh>& volumes) {
    core::parallel_for(threads_, results_.size(), [&](std::size_t i) {
      results_[i].mesh = std::move(volumes[i]);
      results_[i].O = mesh_quality_O(results_[i].mesh, boundary_.grain_size(static_cast<int>(i)));
    });
  }

  /// All meshers try grains whose mesh is not good enough where nodes are now; that stays
  /// unless another may replace it (mesh/candidate.hpp).
  void mesh_poor_grains() {
    tell("meshing poor grains", 0);
    const auto measure = report_.times.measure("meshing");
    const auto numbers = boundary_.numbers();
    const auto positions = boundary_.positions(numbers);
    std::vector<char> good(results_.size(), false);
    core::parallel_for(threads_, results_.size(), [&](std::size_t i) {
      const auto grain = request(static_cast<int>(i), numbers, positions);
      good[i] = is_good(surface_bounds(grain.surface, grain.element_size),
                        min_radius_ratio(results_[i].mesh), results_[i].O, options_.mesher_target);
    });
    std::vector<int> grains;
    for (int i = 0; i < static_cast<int>(good.size()); ++i)
      if (!good[i]) grains.push_back(i);
    const auto source = [&](std::size_t i) { return request(grains[i], numbers, positions); };
    std::size_t got = 0;
    meshers_(grains.size(), source, [&](std::size_t i, GrainResult&& result) {
      tell("meshing poor grains", static_cast<double>(++got) / static_cast<double>(grains.size()));
      GrainResult& now = results_[grains[i]];
      add_faults(result);
      if (result.ok &&
          replaces({min_radius_ratio(result.mesh), result.O}, {min_radius_ratio(now.mesh), now.O}))
        now = std::move(result);
    });
  }

  /// The meshers, one by one, try the grains with the worst elements where nodes are now, as long
  /// as their surfaces allow better ones (mesh/candidate.hpp).
  void mesh_worst_grains() {
    if (turns_.each.empty()) return;
    const auto measure = report_.times.measure("meshing");
    const auto numbers = boundary_.numbers();
    const auto positions = boundary_.positions(numbers);
    std::vector<double> worst(results_.size()), bounds(results_.size(), 0.0);
    core::parallel_for(threads_, results_.size(), [&](std::size_t i) {
      worst[i] = min_radius_ratio(results_[i].mesh);
      if (worst[i] < worst_limit)
        bounds[i] =
            surface_bound(request(static_cast<int>(i), numbers, positions).surface, worst_limit);
    });
    for (const auto& mesher : turns_.each) {
      const auto grains = worst_grains(worst, bounds);
      std::vector<GrainResult> candidates(grains.size());
      mesher(
          grains.size(), [&](std::size_t i) { return request(grains[i], numbers, positions); },
          [&](std::size_t i, GrainResult&& result) { candidates[i] = std::move(result); });
      core::parallel_for(threads_, grains.size(), [&](std::size_t i) {
        GrainResult& candidate = candidates[i];
        if (!candidate.ok) return;
        const auto grain = request(grains[i], numbers, positions);
        candidate.mesh = raise_worst(grain.surface, std::move(candidate.mesh));
        candidate.O = mesh_quality_O(candidate.mesh, grain.element_size);
      });
      for (std::size_t i = 0; i < grains.size(); ++i) {
        GrainResult& now = results_[grains[i]];
        add_faults(candidates[i]);
        const double reached = min_radius_ratio(candidates[i].mesh);
        if (!candidates[i].ok || !raises({reached, candidates[i].O}, {worst[grains[i]], now.O}))
          continue;
        worst[grains[i]] = reached;
        now = std::move(candidates[i]);
      }
    }
  }

  /// A mesher that tries a grain again may fail again.
  void add_faults(const GrainResult& result) {
    auto& all = report_.faults;
    for (const auto& fault : result.faults)
      if (std::find(all.begin(), all.end(), fault) == all.end()) all.push_back(fault);
  }

  GrainRequest request(int grain, const BoundaryNumbers& numbers,
                       const std::vector<Vec3>& positions) const {
    return {grain,
            grain_surface(geometry_.topology, boundary_, numbers, positions, grain, scale_).mesh,
            boundary_.grain_size(grain)};
  }

  void mesh_grains(const std::vector<int>& changed_faces) {
    const auto& topology = geometry_.topology;
    std::vector<char> stale(topology.cell_count(), false);
    for (int f : changed_faces)
      for (int c : topology.faces[f].cells)
        if (c >= 0) stale[c] = true;
    const auto numbers = boundary_.numbers();
    const auto positions = boundary_.positions(numbers);
    std::vector<int> grains;
    for (int grain = 0; grain < topology.cell_count(); ++grain)
      if (stale[grain]) grains.push_back(grain);
    mesh_grains(grains, turns_.first ? turns_.first : meshers_, numbers, positions);
    if (turns_.first && turns_.unoptimised) optimise(grains, numbers, positions);
    std::erase_if(grains, [&](int grain) { return results_[grain].ok; });
    if (turns_.others) mesh_grains(grains, turns_.others, numbers, positions);
  }

  /// Optimises meshes that the first mesher has made, and keeps them as they were.
  void optimise(const std::vector<int>& grains, const BoundaryNumbers& numbers,
                const std::vector<Vec3>& positions) {
    unoptimised_.resize(results_.size());
    core::parallel_for(threads_, grains.size(), [&](std::size_t i) {
      GrainResult& result = results_[grains[i]];
      if (!result.ok) return;
      unoptimised_[grains[i]] = result.mesh;
      result.mesh = optimise_inside(request(grains[i], numbers, positions).surface, result.mesh);
    });
  }

  void mesh_grains(const std::vector<int>& grains, const GrainMeshers& meshers,
                   const BoundaryNumbers& numbers, const std::vector<Vec3>& positions) {
    std::size_t got = 0;
    const auto source = [&](std::size_t i) { return request(grains[i], numbers, positions); };
    const auto take = [&](std::size_t i, GrainResult&& result) {
      result.mesh.nodes.shrink_to_fit();
      result.mesh.tetrahedra.shrink_to_fit();
      results_[grains[i]] = std::move(result);
      tell("meshing grains", static_cast<double>(++got) / static_cast<double>(grains.size()));
    };
    meshers(grains.size(), source, take);
    if (got != grains.size())
      throw core::InternalError(
          fmt::format("meshing: {} grains asked for, {} got", grains.size(), got));
    for (int grain : grains) add_faults(results_[grain]);
  }

  /// What no mesh on the old faces makes better than thin moves off them, if that can be.
  void open_thin(Mesh& mesh) {
    Mesh opened = mesh;
    const auto result = open_thin_elements(opened, scale_, {.least_radius_ratio = least_after});
    if (result.elements_before == 0) return;
    try {
      report_.straightened += mend_curved_elements(opened, threads_);
    } catch (const core::RecoverableError&) {  // it stays as it is
      report_.opened.elements_before = report_.opened.elements_after = result.elements_before;
      return;
    }
    report_.opened = result;
    mesh = std::move(opened);
  }

  /// New and old surfaces share nodes, not all points between them: what volume that costs is given
  /// back by moving mid nodes.
  void keep_volumes(Mesh& mesh) {
    const auto wanted = geometry_.volumes.empty() ? grain_volumes(geometry_) : geometry_.volumes;
    std::vector<char> fixed;
    for (int f = 0; f < static_cast<int>(geometry_.topology.faces.size()); ++f)
      fixed.push_back(boundary_.is_copied(f) || boundary_.is_flat(f));
    for (int i = 0; i < volume_corrections; ++i) {
      correct_volumes(mesh, wanted, fixed);
      report_.straightened = std::max(report_.straightened, mend_curved_elements(mesh, threads_));
    }
  }

  std::vector<int> failed_grains() const {
    std::vector<int> failed;
    for (int grain = 0; grain < static_cast<int>(results_.size()); ++grain)
      if (!results_[grain].ok) failed.push_back(grain);
    return failed;
  }

  /// Copies, for each failed grain, the face at which its surface meets itself, from the third
  /// round on all such; without them, the most distorted ones, twice as many each round, all in the
  /// last. Whether any was copied.
  bool copy_faces(const std::vector<int>& failed, int round) {
    bool any = false;
    for (int grain : failed) {
      bool copied = copy_meeting(
          grain, round < single_rounds ? 1 : geometry_.topology.cell_faces[grain].size());
      if (!copied) {
        const auto order = by_distortion(geometry_.topology.cell_faces[grain]);
        const std::size_t count = round + 1 == copy_rounds
                                      ? order.size()
                                      : std::min(order.size(), std::size_t(1) << round);
        for (std::size_t i = 0; i < count; ++i)
          copied |= boundary_.copy(
              order[i], fmt::format("grain {} cannot be meshed with a new one", grain + 1));
      }
      any |= copied;
    }
    return any;
  }

  /// Two new faces that meet need not meet where one of them is the old one: the most distorted
  /// `count` of them are copied. Whether any was.
  bool copy_meeting(int grain, std::size_t count) {
    const auto s = surface(grain);
    std::vector<int> meeting;
    for (int t : intersecting_triangles(s.mesh)) meeting.push_back(s.faces[t]);
    std::sort(meeting.begin(), meeting.end());
    meeting.erase(std::unique(meeting.begin(), meeting.end()), meeting.end());
    const auto order = by_distortion(meeting);
    bool any = false;
    for (std::size_t i = 0; i < std::min(count, order.size()); ++i)
      any |= boundary_.copy(order[i], fmt::format("it meets another face of grain {}", grain + 1));
    return any;
  }

  /// Those that are not copied yet, the most distorted first.
  std::vector<int> by_distortion(const std::vector<int>& faces) const {
    std::vector<std::pair<double, int>> order;
    for (int f : faces)
      if (!boundary_.is_copied(f)) order.push_back({-boundary_.distortion(f), f});
    std::sort(order.begin(), order.end());
    std::vector<int> sorted;
    for (const auto& [distortion, f] : order) sorted.push_back(f);
    return sorted;
  }

  /// Adjacent 1D lengths are within p_l. Across vertices that can be had from p_l = 2 on: below, a
  /// third of an edge may be too short where a half of it is too long.
  void check_progression() {
    report_.progression = boundary_.largest_progression();
    constexpr double reachable = 2.0, rounding = 1e-6;
    const double p = options_.progression_factor;
    if (p >= reachable && !(report_.progression <= p * (1 + rounding)))
      throw core::InternalError(fmt::format(
          "meshing: adjacent 1D lengths differ by {:.6g}, p_l is {}", report_.progression, p));
  }

  [[noreturn]] void give_up(int grain) const {
    const auto& faults = results_[grain].faults;
    throw core::RecoverableError(fmt::format(
        "grain {} could not be meshed by any of {} meshers{}{}", grain + 1, options_.meshers.size(),
        faults.empty() ? "" : ": ", faults.empty() ? "" : faults.back()));
  }

  void fill_report() {
    report_.wins.assign(options_.meshers.size(), 0);
    report_.mean_O = 0;
    for (const auto& r : results_) {
      report_.mean_O += r.O / static_cast<double>(results_.size());
      for (std::size_t i = 0; i < options_.meshers.size(); ++i)
        report_.wins[i] += r.mesher == options_.meshers[i];
    }
    report_.face_wins = boundary_.face_wins();
    for (const auto& fault : boundary_.face_faults()) report_.faults.push_back(fault);
    report_.copied_faces.clear();
    report_.why_copied.clear();
    for (int f = 0; f < static_cast<int>(geometry_.topology.faces.size()); ++f) {
      if (boundary_.is_copied(f)) {
        report_.copied_faces.push_back(f);
        report_.why_copied.push_back(boundary_.why_copied(f));
      }
      report_.nearest_points += boundary_.faces()[f].nearest_points;
      report_.conformal_faces += boundary_.faces()[f].flattening == Flattening::conformal;
      report_.circle_faces += boundary_.faces()[f].flattening == Flattening::circle;
    }
  }

  const Geometry& geometry_;
  const MeshingOptions& options_;
  Vec3 scale_;
  const GrainMeshers& meshers_;
  const TurnsOfMeshers& turns_;
  MeshingReport& report_;
  const MeshingProgress& progress_;
  int threads_;
  BoundaryMesher boundary_;
  std::vector<GrainResult> results_;
  std::vector<VolumeMesh> unoptimised_;  ///< [grains] or none: as the first mesher left them
};

}  // namespace

std::string repairs_text(const MeshingReport& report) {
  if (report.straightened == 0 && report.nearest_points == 0 && report.copied_faces.empty())
    return {};
  return fmt::format(
      "{} mid nodes pulled towards their chord, {} nodes put on the nearest point of their old "
      "face, {} faces copied",
      report.straightened, report.nearest_points, report.copied_faces.size());
}

Mesh mesh_geometry(const Geometry& geometry, const MeshingOptions& options, const Vec3& scale,
                   const GrainMeshers& meshers, MeshingReport& report,
                   const MeshingProgress& progress, const TurnsOfMeshers& turns,
                   const FaceMeshers& face_meshers) {
  report = {};
  return Pipeline(geometry, options, scale, meshers, report, progress, turns, face_meshers).run();
}

}  // namespace polyslip::mesh
