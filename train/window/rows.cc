#include "train/window/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

/// Records held in memory at a time, shared by the threads.
constexpr std::size_t kPieceRows = 64;

/// Noisy copies of some cases: components and targets by rows, and the residual of each row.
struct DrawnRows {
  std::vector<double> rows, residuals;
};

/// Draws a noisy copy of case `number`, whose record is `from`; returns its residual.
double draw_row(const WindowRecords& records, const WindowTransform& transform,
                std::span<const double> from, std::int64_t number, int copy, std::span<double> to) {
  std::vector<double> record(transform.record_size());
  const NoiseDraw draw(transform.noise, number, copy);
  draw_record(records, from, transform.noise, draw, false, record);
  const std::size_t count = transform.components();
  const WindowReading reading =
      read_components(transform, {record, transform.grid.record_samples()}, to.first(count));
  const auto targets = from.last(records.targets.size());
  std::copy(targets.begin(), targets.end(), to.begin() + static_cast<std::ptrdiff_t>(count));
  return reading.residual;
}

/// Draws one noisy copy of each of `cases`; `piece` holds the records from row `first` on.
DrawnRows draw_rows(const WindowRecords& records, const WindowTransform& transform,
                    std::span<const double> piece, std::size_t first,
                    const std::vector<std::int64_t>& cases, int copy, int threads) {
  const std::size_t width = transform.components() + records.targets.size();
  const std::size_t columns = records.rows.columns();
  DrawnRows drawn{std::vector<double>(cases.size() * width), std::vector<double>(cases.size())};
  share_items(threads, cases.size(), [&](std::size_t i, int) {
    const std::size_t at = static_cast<std::size_t>(cases[i]) - first;
    drawn.residuals[i] = draw_row(records, transform, piece.subspan(at * columns, columns),
                                  cases[i], copy, std::span(drawn.rows).subspan(i * width, width));
  });
  return drawn;
}

/// Sets mean and standard deviation of the residuals of noisy records.
void set_residual(WindowTransform& transform, const std::vector<double>& residuals) {
  double sum = 0.0, squares = 0.0;
  for (const double residual : residuals) sum += residual;
  const auto n = static_cast<double>(residuals.size());
  for (const double residual : residuals) squares += (residual - sum / n) * (residual - sum / n);
  transform.residual_mean = sum / n;
  transform.residual_deviation = std::sqrt(squares / n);
}

std::vector<std::int64_t> list_taken(const TakesCase& takes, std::size_t first, std::size_t count) {
  std::vector<std::int64_t> cases;
  cases.reserve(count);
  for (std::size_t i = first; i < first + count; ++i) {
    const auto number = static_cast<std::int64_t>(i);
    if (takes(number)) cases.push_back(number);
  }
  return cases;
}

}  // namespace

RowStore make_component_rows(const WindowRecords& records, const WindowTransform& transform,
                             const TakesCase& takes, int threads, const RowStoreOptions& store,
                             std::vector<double>* residuals) {
  RowStore made(transform.components() + records.targets.size(), store);
  for (int copy = 0; copy < transform.noise.copies; ++copy) {
    const auto append = [&](std::span<const double> piece, std::size_t first, std::size_t count) {
      const DrawnRows drawn = draw_rows(records, transform, piece, first,
                                        list_taken(takes, first, count), copy, threads);
      made.append(drawn.rows);
      if (residuals == nullptr) return;
      residuals->insert(residuals->end(), drawn.residuals.begin(), drawn.residuals.end());
    };
    for_each_piece(records.rows, append, kPieceRows);
  }
  return made;
}

TrainingRows make_window_rows(Dataset& dataset, const RowChoice& choice, const SplitChoice& split,
                              const WindowChoice& window, const NoiseModel& noise, int threads,
                              const RowStoreOptions& store) {
  const std::size_t spare = count_spare(dataset.schema(), noise);
  const WindowGrid grid = make_window_grid(dataset.schema(), window, spare);
  const WindowRecords records = read_window_records(dataset, choice, grid, spare, store);
  noise.validate(records.channels);
  const auto count = static_cast<std::int64_t>(records.rows.row_count());
  const Split parts = make_split(count, split);
  TrainingRows rows;
  rows.usable = count;
  rows.skipped = records.skipped;
  rows.window = make_window_transform(records, parts, noise, window, store);
  rows.inputs = list_components(rows.window->components());
  rows.targets = records.targets;
  std::vector<double> residuals;
  const auto make = [&](Part part, std::vector<double>* part_residuals) {
    const TakesCase takes = [&](std::int64_t row) { return parts.find_part(row) == part; };
    return make_component_rows(records, *rows.window, takes, threads, store, part_residuals);
  };
  rows.train = make(Part::kTrain, &residuals);
  rows.validate = make(Part::kValidate, nullptr);
  rows.test = make(Part::kTest, nullptr);
  set_residual(*rows.window, residuals);
  fit_maps(rows);
  return rows;
}

WindowRecords read_records_for(const WindowTransform& transform, const RowChoice& choice,
                               Dataset& dataset, const RowStoreOptions& store) {
  const ShardSchema& schema = dataset.schema();
  const std::size_t spare = count_spare(schema, transform.noise);
  const WindowGrid& grid = transform.grid;
  const auto beyond = static_cast<std::int64_t>(grid.margin() + spare);
  const std::int64_t end = grid.first + static_cast<std::int64_t>(grid.samples) + beyond;
  if (schema.history_interval != grid.interval || grid.first < beyond ||
      end > static_cast<std::int64_t>(schema.history_samples)) {
    throw InputError(fmt::format(
        "the model takes histories of {} Hz over {} s; those of the data have {} Hz over {} s",
        format_number(1.0 / grid.interval), format_number(static_cast<double>(end) * grid.interval),
        format_number(1.0 / schema.history_interval),
        format_number(static_cast<double>(schema.history_samples) * schema.history_interval)));
  }
  return read_window_records(dataset, choice, grid, spare, store);
}

}  // namespace strut
