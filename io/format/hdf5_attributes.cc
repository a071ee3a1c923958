// Writes and reads attributes. Their texts are of fixed length, see io/format/hdf5.h.
#include <fmt/format.h>

#include <algorithm>

#include "io/format/hdf5_calls.h"

namespace strut {
namespace hdf5 {

namespace fs = std::filesystem;

namespace {

constexpr char kAttributeNotWritten[] = "attribute cannot be written";
constexpr char kNoAttribute[] = "no such attribute";

/// Returns how messages call an attribute: "/time@unit".
std::string name_attribute(const std::string& object, const std::string& key) {
  return fmt::format("{}@{}", object, key);
}

}  // namespace

void write_texts(const fs::path& path, hid_t object, const std::string& object_name,
                 const std::string& key, const std::vector<std::string>& values, bool scalar) {
  const std::string name = name_attribute(object_name, key);
  const std::string what = kAttributeNotWritten;
  const PackedTexts texts = pack_texts(values);
  const hsize_t count = values.size();
  const Hdf5Handle type = make_type(path, Hdf5Type::kText, texts.length);
  const Hdf5Handle space = checked<EnvironmentError>(
      scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose, path, name,
      what);
  const Hdf5Handle attribute = checked<EnvironmentError>(
      H5Acreate2(object, key.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      path, name, what);
  check<EnvironmentError>(H5Awrite(attribute.id(), type.id(), texts.bytes.data()) >= 0, path, name,
                          what);
}

void write_text_attribute(const Hdf5Sink& sink, const std::string& object, const std::string& key,
                          const std::vector<std::string>& values, bool scalar) {
  const Hdf5Handle handle = checked<EnvironmentError>(
      H5Oopen(sink.file.id(), object.c_str(), H5P_DEFAULT), H5Oclose, sink.shown, object,
      fmt::format("no such dataset or group for attribute {}", key));
  write_texts(sink.shown, handle.id(), object, key, values, scalar);
}

void write_number_attribute(const Hdf5Sink& sink, const std::string& object, const std::string& key,
                            hid_t type, const void* value) {
  const std::string name = name_attribute(object, key);
  const std::string what = kAttributeNotWritten;
  const Hdf5Handle space =
      checked<EnvironmentError>(H5Screate(H5S_SCALAR), H5Sclose, sink.shown, name, what);
  const Hdf5Handle attribute = checked<EnvironmentError>(
      H5Acreate_by_name(sink.file.id(), object.c_str(), key.c_str(), type, space.id(), H5P_DEFAULT,
                        H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, sink.shown, name, what);
  check<EnvironmentError>(H5Awrite(attribute.id(), type, value) >= 0, sink.shown, name, what);
}

std::vector<std::string> unpack_texts(const std::vector<char>& raw, std::size_t length) {
  std::vector<std::string> texts;
  texts.reserve(raw.size() / length);
  for (auto at = raw.begin(); at != raw.end();) {
    const auto end = at + static_cast<std::ptrdiff_t>(length);
    texts.emplace_back(at, std::find(at, end, '\0'));
    at = end;
  }
  return texts;
}

std::size_t get_text_length(const fs::path& path, const std::string& name, hid_t type) {
  const bool fixed = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  check<InputError>(fixed, path, name, "must hold texts of fixed length");
  return H5Tget_size(type);
}

bool has_variable_text(hid_t object, const std::string& key) {
  if (H5Aexists(object, key.c_str()) <= 0) return false;
  const Hdf5Handle attribute(H5Aopen(object, key.c_str(), H5P_DEFAULT), H5Aclose);
  if (attribute.id() < 0) return false;
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  return type.id() >= 0 && H5Tget_class(type.id()) == H5T_STRING &&
         H5Tis_variable_str(type.id()) > 0;
}

std::vector<std::string> read_texts_of(const fs::path& path, hid_t object,
                                       const std::string& object_name, const std::string& key) {
  const std::string name = name_attribute(object_name, key);
  const std::string what = "attribute cannot be read";
  const htri_t exists = H5Aexists(object, key.c_str());
  check<InputError>(exists >= 0, path, name, what);
  if (exists == 0) return {};
  const Hdf5Handle attribute =
      checked<InputError>(H5Aopen(object, key.c_str(), H5P_DEFAULT), H5Aclose, path, name, what);
  const Hdf5Handle stored =
      checked<InputError>(H5Aget_type(attribute.id()), H5Tclose, path, name, what);
  const std::size_t length = get_text_length(path, name, stored.id());
  const Hdf5Handle space =
      checked<InputError>(H5Aget_space(attribute.id()), H5Sclose, path, name, what);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  check<InputError>(count >= 0, path, name, what);
  std::vector<char> raw(static_cast<std::size_t>(count) * length);
  check<InputError>(H5Aread(attribute.id(), stored.id(), raw.data()) >= 0, path, name, what);
  return unpack_texts(raw, length);
}

}  // namespace hdf5

using hdf5::check;
using hdf5::checked;
namespace fs = std::filesystem;

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& key) const {
  const bool exists =
      H5Aexists_by_name(file_.id(), object.c_str(), key.c_str(), hdf5::get_in_file_access()) > 0;
  H5Eclear2(H5E_DEFAULT);
  return exists;
}

std::vector<std::string> Hdf5Reader::read_attribute_list(const std::string& object,
                                                         const std::string& key) const {
  const Hdf5Handle handle =
      checked<InputError>(H5Oopen(file_.id(), object.c_str(), hdf5::get_in_file_access()), H5Oclose,
                          path_, object, "no such object");
  return hdf5::read_texts_of(path_, handle.id(), object, key);
}

std::string Hdf5Reader::read_attribute(const std::string& object, const std::string& key) const {
  const auto values = read_attribute_list(object, key);
  check<InputError>(values.size() == 1, path_, hdf5::name_attribute(object, key),
                    hdf5::kNoAttribute);
  return values.front();
}

namespace {

// Reads a scalar attribute, an integer or, if `real`, any number, as `type` into `value`.
void read_number(const fs::path& path, hid_t file, const std::string& object,
                 const std::string& key, bool real, hid_t type, void* value) {
  const std::string name = hdf5::name_attribute(object, key);
  const Hdf5Handle attribute = checked<InputError>(
      H5Aopen_by_name(file, object.c_str(), key.c_str(), H5P_DEFAULT, hdf5::get_in_file_access()),
      H5Aclose, path, name, hdf5::kNoAttribute);
  const Hdf5Handle stored =
      checked<InputError>(H5Aget_type(attribute.id()), H5Tclose, path, name, hdf5::kDamaged);
  const Hdf5Handle space =
      checked<InputError>(H5Aget_space(attribute.id()), H5Sclose, path, name, hdf5::kDamaged);
  const H5T_class_t kind = H5Tget_class(stored.id());
  const bool fits = (kind == H5T_INTEGER || (real && kind == H5T_FLOAT)) &&
                    H5Sget_simple_extent_npoints(space.id()) == 1;
  check<InputError>(fits, path, name, real ? "must be a number" : "must be an integer");
  check<InputError>(H5Aread(attribute.id(), type, value) >= 0, path, name, hdf5::kDamaged);
}

}  // namespace

std::int64_t Hdf5Reader::read_integer_attribute(const std::string& object,
                                                const std::string& key) const {
  std::int64_t value = 0;
  read_number(path_, file_.id(), object, key, false, H5T_NATIVE_INT64, &value);
  return value;
}

double Hdf5Reader::read_number_attribute(const std::string& object, const std::string& key) const {
  double value = 0.0;
  read_number(path_, file_.id(), object, key, true, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::vector<std::string> Hdf5Reader::list_attributes(const std::string& object) const {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  hsize_t start = 0;
  const herr_t status = H5Aiterate_by_name(file_.id(), object.c_str(), H5_INDEX_NAME, H5_ITER_INC,
                                           &start, add, &names, hdf5::get_in_file_access());
  check<InputError>(status >= 0, path_, object, "attributes cannot be read");
  return names;
}

}  // namespace strut
