// A long table of numbers, held in memory up to a limit and in a scratch file beyond it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "io/file/file_sync.h"

namespace strut {

struct RowStoreOptions {
  /// Bytes held in memory before rows go to the scratch file.
  std::size_t memory = std::size_t{32} << 20;
  /// Folder of the scratch file, which has no name and vanishes with the process; empty: the
  /// system's folder for temporary files.
  std::filesystem::path scratch;
};

/// Rows that are appended once and read often. Failures of the scratch file are EnvironmentError.
class RowStore {
 public:
  explicit RowStore(std::size_t columns, RowStoreOptions options = {});

  std::size_t columns() const { return columns_; }
  std::size_t row_count() const { return row_count_; }
  bool in_memory() const { return !file_.is_open(); }

  /// Appends whole rows; rows.size() must be a multiple of `columns`.
  void append(std::span<const double> rows);
  /// Copies rows [first, first + count), which must exist, to `rows`.
  void read(std::size_t first, std::size_t count, double* rows) const;

 private:
  void open_file();
  void spill();

  std::size_t columns_;
  RowStoreOptions options_;
  std::size_t row_count_ = 0;
  std::size_t spilled_ = 0;     // rows in the scratch file
  std::vector<double> recent_;  // the rows after those
  FileDescriptor file_;
};

/// Calls use(rows, first row, row count) for all rows of a store, at most `piece_rows` at a time.
template <class F>
void for_each_piece(const RowStore& store, const F& use, std::size_t piece_rows = 4096) {
  std::vector<double> rows;
  for (std::size_t first = 0; first < store.row_count(); first += piece_rows) {
    const std::size_t count = std::min(piece_rows, store.row_count() - first);
    rows.resize(count * store.columns());
    store.read(first, count, rows.data());
    use(std::span<const double>(rows), first, count);
  }
}

}  // namespace strut
