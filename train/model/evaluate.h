// How well a model identifies the parameters of given cases.
#pragma once

#include <cstdint>
#include <vector>

#include "io/file/row_store.h"
#include "train/data/metrics.h"
#include "train/model/model_file.h"

namespace strut {

enum class EvaluatedPart {
  kTest,  // of the very data it was trained on: what training never saw
  kAll,
};

struct ModelEvaluation {
  std::vector<Metrics> metrics;  // per parameter
  std::int64_t samples = 0;
  std::int64_t out_of_range = 0;  // samples with an input outside of those trained on
};

/// Predicted parameters of rows as recorded, the model's inputs before its targets; adds to
/// `out_of_range` those with an input outside of those trained on.
RowStore predict_rows(const TrainedModel& model, const RowStore& rows, std::int64_t* out_of_range);

/// The rows that the model's training left aside to test it. Throws InputError as evaluate_model.
RowStore read_test_rows(const TrainedModel& model, Dataset& dataset,
                        const RowStoreOptions& store = {});

/// Rows as recorded, the model's inputs before its targets.
ModelEvaluation evaluate_rows(const TrainedModel& model, const RowStore& rows);

/// Throws InputError where the data lacks a column of the model, or is not what the model was
/// trained on and its test part is asked for.
ModelEvaluation evaluate_model(const TrainedModel& model, Dataset& dataset, EvaluatedPart part,
                               const RowStoreOptions& store = {});

}  // namespace strut
