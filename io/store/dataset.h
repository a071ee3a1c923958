// The cases of a sweep, wherever they lie: in its folder, in single shards, in a merged file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/store/shard.h"
#include "io/store/sweep_folder.h"

namespace strut {

struct DatasetOptions {
  bool partial = false;    // take a sweep folder that lacks shards as it is
  bool histories = false;  // read them too; else `history` of rows is empty
};

/// Rows in the order in which the plan runs them, read piece by piece: a piece is a shard, or some
/// thousand rows of a merged file, and the only one in memory.
class Dataset {
 public:
  /// `paths`: one sweep folder, or one merged file, or shards, which are put in the order of their
  /// numbers. A folder's retries are applied; a shard alone is as it is. Checks every byte of every
  /// file (of a merged file without a seal: every number), and that no case is there twice; of a
  /// folder that its shards hold the plan's cases and bear their own numbers. Throws InputError
  /// that names the file where one is damaged, of another plan or with other columns than the
  /// first, given twice, or missing.
  explicit Dataset(const std::vector<std::filesystem::path>& paths,
                   const DatasetOptions& options = {});

  const ShardSchema& schema() const { return schema_; }
  const std::string& plan_hash() const { return plan_hash_; }
  std::size_t row_count() const { return row_count_; }

  std::size_t piece_count() const { return pieces_.size(); }
  /// Stays until another piece is read. Of a merged file the rows' reasons are empty. Throws
  /// InputError.
  const ShardRows& read_piece(std::size_t piece);
  /// Rows [first, first + count). Throws InputError where there are fewer.
  ShardRows read(std::size_t first, std::size_t count);

 private:
  struct Piece {
    std::filesystem::path file;
    std::int64_t shard = -1;    // -1: of a merged file
    std::size_t first_row = 0;  // in the dataset; of a merged file in the file too
    std::size_t rows = 0;
  };

  void open_folder(const SweepFolder& folder, bool partial);
  void open_merged(const std::filesystem::path& path, Hdf5Reader file);
  void open_shards(const std::vector<std::filesystem::path>& paths);
  void add_shard(const std::filesystem::path& path);
  void check_merged_digest(const std::filesystem::path& path);
  void refuse_repeated();
  void check_same(const std::filesystem::path& path, const std::string& plan_hash,
                  const ShardSchema& schema);
  void number_rows();
  ShardSchema list_read() const;

  ShardParts parts_;
  ShardSchema schema_;
  std::string plan_hash_;
  std::filesystem::path first_file_;  // whose plan and columns are those of all
  std::size_t row_count_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::int64_t> case_ids_;  // while the dataset is opened
  std::optional<SweepFolder> folder_;
  SweepExtent extent_;  // of the folder
  std::optional<Hdf5Reader> merged_;
  std::size_t held_ = 0;  // piece in rows_
  std::optional<ShardRows> rows_;
};

}  // namespace strut
