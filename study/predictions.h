// Predictions of a study's trained network and the true values, case by case.
#pragma once

#include <vector>

#include "study/results.h"
#include "train/model/model_file.h"

namespace strut {

/// The test cases of a model and its predictions of their parameters, one row per case.
struct TestPredictions {
  TrainedModel model;
  std::vector<std::vector<double>> inputs, reference, predicted;
};

/// Predicts the test cases of a cell by its median training: the seed whose mean absolute
/// percentage error, summed over the parameters, is in the middle. Throws InputError.
TestPredictions predict_test_cases(const StudyFolder& folder, const CellResult& cell);

}  // namespace strut
