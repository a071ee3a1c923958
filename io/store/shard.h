// One shard of a sweep: some hundred finished cases in one immutable HDF5 file.
//
// The file is built in memory, sealed (io/file/file_seal.h) with its plan and number, and only then
// written, so the library never meets a full disk.
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

/// What a row of a shard consists of; the same for all shards of a sweep.
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
  std::vector<double> parameters;  // n x p
  std::vector<double> snapshot;    // n x s; NaN where the case failed or never met its instant
  std::vector<std::int32_t> layer;
  std::vector<std::int32_t> status;          // 0: done
  std::vector<std::int32_t> attempt;         // 0: first try; k: the k-th retry
  std::vector<double> event_time;            // s, of the snapshot; NaN: none
  std::vector<double> failure_time;          // s; NaN: none
  std::vector<std::string> reason;           // why it failed; empty: it did not
  std::vector<std::vector<double>> history;  // per channel n x t

  std::size_t size() const { return case_id.size(); }
  /// Room for `count` rows of `schema`; numbers NaN, integers 0.
  static ShardRows make(const ShardSchema& schema, std::size_t count);
  /// Copies row `from` of `other` onto row `to`.
  void set_row(std::size_t to, const ShardRows& other, std::size_t from);
};

/// Who made it, how and when: nothing here enters the data digest.
struct ShardProvenance {
  std::string plan_hash;
  std::int64_t shard = 0;
  std::vector<std::pair<std::string, std::string>> texts;  // attribute -> text, in this order
};

/// SHA-256 of one row: the little-endian bytes of case_id, parameters, snapshot, layer, status,
/// attempt, event_time, failure_time and each history channel in schema order. Every NaN counts as
/// the same one.
Hash calc_row_hash(const ShardRows& rows, std::size_t row);
/// Of all rows.
DataDigest calc_rows_digest(const ShardRows& rows);

/// A shard's datasets, compressed; made by worker threads without the HDF5 library.
struct CompressedShard {
  std::vector<Hdf5Chunks> datasets;
  DataDigest digest;
  std::size_t cases = 0;
  std::vector<std::string> history_names;
  double history_interval = 0.0;  // s; 0: no histories
  std::string status_meaning;
};

/// Thread-safe. Throws CheckError where the rows are not of the schema.
CompressedShard compress_shard(const ShardSchema& schema, const ShardRows& rows);

/// The bytes of the shard's file: equal arguments, equal bytes.
std::vector<std::byte> make_shard_image(const CompressedShard& shard,
                                        const ShardProvenance& provenance);

/// What the seal of a shard says (io/file/file_seal.h).
struct ShardSeal {
  std::string plan_hash;
  std::int64_t shard = 0;  // -1: none
  std::uint64_t size = 0;  // bytes of the whole file
  std::string sha256;      // of all bytes behind the seal
};

SealLabel make_shard_label(const std::string& plan_hash, std::int64_t shard);
ShardSeal make_shard_seal(const FileSeal& seal);

/// Reads 512 bytes and the file's size. Throws InputError where that is no shard's seal, or the
/// size is another.
ShardSeal read_shard_seal(const std::filesystem::path& path);

/// As above, of the bytes of a file called `path`.
ShardSeal read_shard_seal(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Reads every byte and compares it with the seal. Throws InputError that names the file and what
/// is wrong.
ShardSeal check_shard_bytes(const std::filesystem::path& path);

/// As above, of the bytes of a file called `path`.
ShardSeal check_shard_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Why a file with this seal cannot be shard `shard` of the plan `plan_hash`; empty where it can.
std::string find_misplacement(const ShardSeal& seal, const std::string& plan_hash,
                              std::int64_t shard);

struct Shard {
  ShardSchema schema;
  ShardRows rows;
  ShardProvenance provenance;  // texts sorted by name
  DataDigest digest;           // of the rows
};

/// Which datasets of a shard are read.
enum class ShardParts {
  kAll,
  kTables,  // all but the histories: `rows.history` stays empty, and the digest that of nothing
};

/// Reads a file once and checks it in every way; without the histories by the seal's SHA-256, not
/// by the digest of the rows. Throws InputError with file and dataset where a byte or a dataset is
/// missing, damaged or misshapen, or the schema version is unknown.
Shard read_shard(const std::filesystem::path& path, ShardParts parts = ShardParts::kAll);

}  // namespace strut
