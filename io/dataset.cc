#include "io/dataset.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "io/file_bytes.h"
#include "io/input_error.h"
#include "io/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Most rows of a merged file that are held at a time, to whole chunks of the file, and most
/// numbers of their histories.
constexpr std::size_t kPieceRows = 8192, kPieceNumbers = std::size_t{4} << 20;

/// True for a file without the user block that every shard begins with.
bool is_merged(const fs::path& path) {
  constexpr std::array<char, 8> kSignature = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  const std::vector<std::byte> bytes = read_first_bytes(path, kSignature.size());
  return bytes.size() == kSignature.size() &&
         std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) == 0;
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
    if (!fs::exists(path)) throw InputError(path.string() + ": not found");
    if (paths.size() > 1 && (fs::is_directory(path) || is_merged(path))) {
      throw InputError(path.string() + ": stands alone; several files must be shards of one sweep");
    }
  }
  if (fs::is_directory(paths.front())) {
    open_folder(SweepFolder{paths.front()}, options.partial);
  } else if (is_merged(paths.front())) {
    open_merged(paths.front());
  } else {
    open_shards(paths);
  }
  if (row_count_ == 0) throw InputError(paths.front().string() + ": holds no case");
}

void Dataset::open_folder(const SweepFolder& folder, bool partial) {
  if (!fs::exists(folder.plan())) {
    throw InputError(folder.root.string() + ": no sweep folder; `strut plan` makes one");
  }
  const Hdf5Reader plan(folder.plan());
  const auto cases = static_cast<std::size_t>(plan.read_integer_attribute("/", "cases"));
  plan_hash_ = plan.read_attribute("/", kPlanHashKey);
  folder_ = folder;
  for (const std::int64_t shard : list_shards(folder)) add_shard(folder.shard(shard));
  number_rows();
  if (row_count_ < cases && !partial) {
    throw InputError(folder.root.string() + ": " + std::to_string(cases - row_count_) + " of " +
                     std::to_string(cases) + " cases are missing; `strut run " +
                     folder.root.string() + "` makes them, --partial takes what is there");
  }
}

void Dataset::open_merged(const fs::path& path) {
  merged_.emplace(path);
  check_same(path, merged_->read_attribute("/", kPlanHashKey), read_shard_schema(path, *merged_));
  check_shapes(path, *merged_, schema_);
  const std::size_t rows = merged_->read_shape("/case_id").front();
  std::string table = schema_.snapshot.empty() ? kParametersName : kSnapshotName;
  std::size_t most = kPieceRows;
  if (const ShardSchema read = list_read(); !read.history.empty()) {
    table = kHistoryGroup + ("/" + read.history.front().name);
    most = std::clamp<std::size_t>(kPieceNumbers / (read.history.size() * read.history_samples), 1,
                                   kPieceRows);
  }
  const std::size_t chunk =
      std::min(std::max<std::size_t>(merged_->read_chunk_rows(table), 1), most);
  const std::size_t step = most / chunk * chunk;
  for (std::size_t first = 0; first < rows; first += step) {
    pieces_.push_back({path, -1, first, std::min(step, rows - first)});
  }
  row_count_ = rows;
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
  const std::vector<std::byte> bytes = read_shard_bytes(path);
  const ShardSeal seal = check_shard_bytes(path, bytes);
  const Hdf5Reader file(path, bytes);
  check_same(path, seal.plan_hash, read_shard_schema(path, file));
  pieces_.push_back({path, seal.shard, 0, file.read_shape("/case_id").front()});
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
    Shard shard = folder_ ? read_mended_shard(*folder_, piece.shard, nullptr, parts_)
                          : read_shard(piece.file, parts_);
    if (shard.rows.size() != piece.rows) {
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
