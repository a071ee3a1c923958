#include "io/row_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/input_error.h"

namespace strut {
namespace {

/// Rows gather in memory before they are written, also beyond the limit.
constexpr std::size_t kLeastMemory = std::size_t{1} << 20;

[[noreturn]] void fail(const std::filesystem::path& folder, int error) {
  throw EnvironmentError(folder.string() + ": scratch file: " + std::strerror(error));
}

void write_all(int file, const std::byte* data, std::size_t bytes, std::size_t at,
               const std::filesystem::path& folder) {
  while (bytes > 0) {
    const ssize_t done = ::pwrite(file, data, bytes, static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail(folder, done < 0 ? errno : EIO);
    const auto count = static_cast<std::size_t>(done);
    data += count, bytes -= count, at += count;
  }
}

void read_all(int file, std::byte* data, std::size_t bytes, std::size_t at,
              const std::filesystem::path& folder) {
  while (bytes > 0) {
    const ssize_t done = ::pread(file, data, bytes, static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail(folder, done < 0 ? errno : EIO);
    const auto count = static_cast<std::size_t>(done);
    data += count, bytes -= count, at += count;
  }
}

}  // namespace

RowStore::RowStore(std::size_t columns, RowStoreOptions options)
    : columns_(columns), options_(std::move(options)) {}

RowStore::~RowStore() {
  if (file_ >= 0) ::close(file_);
}

RowStore::RowStore(RowStore&& other) noexcept : columns_(0) { *this = std::move(other); }

RowStore& RowStore::operator=(RowStore&& other) noexcept {
  std::swap(columns_, other.columns_);
  std::swap(options_, other.options_);
  std::swap(row_count_, other.row_count_);
  std::swap(filed_, other.filed_);
  std::swap(recent_, other.recent_);
  std::swap(file_, other.file_);
  return *this;
}

void RowStore::open_file() {
  if (options_.scratch.empty()) options_.scratch = std::filesystem::temp_directory_path();
  std::string name = (options_.scratch / "strut-rows-XXXXXX").string();
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) fail(options_.scratch, errno);
  ::unlink(name.c_str());
}

void RowStore::spill() {
  if (file_ < 0) open_file();
  const std::size_t row = columns_ * sizeof(double);
  const auto bytes = std::as_bytes(std::span(recent_));
  write_all(file_, bytes.data(), bytes.size(), filed_ * row, options_.scratch);
  filed_ = row_count_;
  // Not clear(): what was held up to the limit is given back.
  recent_ = {};
}

void RowStore::append(std::span<const double> rows) {
  if (rows.size() % columns_ != 0) throw std::logic_error("a row store takes whole rows");
  recent_.insert(recent_.end(), rows.begin(), rows.end());
  row_count_ += rows.size() / columns_;
  const std::size_t limit = file_ < 0 ? options_.memory : kLeastMemory;
  if (recent_.size() * sizeof(double) > limit) spill();
}

void RowStore::read(std::size_t first, std::size_t count, double* rows) const {
  if (first > row_count_ || count > row_count_ - first) {
    throw std::logic_error("a row store has no such rows");
  }
  const std::size_t row = columns_ * sizeof(double);
  const std::size_t filed = first < filed_ ? std::min(count, filed_ - first) : 0;
  if (filed > 0) {
    read_all(file_, reinterpret_cast<std::byte*>(rows), filed * row, first * row, options_.scratch);
  }
  if (filed == count) return;
  std::copy_n(recent_.data() + (first + filed - filed_) * columns_, (count - filed) * columns_,
              rows + filed * columns_);
}

}  // namespace strut
