#pragma once
// Reading a deck. Each key is declared where it is read, with type, unit, default, bounds and a
// sentence; the declarations are also the check for unknown keys, the resolved deck and the
// reference page.
//
//   Deck deck = Deck::from_file("deck.toml");
//   auto t = deck.table("material", "What the crystals are made of.");
//   const double c11 = t.number("c11", {.unit = "MPa", .fallback = 107.3e3, .min = 0,
//                                       .exclusive_min = true, .help = "Elastic constant C11."});
//   deck.finish();
//
// Reading never throws for a wrong value: it notes the fault and gives the default (NaN, 0 or ""
// where there is none). `finish` throws the first fault by its place in the text, as one line:
//   deck.toml:12:5: [material] unknown key 'h_0'; did you mean 'h0'?

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace polyslip::core {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// A key without `fallback` is required. "1" is the unit of pure numbers.
struct NumberKey {
  std::string unit = "1";
  std::optional<double> fallback = {};
  double min = -unbounded;
  bool exclusive_min = false;
  double max = unbounded;
  bool exclusive_max = false;
  std::string help = {};
};

struct IntegerKey {
  std::string unit = "1";
  std::optional<std::int64_t> fallback = {};
  std::int64_t min = std::numeric_limits<std::int64_t>::min();
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
  std::string help = {};
};

struct BooleanKey {
  std::optional<bool> fallback = {};
  std::string help = {};
};

/// `choices` empty: any text.
struct TextKey {
  std::optional<std::string> fallback = {};
  std::vector<std::string> choices = {};
  std::string help = {};
};

/// The bounds hold for each number of the list.
struct NumbersKey {
  std::string unit = "1";
  std::optional<std::vector<double>> fallback = {};
  double min = -unbounded;
  bool exclusive_min = false;
  double max = unbounded;
  bool exclusive_max = false;
  bool increasing = false;  ///< each larger than the one before
  std::string help = {};
};

struct TextsKey {
  std::optional<std::vector<std::string>> fallback = {};
  std::vector<std::string> choices = {};
  bool unique = false;
  bool not_empty = false;
  std::string help = {};
};

/// What a key was declared as and what it came to; all texts, values as TOML.
struct Declaration {
  std::string section, key;
  std::string type;      ///< "number", "integer", "true or false", "text", "list of numbers", ...
  std::string unit;      ///< empty for texts and truth values
  std::string fallback;  ///< empty: required (or, if `optional`, unset)
  std::string bounds;    ///< "> 0", "one of ..."; may be empty
  std::string help;
  std::string value;  ///< as resolved; empty if unset
  bool optional = false;
};

class Deck {
 public:
  struct Impl;  // core/deck_impl.hpp; for deck*.cpp only

  /// One [section] of the deck. Lives as long as its deck.
  class Table {
   public:
    /// An integer literal will do.
    double number(const std::string& key, const NumberKey& rule);
    std::int64_t integer(const std::string& key, const IntegerKey& rule);
    bool boolean(const std::string& key, const BooleanKey& rule);
    std::string text(const std::string& key, const TextKey& rule);
    std::vector<double> numbers(const std::string& key, const NumbersKey& rule);
    std::vector<std::string> texts(const std::string& key, const TextsKey& rule);
    /// A list of exactly three numbers.
    Vec3 vector3(const std::string& key, const NumbersKey& rule);
    /// Keys that may be left out: no default, no fault.
    std::optional<double> optional_number(const std::string& key, const NumberKey& rule);
    /// A list of exactly `count` numbers.
    std::optional<std::vector<double>> optional_numbers(const std::string& key, std::size_t count,
                                                        const NumbersKey& rule);
    /// A list of lists of `columns` numbers, one at least.
    std::optional<std::vector<std::vector<double>>> optional_rows(const std::string& key,
                                                                  std::size_t columns,
                                                                  const NumbersKey& rule);
    std::optional<std::string> optional_text(const std::string& key, const TextKey& rule);
    /// A file: a relative path is taken from the deck's folder. The path to open; the resolved deck
    /// holds it absolute, so that it can be run from elsewhere.
    std::optional<std::string> optional_file(const std::string& key, const TextKey& rule);

    /// Whether the deck itself has the key (so it is no default).
    bool given(const std::string& key) const;
    /// "deck.toml:12:7" of the key's value; of the table, or the file alone, if it is not there.
    std::string where(const std::string& key) const;
    /// Notes a fault found between keys: "<where>: [section] <what>". Thrown by `finish` unless
    /// there are faults of single keys, which come first.
    void fault(const std::string& key, const std::string& what);

    /// As declared.
    const std::string& name() const { return section_; }

   private:
    friend class Deck;
    Table(Impl& deck, std::string section) : deck_(&deck), section_(std::move(section)) {}
    Impl* deck_;
    std::string section_;
  };

  /// InputError "<path>: no such file", or of syntax.
  static Deck from_file(const std::string& path);
  /// `path` names the deck in messages and gives the folder of relative paths. For ranks that get
  /// the text from rank 0, and for tests.
  static Deck from_text(const std::string& text, const std::string& path);
  Deck(Deck&&) noexcept;
  Deck& operator=(Deck&&) noexcept;
  ~Deck();

  /// Declares a section, with a sentence for the reference page.
  Table table(const std::string& section, const std::string& help = "");
  /// Declares the tables of a list, [[section.list]]: as many as the deck has, in its order. Their
  /// names, in messages and for the functions below, are "section.list 1" and so on.
  std::vector<Table> tables(const std::string& list, const std::string& help = "");
  /// `Table::given`, `Table::where` and `Table::fault` for checks between tables.
  bool given(const std::string& section, const std::string& key) const;
  std::string where(const std::string& section, const std::string& key) const;
  void fault(const std::string& section, const std::string& key, const std::string& what);
  /// Throws the first fault (InputError), those of undeclared keys and tables among them.
  void finish() const;

  const std::string& path() const;
  /// As given.
  const std::string& text() const;
  /// TOML with every declared key: what the program understood. Reads back to the same values.
  std::string resolved() const;
  /// 16 hexadecimal digits that change when a resolved value does.
  std::string fingerprint() const;
  /// In the order of reading.
  const std::vector<Declaration>& declarations() const;
  /// Markdown: a heading and a table a section.
  std::string reference() const;

 private:
  explicit Deck(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Least number of insertions, deletions, replacements and swaps of neighbours from a to b.
int edit_distance(const std::string& a, const std::string& b);

/// The nearest of `known` to `word`, or "" if none is near (more than a third of it, and 2, away).
std::string nearest_name(const std::string& word, const std::vector<std::string>& known);

}  // namespace polyslip::core
