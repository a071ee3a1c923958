#include "study/predictions.h"

#include <algorithm>
#include <span>

#include "train/model/evaluate.h"

namespace strut {
namespace {

using Rows = std::vector<std::vector<double>>;

const SeedResult& find_median_seed(const CellResult& cell) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t s = 0; s < cell.seeds.size(); ++s) {
    double sum = 0.0;
    for (const Metrics& m : cell.seeds[s].metrics) sum += m.mean_absolute_percentage;
    order.emplace_back(sum, s);
  }
  std::sort(order.begin(), order.end());
  return cell.seeds[order[(order.size() - 1) / 2].second];
}

Rows read_columns(const RowStore& store, std::size_t first, std::size_t count) {
  Rows rows;
  rows.reserve(store.row_count());
  for_each_piece(store, [&](std::span<const double> values, std::size_t, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = values.subspan(i * store.columns() + first, count);
      rows.emplace_back(row.begin(), row.end());
    }
  });
  return rows;
}

}  // namespace

TestPredictions predict_test_cases(const StudyFolder& folder, const CellResult& cell) {
  TestPredictions made{read_trained_model(folder.root / find_median_seed(cell).model), {}, {}, {}};
  const TrainedModel& model = made.model;
  Dataset dataset({folder.sweep(cell.sweep).root});
  const RowStore test = read_test_rows(model, dataset);
  std::int64_t outside = 0;
  const std::size_t inputs = model.inputs.size(), targets = model.targets.size();
  made.inputs = read_columns(test, 0, inputs);
  made.reference = read_columns(test, inputs, targets);
  made.predicted = read_columns(predict_rows(model, test, &outside), 0, targets);
  return made;
}

}  // namespace strut
