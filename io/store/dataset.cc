#include "io/store/dataset.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "base/error/input_error.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Most rows of a merged file that are held at a time, to whole chunks of the file, and most
/// numbers of their histories.
constexpr std::size_t kPieceRows = 8192, kPieceNumbers = std::size_t{4} << 20;

enum class DataKind { kFolder, kShard, kMerged, kUnsealedMerged };

DataKind find_kind(const fs::path& path) {
  if (!fs::exists(path)) throw InputError(path.string() + ": not found");
  if (fs::is_directory(path)) return DataKind::kFolder;
  if (!is_sealed(path)) return DataKind::kUnsealedMerged;
  const std::string kind = find_seal_kind(path);
  if (kind == kMergedSeal.name) return DataKind::kMerged;
  if (kind.empty() || kind == kShardSeal.name) return DataKind::kShard;
  throw InputError(path.string() + ": a " + kind +
                   " of strut; must be a sweep folder, shards of one, or a merged file");
}

/// Rows [first, first + count) of a merged file but for their reasons.
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
  return numbers == 0 ? kPieceRows
                      : std::clamp<std::size_t>(kPieceNumbers / numbers, 1, kPieceRows);
}

/// Every dataset of a merged file has one row per case.
void check_shapes(const fs::path& path, const Hdf5Reader& file, const ShardSchema& schema) {
  const std::size_t count = file.read_shape("/case_id").front();
  ShardRows rows;
  rows.history.resize(schema.history.size());
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, const auto&) {
    std::vector<std::size_t> shape = {count};
    if (column.columns > 0) shape.push_back(column.columns);
    if (file.read_shape(column.name) != shape) {
      throw InputError(path.string() + ": " + column.name + ": must have " + std::to_string(count) +
                       " rows, one per case, and " +
                       std::to_string(std::max<std::size_t>(column.columns, 1)) + " columns");
    }
  });
}

}  // namespace

Dataset::Dataset(const std::vector<fs::path>& paths, const DatasetOptions& options)
    : parts_(options.histories ? ShardParts::kAll : ShardParts::kTables) {
  if (paths.empty()) throw InputError("no data: name a sweep folder, shards, or a merged file");
  for (const fs::path& path : paths) {
    if (paths.size() > 1 && find_kind(path) != DataKind::kShard) {
      throw InputError(path.string() + ": stands alone; several files must be shards of one sweep");
    }
  }
  switch (find_kind(paths.front())) {
    case DataKind::kFolder:
      open_folder(SweepFolder{paths.front()}, options.partial);
      break;
    case DataKind::kShard:
      open_shards(paths);
      break;
    case DataKind::kMerged: {
      const FileSeal seal =
          require_sound(paths.front(), check_sealed_file(paths.front(), kMergedSeal));
      open_merged(paths.front(), Hdf5Reader(paths.front()));
      if (seal.get("plan") != plan_hash_) {
        throw InputError(paths.front().string() + ": its seal names another plan than the file");
      }
      break;
    }
    case DataKind::kUnsealedMerged:
      open_merged(paths.front(), Hdf5Reader::open_unsealed(paths.front()));
      check_merged_digest(paths.front());
      break;
  }
  if (row_count_ == 0) throw InputError(paths.front().string() + ": holds no case");
  refuse_repeated();
}

void Dataset::open_folder(const SweepFolder& folder, bool partial) {
  if (!fs::exists(folder.plan())) {
    throw InputError(folder.root.string() + ": no sweep folder; `strut plan` makes one");
  }
  extent_ = read_sweep_extent(folder);
  plan_hash_ = extent_.plan_hash;
  folder_ = folder;
  const auto cases = static_cast<std::size_t>(extent_.cases);
  for (const std::int64_t shard : list_shards(folder)) add_shard(folder.shard(shard));
  number_rows();
  if (row_count_ < cases && !partial) {
    throw InputError(folder.root.string() + ": " + std::to_string(cases - row_count_) + " of " +
                     std::to_string(cases) + " cases are missing; `strut run " +
                     folder.root.string() + "` makes them, --partial takes what is there");
  }
}

void Dataset::open_merged(const fs::path& path, Hdf5Reader file) {
  merged_ = std::move(file);
  check_same(path, merged_->read_attribute("/", kPlanHashKey), read_shard_schema(path, *merged_));
  check_shapes(path, *merged_, schema_);
  const std::size_t rows = merged_->read_shape("/case_id").front();
  std::string table = schema_.snapshot.empty() ? kParametersName : kSnapshotName;
  const ShardSchema read = list_read();
  if (!read.history.empty()) table = kHistoryGroup + ("/" + read.history.front().name);
  const std::size_t most = count_piece_rows(read);
  const std::size_t chunk =
      std::min(std::max<std::size_t>(merged_->read_chunk_rows(table), 1), most);
  const std::size_t step = most / chunk * chunk;
  for (std::size_t first = 0; first < rows; first += step) {
    pieces_.push_back({path, -1, first, std::min(step, rows - first)});
  }
  row_count_ = rows;
  case_ids_ = merged_->read_integers("/case_id");
}

/// The checksum of a merged file is the digest of its rows: all but names, units and reasons.
void Dataset::check_merged_digest(const fs::path& path) {
  DataDigest digest;
  const std::size_t step = count_piece_rows(schema_);
  for (std::size_t first = 0; first < row_count_; first += step) {
    const std::size_t count = std::min(step, row_count_ - first);
    digest.add(calc_rows_digest(read_merged_rows(*merged_, schema_, first, count)));
  }
  if (digest.text() != merged_->read_attribute("/", kChecksumKey)) {
    throw InputError(path.string() + ": " + kChecksumKey +
                     ": damaged: the rows have another one; " + kMergedSeal.remedy);
  }
}

void Dataset::refuse_repeated() {
  const std::int64_t twice = find_repeated(std::exchange(case_ids_, {}));
  if (twice < 0) return;
  std::string files;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const std::vector<std::int64_t>& ids = read_piece(i).case_id;
    if (std::find(ids.begin(), ids.end(), twice) == ids.end()) continue;
    const std::string file = pieces_[i].file.string();
    if (!files.ends_with(file)) files += (files.empty() ? "" : ", ") + file;
  }
  throw InputError(files + ": case " + std::to_string(twice) +
                   " is there twice; each may be once in a dataset");
}

void Dataset::open_shards(const std::vector<fs::path>& paths) {
  for (const fs::path& path : paths) add_shard(path);
  std::sort(pieces_.begin(), pieces_.end(),
            [](const Piece& a, const Piece& b) { return a.shard < b.shard; });
  for (std::size_t i = 1; i < pieces_.size(); ++i) {
    if (pieces_[i].shard == pieces_[i - 1].shard) {
      throw InputError(pieces_[i].file.string() + ": shard " + std::to_string(pieces_[i].shard) +
                       " is given twice, also as " + pieces_[i - 1].file.string());
    }
  }
  number_rows();
}

void Dataset::add_shard(const fs::path& path) {
  const SealedBytes sealed = read_sealed(path, kShardSeal);
  const ShardSeal seal = read_shard_seal(path, sealed.bytes);
  const Hdf5Reader file(path, sealed.bytes);
  const std::vector<std::int64_t> case_ids = file.read_integers("/case_id");
  const std::int64_t named = SweepFolder::parse_shard_name(path.stem().string());
  if (folder_) {
    require_shard(path, extent_, named, seal, case_ids);
  } else if (named >= 0 && named != seal.shard) {
    throw InputError(path.string() + ": " + find_misplacement(seal, seal.plan_hash, named) +
                     "; must bear its own number");
  }
  check_same(path, seal.plan_hash, read_shard_schema(path, file));
  pieces_.push_back({path, seal.shard, 0, case_ids.size()});
  case_ids_.insert(case_ids_.end(), case_ids.begin(), case_ids.end());
}

void Dataset::check_same(const fs::path& path, const std::string& plan_hash,
                         const ShardSchema& schema) {
  const fs::path& other = folder_ ? folder_->plan() : first_file_;
  if (!plan_hash_.empty() && plan_hash != plan_hash_) {
    throw InputError(path.string() + ": a shard of another plan (" + plan_hash.substr(0, 12) +
                     "...) than " + other.string() + " (" + plan_hash_.substr(0, 12) + "...)");
  }
  if (!first_file_.empty() && schema != schema_) {
    throw InputError(path.string() + ": has other columns than " + first_file_.string());
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

/// The schema without what is not read.
ShardSchema Dataset::list_read() const {
  ShardSchema schema = schema_;
  if (parts_ == ShardParts::kTables) schema.history.clear();
  return schema;
}

const ShardRows& Dataset::read_piece(std::size_t number) {
  if (rows_ && held_ == number) return *rows_;
  const Piece& piece = pieces_.at(number);
  rows_.reset();
  if (merged_) {
    rows_ = read_merged_rows(*merged_, list_read(), piece.first_row, piece.rows);
  } else {
    Shard shard = folder_ ? read_mended_shard(*folder_, extent_, piece.shard, parts_)
                          : read_shard(piece.file, parts_);
    if (shard.rows.size() != piece.rows || shard.provenance.shard != piece.shard) {
      throw InputError(piece.file.string() + ": changed while it was read");
    }
    rows_ = std::move(shard.rows);
  }
  held_ = number;
  return *rows_;
}

ShardRows Dataset::read(std::size_t first, std::size_t count) {
  if (first > row_count_ || count > row_count_ - first) {
    throw InputError("rows " + std::to_string(first) + " to " + std::to_string(first + count) +
                     " asked for; there are " + std::to_string(row_count_));
  }
  ShardRows rows = ShardRows::make(list_read(), count);
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
