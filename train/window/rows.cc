#include "train/window/rows.h"

#include <cmath>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

/// Records held at a time, shared by the threads.
constexpr std::size_t kPieceRows = 64;

/// One noisy copy of each wanted case of a piece of records.
class PieceWork {
 public:
  PieceWork(const WindowRecords& records, const WindowTransform& transform)
      : records_(&records), transform_(&transform) {}

  struct Result {
    std::vector<double> rows, leftovers;
  };

  Result run(std::span<const double> rows, const std::vector<std::int64_t>& cases,
             std::size_t first, int copy, int threads) const {
    const std::size_t width = transform_->components() + records_->targets.size();
    Result result{std::vector<double>(cases.size() * width), std::vector<double>(cases.size())};
    share_items(threads, cases.size(), [&](std::size_t i, int) {
      const std::size_t at = static_cast<std::size_t>(cases[i]) - first;
      const std::size_t columns = records_->rows.columns();
      result.leftovers[i] = fill(rows.subspan(at * columns, columns), cases[i], copy,
                                 std::span(result.rows).subspan(i * width, width));
    });
    return result;
  }

 private:
  double fill(std::span<const double> from, std::int64_t number, int copy,
              std::span<double> to) const {
    std::vector<double> record(transform_->record_size());
    const NoiseDraw draw(transform_->noise, number, copy);
    draw_record(*records_, from, transform_->noise, draw, false, record);
    const std::size_t count = transform_->components(), targets = records_->targets.size();
    const WindowReading reading =
        read_components(*transform_, {record, transform_->grid.record_samples()}, to.first(count));
    const auto last = from.last(targets);
    std::copy(last.begin(), last.end(), to.begin() + static_cast<std::ptrdiff_t>(count));
    return reading.leftover;
  }

  const WindowRecords* records_;
  const WindowTransform* transform_;
};

/// Mean and standard deviation of what noisy records leave over.
void set_leftover(WindowTransform& transform, const std::vector<double>& leftovers) {
  double sum = 0.0, squares = 0.0;
  for (const double left : leftovers) sum += left;
  const auto n = static_cast<double>(leftovers.size());
  for (const double left : leftovers) squares += (left - sum / n) * (left - sum / n);
  transform.leftover_mean = sum / n;
  transform.leftover_deviation = std::sqrt(squares / n);
}

}  // namespace

RowStore make_component_rows(const WindowRecords& records, const WindowTransform& transform,
                             const TakesCase& takes, int threads, const RowStoreOptions& store,
                             std::vector<double>* leftovers) {
  RowStore made(transform.components() + records.targets.size(), store);
  const PieceWork work(records, transform);
  for (int copy = 0; copy < transform.noise.copies; ++copy) {
    const auto piece = [&](std::span<const double> rows, std::size_t first, std::size_t count) {
      std::vector<std::int64_t> cases;
      cases.reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        const auto number = static_cast<std::int64_t>(first + i);
        if (takes(number)) cases.push_back(number);
      }
      const PieceWork::Result result = work.run(rows, cases, first, copy, threads);
      made.append(result.rows);
      if (leftovers == nullptr) return;
      leftovers->insert(leftovers->end(), result.leftovers.begin(), result.leftovers.end());
    };
    for_each_piece(records.rows, piece, kPieceRows);
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
  std::vector<double> leftovers;
  const auto make = [&](Part part, std::vector<double>* left) {
    const TakesCase takes = [&](std::int64_t row) { return parts.find_part(row) == part; };
    return make_component_rows(records, *rows.window, takes, threads, store, left);
  };
  rows.train = make(Part::kTrain, &leftovers);
  rows.validate = make(Part::kValidate, nullptr);
  rows.test = make(Part::kTest, nullptr);
  set_leftover(*rows.window, leftovers);
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
    throw InputError(
        "the model takes histories of " + format_number(1.0 / grid.interval) + " Hz over " +
        format_number(static_cast<double>(end) * grid.interval) + " s; the data's are of " +
        format_number(1.0 / schema.history_interval) + " Hz over " +
        format_number(static_cast<double>(schema.history_samples) * schema.history_interval) +
        " s");
  }
  return read_window_records(dataset, choice, grid, spare, store);
}

}  // namespace strut
