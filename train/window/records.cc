#include "train/window/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "train/data/shift.h"

namespace strut {
namespace {

/// Tolerance, in samples, for times that are whole numbers of samples.
constexpr double kRounding = 1e-6;

double calc_last_time(const ShardSchema& schema) {
  return static_cast<double>(schema.history_samples - 1) * schema.history_interval;
}

void require_histories(const ShardSchema& schema) {
  if (!schema.history.empty()) return;
  throw InputError(
      "the data have no histories, which a window needs; record them with "
      "[record] history = { rate = 500, channels = [...] } in the sweep file");
}

}  // namespace

WindowGrid make_window_grid(const ShardSchema& schema, const WindowChoice& choice,
                            std::size_t spare) {
  require_histories(schema);
  const double interval = schema.history_interval;
  const Range reach = at_least(0.0, "s");
  if (!reach.contains(choice.reach)) {
    throw InputError(
        fmt::format("--align = {}: {}", format_number(choice.reach), reach.describe()));
  }
  WindowGrid grid;
  grid.interval = interval;
  grid.lags = static_cast<std::size_t>(std::ceil(choice.reach / interval - kRounding));
  const std::size_t beyond = grid.margin() + spare;
  const double first = std::ceil(choice.from / interval - kRounding);
  const double last = std::floor(choice.to / interval + kRounding);
  const auto low = static_cast<double>(beyond);
  const double high =
      static_cast<double>(schema.history_samples) - 1.0 - static_cast<double>(beyond);
  const std::string sides = fmt::format("{} s that aligning and hit times need on each side",
                                        format_rounded(low * interval));
  if (high <= low) {
    throw InputError(fmt::format(
        "--window, --align, --hit-time-sigma: the histories, {} s, have no room between the {}",
        format_rounded(calc_last_time(schema)), sides));
  }
  if (!(first >= low && last <= high && last > first)) {
    throw InputError(fmt::format(
        "--window = {}:{}: must begin before it ends and lie in [{}, {}] s, the histories without "
        "the {}",
        format_rounded(choice.from), format_rounded(choice.to), format_rounded(low * interval),
        format_rounded(high * interval), sides));
  }
  grid.first = static_cast<std::int64_t>(first);
  grid.samples = static_cast<std::size_t>(last - first) + 1;
  return grid;
}

std::size_t count_spare(const ShardSchema& schema, const NoiseModel& noise) {
  require_histories(schema);
  if (noise.hit_time == 0.0) return 0;
  const double max = NoiseModel::kMaxDeviations * noise.hit_time / schema.history_interval;
  return static_cast<std::size_t>(std::ceil(max)) + ShiftStencil::kBefore;
}

WindowRecords read_window_records(Dataset& dataset, const RowChoice& choice, const WindowGrid& grid,
                                  std::size_t spare, const RowStoreOptions& store) {
  const ShardSchema& schema = dataset.schema();
  require_histories(schema);
  const auto channels = find_columns(schema.history, choice.inputs, "history channel");
  const auto targets = find_targets(schema, choice);
  WindowRecords records;
  records.channels = take_columns(schema.history, channels);
  records.targets = take_columns(schema.parameters, targets);
  records.grid = grid;
  records.spare = spare;
  const std::size_t samples = records.samples(), all = schema.history_samples;
  records.rows = RowStore(channels.size() * samples + targets.size(), store);
  const auto begin = static_cast<std::size_t>(grid.first) - grid.margin() - spare;
  const auto append = [&](const ShardRows& piece, std::size_t i, std::vector<double>& row) {
    STRUT_CHECK(!piece.history.empty(), "a dataset was opened without its histories");
    for (const std::size_t c : channels) {
      const auto from = piece.history.at(c).begin() + static_cast<std::ptrdiff_t>(i * all + begin);
      row.insert(row.end(), from, from + static_cast<std::ptrdiff_t>(samples));
    }
    for (const std::size_t t : targets) {
      row.push_back(piece.parameters[i * schema.parameters.size() + t]);
    }
  };
  records.skipped = collect_usable(dataset, choice.samples, append, records.rows);
  return records;
}

void draw_record(const WindowRecords& records, std::span<const double> row, const NoiseModel& noise,
                 const NoiseDraw& draw, bool noise_free, std::span<double> record) {
  const std::size_t samples = records.samples(), size = records.grid.record_samples();
  const double later = noise.hit_time > 0.0 ? draw.calc_hit_time() / records.grid.interval : 0.0;
  for (std::size_t c = 0; c < records.channels.size(); ++c) {
    const std::span<const double> from = row.subspan(c * samples, samples);
    const std::span<double> to = record.subspan(c * size, size);
    if (records.spare > 0) {
      read_shifted(from, static_cast<double>(records.spare) - later, to);
    } else {
      std::copy(from.begin(), from.end(), to.begin());
    }
    if (!noise_free) draw.add(c, to);
  }
}

}  // namespace strut
