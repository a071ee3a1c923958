#include "io/format/hdf5.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/error/check.h"
#include "io/format/hdf5_calls.h"

namespace strut {

namespace fs = std::filesystem;
using hdf5::check;
using hdf5::checked;

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

std::size_t get_element_size(Hdf5Type type, std::size_t text_length) {
  if (type == Hdf5Type::kText) return text_length;
  return type == Hdf5Type::kInt32 ? 4 : 8;
}

PackedTexts pack_texts(std::span<const std::string> texts, std::size_t min_length) {
  PackedTexts packed{.length = min_length, .bytes = {}};
  for (const std::string& text : texts) packed.length = std::max(packed.length, text.size());
  packed.bytes.resize(texts.size() * packed.length);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    std::memcpy(packed.bytes.data() + i * packed.length, texts[i].data(), texts[i].size());
  }
  return packed;
}

// Memory of a file of the core driver. The bytes are complete only once the file is closed, which
// passes them to `release` (H5Fget_file_image of 1.10.8 omits the user block, and clears flags in
// the superblock without updating its checksum).
struct Hdf5Writer::Memory {
  void* data = nullptr;
  std::size_t size = 0;
  bool closed = false;

  Memory() = default;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() {
    if (closed) std::free(data);
  }

  static void* allocate(std::size_t size, H5FD_file_image_op_t, void* self) {
    return resize(nullptr, size, H5FD_FILE_IMAGE_OP_NO_OP, self);
  }
  static void* copy(void* to, const void* from, std::size_t size, H5FD_file_image_op_t, void*) {
    return std::memcpy(to, from, size);
  }
  static void* resize(void* data, std::size_t size, H5FD_file_image_op_t, void* self) {
    auto& memory = *static_cast<Memory*>(self);
    void* const grown = std::realloc(data, size);
    if (grown != nullptr) memory.data = grown, memory.size = size;
    return grown;
  }
  static herr_t release(void* data, H5FD_file_image_op_t, void* self) {
    auto& memory = *static_cast<Memory*>(self);
    memory.data = data;
    memory.closed = true;
    return 0;
  }
  static void* share(void* self) { return self; }
  static herr_t unshare(void*) { return 0; }
};

namespace {

constexpr std::size_t kMemoryIncrement = std::size_t{1} << 18;

// Reads the size of the file from its superblock (version 3); memory after it is unused.
std::uint64_t read_end_of_file(const std::byte* superblock) {
  constexpr std::size_t kEndOfFile = 28;
  std::uint64_t end = 0;
  std::memcpy(&end, superblock + kEndOfFile, sizeof end);
  return end;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const fs::path& path, const Hdf5WriterOptions& options) {
  target_.emplace(path);
  sink_.shown = path;
  open(options);
}

Hdf5Writer::Hdf5Writer(const Folder& folder, const std::string& name,
                       const Hdf5WriterOptions& options) {
  target_.emplace(folder, name);
  sink_.shown = folder.path_of(name);
  open(options);
}

Hdf5Writer::Hdf5Writer(const Hdf5InMemory& memory, const Hdf5WriterOptions& options) {
  sink_.shown = memory.name;
  open(options);
}

Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::open(const Hdf5WriterOptions& options) {
  hdf5::prepare_library();
  memory_ = std::make_unique<Memory>();
  H5FD_file_image_callbacks_t callbacks = {Memory::allocate, Memory::copy,  Memory::resize,
                                           Memory::release,  Memory::share, Memory::unshare,
                                           memory_.get()};
  const Hdf5Handle access = hdf5::make_file_access(sink_.shown);
  const bool good = H5Pset_fapl_core(access.id(), kMemoryIncrement, false) >= 0 &&
                    H5Pset_file_image_callbacks(access.id(), &callbacks) >= 0;
  check<EnvironmentError>(good, sink_.shown, "", kNotWritten);
  seal_ = options.seal;
  const Hdf5Handle creation = hdf5::make_file_creation(sink_.shown, has_user_block());
  sink_.file = checked<EnvironmentError>(
      H5Fcreate(hdf5::make_memory_name().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()),
      H5Fclose, sink_.shown, "", kNotWritten);
}

void Hdf5Writer::write(const std::string& name, std::span<const double> values,
                       const Hdf5Label& label) {
  hdf5::write_dataset(sink_, name, Hdf5Type::kDouble, 0, {values.size()}, values.data(), label);
}

void Hdf5Writer::write(const std::string& name, std::span<const std::int32_t> values,
                       const Hdf5Label& label) {
  hdf5::write_dataset(sink_, name, Hdf5Type::kInt32, 0, {values.size()}, values.data(), label);
}

void Hdf5Writer::write(const std::string& name, std::span<const std::int64_t> values,
                       const Hdf5Label& label) {
  hdf5::write_dataset(sink_, name, Hdf5Type::kInt64, 0, {values.size()}, values.data(), label);
}

void Hdf5Writer::write(const std::string& name, const std::vector<std::string>& values,
                       const Hdf5Label& label) {
  const PackedTexts texts = pack_texts(values);
  hdf5::write_dataset(sink_, name, Hdf5Type::kText, texts.length, {values.size()},
                      texts.bytes.data(), label);
}

void Hdf5Writer::write(const std::string& name, std::span<const double> values, std::size_t columns,
                       const Hdf5Label& label) {
  const bool fits = columns > 0 && values.size() % columns == 0;
  const bool named = label.names.empty() || label.names.size() == columns;
  STRUT_CHECK(fits && named, name + ": values, columns and names do not fit each other");
  hdf5::write_dataset(sink_, name, Hdf5Type::kDouble, 0, {values.size() / columns, columns},
                      values.data(), label);
}

void Hdf5Writer::write_chunks(const Hdf5Chunks& d) {
  const Hdf5Handle creation = hdf5::make_dataset_creation(sink_, d.name, d.type, d.text_length);
  hdf5::set_chunks(sink_, d.name, creation.id(), d.shape, d.chunk_rows);
  Hdf5Handle dataset =
      hdf5::create_dataset(sink_, d.name, d.type, d.text_length, d.shape, creation.id(), d.label);
  for (std::size_t i = 0; i < d.chunks.size(); ++i) {
    hdf5::write_chunk(sink_, d.name, dataset.id(), d.shape.size(), i * d.chunk_rows, d.chunks[i]);
  }
  hdf5::close_dataset(sink_, d.name, dataset);
}

void Hdf5Writer::write_attribute(const std::string& object, const std::string& key,
                                 const std::string& value) {
  hdf5::write_text_attribute(sink_, object, key, {value}, true);
}

void Hdf5Writer::write_attribute_list(const std::string& object, const std::string& key,
                                      const std::vector<std::string>& values) {
  hdf5::write_text_attribute(sink_, object, key, values, false);
}

void Hdf5Writer::write_attribute(const std::string& object, const std::string& key,
                                 std::int64_t value) {
  hdf5::write_number_attribute(sink_, object, key, H5T_NATIVE_INT64, &value);
}

void Hdf5Writer::write_attribute(const std::string& object, const std::string& key, double value) {
  hdf5::write_number_attribute(sink_, object, key, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5Writer::attach_scale(const std::string& scale, unsigned dimension,
                              const std::vector<std::string>& datasets) {
  hdf5::attach_scale(sink_, scale, dimension, datasets);
}

std::vector<std::byte> Hdf5Writer::image() {
  const bool good = H5Fflush(sink_.file.id(), H5F_SCOPE_GLOBAL) >= 0 && sink_.file.reset();
  check<EnvironmentError>(good && memory_->closed, sink_.shown, "", kNotWritten);
  const auto* const begin = static_cast<const std::byte*>(memory_->data);
  const std::uint64_t end = read_end_of_file(begin + (has_user_block() ? kSealBytes : 0));
  STRUT_CHECK(end <= memory_->size, "an HDF5 file ends beyond its memory");
  std::vector<std::byte> bytes(begin, begin + end);
  memory_.reset();
  if (seal_) seal_image(*seal_, bytes);
  return bytes;
}

void Hdf5Writer::commit() {
  STRUT_CHECK(target_, "a file in memory has no path to be written to");
  target_->write(image());
  target_->commit();
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

}  // namespace strut
