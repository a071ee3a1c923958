#include "io/hdf5.h"

#include <hdf5.h>

#include <algorithm>
#include <utility>

namespace strut {

static_assert(sizeof(hid_t) == sizeof(Hdf5Handle::Id), "handles carry an hid_t");

namespace {

namespace fs = std::filesystem;

// The deepest entry of the library's error stack says what really happened.
std::string last_library_error() {
  std::string text;
  const auto keep_first = [](unsigned, const H5E_error2_t* entry, void* out) -> herr_t {
    auto& message = *static_cast<std::string*>(out);
    if (message.empty() && entry->desc != nullptr) message = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &text);
  H5Eclear2(H5E_DEFAULT);
  return text.empty() ? "" : " (" + text + ")";
}

std::string place(const fs::path& path, const std::string& object) {
  return path.string() + (object.empty() ? "" : ": " + object);
}

template <class Error>
void check(bool good, const fs::path& path, const std::string& object, const std::string& what) {
  if (!good) throw Error(place(path, object) + ": " + what + last_library_error());
}

template <class Error>
Hdf5Handle checked(hid_t id, Hdf5Handle::Close close, const fs::path& path,
                   const std::string& object, const std::string& what) {
  check<Error>(id >= 0, path, object, what);
  return {id, close};
}

// Before the first call of the library. Errors become exceptions, so it must not print them as
// well; and it must not clean up at exit: every handle is closed here, and a file that could not be
// flushed to a full disk crashes 1.10.8 there.
void prepare_library() {
  static const bool no_cleanup = H5dont_atexit() >= 0;
  static_cast<void>(no_cleanup);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Handle make_string_type(const fs::path& path) {
  Hdf5Handle type = checked<EnvironmentError>(H5Tcopy(H5T_C_S1), H5Tclose, path, "", "string type");
  check<EnvironmentError>(H5Tset_size(type.id(), H5T_VARIABLE) >= 0, path, "", "string type");
  check<EnvironmentError>(H5Tset_cset(type.id(), H5T_CSET_UTF8) >= 0, path, "", "string type");
  return type;
}

void write_strings(const fs::path& path, hid_t object, const std::string& object_name,
                   const std::string& key, const std::vector<const char*>& values, bool scalar) {
  const std::string name = object_name + "@" + key;
  const std::string what = "attribute cannot be written";
  const hsize_t count = values.size();
  const Hdf5Handle type = make_string_type(path);
  const Hdf5Handle space = checked<EnvironmentError>(
      scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose, path, name,
      what);
  const Hdf5Handle attribute = checked<EnvironmentError>(
      H5Acreate2(object, key.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      path, name, what);
  check<EnvironmentError>(H5Awrite(attribute.id(), type.id(), values.data()) >= 0, path, name,
                          what);
}

// Attribute `key` as strings, [] where there is none.
std::vector<std::string> read_strings(const fs::path& path, hid_t object,
                                      const std::string& object_name, const std::string& key) {
  const std::string name = object_name + "@" + key;
  const std::string what = "attribute cannot be read as text";
  if (H5Aexists(object, key.c_str()) <= 0) return {};
  const Hdf5Handle attribute =
      checked<InputError>(H5Aopen(object, key.c_str(), H5P_DEFAULT), H5Aclose, path, name, what);
  const Hdf5Handle stored =
      checked<InputError>(H5Aget_type(attribute.id()), H5Tclose, path, name, what);
  check<InputError>(H5Tis_variable_str(stored.id()) > 0, path, name, what);
  const Hdf5Handle space =
      checked<InputError>(H5Aget_space(attribute.id()), H5Sclose, path, name, what);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  check<InputError>(count >= 0, path, name, what);
  const Hdf5Handle type = make_string_type(path);
  std::vector<char*> raw(static_cast<std::size_t>(count), nullptr);
  check<InputError>(H5Aread(attribute.id(), type.id(), raw.data()) >= 0, path, name, what);
  std::vector<std::string> values;
  values.reserve(raw.size());
  for (const char* text : raw) values.emplace_back(text == nullptr ? "" : text);
  H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, raw.data());
  return values;
}

std::string first_or_empty(const std::vector<std::string>& texts) {
  return texts.empty() ? "" : texts.front();
}

std::vector<std::size_t> read_shape(const fs::path& path, const std::string& name, hid_t dataset) {
  const Hdf5Handle space =
      checked<InputError>(H5Dget_space(dataset), H5Sclose, path, name, "shape cannot be read");
  const int rank = H5Sget_simple_extent_ndims(space.id());
  check<InputError>(rank == 1 || rank == 2, path, name, "must have one or two dimensions");
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  check<InputError>(H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr) == rank, path,
                    name, "shape cannot be read");
  return {sizes.begin(), sizes.end()};
}

}  // namespace

Hdf5Handle::Hdf5Handle(Hdf5Handle&& other) noexcept
    : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
  reset();
  id_ = std::exchange(other.id_, -1);
  close_ = other.close_;
  return *this;
}

bool Hdf5Handle::reset() {
  const Id id = std::exchange(id_, -1);
  return id < 0 || close_(id) >= 0;
}

Hdf5Writer::Hdf5Writer(const fs::path& path) : target_(path) {
  prepare_library();
  file_ = checked<EnvironmentError>(
      H5Fcreate(target_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
      path, "", "cannot be written");
}

void Hdf5Writer::write(const std::string& name, std::span<const double> values,
                       const Hdf5Label& label) {
  write_shaped(name, values, {values.size()}, label);
}

void Hdf5Writer::write(const std::string& name, std::span<const double> values, std::size_t columns,
                       const Hdf5Label& label) {
  const bool fits = columns > 0 && values.size() % columns == 0;
  const bool named = label.names.empty() || label.names.size() == columns;
  if (!fits || !named) {
    throw std::logic_error(name + ": values, columns and names do not fit each other");
  }
  write_shaped(name, values, {values.size() / columns, columns}, label);
}

void Hdf5Writer::write_shaped(const std::string& name, std::span<const double> values,
                              const std::vector<std::size_t>& shape, const Hdf5Label& label) {
  const fs::path& path = target_.target();
  const std::string what = "dataset cannot be written";
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  const Hdf5Handle space = checked<EnvironmentError>(
      H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose, path, name,
      what);
  const Hdf5Handle links =
      checked<EnvironmentError>(H5Pcreate(H5P_LINK_CREATE), H5Pclose, path, name, what);
  check<EnvironmentError>(H5Pset_create_intermediate_group(links.id(), 1) >= 0, path, name, what);
  const Hdf5Handle dataset =
      checked<EnvironmentError>(H5Dcreate2(file_.id(), name.c_str(), H5T_NATIVE_DOUBLE, space.id(),
                                           links.id(), H5P_DEFAULT, H5P_DEFAULT),
                                H5Dclose, path, name, what);
  check<EnvironmentError>(
      H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
      path, name, what);
  write_strings(path, dataset.id(), name, "unit", {label.unit.c_str()}, true);
  write_strings(path, dataset.id(), name, "description", {label.description.c_str()}, true);
  std::vector<const char*> names;
  for (const std::string& column : label.names) names.push_back(column.c_str());
  if (!names.empty()) write_strings(path, dataset.id(), name, "names", names, false);
}

void Hdf5Writer::write_attribute(const std::string& object, const std::string& key,
                                 const std::string& value) {
  const Hdf5Handle handle = checked<EnvironmentError>(
      H5Oopen(file_.id(), object.c_str(), H5P_DEFAULT), H5Oclose, target_.target(), object,
      "no such dataset or group to hold attribute " + key);
  write_strings(target_.target(), handle.id(), object, key, {value.c_str()}, true);
}

void Hdf5Writer::commit() {
  const bool flushed = H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) >= 0;
  check<EnvironmentError>(flushed, target_.target(), "", "cannot be written; disk full?");
  check<EnvironmentError>(file_.reset(), target_.target(), "", "cannot be written; disk full?");
  target_.commit();
}

Hdf5Reader::Hdf5Reader(const fs::path& path) : path_(path) {
  prepare_library();
  if (!fs::exists(path)) throw InputError(path.string() + ": file not found");
  check<InputError>(H5Fis_hdf5(path.c_str()) > 0, path, "", "not an HDF5 file");
  file_ = checked<InputError>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path,
                              "", "damaged or not readable");
}

bool Hdf5Reader::has(const std::string& name) const {
  // H5Lexists needs every group on the way to exist.
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    if (H5Lexists(file_.id(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
    if (slash == std::string::npos) return true;
  }
}

Hdf5Dataset Hdf5Reader::read(const std::string& name) const {
  check<InputError>(has(name), path_, name, "no such dataset");
  const Hdf5Handle dataset = checked<InputError>(H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT),
                                                 H5Dclose, path_, name, "not a dataset");
  Hdf5Dataset data;
  data.shape = read_shape(path_, name, dataset.id());
  std::size_t count = 1;
  for (const std::size_t size : data.shape) count *= size;
  // A damaged header may claim any size; the stored bytes bound what is believed.
  const hsize_t stored = H5Dget_storage_size(dataset.id());
  const Hdf5Handle creation =
      checked<InputError>(H5Dget_create_plist(dataset.id()), H5Pclose, path_, name, "damaged");
  const bool plain = H5Pget_nfilters(creation.id()) == 0;
  check<InputError>(!plain || stored >= count, path_, name, "damaged: data missing");
  data.values.resize(count);
  check<InputError>(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                            data.values.data()) >= 0,
                    path_, name, "damaged, or not numbers");
  data.label.unit = first_or_empty(read_strings(path_, dataset.id(), name, "unit"));
  data.label.description = first_or_empty(read_strings(path_, dataset.id(), name, "description"));
  data.label.names = read_strings(path_, dataset.id(), name, "names");
  return data;
}

std::string Hdf5Reader::read_attribute(const std::string& object, const std::string& key) const {
  const Hdf5Handle handle = checked<InputError>(H5Oopen(file_.id(), object.c_str(), H5P_DEFAULT),
                                                H5Oclose, path_, object, "no such object");
  const auto values = read_strings(path_, handle.id(), object, key);
  check<InputError>(values.size() == 1, path_, object + "@" + key, "no such attribute");
  return values.front();
}

std::vector<std::string> Hdf5Reader::list(const std::string& group) const {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  const herr_t status = H5Literate_by_name(file_.id(), group.c_str(), H5_INDEX_NAME, H5_ITER_INC,
                                           nullptr, add, &names, H5P_DEFAULT);
  check<InputError>(status >= 0, path_, group, "no such group");
  return names;
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

}  // namespace strut
