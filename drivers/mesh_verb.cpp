#include "drivers/mesh_verb.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/deck.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "core/version.hpp"
#include "drivers/deck_record.hpp"
#include "drivers/generate.hpp"
#include "drivers/options.hpp"
#include "results/folder.hpp"
#include "results/names.hpp"
#include "results/picture.hpp"
#include "results/picture_cut.hpp"
#include "results/summary.hpp"

namespace polyslip::drivers {

namespace {

void check_picture(const std::string& picture) {
  const auto parent = std::filesystem::path(picture).parent_path();
  if (!parent.empty() && !std::filesystem::is_directory(parent))
    throw core::InputError(
        fmt::format("--picture {}: no such folder as {}", picture, parent.string()));
}

}  // namespace

void make_mesh(const std::string& deck_path, const std::string& folder, bool overwrite, int jobs,
               mesh::MesherPool& pool, const std::string& picture, bool cut) {
  const double wall_start = core::wall_seconds();
  core::Deck deck = core::Deck::from_file(deck_path);
  Options options = read_options(deck, Purpose::mesh);
  options.mesh.jobs = jobs;
  check_picture(picture);
  results::check_deck_place(folder, deck.text(), overwrite);
  Input input = read_input(options);
  results::prepare_run_folder(folder, overwrite);
  const auto path = [&folder](std::string_view name) { return results::in_folder(folder, name); };
  write_decks(folder, deck.text(), deck.resolved());
  core::Log log;
  log.to_file(path(results::log_name));
  core::StageTimes times;
  const mesh::Mesh mesh = generate_polycrystal(options, input, folder, pool, log, times);

  results::Summary summary;
  summary.completed = true;
  summary.grains = mesh.topology.cell_count();
  summary.elements_initial = mesh.element_count();
  summary.nodes_initial = mesh.node_count();
  const mesh::QualitySummary quality = mesh::quality(mesh);
  summary.min_radius_ratio = quality.min_radius_ratio;
  summary.mean_radius_ratio = quality.mean_radius_ratio;
  summary.cpu_s = {times.stages().begin(), times.stages().end()};
  summary.wall_s = core::wall_seconds() - wall_start;
  summary.peak_rss_mb = core::peak_rss_mb();
  summary.version = core::version();
  summary.seed = options.polycrystal.seed;
  results::write_summary(path(results::summary_name), summary);
  log.info("mesh: {}", path(results::mesh_name(0)));
  if (picture.empty()) return;
  results::write_mesh_picture(picture, cut ? results::without_nearest_eighth(mesh) : mesh,
                              input.orientations, {.width = 520});
  log.info("picture: {}", picture);
}

}  // namespace polyslip::drivers
