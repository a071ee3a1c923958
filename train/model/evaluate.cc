#include "train/model/evaluate.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "base/error/input_error.h"
#include "io/store/shard_layout.h"
#include "train/network/network.h"
#include "train/window/rows.h"

namespace strut {
namespace {

std::vector<double> read_column(const RowStore& rows, std::size_t column) {
  std::vector<double> values;
  values.reserve(rows.row_count());
  for_each_piece(rows, [&](std::span<const double> piece, std::size_t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values.push_back(piece[i * rows.columns() + column]);
  });
  return values;
}

void require_trained_on(const TrainedModel& model, const Dataset& dataset, const RowStore& usable) {
  if (dataset.plan_hash() != model.plan_hash) {
    throw InputError(
        "the model was trained on data of another plan, so these data have no test part; --part "
        "all takes all cases");
  }
  const auto rows = static_cast<std::int64_t>(usable.row_count());
  if (rows != model.usable) {
    throw InputError(fmt::format(
        "the model was trained on data with {} usable cases, these have {}, so the test part is "
        "unknown; --part all takes all cases",
        model.usable, rows));
  }
}

/// The noise of the training, with another seed for other data: draws depend on row numbers.
NoiseModel choose_noise(NoiseModel noise, const TrainedModel& model, const Dataset& dataset) {
  if (dataset.plan_hash() != model.plan_hash) ++noise.seed;
  return noise;
}

/// Reads the model's inputs and targets, as noisy as the training data.
RowStore read_rows(const TrainedModel& model, Dataset& dataset, EvaluatedPart part,
                   const RowStoreOptions& store) {
  const bool test = part == EvaluatedPart::kTest;
  RowChoice choice{list_names(model.window ? model.window->channels : model.inputs),
                   list_names(model.targets)};
  if (test) choice.samples = model.samples;
  std::optional<Split> split;
  const auto takes = [&](std::int64_t row) {
    return !split || split->find_part(row) == Part::kTest;
  };
  const auto take_test = [&](const RowStore& usable) {
    if (!test) return;
    require_trained_on(model, dataset, usable);
    split = make_split(model.usable, model.split);
  };
  if (model.window) {
    const WindowRecords records = read_records_for(*model.window, choice, dataset, store);
    take_test(records.rows);
    WindowTransform window = *model.window;
    window.noise = choose_noise(window.noise, model, dataset);
    return make_component_rows(records, window, takes, 1, store);
  }
  UsableRows usable = read_usable_rows(dataset, choice, store);
  take_test(usable.rows);
  if (model.noise) {
    return make_noisy_rows(usable.rows, choose_noise(*model.noise, model, dataset), takes, store);
  }
  return split ? take_part(usable.rows, *split, Part::kTest, store) : std::move(usable.rows);
}

}  // namespace

RowStore predict_rows(const TrainedModel& model, const RowStore& rows, std::int64_t* out_of_range) {
  const Predictor predictor(NetworkShape(model.sizes), model.weights);
  const std::size_t n = model.inputs.size(), m = model.targets.size();
  RowStore predicted(m);
  for_each_piece(rows, [&](std::span<const double> values, std::size_t, std::size_t count) {
    std::vector<double> inputs, outputs(count * m);
    inputs.reserve(count * n);
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = values.subspan(i * (n + m), n);
      inputs.insert(inputs.end(), row.begin(), row.end());
      if (model.input_map.calc_excess(row) > 0.0) ++*out_of_range;
    }
    model.input_map.normalize(inputs);
    predictor.predict_rows(inputs.data(), count, outputs.data());
    model.target_map.restore(outputs);
    predicted.append(outputs);
  });
  return predicted;
}

RowStore read_test_rows(const TrainedModel& model, Dataset& dataset, const RowStoreOptions& store) {
  return read_rows(model, dataset, EvaluatedPart::kTest, store);
}

ModelEvaluation evaluate_rows(const TrainedModel& model, const RowStore& rows) {
  ModelEvaluation evaluation;
  evaluation.samples = static_cast<std::int64_t>(rows.row_count());
  const RowStore predicted = predict_rows(model, rows, &evaluation.out_of_range);
  evaluation.metrics.reserve(model.targets.size());
  for (std::size_t target = 0; target < model.targets.size(); ++target) {
    const auto reference = read_column(rows, model.inputs.size() + target);
    evaluation.metrics.push_back(calc_metrics(reference, read_column(predicted, target)));
  }
  return evaluation;
}

ModelEvaluation evaluate_model(const TrainedModel& model, Dataset& dataset, EvaluatedPart part,
                               const RowStoreOptions& store) {
  return evaluate_rows(model, read_rows(model, dataset, part, store));
}

}  // namespace strut
