#include "drivers/stats_verb.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "drivers/options.hpp"
#include "mesh/measures.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/size_field.hpp"
#include "mesh/tess_reader.hpp"
#include "results/names.hpp"
#include "results/statistics_files.hpp"

namespace polyslip::drivers {
namespace {

namespace fs = std::filesystem;

struct Subject {
  std::optional<mesh::Tessellation> tessellation;
  std::optional<mesh::MeshFile> mesh;
  std::optional<mesh::MeshingOptions> meshing;  ///< of the deck
  std::optional<results::RegularisationRecord> regularisation;
};

/// [mesh] of the deck that a folder's mesh was made by; nothing if the mesh came from a file.
std::optional<mesh::MeshingOptions> meshing_of(const std::string& deck_path) {
  if (!fs::exists(deck_path)) return {};
  core::Deck deck = core::Deck::from_file(deck_path);
  const Options options = read_options(deck, Purpose::mesh);
  if (options.input.mesh) return {};
  return options.mesh;
}

Subject read_folder(const std::string& folder) {
  Subject subject;
  const std::string tess = results::in_folder(folder, results::tessellation_name);
  const std::string msh = results::in_folder(folder, results::mesh_name(0));
  if (!fs::exists(tess) && !fs::exists(msh))
    throw core::InputError(
        fmt::format("{}: holds neither {} nor {}; give a folder of polyslip run "
                    "or mesh, or a .tess or .msh file",
                    folder, results::tessellation_name, results::mesh_name(0)));
  if (fs::exists(tess)) {
    subject.tessellation = mesh::read_tess(tess).tessellation;
    subject.regularisation = results::read_regularisation(folder);
  }
  if (fs::exists(msh)) {
    subject.meshing = meshing_of(results::in_folder(folder, results::resolved_deck_name));
    subject.mesh = mesh::read_msh(msh);
  }
  if (subject.tessellation && subject.mesh &&
      subject.tessellation->topology.cell_count() != subject.mesh->mesh.topology.cell_count())
    throw core::InputError(
        fmt::format("{}: {} has {} grains and {} has {}; give one of the files", folder,
                    results::tessellation_name, subject.tessellation->topology.cell_count(),
                    results::mesh_name(0), subject.mesh->mesh.topology.cell_count()));
  return subject;
}

Subject read_subject(const std::string& input) {
  if (!fs::exists(input)) throw core::InputError(input + ": no such file or folder");
  if (fs::is_directory(input)) return read_folder(input);
  const std::string name = input.ends_with(".gz") ? input.substr(0, input.size() - 3) : input;
  Subject subject;
  if (name.ends_with(".tess"))
    subject.tessellation = mesh::read_tess(input).tessellation;
  else if (name.ends_with(".msh"))
    subject.mesh = mesh::read_msh(input);
  else
    throw core::InputError(input +
                           ": is neither a tessellation (.tess) nor a mesh (.msh), nor a folder of "
                           "polyslip run or mesh");
  return subject;
}

results::StatisticsOptions options_of(const StatsRequest& request, const Subject& subject) {
  results::StatisticsOptions options;
  options.inner = request.inner;
  if (request.element_size) {
    options.element_size = request.element_size;
    options.element_size_source = results::ElementSizeSource::option;
  } else if (subject.meshing && subject.mesh) {
    options.element_size = subject.meshing->element_size;
    options.element_size_source = results::ElementSizeSource::deck;
    if (subject.meshing->outer_element_size || !subject.meshing->grain_element_sizes.empty())
      options.element_sizes =
          mesh::element_sizes(subject.mesh->mesh.topology, *subject.meshing).grains;
  }
  return options;
}

}  // namespace

void print_statistics(const StatsRequest& request) {
  if (!request.to.empty()) results::check_statistics_folder(request.to, request.overwrite);
  const Subject subject = read_subject(request.input);
  const mesh::Mesh* mesh = subject.mesh ? &subject.mesh->mesh : nullptr;
  auto statistics = results::statistics_of(
      subject.tessellation ? mesh::measure(*subject.tessellation) : mesh::measure(*mesh), mesh,
      options_of(request, subject));
  statistics.regularisation = subject.regularisation;
  if (subject.mesh) {
    statistics.grain_ids = subject.mesh->grain_ids;
    statistics.file_rows = subject.mesh->file_rows;
  }
  const mesh::Domain& domain = subject.tessellation ? subject.tessellation->domain : mesh->domain;
  for (const mesh::DomainFace& face : domain.faces) statistics.domain_faces.push_back(face.name);
  std::cout << results::table_text(statistics, request.input);
  if (request.to.empty()) return;
  std::cout << "\nwritten to " << request.to << ":";
  for (const auto& name : results::write_statistics(request.to, statistics, mesh, request.input))
    std::cout << ' ' << name;
  std::cout << '\n';
}

}  // namespace polyslip::drivers
