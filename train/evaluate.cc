#include "train/evaluate.h"

#include <algorithm>

#include "io/input_error.h"
#include "io/shard_layout.h"
#include "train/network.h"

namespace strut {
namespace {

/// Predicted parameters of all rows, and how many lie outside of the model's range.
RowStore predict(const Model& model, const RowStore& rows, std::int64_t* out_of_range) {
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

std::vector<double> read_column(const RowStore& rows, std::size_t column) {
  std::vector<double> values;
  values.reserve(rows.row_count());
  for_each_piece(rows, [&](std::span<const double> piece, std::size_t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values.push_back(piece[i * rows.columns() + column]);
  });
  return values;
}

void require_trained_on(const Model& model, const Dataset& dataset, const UsableRows& usable) {
  if (dataset.plan_hash() != model.plan_hash) {
    throw InputError(
        "the data is of another plan than the model was trained on, so it has no "
        "test part of it; --part all takes all cases");
  }
  const auto rows = static_cast<std::int64_t>(usable.rows.row_count());
  if (rows != model.usable) {
    throw InputError("the model was trained on data with " + std::to_string(model.usable) +
                     " usable cases, this has " + std::to_string(rows) +
                     "; its test part cannot be told; --part all takes all cases");
  }
}

}  // namespace

Evaluation evaluate_rows(const Model& model, const RowStore& rows) {
  Evaluation evaluation;
  evaluation.samples = static_cast<std::int64_t>(rows.row_count());
  const RowStore predicted = predict(model, rows, &evaluation.out_of_range);
  evaluation.metrics.reserve(model.targets.size());
  for (std::size_t target = 0; target < model.targets.size(); ++target) {
    const auto reference = read_column(rows, model.inputs.size() + target);
    evaluation.metrics.push_back(calc_metrics(reference, read_column(predicted, target)));
  }
  return evaluation;
}

Evaluation evaluate_model(const Model& model, Dataset& dataset, EvaluatedPart part,
                          const RowStoreOptions& store) {
  RowChoice choice{list_names(model.inputs), list_names(model.targets)};
  if (part == EvaluatedPart::kAll) {
    return evaluate_rows(model, read_usable_rows(dataset, choice, store).rows);
  }
  choice.samples = model.samples;
  const UsableRows usable = read_usable_rows(dataset, choice, store);
  require_trained_on(model, dataset, usable);
  const Split split = make_split(model.usable, model.split);
  return evaluate_rows(model, take_part(usable.rows, split, Part::kTest, store));
}

}  // namespace strut
