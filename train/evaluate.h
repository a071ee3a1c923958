// How well a model identifies the parameters of given cases.
#pragma once

#include <cstdint>
#include <vector>

#include "io/row_store.h"
#include "train/metrics.h"
#include "train/model_file.h"

namespace strut {

enum class EvaluatedPart {
  kTest,  // of the very data it was trained on: what training never saw
  kAll,
};

struct Evaluation {
  std::vector<Metrics> metrics;  // per parameter
  std::int64_t samples = 0;
  std::int64_t out_of_range = 0;  // samples with an input outside of those trained on
};

/// Rows as recorded, the model's inputs before its targets.
Evaluation evaluate_rows(const Model& model, const RowStore& rows);

/// Throws InputError where the data lacks a column of the model, or is not what the model was
/// trained on and its test part is asked for.
Evaluation evaluate_model(const Model& model, Dataset& dataset, EvaluatedPart part,
                          const RowStoreOptions& store = {});

}  // namespace strut
