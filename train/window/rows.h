// Makes the training and test rows of a network over windows.
#pragma once

#include <functional>
#include <vector>

#include "train/data/dataset_source.h"
#include "train/window/basis.h"

namespace strut {

/// True for the cases to take, by their numbers among the usable ones.
using TakesCase = std::function<bool(std::int64_t)>;

/// Makes noisy copies of the cases that `takes` selects, each row its components, then its targets.
/// The first copy of all cases comes before the second, so that the first rows are an unbiased
/// sample. Appends the residual of each row to `residuals`, if given. No result depends on
/// `threads`.
RowStore make_component_rows(const WindowRecords& records, const WindowTransform& transform,
                             const TakesCase& takes, int threads, const RowStoreOptions& store,
                             std::vector<double>* residuals = nullptr);

/// Splits the cases, computes the transform from the training part and makes noisy copies of each
/// part. `choice.inputs`: history channels. Throws InputError as its steps do.
TrainingRows make_window_rows(Dataset& dataset, const RowChoice& choice, const SplitChoice& split,
                              const WindowChoice& window, const NoiseModel& noise, int threads,
                              const RowStoreOptions& store);

/// Reads the records of a dataset for a model's transform. Throws InputError if its histories lack
/// a channel, or differ in interval or duration from those that the model was trained on.
WindowRecords read_records_for(const WindowTransform& transform, const RowChoice& choice,
                               Dataset& dataset, const RowStoreOptions& store);

}  // namespace strut
