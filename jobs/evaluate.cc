#include "jobs/evaluate.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "base/text/nearest_name.h"
#include "identify/history.h"
#include "io/store/shard_layout.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/unsealed.h"

namespace strut {

Json make_json(const TrainedModel& model, const ModelEvaluation& evaluation) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < evaluation.metrics.size(); ++i) {
    Json values = Json::object();
    for (const MetricInfo& metric : kMetrics) {
      values[metric.name] = evaluation.metrics[i].*metric.value;
    }
    parameters[model.targets[i].name] = values;
  }
  Json json = Json::object();
  json["parameters"] = parameters;
  json["samples"] = evaluation.samples;
  json["out_of_range"] = evaluation.out_of_range;
  return json;
}

void print_table(const TrainedModel& model, const ModelEvaluation& evaluation) {
  std::cout << fmt::format("{:<24}{:<8}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "parameter", "unit", "ME",
                           "MAE", "MAPE %", "RMSE", "1 - R2");
  for (std::size_t i = 0; i < evaluation.metrics.size(); ++i) {
    const Metrics& m = evaluation.metrics[i];
    std::cout << fmt::format("{:<24}{:<8}{:12.4g}{:12.4g}{:12.4g}{:12.4g}{:12.4g}\n",
                             model.targets[i].name, model.targets[i].unit, m.largest_error,
                             m.mean_absolute_error, m.mean_absolute_percentage, m.rms_error,
                             1.0 - m.r2);
  }
  if (evaluation.out_of_range > 0) {
    print_note(fmt::format("{} of {} cases have inputs outside of the range trained on",
                           format_count(evaluation.out_of_range),
                           format_count(evaluation.samples)));
  }
}

void suggest_next_identify(const std::string& file, const TrainedModel& model) {
  std::vector<std::string> columns = list_names(model.inputs);
  if (model.window) {
    columns = list_names(model.window->channels);
    columns.insert(columns.begin(), kTimeColumn);
  }
  suggest_next({"strut", "identify", file, "MEASURED.csv"},
               "a table with columns " + join_names(columns));
}

Arguments describe_evaluate() {
  Arguments arguments(
      "strut evaluate MODEL DATA... [OPTIONS]",
      "Identifies the parameters of the cases in DATA (a sweep folder, shards of one sweep, or a\n"
      "merged file) by the network in MODEL and compares them with the true values: largest error\n"
      "ME, mean absolute error MAE, mean absolute percentage error MAPE, root mean square error\n"
      "RMSE, coefficient of determination R2.",
      "  strut evaluate model.h5 cars\n  strut evaluate model.h5 other_sweep --part all --json");
  arguments.add_operand(ArgumentValue::file("MODEL", {"h5"}));
  arguments.add_operands(ArgumentValue::path("DATA", {"h5", "hdf5"}));
  arguments.add_option("part", ArgumentValue::one_of({"test", "all"}),
                       "test: the test cases of the training data; all: every case. Default: test\n"
                       "where DATA belongs to the plan trained on, else all");
  arguments.add_switch("partial", "accept a sweep folder with missing shards");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_evaluate(const Arguments& arguments) {
  const auto& names = arguments.positional();
  if (names.size() < 2)
    throw arguments.usage_error(
        "expected MODEL, a file of strut train, and DATA, a sweep folder, shards or a merged file");
  const TrainedModel model = load_model(names.front());
  DatasetOptions options;
  options.partial = arguments.is_on("partial");
  options.histories = model.window.has_value();
  Dataset dataset({names.begin() + 1, names.end()}, options);
  note_unsealed_data({names.begin() + 1, names.end()});
  const int own = dataset.plan_hash() == model.plan_hash ? 0 : 1;
  const bool all = arguments.choice_or("part", own) == 1;
  const EvaluatedPart part = all ? EvaluatedPart::kAll : EvaluatedPart::kTest;
  const ModelEvaluation evaluation = [&] {
    const Stage stage("evaluation");
    const ProgressLine line("evaluating cases");
    return evaluate_model(model, dataset, part);
  }();
  if (arguments.is_on("json")) {
    std::cout << format_json(make_json(model, evaluation)) << "\n";
  } else {
    std::cout << format_count(evaluation.samples)
              << (all ? " cases\n" : " cases of the test part\n");
    print_table(model, evaluation);
  }
  suggest_next_identify(names.front(), model);
  return kExitDone;
}

}  // namespace strut
