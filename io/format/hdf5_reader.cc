#include <fmt/format.h>

#include <algorithm>

#include "io/format/hdf5_calls.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using hdf5::check;
using hdf5::checked;
using hdf5::kDamaged;

/// Stands for a text of variable length, which the library cannot read safely (get_text_length).
constexpr char kVariableText[] = "(a text of variable length)";
constexpr char kDataMissing[] = "damaged: data missing";

std::string first_or_empty(const std::vector<std::string>& texts) {
  return texts.empty() ? "" : texts.front();
}

Hdf5Label get_label(const fs::path& path, const std::string& name, hid_t dataset) {
  const auto read = [&](const char* key) {
    // Other programs label their datasets, too.
    if (hdf5::has_variable_text(dataset, key)) return std::vector<std::string>{kVariableText};
    return hdf5::read_texts_of(path, dataset, name, key);
  };
  return {first_or_empty(read("unit")), first_or_empty(read("description")), read("names"),
          read("units"), read("descriptions")};
}

std::vector<std::size_t> get_shape(const fs::path& path, const std::string& name, hid_t dataset) {
  const Hdf5Handle space =
      checked<InputError>(H5Dget_space(dataset), H5Sclose, path, name, "shape cannot be read");
  const int rank = H5Sget_simple_extent_ndims(space.id());
  check<InputError>(rank == 1 || rank == 2, path, name, "must have one or two dimensions");
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  check<InputError>(H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr) == rank, path,
                    name, "shape cannot be read");
  return {sizes.begin(), sizes.end()};
}

// Returns the number of elements of a dataset. A damaged header may claim any number; the stored
// bytes bound what is plausible. Deflate packs at most 1032 to 1.
std::size_t count_elements(const fs::path& path, const std::string& name, hid_t dataset,
                           const std::vector<std::size_t>& shape) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 48;
  const Hdf5Handle creation =
      checked<InputError>(H5Dget_create_plist(dataset), H5Pclose, path, name, kDamaged);
  const Hdf5Handle type = checked<InputError>(H5Dget_type(dataset), H5Tclose, path, name, kDamaged);
  const std::size_t element = H5Tget_size(type.id());
  check<InputError>(element > 0, path, name, kDamaged);
  std::size_t bytes = element;
  for (const std::size_t size : shape) {
    check<InputError>(size == 0 || bytes <= kMaxBytes / size, path, name, kDataMissing);
    bytes *= size;
  }
  const std::size_t max_packing = H5Pget_nfilters(creation.id()) == 0 ? 1 : 1040;
  const bool present = H5Dget_storage_size(dataset) >= bytes / max_packing;
  check<InputError>(present, path, name, kDataMissing);
  return bytes / element;
}

void require_class(const fs::path& path, const std::string& name, hid_t dataset, bool integer,
                   bool real) {
  const Hdf5Handle type = checked<InputError>(H5Dget_type(dataset), H5Tclose, path, name, kDamaged);
  const H5T_class_t kind = H5Tget_class(type.id());
  check<InputError>((integer && kind == H5T_INTEGER) || (real && kind == H5T_FLOAT), path, name,
                    real ? "must hold numbers" : "must hold integers");
}

struct RowRange {
  std::size_t first = 0, count = 0;
};

// Selects whole rows of a dataset of `shape`.
Hdf5Handle select_rows(const fs::path& path, const std::string& name,
                       const std::vector<std::size_t>& shape, const RowRange& range) {
  const std::string what = "rows cannot be selected";
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  Hdf5Handle space =
      checked<InputError>(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                          H5Sclose, path, name, what);
  std::vector<hsize_t> start(shape.size(), 0);
  std::vector<hsize_t> block = sizes;
  start.front() = range.first;
  block.front() = range.count;
  check<InputError>(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr,
                                        block.data(), nullptr) >= 0,
                    path, name, what);
  return space;
}

template <class T>
std::vector<T> read_range(const fs::path& path, const std::string& name, hid_t dataset,
                          const RowRange& range) {
  std::vector<std::size_t> shape = get_shape(path, name, dataset);
  const std::size_t total = count_elements(path, name, dataset, shape);
  const bool inside =
      range.count > 0 && range.first <= shape.front() && range.count <= shape.front() - range.first;
  check<InputError>(inside, path, name,
                    fmt::format("has {} rows; rows {} to {} were requested", shape.front(),
                                range.first, range.first + range.count));
  const Hdf5Handle stored = select_rows(path, name, shape, range);
  std::vector<T> values(total / shape.front() * range.count);
  shape.front() = range.count;
  const Hdf5Handle memory = select_rows(path, name, shape, {0, range.count});
  const hid_t type = hdf5_type<T> == Hdf5Type::kDouble ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  check<InputError>(
      H5Dread(dataset, type, memory.id(), stored.id(), H5P_DEFAULT, values.data()) >= 0, path, name,
      kDamaged);
  return values;
}

}  // namespace

Hdf5Reader::Hdf5Reader(const fs::path& path) : path_(path) {
  hdf5::prepare_library();
  open_regular_file(path);  // the library would wait for the other end of a pipe
  check<InputError>(H5Fis_hdf5(path.c_str()) > 0, path, "", "not an HDF5 file");
  file_ = checked<InputError>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path,
                              "", "damaged or not readable");
}

Hdf5Reader::Hdf5Reader(const fs::path& path, std::span<const std::byte> image) : path_(path) {
  hdf5::prepare_library();
  const Hdf5Handle access =
      checked<InputError>(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path, "", kNotRead);
  // The library copies the image, though it takes a pointer that is not const.
  const bool good =
      H5Pset_fapl_core(access.id(), image.size(), false) >= 0 &&
      H5Pset_file_image(access.id(), const_cast<std::byte*>(image.data()), image.size()) >= 0;
  check<InputError>(good, path, "", kNotRead);
  file_ =
      checked<InputError>(H5Fopen(hdf5::make_memory_name().c_str(), H5F_ACC_RDONLY, access.id()),
                          H5Fclose, path, "", "damaged, or not an HDF5 file");
}

Hdf5Reader::Hdf5Reader(const fs::path& path, const SealKind& kind)
    : Hdf5Reader(is_sealed(path) ? Hdf5Reader(path, read_sealed(path, kind).bytes)
                                 : open_unsealed(path)) {}

Hdf5Reader Hdf5Reader::open_unsealed(const fs::path& path) {
  refuse_global_heap(path);
  return Hdf5Reader(path);
}

bool Hdf5Reader::has(const std::string& name) const {
  // H5Lexists requires that every group on the way exists.
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    if (H5Lexists(file_.id(), name.substr(0, slash).c_str(), hdf5::get_in_file_access()) <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
    if (slash == std::string::npos) return true;
  }
}

Hdf5Kind Hdf5Reader::find_kind(const std::string& name) const {
  if (!has(name)) return Hdf5Kind::kOther;  // a link to nowhere
  const Hdf5Handle object =
      checked<InputError>(H5Oopen(file_.id(), name.c_str(), hdf5::get_in_file_access()), H5Oclose,
                          path_, name, kDamaged);
  const H5I_type_t kind = H5Iget_type(object.id());
  if (kind == H5I_GROUP) return Hdf5Kind::kGroup;
  if (kind != H5I_DATASET) return Hdf5Kind::kOther;
  const Hdf5Handle type =
      checked<InputError>(H5Dget_type(object.id()), H5Tclose, path_, name, kDamaged);
  const Hdf5Handle space =
      checked<InputError>(H5Dget_space(object.id()), H5Sclose, path_, name, kDamaged);
  const H5T_class_t element = H5Tget_class(type.id());
  const int rank = H5Sget_simple_extent_ndims(space.id());
  const bool is_number = element == H5T_INTEGER || element == H5T_FLOAT;
  return is_number && (rank == 1 || rank == 2) ? Hdf5Kind::kNumbers : Hdf5Kind::kOther;
}

Hdf5Handle Hdf5Reader::open_dataset(const std::string& name) const {
  check<InputError>(has(name), path_, name, "no such dataset");
  Hdf5Handle dataset =
      checked<InputError>(H5Dopen2(file_.id(), name.c_str(), hdf5::get_in_file_access()), H5Dclose,
                          path_, name, "not a dataset of this file");
  const Hdf5Handle creation =
      checked<InputError>(H5Dget_create_plist(dataset.id()), H5Pclose, path_, name, kDamaged);
  const bool lies_elsewhere =
      H5Pget_layout(creation.id()) == H5D_VIRTUAL || H5Pget_external_count(creation.id()) > 0;
  check<InputError>(!lies_elsewhere, path_, name, kViewFault);
  return dataset;
}

Hdf5Dataset Hdf5Reader::read(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  Hdf5Dataset data;
  data.shape = get_shape(path_, name, dataset.id());
  require_class(path_, name, dataset.id(), true, true);
  data.values.resize(count_elements(path_, name, dataset.id(), data.shape));
  check<InputError>(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                            data.values.data()) >= 0,
                    path_, name, kDamaged);
  data.label = get_label(path_, name, dataset.id());
  return data;
}

Hdf5Dataset Hdf5Reader::read_rows(const std::string& name, std::size_t first,
                                  std::size_t count) const {
  const Hdf5Handle dataset = open_dataset(name);
  require_class(path_, name, dataset.id(), true, true);
  Hdf5Dataset data;
  data.values = read_range<double>(path_, name, dataset.id(), {first, count});
  data.shape = get_shape(path_, name, dataset.id());
  data.shape.front() = count;
  data.label = get_label(path_, name, dataset.id());
  return data;
}

std::vector<std::int64_t> Hdf5Reader::read_integer_rows(const std::string& name, std::size_t first,
                                                        std::size_t count) const {
  const Hdf5Handle dataset = open_dataset(name);
  require_class(path_, name, dataset.id(), true, false);
  return read_range<std::int64_t>(path_, name, dataset.id(), {first, count});
}

std::vector<std::int64_t> Hdf5Reader::read_integers(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  require_class(path_, name, dataset.id(), true, false);
  const auto shape = get_shape(path_, name, dataset.id());
  std::vector<std::int64_t> values(count_elements(path_, name, dataset.id(), shape));
  check<InputError>(
      H5Dread(dataset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
      path_, name, kDamaged);
  return values;
}

std::size_t Hdf5Reader::read_text_length(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle stored =
      checked<InputError>(H5Dget_type(dataset.id()), H5Tclose, path_, name, kDamaged);
  return hdf5::get_text_length(path_, name, stored.id());
}

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name) const {
  const std::size_t length = read_text_length(name);
  const Hdf5Handle dataset = open_dataset(name);
  const std::size_t count =
      count_elements(path_, name, dataset.id(), get_shape(path_, name, dataset.id()));
  const Hdf5Handle type = hdf5::make_type(path_, Hdf5Type::kText, length);
  std::vector<char> raw(count * length);
  check<InputError>(
      H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data()) >= 0, path_, name,
      kDamaged);
  return hdf5::unpack_texts(raw, length);
}

Hdf5Label Hdf5Reader::read_label(const std::string& name) const {
  return get_label(path_, name, open_dataset(name).id());
}

std::vector<std::size_t> Hdf5Reader::read_shape(const std::string& name) const {
  return get_shape(path_, name, open_dataset(name).id());
}

std::size_t Hdf5Reader::read_chunk_rows(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  const auto shape = get_shape(path_, name, dataset.id());
  const Hdf5Handle creation =
      checked<InputError>(H5Dget_create_plist(dataset.id()), H5Pclose, path_, name, kDamaged);
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED) return shape.front();
  std::vector<hsize_t> sizes(shape.size());
  check<InputError>(H5Pget_chunk(creation.id(), static_cast<int>(sizes.size()), sizes.data()) >= 0,
                    path_, name, kDamaged);
  return sizes.front();
}

std::vector<std::string> Hdf5Reader::list(const std::string& group) const {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  const herr_t status = H5Literate_by_name(file_.id(), group.c_str(), H5_INDEX_NAME, H5_ITER_INC,
                                           nullptr, add, &names, hdf5::get_in_file_access());
  check<InputError>(status >= 0, path_, group, "no such group");
  return names;
}

}  // namespace strut
