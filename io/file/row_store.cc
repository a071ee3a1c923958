#include "io/file/row_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/error/check.h"
#include "base/error/input_error.h"

namespace strut {
namespace {

/// Bytes of rows collected in memory between writes once the limit is exceeded.
constexpr std::size_t kWriteBytes = std::size_t{1} << 20;
constexpr char kScratchFile[] = "scratch file";

void read_all(int file, std::span<std::byte> bytes, std::size_t at,
              const std::filesystem::path& folder) {
  while (!bytes.empty()) {
    const ssize_t done = ::pread(file, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) throw file_failure(folder, kScratchFile, done < 0 ? errno : EIO);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
    at += static_cast<std::size_t>(done);
  }
}

}  // namespace

RowStore::RowStore(std::size_t columns, RowStoreOptions options)
    : columns_(columns), options_(std::move(options)) {}

void RowStore::open_file() {
  if (options_.scratch.empty()) options_.scratch = std::filesystem::temp_directory_path();
  std::string name = (options_.scratch / "strut-rows-XXXXXX").string();
  file_ = FileDescriptor(::mkostemp(name.data(), O_CLOEXEC));
  if (!file_.is_open()) throw file_failure(options_.scratch, kScratchFile, errno);
  ::unlink(name.c_str());
}

void RowStore::spill() {
  if (!file_.is_open()) open_file();
  write_all(file_.get(), std::as_bytes(std::span(recent_)), options_.scratch);
  spilled_ = row_count_;
  // Not clear(), which would keep the memory.
  recent_ = {};
}

void RowStore::append(std::span<const double> rows) {
  STRUT_CHECK(rows.size() % columns_ == 0, "a row store takes whole rows");
  recent_.insert(recent_.end(), rows.begin(), rows.end());
  row_count_ += rows.size() / columns_;
  const std::size_t limit = file_.is_open() ? kWriteBytes : options_.memory;
  if (recent_.size() * sizeof(double) > limit) spill();
}

void RowStore::read(std::size_t first, std::size_t count, double* rows) const {
  STRUT_CHECK(first <= row_count_ && count <= row_count_ - first, "a row store lacks these rows");
  const std::size_t row = columns_ * sizeof(double);
  const std::size_t from_file = first < spilled_ ? std::min(count, spilled_ - first) : 0;
  if (from_file > 0) {
    read_all(file_.get(), std::as_writable_bytes(std::span(rows, from_file * columns_)),
             first * row, options_.scratch);
  }
  if (from_file == count) return;
  std::copy_n(recent_.data() + (first + from_file - spilled_) * columns_,
              (count - from_file) * columns_, rows + from_file * columns_);
}

}  // namespace strut
