#include "core/deck.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/deck_impl.hpp"
#include "core/error.hpp"
#include "core/file.hpp"

namespace polyslip::core {

const TomlTable* Deck::Impl::find_table(const std::string& section) const {
  const auto found = std::ranges::find(document.tables, section, &TomlTable::name);
  return found == document.tables.end() ? nullptr : &*found;
}

const TomlEntry* Deck::Impl::find(const std::string& section, const std::string& key) const {
  const TomlTable* table = find_table(section);
  if (table == nullptr) return nullptr;
  const auto found = std::ranges::find(table->entries, key, &TomlEntry::key);
  return found == table->entries.end() ? nullptr : &*found;
}

std::vector<std::string> Deck::Impl::known_keys(const std::string& section) const {
  std::vector<std::string> keys;
  for (const auto& d : declarations)
    if (d.section == section) keys.push_back(d.key);
  return keys;
}

Position Deck::Impl::place(const std::string& section, const std::string& key) const {
  if (const auto* entry = find(section, key)) return entry->value.at;
  if (const auto* table = find_table(section)) return table->at;
  return {};
}

std::string Deck::Impl::place_text(Position at) const {
  return at.line > 0 ? fmt::format("{}:{}:{}", path, at.line, at.column) : path;
}

void Deck::Impl::key_fault(Position at, const std::string& section, const std::string& what) {
  key_faults.push_back({at, "[" + section + "] " + what});
}

Deck::Deck(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Deck::Deck(Deck&&) noexcept = default;
Deck& Deck::operator=(Deck&&) noexcept = default;
Deck::~Deck() = default;

Deck Deck::from_file(const std::string& path) { return from_text(read_text(path), path); }

Deck Deck::from_text(const std::string& text, const std::string& path) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->text = text;
  impl->document = parse_toml(text, path);
  return Deck(std::move(impl));
}

Deck::Table Deck::table(const std::string& section, const std::string& help) {
  impl_->sections.emplace_back(section, help);
  return {*impl_, section};
}

std::vector<Deck::Table> Deck::tables(const std::string& list, const std::string& help) {
  std::vector<Table> found;
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("{} {}", list, number);
    if (impl_->find_table(name) == nullptr) return found;
    found.push_back(table(name, help));
  }
}

void Deck::finish() const {
  auto faults = impl_->key_faults;
  for (auto& fault : impl_->unknown()) faults.push_back(std::move(fault));
  if (faults.empty()) faults = impl_->cross_faults;
  if (faults.empty()) return;
  // What has no place in the text (a whole table is missing) comes after what has.
  const auto order = [](const Impl::Fault& f) { return std::pair(f.at.line == 0, f.at); };
  const auto first = std::ranges::min_element(faults, {}, order);
  throw InputError(impl_->place_text(first->at) + ": " + first->what);
}

const std::string& Deck::path() const { return impl_->path; }
const std::string& Deck::text() const { return impl_->text; }
const std::vector<Declaration>& Deck::declarations() const { return impl_->declarations; }

bool Deck::given(const std::string& section, const std::string& key) const {
  return impl_->find(section, key) != nullptr;
}

std::string Deck::where(const std::string& section, const std::string& key) const {
  return impl_->place_text(impl_->place(section, key));
}

void Deck::fault(const std::string& section, const std::string& key, const std::string& what) {
  impl_->cross_faults.push_back({impl_->place(section, key), "[" + section + "] " + what});
}

bool Deck::Table::given(const std::string& key) const {
  return deck_->find(section_, key) != nullptr;
}

std::string Deck::Table::where(const std::string& key) const {
  return deck_->place_text(deck_->place(section_, key));
}

void Deck::Table::fault(const std::string& key, const std::string& what) {
  deck_->cross_faults.push_back({deck_->place(section_, key), "[" + section_ + "] " + what});
}

}  // namespace polyslip::core
