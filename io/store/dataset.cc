#include "io/store/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "base/error/input_error.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Bounds on a piece of a merged file, which is rounded down to whole chunks of the file: rows, and
/// numbers of their histories.
constexpr std::size_t kMaxPieceRows = 8192, kMaxPieceNumbers = std::size_t{4} << 20;

InputError path_error(const fs::path& path, const std::string& what) {
  return InputError(fmt::format("{}: {}", path.string(), what));
}

enum class DataKind { kFolder, kShard, kMerged, kUnsealedMerged };

DataKind find_kind(const fs::path& path) {
  if (!fs::exists(path)) throw path_error(path, "not found");
  if (fs::is_directory(path)) return DataKind::kFolder;
  if (!is_sealed(path)) return DataKind::kUnsealedMerged;
  const std::string kind = find_seal_kind(path);
  if (kind == kMergedSeal.name) return DataKind::kMerged;
  if (kind.empty() || kind == kShardSeal.name) return DataKind::kShard;
  throw path_error(
      path,
      fmt::format("a {} file of strut; must be a sweep folder, shards of one, or a merged file",
                  kind));
}

/// Reads rows [first, first + count) of a merged file, without their reasons.
ShardRows read_merged_rows(const Hdf5Reader& file, const ShardSchema& schema, std::size_t first,
                           std::size_t count) {
  ShardRows rows = ShardRows::make(schema, count);
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    if constexpr (std::is_same_v<Value, double>) {
      values = file.read_rows(column.name, first, count).values;
    } else if constexpr (!std::is_same_v<Value, std::string>) {
      const auto integers = file.read_integer_rows(column.name, first, count);
      std::transform(integers.begin(), integers.end(), values.begin(),
                     [](std::int64_t value) { return static_cast<Value>(value); });
    }
  });
  return rows;
}

std::size_t count_piece_rows(const ShardSchema& schema) {
  const std::size_t numbers = schema.history.size() * schema.history_samples;
  return numbers == 0 ? kMaxPieceRows
                      : std::clamp<std::size_t>(kMaxPieceNumbers / numbers, 1, kMaxPieceRows);
}

/// Throws InputError unless every dataset of a merged file has one row per case.
void check_shapes(const fs::path& path, const Hdf5Reader& file, const ShardSchema& schema) {
  const std::size_t count = file.read_shape(kCaseIdName).front();
  ShardRows rows;
  rows.history.resize(schema.history.size());
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, const auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    // Reasons are not read: texts of equal length, or characters since axes were added.
    if constexpr (!std::is_same_v<Value, std::string>) require_shape(path, file, column, count);
  });
}

}  // namespace

Dataset::Dataset(const std::vector<fs::path>& paths, const DatasetOptions& options)
    : parts_(options.histories ? ShardParts::kAll : ShardParts::kTables) {
  if (paths.empty()) throw InputError("no data: name a sweep folder, shards, or a merged file");
  for (const fs::path& path : paths) {
    if (paths.size() > 1 && find_kind(path) != DataKind::kShard) {
      throw path_error(path, "must be given alone; several files must be shards of one sweep");
    }
  }
  open(paths, options.partial);
  if (row_count_ == 0) throw path_error(paths.front(), "holds no case");
  refuse_repeated();
}

void Dataset::open(const std::vector<fs::path>& paths, bool partial) {
  switch (find_kind(paths.front())) {
    case DataKind::kFolder:
      return open_folder(SweepFolder{paths.front()}, partial);
    case DataKind::kShard:
      return open_shards(paths);
    case DataKind::kMerged:
      return open_sealed_merged(paths.front());
    case DataKind::kUnsealedMerged:
      return open_unsealed_merged(paths.front());
  }
}

void Dataset::open_sealed_merged(const fs::path& path) {
  const FileSeal seal = require_intact(path, check_sealed_file(path, kMergedSeal));
  open_merged(path, Hdf5Reader(path));
  if (seal.get("plan") != plan_hash_) {
    throw path_error(path, "damaged: its seal names another plan than the file");
  }
}

void Dataset::open_unsealed_merged(const fs::path& path) {
  open_merged(path, Hdf5Reader::open_unsealed(path));
  check_merged_digest(path);
}

void Dataset::open_folder(const SweepFolder& folder, bool partial) {
  if (!fs::exists(folder.plan())) {
    throw path_error(folder.root, "not a sweep folder; `strut plan` makes one");
  }
  extent_ = read_sweep_extent(folder);
  plan_hash_ = extent_.plan_hash;
  folder_ = folder;
  const auto cases = static_cast<std::size_t>(extent_.cases);
  for (const std::int64_t shard : list_shards(folder)) add_shard(folder.shard(shard));
  number_rows();
  if (row_count_ < cases && !partial) {
    throw InputError(
        fmt::format("{0}: {1} of {2} cases are missing; `strut run {0}` makes them, --partial "
                    "continues without them",
                    folder.root.string(), cases - row_count_, cases));
  }
}

void Dataset::open_merged(const fs::path& path, Hdf5Reader file) {
  merged_ = std::move(file);
  check_same(path, merged_->read_attribute("/", kPlanHashKey), read_shard_schema(path, *merged_));
  check_shapes(path, *merged_, schema_);
  const std::size_t rows = merged_->read_shape(kCaseIdName).front();
  std::string table = schema_.snapshot.empty() ? kParametersName : kSnapshotName;
  const ShardSchema read = get_read_schema();
  if (!read.history.empty()) table = get_history_name(read.history.front());
  const std::size_t max_rows = count_piece_rows(read);
  const std::size_t chunk =
      std::min(std::max<std::size_t>(merged_->read_chunk_rows(table), 1), max_rows);
  const std::size_t step = max_rows / chunk * chunk;
  for (std::size_t first = 0; first < rows; first += step) {
    pieces_.push_back({path, -1, first, std::min(step, rows - first)});
  }
  row_count_ = rows;
  case_ids_ = merged_->read_integers(kCaseIdName);
}

/// The checksum of a merged file is the digest of its rows, which excludes names, units and
/// reasons.
void Dataset::check_merged_digest(const fs::path& path) {
  DataDigest digest;
  const std::size_t step = count_piece_rows(schema_);
  for (std::size_t first = 0; first < row_count_; first += step) {
    const std::size_t count = std::min(step, row_count_ - first);
    digest.add(calc_rows_digest(read_merged_rows(*merged_, schema_, first, count)));
  }
  if (digest.text() != merged_->read_attribute("/", kChecksumKey)) {
    throw path_error(path, fmt::format("{}: damaged: does not match the rows; {}", kChecksumKey,
                                       kMergedSeal.remedy));
  }
}

void Dataset::refuse_repeated() {
  const std::int64_t repeated = find_repeated(std::exchange(case_ids_, {}));
  if (repeated < 0) return;
  std::string files;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const std::vector<std::int64_t>& ids = read_piece(i).case_id;
    if (std::find(ids.begin(), ids.end(), repeated) == ids.end()) continue;
    const std::string file = pieces_[i].file.string();
    if (!files.ends_with(file)) files += (files.empty() ? "" : ", ") + file;
  }
  throw InputError(fmt::format("{}: case {} appears twice; each case may appear once in a dataset",
                               files, repeated));
}

void Dataset::open_shards(const std::vector<fs::path>& paths) {
  for (const fs::path& path : paths) add_shard(path);
  std::sort(pieces_.begin(), pieces_.end(),
            [](const Piece& a, const Piece& b) { return a.shard < b.shard; });
  for (std::size_t i = 1; i < pieces_.size(); ++i) {
    if (pieces_[i].shard == pieces_[i - 1].shard) {
      throw path_error(pieces_[i].file,
                       fmt::format("shard {} is given twice, also as {}", pieces_[i].shard,
                                   pieces_[i - 1].file.string()));
    }
  }
  number_rows();
}

void Dataset::add_shard(const fs::path& path) {
  const SealedBytes sealed = read_sealed(path, kShardSeal);
  const ShardSeal seal = read_shard_seal(path, sealed.bytes);
  const Hdf5Reader file(path, sealed.bytes);
  const std::vector<std::int64_t> case_ids = file.read_integers(kCaseIdName);
  const std::int64_t named = SweepFolder::parse_shard_name(path.stem().string());
  if (folder_) {
    require_shard(path, extent_, named, seal, case_ids);
  } else if (named >= 0 && named != seal.shard) {
    throw path_error(path, fmt::format("{}; must bear its own number",
                                       find_misplacement(seal, seal.plan_hash, named)));
  }
  check_same(path, seal.plan_hash, read_shard_schema(path, file));
  pieces_.push_back({path, seal.shard, 0, case_ids.size()});
  case_ids_.insert(case_ids_.end(), case_ids.begin(), case_ids.end());
}

void Dataset::check_same(const fs::path& path, const std::string& plan_hash,
                         const ShardSchema& schema) {
  const fs::path& other = folder_ ? folder_->plan() : first_file_;
  if (!plan_hash_.empty() && plan_hash != plan_hash_) {
    throw path_error(path, fmt::format("belongs to plan {:.12}..., but {} to plan {:.12}...",
                                       plan_hash, other.string(), plan_hash_));
  }
  if (!first_file_.empty() && schema != schema_) {
    throw path_error(path,
                     fmt::format("its columns differ from those of {}", first_file_.string()));
  }
  if (!first_file_.empty()) return;
  plan_hash_ = plan_hash;
  schema_ = schema;
  first_file_ = path;
}

void Dataset::number_rows() {
  row_count_ = 0;
  for (Piece& piece : pieces_) {
    piece.first_row = row_count_;
    row_count_ += piece.rows;
  }
}

/// Returns the schema of the rows that are read.
ShardSchema Dataset::get_read_schema() const {
  ShardSchema schema = schema_;
  if (parts_ == ShardParts::kTables) schema.history.clear();
  return schema;
}

const ShardRows& Dataset::read_piece(std::size_t number) {
  if (rows_ && held_ == number) return *rows_;
  const Piece& piece = pieces_.at(number);
  rows_.reset();
  if (merged_) {
    rows_ = read_merged_rows(*merged_, get_read_schema(), piece.first_row, piece.rows);
  } else {
    Shard shard = folder_ ? read_shard_with_retries(*folder_, extent_, piece.shard, parts_)
                          : read_shard(piece.file, parts_);
    if (shard.rows.size() != piece.rows || shard.provenance.shard != piece.shard) {
      throw path_error(piece.file, "changed while it was read");
    }
    rows_ = std::move(shard.rows);
  }
  held_ = number;
  return *rows_;
}

ShardRows Dataset::read(std::size_t first, std::size_t count) {
  if (first > row_count_ || count > row_count_ - first) {
    throw InputError(fmt::format("{}: has {} rows; rows {} to {} were requested",
                                 first_file_.string(), row_count_, first, first + count));
  }
  ShardRows rows = ShardRows::make(get_read_schema(), count);
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
    const std::size_t begin = std::max(first, pieces_[piece].first_row);
    const std::size_t end = std::min(first + count, pieces_[piece].first_row + pieces_[piece].rows);
    for (std::size_t row = begin; row < end; ++row) {
      rows.set_row(row - first, read_piece(piece), row - pieces_[piece].first_row);
    }
  }
  return rows;
}

}  // namespace strut
