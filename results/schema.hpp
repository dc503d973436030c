#pragma once
// The datasets of a state file: one table for writer, reader and docs/results-format.md.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "results/hdf5.hpp"

namespace polyslip::results {

inline const std::string state_file_type = "polyslip-state";
inline constexpr int state_file_version = 1;

/// One dataset, or a family of them if the name ends in "/*".
struct DatasetSpec {
  std::string name;
  hdf5::Number type;
  std::vector<std::string> shape;  ///< a word: a size, the same wherever it stands; or a number
  std::string unit;                ///< "1" for pure numbers, "-" for ids
  std::string location;            ///< what a row belongs to
  std::string description;
};

const std::vector<DatasetSpec>& state_schema();

/// The row of a dataset, families included; InternalError for a name that no row covers.
const DatasetSpec& dataset_spec(const std::string& name);

/// Writes datasets of the table, with unit, location and description as attributes.
class TableWriter {
 public:
  explicit TableWriter(hdf5::File& file) : file_(file) {}
  /// Gives a word of the table its size ("nodes", 1234).
  void set_size(const std::string& word, std::uint64_t size) { sizes_[word] = size; }
  /// InternalError if the values are not as many as the table says.
  template <class T>
  void put(const std::string& name, std::span<const T> values) {
    put(name, hdf5::number_of<T>(), values.data(), values.size());
  }
  template <class T>
  void put(const std::string& name, const std::vector<T>& values) {
    put(name, std::span<const T>(values));
  }
  template <class T>
  void put_scalar(const std::string& name, T value) {
    put(name, std::span<const T>(&value, 1));
  }
  /// New dataset of the table, whose rows follow, each once.
  template <class T>
  void create(const std::string& name) {
    create(name, hdf5::number_of<T>());
  }
  /// The rows from `first` on of such a dataset. InternalError if the values are not whole rows.
  template <class T>
  void put_rows(const std::string& name, std::uint64_t first, const std::vector<T>& values) {
    put_rows(name, hdf5::number_of<T>(), first, values.data(), values.size());
  }

 private:
  std::vector<std::uint64_t> shape_of(const DatasetSpec& spec, const std::string& name) const;
  void describe(const DatasetSpec& spec, const std::string& name);
  void create(const std::string& name, hdf5::Number type);
  void put_rows(const std::string& name, hdf5::Number type, std::uint64_t first, const void* data,
                std::size_t count);
  void put(const std::string& name, hdf5::Number type, const void* data, std::size_t count);
  hdf5::File& file_;
  std::map<std::string, std::uint64_t> sizes_;
};

/// Reads datasets of the table; InputError if one is missing or its shape is not the table's, the
/// words' sizes being the same throughout.
class TableReader {
 public:
  explicit TableReader(const hdf5::File& file) : file_(file) {}
  template <class T>
  std::vector<T> get(const std::string& name) {
    std::vector<T> values(expect(name, hdf5::number_of<T>()));
    if (!values.empty()) file_.read(name, hdf5::number_of<T>(), values.data());
    return values;
  }
  template <class T>
  T get_scalar(const std::string& name) {
    return get<T>(name).at(0);
  }
  /// Size of a word met by now, or given.
  std::uint64_t size(const std::string& word) const { return sizes_.at(word); }
  void set_size(const std::string& word, std::uint64_t size) { sizes_[word] = size; }
  /// Lets a word take another size in the next dataset (components of fields).
  void forget_size(const std::string& word) { sizes_.erase(word); }

 private:
  std::size_t expect(const std::string& name, hdf5::Number type);
  const hdf5::File& file_;
  std::map<std::string, std::uint64_t> sizes_;
};

}  // namespace polyslip::results
