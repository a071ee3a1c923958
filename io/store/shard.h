// One shard of a sweep: hundreds of finished cases in one immutable HDF5 file.
//
// The file is built in memory, sealed (io/file/file_seal.h) with its plan and number, and only then
// written, so that a full disk never affects the HDF5 library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/file/file_seal.h"
#include "io/file/sha256.h"
#include "io/format/hdf5.h"
#include "io/store/data_digest.h"

namespace strut {

inline constexpr int kShardSchemaVersion = 1;

struct ColumnInfo {
  std::string name, unit, description;
  bool operator==(const ColumnInfo&) const = default;
};

/// Columns of a shard's rows; the same for all shards of a sweep.
struct ShardSchema {
  std::vector<ColumnInfo> parameters;
  std::vector<ColumnInfo> snapshot;  // empty: none recorded
  std::vector<ColumnInfo> history;   // one dataset each; empty: none recorded
  std::size_t history_samples = 0;
  double history_interval = 0.0;  // s
  std::string status_meaning;     // "0 done, 1 diverged, ..."
  bool operator==(const ShardSchema&) const = default;
};

/// Rows of a shard, one per case; arrays row by row.
struct ShardRows {
  std::vector<std::int64_t> case_id;
  std::vector<double> parameters;     // n x p
  std::vector<double> snapshot;       // n x s; NaN if the case failed or never reached its instant
  std::vector<std::int32_t> layer;    // stratum
  std::vector<std::int32_t> status;   // 0: done
  std::vector<std::int32_t> attempt;  // 0: first try; k: the k-th retry
  std::vector<double> event_time;     // s, of the snapshot; NaN: none
  std::vector<double> failure_time;   // s; NaN: none
  std::vector<std::string> reason;    // cause of failure; empty: none
  std::vector<std::vector<double>> history;  // per channel n x t

  std::size_t size() const { return case_id.size(); }
  /// Makes `count` rows of `schema` with all numbers NaN and all integers 0.
  static ShardRows make(const ShardSchema& schema, std::size_t count);
  /// Copies row `from` of `other` onto row `to`.
  void set_row(std::size_t to, const ShardRows& other, std::size_t from);
};

/// Origin of a shard; excluded from the data digest.
struct ShardProvenance {
  std::string plan_hash;
  std::int64_t shard = 0;
  std::vector<std::pair<std::string, std::string>> texts;  // attribute -> text, in this order
};

/// Returns the SHA-256 of one row: the little-endian bytes of case_id, parameters, snapshot, layer,
/// status, attempt, event_time, failure_time and each history channel in schema order. All NaNs are
/// equal.
Hash calc_row_hash(const ShardRows& rows, std::size_t row);
/// Returns the digest of all rows.
DataDigest calc_rows_digest(const ShardRows& rows);

/// Compressed datasets of a shard; made by worker threads without the HDF5 library.
struct CompressedShard {
  std::vector<Hdf5Chunks> datasets;
  DataDigest digest;
  std::size_t cases = 0;
  std::vector<std::string> history_names;
  double history_interval = 0.0;  // s; 0: no histories
  std::string status_meaning;
};

/// Compresses rows. Thread-safe. Throws CheckError if the rows do not match the schema.
CompressedShard compress_shard(const ShardSchema& schema, const ShardRows& rows);

/// Returns the bytes of the shard's file, which depend on nothing but the arguments.
std::vector<std::byte> make_shard_image(const CompressedShard& shard,
                                        const ShardProvenance& provenance);

/// Content of a shard's seal (io/file/file_seal.h).
struct ShardSeal {
  std::string plan_hash;
  std::int64_t shard = 0;  // -1: none
  std::uint64_t size = 0;  // bytes of the whole file
  std::string sha256;      // digest of all bytes after the seal
};

SealLabel make_shard_label(const std::string& plan_hash, std::int64_t shard);
ShardSeal make_shard_seal(const FileSeal& seal);

/// Reads 512 bytes and the file's size. Throws InputError if they are not the seal of a shard, or
/// if the size differs.
ShardSeal read_shard_seal(const std::filesystem::path& path);

/// As above, for the bytes of a file that messages call `path`.
ShardSeal read_shard_seal(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Compares every byte with the seal. Throws InputError that names the file and the fault.
ShardSeal check_shard_bytes(const std::filesystem::path& path);

/// As above, for the bytes of a file that messages call `path`.
ShardSeal check_shard_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Returns the reason why a file with this seal cannot be shard `shard` of the plan `plan_hash`;
/// empty if it can.
std::string find_misplacement(const ShardSeal& seal, const std::string& plan_hash,
                              std::int64_t shard);

struct Shard {
  ShardSchema schema;
  ShardRows rows;
  ShardProvenance provenance;  // texts sorted by name
  DataDigest digest;           // digest of the rows
};

/// Datasets of a shard to read.
enum class ShardParts {
  kAll,
  kTables,  // all but the histories: `rows.history` stays empty, and the digest is that of no rows
};

/// Reads a file once and verifies it by the seal's SHA-256 and, if histories are read, by the
/// digest of the rows. Throws InputError with file and dataset if a byte or a dataset is missing,
/// damaged or of the wrong shape, or if the schema version is unknown.
Shard read_shard(const std::filesystem::path& path, ShardParts parts = ShardParts::kAll);
/// The same of a file that is read already; `path` is for messages.
Shard read_shard(const std::filesystem::path& path, const SealedBytes& sealed,
                 ShardParts parts = ShardParts::kAll);

}  // namespace strut
