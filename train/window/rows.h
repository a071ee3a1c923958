// Rows that a network over windows trains on and is judged by.
#pragma once

#include <functional>
#include <vector>

#include "train/data/dataset_source.h"
#include "train/window/basis.h"

namespace strut {

/// True for a case, by its number among the usable ones, that is to be taken.
using TakesCase = std::function<bool(std::int64_t)>;

/// Noisy copies of the cases that `takes` says: the components of each, then its targets; all cases
/// of the first copy before those of the second, so that any beginning is a fair sample. Appends
/// what the directions leave over of each to `leftovers`, where given. The rows do not depend on
/// `threads`.
RowStore make_component_rows(const WindowRecords& records, const WindowTransform& transform,
                             const TakesCase& takes, int threads, const RowStoreOptions& store,
                             std::vector<double>* leftovers = nullptr);

/// Everything for a training: split by case, transform from the training part, noisy copies of each
/// part. `choice.inputs`: history channels. Throws InputError as its steps do.
TrainingRows make_window_rows(Dataset& dataset, const RowChoice& choice, const SplitChoice& split,
                              const WindowChoice& window, const NoiseModel& noise, int threads,
                              const RowStoreOptions& store);

/// Records of a dataset for a model's transform. Throws InputError where the histories have other
/// channels, or another interval, than those trained on.
WindowRecords read_records_for(const WindowTransform& transform, const RowChoice& choice,
                               Dataset& dataset, const RowStoreOptions& store);

}  // namespace strut
