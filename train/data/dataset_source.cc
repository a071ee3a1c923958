#include "train/data/dataset_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/math/all_finite.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

/// Appends the usable rows of a piece, at most `max` of them; returns the number of unusable ones.
std::int64_t append_usable(const ShardRows& piece, const FillRow& fill, std::size_t max,
                           RowStore& rows) {
  std::vector<double> kept, row;
  std::int64_t skipped = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < piece.size() && count < max; ++i) {
    row.clear();
    if (piece.status[i] == 0) fill(piece, i, row);
    if (row.empty() || !all_finite(row)) {
      ++skipped;
      continue;
    }
    kept.insert(kept.end(), row.begin(), row.end());
    ++count;
  }
  rows.append(kept);
  return skipped;
}

void require_spread(const Normalizer& map, const std::vector<ColumnInfo>& columns, const char* kind,
                    std::int64_t rows) {
  const std::size_t at = map.find_constant();
  if (at == columns.size()) return;
  throw InputError(
      fmt::format("{} '{}' is constant, {} {}, in all {} training rows: nothing can be learned "
                  "from it; leave it out",
                  kind, columns[at].name, format_number(map.low()[at]), columns[at].unit, rows));
}

}  // namespace

std::vector<std::size_t> find_columns(const std::vector<ColumnInfo>& columns,
                                      const std::vector<std::string>& names, const char* kind) {
  const std::vector<std::string> known = list_names(columns);
  std::vector<std::size_t> found;
  found.reserve(names.size());
  for (const std::string& name : names) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end()) {
      throw InputError(fmt::format("the data have no {} '{}'{}; they have: {}", kind, name,
                                   suggest_name(name, known),
                                   known.empty() ? "none" : join_names(known)));
    }
    const auto column = static_cast<std::size_t>(at - known.begin());
    if (std::find(found.begin(), found.end(), column) != found.end()) {
      throw InputError(fmt::format("{} '{}' is named twice", kind, name));
    }
    found.push_back(column);
  }
  if (found.empty()) throw InputError(fmt::format("no {} chosen", kind));
  return found;
}

std::vector<ColumnInfo> take_columns(const std::vector<ColumnInfo>& from,
                                     const std::vector<std::size_t>& columns) {
  std::vector<ColumnInfo> taken;
  taken.reserve(columns.size());
  for (const std::size_t column : columns) taken.push_back(from[column]);
  return taken;
}

std::vector<std::size_t> find_targets(const ShardSchema& schema, const RowChoice& choice) {
  const auto names = choice.targets.empty() ? list_names(schema.parameters) : choice.targets;
  return find_columns(schema.parameters, names, "parameter");
}

std::int64_t collect_usable(Dataset& dataset, std::int64_t samples, const FillRow& fill,
                            RowStore& rows) {
  const std::size_t all = dataset.row_count();
  const std::size_t max = samples > 0 ? static_cast<std::size_t>(samples) : all;
  std::int64_t skipped = 0;
  for (std::size_t piece = 0; piece < dataset.piece_count() && rows.row_count() < max; ++piece) {
    skipped += append_usable(dataset.read_piece(piece), fill, max - rows.row_count(), rows);
  }
  const std::size_t count = rows.row_count();
  if (count == 0 || static_cast<std::int64_t>(count) < samples) {
    throw InputError(
        fmt::format("the data have {} usable cases of {} (the others failed or have NaN){}", count,
                    all, samples > 0 ? fmt::format("; asked for {}", samples) : ""));
  }
  return skipped;
}

UsableRows read_usable_rows(Dataset& dataset, const RowChoice& choice,
                            const RowStoreOptions& store) {
  const ShardSchema& schema = dataset.schema();
  const auto inputs = find_columns(schema.snapshot, choice.inputs, "snapshot channel");
  const auto targets = find_targets(schema, choice);
  UsableRows usable{take_columns(schema.snapshot, inputs), take_columns(schema.parameters, targets),
                    RowStore(inputs.size() + targets.size(), store)};
  const auto fill = [&](const ShardRows& piece, std::size_t i, std::vector<double>& row) {
    for (const std::size_t c : inputs) {
      row.push_back(piece.snapshot[i * schema.snapshot.size() + c]);
    }
    for (const std::size_t c : targets) {
      row.push_back(piece.parameters[i * schema.parameters.size() + c]);
    }
  };
  usable.skipped = collect_usable(dataset, choice.samples, fill, usable.rows);
  return usable;
}

Split make_split(std::int64_t rows, const SplitChoice& choice) {
  try {
    return {rows, choice.train, choice.validate, choice.seed};
  } catch (const std::invalid_argument&) {
    throw InputError(fmt::format("{} usable cases: too few to train, validate and test", rows));
  }
}

RowStore take_part(const RowStore& rows, const Split& split, Part part,
                   const RowStoreOptions& store) {
  RowStore taken(rows.columns(), store);
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

RowStore make_noisy_rows(const RowStore& rows, const NoiseModel& noise,
                         const std::function<bool(std::int64_t)>& takes,
                         const RowStoreOptions& store) {
  RowStore made(rows.columns(), store);
  const std::size_t columns = rows.columns();
  for (int copy = 0; copy < noise.copies; ++copy) {
    for_each_piece(rows, [&](std::span<const double> values, std::size_t first, std::size_t count) {
      std::vector<double> kept;
      for (std::size_t i = 0; i < count; ++i) {
        const auto number = static_cast<std::int64_t>(first + i);
        if (!takes(number)) continue;
        const auto row = values.subspan(i * columns, columns);
        kept.insert(kept.end(), row.begin(), row.end());
        const auto own = std::span(kept).last(columns);
        const NoiseDraw draw(noise, number, copy);
        for (std::size_t c = 0; c < noise.sigma.size(); ++c) draw.add(c, own.subspan(c, 1));
      }
      made.append(kept);
    });
  }
  return made;
}

void fit_maps(TrainingRows& rows) {
  Normalizer bounds(rows.train.columns());
  for_each_piece(rows.train, [&](std::span<const double> values, std::size_t, std::size_t) {
    bounds.include(values);
  });
  const auto cut = static_cast<std::ptrdiff_t>(rows.inputs.size());
  const std::vector<double>&low = bounds.low(), &high = bounds.high();
  rows.input_map = Normalizer({low.begin(), low.begin() + cut}, {high.begin(), high.begin() + cut});
  rows.target_map = Normalizer({low.begin() + cut, low.end()}, {high.begin() + cut, high.end()});
  const auto trained = static_cast<std::int64_t>(rows.train.row_count());
  require_spread(rows.input_map, rows.inputs, "input", trained);
  require_spread(rows.target_map, rows.targets, "parameter", trained);
}

TrainingRows split_rows(UsableRows usable, const SplitChoice& choice, const RowStoreOptions& store,
                        const std::optional<NoiseModel>& noise) {
  const auto count = static_cast<std::int64_t>(usable.rows.row_count());
  const Split split = make_split(count, choice);
  if (noise) noise->validate(usable.inputs);
  const auto take = [&](Part part) {
    if (!noise) return take_part(usable.rows, split, part, store);
    const auto takes = [&](std::int64_t row) { return split.find_part(row) == part; };
    return make_noisy_rows(usable.rows, *noise, takes, store);
  };
  TrainingRows parts;
  parts.usable = count;
  parts.skipped = usable.skipped;
  parts.noise = noise;
  parts.train = take(Part::kTrain);
  parts.validate = take(Part::kValidate);
  parts.test = take(Part::kTest);
  parts.inputs = std::move(usable.inputs);
  parts.targets = std::move(usable.targets);
  fit_maps(parts);
  return parts;
}

StoreSource::StoreSource(const RowStore& rows, Normalizer input_map, Normalizer target_map)
    : rows_(&rows), input_map_(std::move(input_map)), target_map_(std::move(target_map)) {
  STRUT_CHECK(rows.columns() == input_map_.columns() + target_map_.columns(),
              "the columns of a store are not those of its maps");
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
