#include "drivers/deck_record.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "results/names.hpp"

namespace polyslip::drivers {
namespace {

std::string origin_line(const std::string& given) {
  return fmt::format("# deck.toml ({:016x}) as understood\n", core::fnv1a(given));
}

}  // namespace

void write_decks(const std::string& folder, const std::string& given, const std::string& resolved) {
  core::write_file(results::in_folder(folder, results::deck_name), given);
  core::write_file(results::in_folder(folder, results::resolved_deck_name),
                   origin_line(given) + resolved);
}

void require_unedited_deck(const std::string& folder) {
  const std::string given = results::in_folder(folder, results::deck_name);
  const std::string resolved = results::in_folder(folder, results::resolved_deck_name);
  if (!core::read_text(resolved).starts_with(origin_line(core::read_text(given))))
    throw core::InputError(
        given + ": not the deck that this run began with; put that back, or start a new run");
}

}  // namespace polyslip::drivers
