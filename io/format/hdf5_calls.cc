#include "io/format/hdf5_calls.h"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <atomic>
#include <charconv>
#include <limits>
#include <string_view>

#include "io/file/compress.h"
#include "io/file/file_sync.h"

namespace strut::hdf5 {
namespace {

namespace fs = std::filesystem;

constexpr char kDatasetNotWritten[] = "dataset cannot be written";

/// Returns "PATH: OBJECT: WHAT"; `object` may be empty.
std::string describe_failure(const fs::path& path, const std::string& object,
                             const std::string& what) {
  return object.empty() ? fmt::format("{}: {}", path.string(), what)
                        : fmt::format("{}: {}: {}", path.string(), object, what);
}

void write_label(const fs::path& path, hid_t dataset, const std::string& name,
                 const Hdf5Label& label) {
  write_texts(path, dataset, name, "unit", {label.unit}, true);
  write_texts(path, dataset, name, "description", {label.description}, true);
  const auto write_list = [&](const char* key, const std::vector<std::string>& texts) {
    if (!texts.empty()) write_texts(path, dataset, name, key, texts, false);
  };
  write_list("names", label.names);
  write_list("units", label.units);
  write_list("descriptions", label.descriptions);
}

// The library would give groups that it makes itself a time.
void make_groups(const Hdf5Sink& sink, const std::string& name) {
  const std::string what = "group cannot be made";
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos;
       slash = name.find('/', slash + 1)) {
    const std::string group = name.substr(0, slash);
    if (H5Lexists(sink.file.id(), group.c_str(), H5P_DEFAULT) > 0) continue;
    const Hdf5Handle creation =
        checked<EnvironmentError>(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, sink.shown, group, what);
    check<EnvironmentError>(H5Pset_obj_track_times(creation.id(), false) >= 0, sink.shown, group,
                            what);
    checked<EnvironmentError>(
        H5Gcreate2(sink.file.id(), group.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
        H5Gclose, sink.shown, group, what);
  }
}

Hdf5Handle make_space(const Hdf5Sink& sink, const std::string& name,
                      const std::vector<std::size_t>& shape) {
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  return checked<EnvironmentError>(
      H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose, sink.shown,
      name, kDatasetNotWritten);
}

}  // namespace

// Errors become exceptions, so the library must not print them. It must not clean up at exit
// either: every handle is closed here, and a file that could not be flushed to a full disk would
// crash 1.10.8 there.
void prepare_library() {
  static const bool no_cleanup = H5dont_atexit() >= 0;
  static_cast<void>(no_cleanup);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// The deepest entry of the library's error stack holds the cause.
void fail_to_read(const fs::path& path, const std::string& object, const std::string& what) {
  std::string cause;
  const auto keep_first = [](unsigned, const H5E_error2_t* entry, void* out) -> herr_t {
    auto& message = *static_cast<std::string*>(out);
    if (message.empty() && entry->desc != nullptr) message = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &cause);
  H5Eclear2(H5E_DEFAULT);
  std::erase(cause, '\n');  // some entries contain the time and a line end
  if (!cause.empty()) cause = fmt::format(" ({})", cause);
  throw InputError(describe_failure(path, object, what) + cause);
}

void fail_to_write(const fs::path& path, const std::string& object, const std::string& what) {
  int error_number = 0;
  const auto keep_first = [](unsigned, const H5E_error2_t* entry, void* out) -> herr_t {
    constexpr std::string_view kMark = "errno = ";
    const std::string_view text = entry->desc == nullptr ? "" : entry->desc;
    const std::size_t mark = text.find(kMark);
    auto& number = *static_cast<int*>(out);
    if (number == 0 && mark != std::string_view::npos) {
      std::from_chars(text.data() + mark + kMark.size(), text.data() + text.size(), number);
    }
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &error_number);
  H5Eclear2(H5E_DEFAULT);
  if (error_number != 0) throw file_failure(path, kNotWritten, error_number);
  throw EnvironmentError(describe_failure(path, object, what));
}

Hdf5Handle make_type(const fs::path& path, Hdf5Type type, std::size_t text_length) {
  const auto copy = [&path](hid_t of) {
    return checked<EnvironmentError>(H5Tcopy(of), H5Tclose, path, "", "data type cannot be made");
  };
  if (type == Hdf5Type::kDouble) return copy(H5T_NATIVE_DOUBLE);
  if (type == Hdf5Type::kInt32) return copy(H5T_NATIVE_INT32);
  if (type == Hdf5Type::kInt64) return copy(H5T_NATIVE_INT64);
  Hdf5Handle text = copy(H5T_C_S1);
  const bool good = H5Tset_size(text.id(), text_length) >= 0 &&
                    H5Tset_cset(text.id(), H5T_CSET_UTF8) >= 0 &&
                    H5Tset_strpad(text.id(), H5T_STR_NULLPAD) >= 0;
  check<EnvironmentError>(good, path, "", "data type cannot be made");
  return text;
}

hid_t get_in_file_access() {
  static const hid_t access = [] {
    const hid_t list = H5Pcreate(H5P_DATASET_ACCESS);
    const auto refuse = [](const char*, const char*, const char*, const char*, unsigned*, hid_t,
                           void*) -> herr_t { return -1; };
    H5Pset_elink_cb(list, refuse, nullptr);
    return list;
  }();
  return access;
}

Hdf5Handle make_file_access(const fs::path& path) {
  Hdf5Handle access =
      checked<EnvironmentError>(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path, "", kNotWritten);
  check<EnvironmentError>(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0,
                          path, "", kNotWritten);
  return access;
}

Hdf5Handle make_file_creation(const fs::path& path, bool user_block) {
  Hdf5Handle creation =
      checked<EnvironmentError>(H5Pcreate(H5P_FILE_CREATE), H5Pclose, path, "", kNotWritten);
  const bool good = H5Pset_obj_track_times(creation.id(), false) >= 0 &&
                    H5Pset_userblock(creation.id(), user_block ? kSealBytes : 0) >= 0;
  check<EnvironmentError>(good, path, "", kNotWritten);
  return creation;
}

Hdf5Handle make_dataset_creation(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                                 std::size_t text_length) {
  const std::string what = kDatasetNotWritten;
  Hdf5Handle creation =
      checked<EnvironmentError>(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, sink.shown, name, what);
  bool good = H5Pset_obj_track_times(creation.id(), false) >= 0;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::int64_t none = -1;
  if (type == Hdf5Type::kDouble) {
    good = good && H5Pset_fill_value(creation.id(), H5T_NATIVE_DOUBLE, &nan) >= 0;
  } else if (type != Hdf5Type::kText) {
    good = good && H5Pset_fill_value(creation.id(), H5T_NATIVE_INT64, &none) >= 0;
  } else {
    const Hdf5Handle text = make_type(sink.shown, type, text_length);
    const std::string empty(text_length, '\0');
    good = good && H5Pset_fill_value(creation.id(), text.id(), empty.data()) >= 0;
  }
  check<EnvironmentError>(good, sink.shown, name, what);
  return creation;
}

void set_chunks(const Hdf5Sink& sink, const std::string& name, hid_t creation,
                const std::vector<std::size_t>& shape, std::size_t chunk_rows) {
  std::vector<hsize_t> sizes(shape.begin(), shape.end());
  sizes.front() = chunk_rows;
  // The level only informs readers, who do not need it.
  const bool good = H5Pset_chunk(creation, static_cast<int>(sizes.size()), sizes.data()) >= 0 &&
                    H5Pset_shuffle(creation) >= 0 && H5Pset_deflate(creation, kDeflateLevel) >= 0 &&
                    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER) >= 0;
  check<EnvironmentError>(good, sink.shown, name, kDatasetNotWritten);
}

Hdf5Handle create_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                          std::size_t text_length, const std::vector<std::size_t>& shape,
                          hid_t creation, const Hdf5Label& label) {
  make_groups(sink, name);
  const Hdf5Handle space = make_space(sink, name, shape);
  const Hdf5Handle element = make_type(sink.shown, type, text_length);
  Hdf5Handle dataset =
      checked<EnvironmentError>(H5Dcreate2(sink.file.id(), name.c_str(), element.id(), space.id(),
                                           H5P_DEFAULT, creation, H5P_DEFAULT),
                                H5Dclose, sink.shown, name, kDatasetNotWritten);
  write_label(sink.shown, dataset.id(), name, label);
  return dataset;
}

void write_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                   std::size_t text_length, const std::vector<std::size_t>& shape,
                   const void* values, const Hdf5Label& label) {
  const Hdf5Handle creation = make_dataset_creation(sink, name, type, text_length);
  Hdf5Handle dataset = create_dataset(sink, name, type, text_length, shape, creation.id(), label);
  const Hdf5Handle element = make_type(sink.shown, type, text_length);
  check<EnvironmentError>(
      H5Dwrite(dataset.id(), element.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, sink.shown,
      name, kDatasetNotWritten);
  close_dataset(sink, name, dataset);
}

void write_chunk(const Hdf5Sink& sink, const std::string& name, hid_t dataset, std::size_t rank,
                 std::size_t first_row, std::span<const std::byte> bytes) {
  std::vector<hsize_t> offset(rank, 0);
  offset.front() = first_row;
  check<EnvironmentError>(
      H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset.data(), bytes.size(), bytes.data()) >= 0,
      sink.shown, name, "chunk cannot be written; disk full?");
}

void close_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Handle& dataset) {
  check<EnvironmentError>(dataset.reset(), sink.shown, name,
                          "dataset cannot be written; disk full?");
}

void write_variable_texts(const Hdf5Sink& sink, const std::string& name,
                          const std::vector<std::string>& texts, const Hdf5Label& label) {
  const Hdf5Handle type = make_type(sink.shown, Hdf5Type::kText, H5T_VARIABLE);
  const Hdf5Handle creation = checked<EnvironmentError>(H5Pcreate(H5P_DATASET_CREATE), H5Pclose,
                                                        sink.shown, name, kDatasetNotWritten);
  check<EnvironmentError>(H5Pset_obj_track_times(creation.id(), false) >= 0, sink.shown, name,
                          kDatasetNotWritten);
  Hdf5Handle dataset = create_dataset(sink, name, Hdf5Type::kText, H5T_VARIABLE, {texts.size()},
                                      creation.id(), label);
  std::vector<const char*> pointers;
  pointers.reserve(texts.size());
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  check<EnvironmentError>(
      H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) >= 0,
      sink.shown, name, kDatasetNotWritten);
  close_dataset(sink, name, dataset);
}

void create_dimension(const Hdf5Sink& sink, const std::string& name, std::size_t size) {
  const Hdf5Handle space = make_space(sink, name, {size});
  const Hdf5Handle creation = make_dataset_creation(sink, name, Hdf5Type::kInt32, 0);
  Hdf5Handle dataset =
      checked<EnvironmentError>(H5Dcreate2(sink.file.id(), name.c_str(), H5T_NATIVE_INT32,
                                           space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                                H5Dclose, sink.shown, name, kDatasetNotWritten);
  // The words by which netCDF knows it.
  constexpr char kNoVariable[] = "This is a netCDF dimension but not a netCDF variable.";
  check<EnvironmentError>(
      H5DSset_scale(dataset.id(), fmt::format("{}{:10}", kNoVariable, size).c_str()) >= 0,
      sink.shown, name, kDatasetNotWritten);
  close_dataset(sink, name, dataset);
}

void attach_scale(const Hdf5Sink& sink, const std::string& scale, unsigned dimension,
                  const std::vector<std::string>& datasets) {
  const auto open = [&](const std::string& name) {
    return checked<EnvironmentError>(H5Dopen2(sink.file.id(), name.c_str(), H5P_DEFAULT), H5Dclose,
                                     sink.shown, name, kDatasetNotWritten);
  };
  const Hdf5Handle axis = open(scale);
  const std::string name = scale.substr(scale.rfind('/') + 1);
  const bool is_new = H5DSis_scale(axis.id()) == 0;
  check<EnvironmentError>(!is_new || H5DSset_scale(axis.id(), name.c_str()) >= 0, sink.shown, scale,
                          kDatasetNotWritten);
  for (const std::string& dataset : datasets) {
    const Hdf5Handle handle = open(dataset);
    check<EnvironmentError>(H5DSattach_scale(handle.id(), axis.id(), dimension) >= 0, sink.shown,
                            dataset, kDatasetNotWritten);
  }
}

std::string make_memory_name() {
  static std::atomic<std::uint64_t> count = 0;
  return fmt::format("strut memory {}", count++);
}

}  // namespace strut::hdf5
