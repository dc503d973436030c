#include "results/hdf5.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace polyslip::results::hdf5 {
namespace {

using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;
using Object = Handle<H5Oclose>;

/// Keeps HDF5 from printing while it lives.
class Quiet {
 public:
  Quiet() {
    // Every file is closed by its owner, and one that is abandoned must not be: see File::abandon.
    static const herr_t no_clean_up = H5dont_atexit();
    static_cast<void>(no_clean_up);
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Innermost message of HDF5's error stack.
std::string reason() {
  std::string text;
  const auto take = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    auto& first = *static_cast<std::string*>(data);
    if (first.empty() && error->desc != nullptr) first = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text.empty() ? "no reason given" : text;
}

/// Passes on what is not negative.
template <class T>
T require(T status, const std::string& path, const std::string& what) {
  if (status < 0) throw core::InputError(fmt::format("{}: {} ({})", path, what, reason()));
  return status;
}

hid_t memory_type(Number type) {
  switch (type) {
    case Number::float64:
      return H5T_NATIVE_DOUBLE;
    case Number::int32:
      return H5T_NATIVE_INT32;
    case Number::uint8:
      return H5T_NATIVE_UINT8;
  }
  throw core::InternalError("results/hdf5: unknown number type");
}

hid_t file_type(Number type) {
  switch (type) {
    case Number::float64:
      return H5T_IEEE_F64LE;
    case Number::int32:
      return H5T_STD_I32LE;
    case Number::uint8:
      return H5T_STD_U8LE;
  }
  throw core::InternalError("results/hdf5: unknown number type");
}

Type text_type(const std::string& path) {
  Type type(require(H5Tcopy(H5T_C_S1), path, "cannot make a text type"));
  require(H5Tset_size(type.get(), H5T_VARIABLE), path, "cannot make a text type");
  require(H5Tset_cset(type.get(), H5T_CSET_UTF8), path, "cannot make a text type");
  return type;
}

Space space_of(std::span<const std::uint64_t> shape, const std::string& path) {
  if (shape.empty()) return Space(require(H5Screate(H5S_SCALAR), path, "cannot make a scalar"));
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  return Space(require(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                       path, "cannot make a data space"));
}

/// New dataset, groups made on the way, without time stamps: same data, same bytes.
Dataset make_dataset(hid_t file, const std::string& name, hid_t type, hid_t space,
                     const std::string& path) {
  const std::string what = "cannot write " + name;
  Properties link(require(H5Pcreate(H5P_LINK_CREATE), path, what));
  require(H5Pset_create_intermediate_group(link.get(), 1), path, what);
  Properties creation(require(H5Pcreate(H5P_DATASET_CREATE), path, what));
  require(H5Pset_obj_track_times(creation.get(), false), path, what);
  return Dataset(
      require(H5Dcreate2(file, name.c_str(), type, space, link.get(), creation.get(), H5P_DEFAULT),
              path, what));
}

/// A text of variable length, read and freed.
template <class Read>
std::string take_text(Read read, const std::string& path, const std::string& what) {
  char* text = nullptr;
  require(read(&text), path, what);
  std::string copy = text != nullptr ? text : "";
  require(H5free_memory(text), path, what);
  return copy;
}

bool is_variable_text(hid_t type) {
  return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) > 0;
}

}  // namespace

File File::create(const std::string& path, std::uint64_t user_block) {
  const Quiet quiet;
  Properties properties(require(H5Pcreate(H5P_FILE_CREATE), path, "cannot create"));
  require(H5Pset_userblock(properties.get(), user_block), path, "cannot create");
  return File(path, Handle<H5Fclose>(require(
                        H5Fcreate(path.c_str(), H5F_ACC_TRUNC, properties.get(), H5P_DEFAULT), path,
                        "cannot create")));
}

File File::open(const std::string& path) {
  const Quiet quiet;
  return File(path, Handle<H5Fclose>(require(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                                             path, "cannot open as an HDF5 file")));
}

void File::close() {
  const Quiet quiet;
  require(file_.close(), path_, "cannot finish writing");
}

void File::write(const std::string& name, Number type, std::span<const std::uint64_t> shape,
                 const void* data) {
  const Quiet quiet;
  const Space space = space_of(shape, path_);
  const Dataset dataset = make_dataset(file_.get(), name, file_type(type), space.get(), path_);
  for (const auto size : shape)
    if (size == 0) return;
  require(H5Dwrite(dataset.get(), memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data), path_,
          "cannot write " + name);
}

void File::create_dataset(const std::string& name, Number type,
                          std::span<const std::uint64_t> shape) {
  const Quiet quiet;
  const Space space = space_of(shape, path_);
  const Dataset dataset = make_dataset(file_.get(), name, file_type(type), space.get(), path_);
}

void File::write_rows(const std::string& name, Number type, std::uint64_t first,
                      std::uint64_t count, const void* data) {
  const Quiet quiet;
  const std::string what = "cannot write " + name;
  const Dataset dataset(require(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), path_, what));
  const Space space(require(H5Dget_space(dataset.get()), path_, what));
  const int rank = require(H5Sget_simple_extent_ndims(space.get()), path_, what);
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank)), start(sizes.size(), 0);
  require(H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr), path_, what);
  sizes.at(0) = count;
  start.at(0) = first;
  require(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, sizes.data(),
                              nullptr),
          path_, what);
  const Space memory(require(H5Screate_simple(rank, sizes.data(), nullptr), path_, what));
  require(H5Dwrite(dataset.get(), memory_type(type), memory.get(), space.get(), H5P_DEFAULT, data),
          path_, what);
}

void File::write_text(const std::string& name, const std::string& text) {
  const Quiet quiet;
  const Type type = text_type(path_);
  const Space space = space_of({}, path_);
  const Dataset dataset = make_dataset(file_.get(), name, type.get(), space.get(), path_);
  const char* start = text.c_str();
  require(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &start), path_,
          "cannot write " + name);
}

void File::write_attribute(const std::string& name, const std::string& attribute,
                           const std::string& text) {
  const Quiet quiet;
  const std::string what = fmt::format("cannot write {} of {}", attribute, name);
  const Type type = text_type(path_);
  const Space space = space_of({}, path_);
  const Object object(require(H5Oopen(file_.get(), name.c_str(), H5P_DEFAULT), path_, what));
  const Attribute a(require(H5Acreate2(object.get(), attribute.c_str(), type.get(), space.get(),
                                       H5P_DEFAULT, H5P_DEFAULT),
                            path_, what));
  const char* start = text.c_str();
  require(H5Awrite(a.get(), type.get(), &start), path_, what);
}

void File::write_attribute(const std::string& name, const std::string& attribute,
                           std::int32_t value) {
  const Quiet quiet;
  const std::string what = fmt::format("cannot write {} of {}", attribute, name);
  const Space space = space_of({}, path_);
  const Object object(require(H5Oopen(file_.get(), name.c_str(), H5P_DEFAULT), path_, what));
  const Attribute a(require(H5Acreate2(object.get(), attribute.c_str(), H5T_STD_I32LE, space.get(),
                                       H5P_DEFAULT, H5P_DEFAULT),
                            path_, what));
  require(H5Awrite(a.get(), H5T_NATIVE_INT32, &value), path_, what);
}

bool File::has(const std::string& name) const {
  const Quiet quiet;
  for (std::size_t end = name.find('/'); end != std::string::npos; end = name.find('/', end + 1))
    if (H5Lexists(file_.get(), name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> File::names(const std::string& group) const {
  if (!has(group)) return {};
  const Quiet quiet;
  std::vector<std::string> all;
  const auto take = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  hsize_t from = 0;
  const Object object(
      require(H5Oopen(file_.get(), group.c_str(), H5P_DEFAULT), path_, "cannot open " + group));
  require(H5Literate(object.get(), H5_INDEX_NAME, H5_ITER_INC, &from, take, &all), path_,
          "cannot list " + group);
  return all;
}

std::vector<std::uint64_t> File::shape(const std::string& name, Number type) const {
  const Quiet quiet;
  const std::string what = "cannot read " + name;
  const Dataset dataset(require(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), path_, what));
  const Type stored(require(H5Dget_type(dataset.get()), path_, what));
  if (H5Tequal(stored.get(), file_type(type)) <= 0)
    throw core::InputError(fmt::format("{}: {} is of another number type", path_, name));
  const Space space(require(H5Dget_space(dataset.get()), path_, what));
  const int rank = require(H5Sget_simple_extent_ndims(space.get()), path_, what);
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  if (rank > 0) require(H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr), path_, what);
  return {sizes.begin(), sizes.end()};
}

void File::read(const std::string& name, Number type, void* data) const {
  const Quiet quiet;
  const std::string what = "cannot read " + name;
  const Dataset dataset(require(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), path_, what));
  require(H5Dread(dataset.get(), memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data), path_,
          what);
}

std::string File::read_text(const std::string& name) const {
  const Quiet quiet;
  const std::string what = "cannot read " + name;
  const Dataset dataset(require(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), path_, what));
  const Type stored(require(H5Dget_type(dataset.get()), path_, what));
  if (!is_variable_text(stored.get()))
    throw core::InputError(fmt::format("{}: {} is not a text", path_, name));
  const Type type = text_type(path_);
  return take_text(
      [&](char** text) {
        return H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
      },
      path_, what);
}

std::string File::read_text_attribute(const std::string& name, const std::string& attribute) const {
  const Quiet quiet;
  const std::string what = fmt::format("cannot read {} of {}", attribute, name);
  const Attribute a(require(
      H5Aopen_by_name(file_.get(), name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      path_, what));
  const Type stored(require(H5Aget_type(a.get()), path_, what));
  if (!is_variable_text(stored.get()))
    throw core::InputError(fmt::format("{}: {} of {} is not a text", path_, attribute, name));
  const Type type = text_type(path_);
  return take_text([&](char** text) { return H5Aread(a.get(), type.get(), text); }, path_, what);
}

std::int32_t File::read_int_attribute(const std::string& name, const std::string& attribute) const {
  const Quiet quiet;
  const std::string what = fmt::format("cannot read {} of {}", attribute, name);
  const Attribute a(require(
      H5Aopen_by_name(file_.get(), name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
      path_, what));
  std::int32_t value = 0;
  require(H5Aread(a.get(), H5T_NATIVE_INT32, &value), path_, what);
  return value;
}

}  // namespace polyslip::results::hdf5
