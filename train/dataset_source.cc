#include "train/dataset_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "io/input_error.h"
#include "io/nearest_name.h"
#include "io/shard_layout.h"

namespace strut {
namespace {

/// Columns of a table by name.
std::vector<std::size_t> find_columns(const std::vector<ColumnInfo>& columns,
                                      const std::vector<std::string>& names, const char* kind) {
  const std::vector<std::string> known = list_names(columns);
  std::vector<std::size_t> found;
  found.reserve(names.size());
  for (const std::string& name : names) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end()) {
      throw InputError("the data has no " + std::string(kind) + " '" + name + "'" +
                       suggest_name(name, known) + "; it has: " + join_names(known));
    }
    const auto column = static_cast<std::size_t>(at - known.begin());
    if (std::find(found.begin(), found.end(), column) != found.end()) {
      throw InputError(std::string(kind) + " '" + name + "' is named twice");
    }
    found.push_back(column);
  }
  if (found.empty()) throw InputError("no " + std::string(kind) + " chosen");
  return found;
}

std::vector<ColumnInfo> take(const std::vector<ColumnInfo>& from,
                             const std::vector<std::size_t>& columns) {
  std::vector<ColumnInfo> taken;
  taken.reserve(columns.size());
  for (const std::size_t column : columns) taken.push_back(from[column]);
  return taken;
}

/// Appends the usable rows of a piece, at most `most` of them; counts the others.
void append_usable(const ShardRows& piece, const ShardSchema& schema,
                   const std::vector<std::size_t>& inputs, const std::vector<std::size_t>& targets,
                   std::int64_t most, UsableRows& usable) {
  const std::int64_t before = static_cast<std::int64_t>(usable.rows.row_count());
  std::vector<double> kept, row;
  row.reserve(inputs.size() + targets.size());
  std::int64_t count = 0;
  for (std::size_t i = 0; i < piece.size() && before + count < most; ++i) {
    row.clear();
    for (const std::size_t c : inputs)
      row.push_back(piece.snapshot[i * schema.snapshot.size() + c]);
    for (const std::size_t c : targets) {
      row.push_back(piece.parameters[i * schema.parameters.size() + c]);
    }
    const bool finite =
        std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); });
    if (piece.status[i] != 0 || !finite) {
      ++usable.skipped;
      continue;
    }
    kept.insert(kept.end(), row.begin(), row.end());
    ++count;
  }
  usable.rows.append(kept);
}

void require_spread(const Normalizer& map, const std::vector<ColumnInfo>& columns, const char* kind,
                    std::int64_t rows) {
  const std::size_t at = map.find_constant();
  if (at == columns.size()) return;
  throw InputError(std::string(kind) + " '" + columns[at].name + "' is constant, " +
                   std::to_string(map.low()[at]) + " " + columns[at].unit + ", in all " +
                   std::to_string(rows) + " training rows: nothing can be learned from it; " +
                   "leave it out");
}

RowStore make_like(const RowStore& rows, const RowStoreOptions& options) {
  return RowStore(rows.columns(), options);
}

}  // namespace

UsableRows read_usable_rows(Dataset& dataset, const RowChoice& choice,
                            const RowStoreOptions& store) {
  const ShardSchema& schema = dataset.schema();
  const auto target_names = choice.targets.empty() ? list_names(schema.parameters) : choice.targets;
  const auto inputs = find_columns(schema.snapshot, choice.inputs, "snapshot channel");
  const auto targets = find_columns(schema.parameters, target_names, "parameter");
  UsableRows usable{take(schema.snapshot, inputs), take(schema.parameters, targets),
                    RowStore(inputs.size() + targets.size(), store)};
  const auto all = static_cast<std::int64_t>(dataset.row_count());
  const std::int64_t most = choice.samples > 0 ? choice.samples : all;
  for (std::size_t piece = 0; piece < dataset.piece_count(); ++piece) {
    if (static_cast<std::int64_t>(usable.rows.row_count()) >= most) break;
    append_usable(dataset.read_piece(piece), schema, inputs, targets, most, usable);
  }
  const auto count = static_cast<std::int64_t>(usable.rows.row_count());
  if (count == 0 || count < choice.samples) {
    throw InputError("the data has " + std::to_string(count) + " usable cases of " +
                     std::to_string(all) + " (the others failed or hold NaN)" +
                     (choice.samples > 0 ? "; asked for " + std::to_string(choice.samples) : ""));
  }
  return usable;
}

Split make_split(std::int64_t rows, const SplitChoice& choice) {
  try {
    return {rows, choice.train, choice.validate, choice.seed};
  } catch (const std::invalid_argument&) {
    throw InputError(std::to_string(rows) +
                     " usable cases: too few to train, validate and test with");
  }
}

RowStore take_part(const RowStore& rows, const Split& split, Part part,
                   const RowStoreOptions& store) {
  RowStore taken = make_like(rows, store);
  const std::size_t columns = rows.columns();
  for_each_piece(rows, [&](std::span<const double> values, std::size_t first, std::size_t count) {
    std::vector<double> kept;
    for (std::size_t i = 0; i < count; ++i) {
      if (split.find_part(static_cast<std::int64_t>(first + i)) != part) continue;
      const auto row = values.subspan(i * columns, columns);
      kept.insert(kept.end(), row.begin(), row.end());
    }
    taken.append(kept);
  });
  return taken;
}

TrainingRows split_rows(UsableRows usable, const SplitChoice& choice,
                        const RowStoreOptions& store) {
  const auto count = static_cast<std::int64_t>(usable.rows.row_count());
  const Split split = make_split(count, choice);
  TrainingRows parts;
  parts.usable = count;
  parts.skipped = usable.skipped;
  parts.train = take_part(usable.rows, split, Part::kTrain, store);
  parts.validate = take_part(usable.rows, split, Part::kValidate, store);
  parts.test = take_part(usable.rows, split, Part::kTest, store);
  Normalizer bounds(usable.rows.columns());
  for_each_piece(parts.train, [&](std::span<const double> values, std::size_t, std::size_t) {
    bounds.include(values);
  });
  const auto cut = static_cast<std::ptrdiff_t>(usable.inputs.size());
  const std::vector<double>&low = bounds.low(), &high = bounds.high();
  parts.input_map =
      Normalizer({low.begin(), low.begin() + cut}, {high.begin(), high.begin() + cut});
  parts.target_map = Normalizer({low.begin() + cut, low.end()}, {high.begin() + cut, high.end()});
  parts.inputs = std::move(usable.inputs);
  parts.targets = std::move(usable.targets);
  const std::int64_t trained = split.count(Part::kTrain);
  require_spread(parts.input_map, parts.inputs, "input", trained);
  require_spread(parts.target_map, parts.targets, "parameter", trained);
  return parts;
}

StoreSource::StoreSource(const RowStore& rows, Normalizer input_map, Normalizer target_map)
    : rows_(&rows), input_map_(std::move(input_map)), target_map_(std::move(target_map)) {
  if (rows.columns() != input_map_.columns() + target_map_.columns()) {
    throw std::logic_error("a store's columns are not those of its maps");
  }
}

void StoreSource::read(std::size_t first, std::size_t count, double* inputs, double* targets) {
  const std::size_t n = input_map_.columns(), m = target_map_.columns();
  buffer_.resize(count * (n + m));
  rows_->read(first, count, buffer_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const double* const row = buffer_.data() + i * (n + m);
    std::copy_n(row, n, inputs + i * n);
    std::copy_n(row + n, m, targets + i * m);
  }
  input_map_.normalize({inputs, count * n});
  target_map_.normalize({targets, count * m});
}

}  // namespace strut
