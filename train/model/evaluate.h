// Evaluates how accurately a model identifies the parameters of given cases.
#pragma once

#include <cstdint>
#include <vector>

#include "io/file/row_store.h"
#include "train/data/metrics.h"
#include "train/model/model_file.h"

namespace strut {

enum class EvaluatedPart {
  kTest,  // the test part of the training data, which training never saw
  kAll,
};

struct ModelEvaluation {
  std::vector<Metrics> metrics;  // per parameter
  std::int64_t samples = 0;
  std::int64_t out_of_range = 0;  // samples with an input outside of the training range
};

/// Predicts the parameters of recorded rows, the model's inputs, then its targets; adds the number
/// of rows with an input outside of the training range to `out_of_range`.
RowStore predict_rows(const TrainedModel& model, const RowStore& rows, std::int64_t* out_of_range);

/// Reads the test part of the model's training data. Throws InputError as evaluate_model does.
RowStore read_test_rows(const TrainedModel& model, Dataset& dataset,
                        const RowStoreOptions& store = {});

/// Evaluates recorded rows, the model's inputs, then its targets.
ModelEvaluation evaluate_rows(const TrainedModel& model, const RowStore& rows);

/// Throws InputError if the dataset lacks a column of the model, or if `part` is the test part and
/// the model was not trained on this dataset.
ModelEvaluation evaluate_model(const TrainedModel& model, Dataset& dataset, EvaluatedPart part,
                               const RowStoreOptions& store = {});

}  // namespace strut
