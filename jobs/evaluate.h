// strut evaluate: errors of a trained network on the cases of a sweep.
#pragma once

#include <string>

#include "io/format/json.h"
#include "jobs/cli/arguments.h"
#include "train/model/evaluate.h"

namespace strut {

Arguments describe_evaluate();
int run_evaluate(const Arguments& arguments);

/// {"parameters": {"front_stiffness": {"ME":, "MAE":, "MAPE":, "RMSE":, "R2":}, ...}, "samples":}
Json make_json(const TrainedModel& model, const ModelEvaluation& evaluation);

/// Prints the same as a table, and a note about inputs out of range.
void print_table(const TrainedModel& model, const ModelEvaluation& evaluation);

/// Names `strut identify` as what comes after a model in `file`, and what it takes.
void suggest_next_identify(const std::string& file, const TrainedModel& model);

}  // namespace strut
