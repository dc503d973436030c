#pragma once
// Owning handles of HDF5 objects and the few checked calls that the state file needs. Serial use,
// on one rank. HDF5's own error printing is off inside every call. Every failure is an exception
// that names the file: InputError, since a file that cannot be written or read is the user's.

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/handle.hpp"

namespace polyslip::results::hdf5 {

/// Owns one HDF5 identifier.
template <herr_t (*close_function)(hid_t)>
using Handle = core::Handle<hid_t, close_function, hid_t{H5I_INVALID_HID}>;

/// Number types of the state file.
enum class Number { float64, int32, uint8 };

template <class T>
constexpr Number number_of();
template <>
constexpr Number number_of<double>() {
  return Number::float64;
}
template <>
constexpr Number number_of<std::int32_t>() {
  return Number::int32;
}
template <>
constexpr Number number_of<std::uint8_t>() {
  return Number::uint8;
}

/// An open file: created anew with a block of `user_block` bytes ahead of it that HDF5 leaves
/// alone, or opened for reading.
class File {
 public:
  static File create(const std::string& path, std::uint64_t user_block);
  static File open(const std::string& path);
  /// Closes and reports what could not be written.
  void close();
  /// Lets go of a file that could not be written, without closing it: after a failed write HDF5
  /// 1.10 crashes in H5Fclose, and again at the end of the program.
  void abandon() { file_.release(); }
  const std::string& path() const { return path_; }

  /// New dataset with the groups on its way. `data` holds the product of `shape` numbers; an empty
  /// shape is a scalar.
  void write(const std::string& name, Number type, std::span<const std::uint64_t> shape,
             const void* data);
  /// New dataset like that of `write`, whose rows are written later, each once.
  void create_dataset(const std::string& name, Number type, std::span<const std::uint64_t> shape);
  /// Rows first ... first + count - 1 of such a dataset.
  void write_rows(const std::string& name, Number type, std::uint64_t first, std::uint64_t count,
                  const void* data);
  void write_text(const std::string& name, const std::string& text);
  /// On a dataset or group ("/": the file).
  void write_attribute(const std::string& name, const std::string& attribute,
                       const std::string& text);
  void write_attribute(const std::string& name, const std::string& attribute, std::int32_t value);

  bool has(const std::string& name) const;
  /// Names in a group in alphabetical order; none if there is no such group.
  std::vector<std::string> names(const std::string& group) const;
  /// Throws if the dataset is of another number type.
  std::vector<std::uint64_t> shape(const std::string& name, Number type) const;
  void read(const std::string& name, Number type, void* data) const;
  std::string read_text(const std::string& name) const;
  std::string read_text_attribute(const std::string& name, const std::string& attribute) const;
  std::int32_t read_int_attribute(const std::string& name, const std::string& attribute) const;

 private:
  File(std::string path, Handle<H5Fclose> file) : path_(std::move(path)), file_(std::move(file)) {}
  std::string path_;
  Handle<H5Fclose> file_;
};

}  // namespace polyslip::results::hdf5
