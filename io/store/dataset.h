// The cases of a sweep, from its folder, from single shards, or from a merged file.
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
  bool partial = false;    // accept a sweep folder that lacks shards
  bool histories = false;  // read histories too; otherwise `history` of the rows is empty
};

/// Rows in the run order of the plan, read piece by piece: a piece is a shard, or thousands of rows
/// of a merged file. One piece is in memory at a time.
class Dataset {
 public:
  /// `paths`: one sweep folder, or one merged file, or shards, which are sorted by number. Retries
  /// are applied only to the shards of a folder. Verifies every byte of every file (for a merged
  /// file without a seal: every number) and that no case appears twice; for a folder, also that its
  /// shards hold the plan's cases and bear their own numbers. Throws InputError that names the file
  /// if one is damaged, missing, given twice, of another plan, or if its columns differ from those
  /// of the first.
  explicit Dataset(const std::vector<std::filesystem::path>& paths,
                   const DatasetOptions& options = {});

  const ShardSchema& schema() const { return schema_; }
  const std::string& plan_hash() const { return plan_hash_; }
  std::size_t row_count() const { return row_count_; }

  std::size_t piece_count() const { return pieces_.size(); }
  /// Returns a piece, valid until another is read. Rows of a merged file have empty reasons. Throws
  /// InputError.
  const ShardRows& read_piece(std::size_t piece);
  /// Returns rows [first, first + count). Throws InputError if there are fewer.
  ShardRows read(std::size_t first, std::size_t count);

 private:
  struct Piece {
    std::filesystem::path file;
    std::int64_t shard = -1;    // -1: a piece of a merged file
    std::size_t first_row = 0;  // in the dataset, and in a merged file
    std::size_t rows = 0;
  };

  void open(const std::vector<std::filesystem::path>& paths, bool partial);
  void open_folder(const SweepFolder& folder, bool partial);
  void open_sealed_merged(const std::filesystem::path& path);
  void open_unsealed_merged(const std::filesystem::path& path);
  void open_merged(const std::filesystem::path& path, Hdf5Reader file);
  void open_shards(const std::vector<std::filesystem::path>& paths);
  void add_shard(const std::filesystem::path& path);
  void check_merged_digest(const std::filesystem::path& path);
  void refuse_repeated();
  void check_same(const std::filesystem::path& path, const std::string& plan_hash,
                  const ShardSchema& schema);
  void number_rows();
  ShardSchema get_read_schema() const;

  ShardParts parts_;
  ShardSchema schema_;
  std::string plan_hash_;
  std::filesystem::path first_file_;  // all files have its plan and columns
  std::size_t row_count_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::int64_t> case_ids_;  // while the dataset is opened
  std::optional<SweepFolder> folder_;
  SweepExtent extent_;  // extent of folder_
  std::optional<Hdf5Reader> merged_;
  std::size_t held_ = 0;  // piece in rows_
  std::optional<ShardRows> rows_;
};

}  // namespace strut
