// strut evaluate: how well a trained network identifies the parameters of a sweep's cases.
#pragma once

#include <string>
#include <vector>

#include "jobs/json.h"
#include "train/evaluate.h"

namespace strut {

int run_evaluate(const std::vector<std::string>& arguments);

/// {"parameters": {"front_stiffness": {"ME":, "MAE":, "MAPE":, "RMSE":, "R2":}, ...}, "samples":}
Json make_json(const Model& model, const ModelEvaluation& evaluation);

/// The same as a table for people.
void print_table(const Model& model, const ModelEvaluation& evaluation);

}  // namespace strut
