// strut evaluate: how well a trained network identifies the parameters of a sweep's cases.
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

/// The same as a table for people.
void print_table(const TrainedModel& model, const ModelEvaluation& evaluation);

/// Names `strut identify` as what comes after a model in `file`, and what it takes.
void suggest_next_identify(const std::string& file, const TrainedModel& model);

}  // namespace strut
