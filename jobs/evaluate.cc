#include "jobs/evaluate.h"

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "jobs/arguments.h"
#include "jobs/command.h"
#include "jobs/progress.h"

namespace strut {
namespace {

Arguments make_arguments() {
  Arguments arguments(
      "strut evaluate MODEL DATA... [OPTIONS]",
      "Lets the network in MODEL identify the parameters of the cases in DATA (a sweep folder,\n"
      "shards of one sweep, or a merged file) and compares them with the true ones: largest error\n"
      "ME, mean absolute error MAE, mean absolute percentage error MAPE, root mean square error\n"
      "RMSE, coefficient of determination R2.",
      "  strut evaluate model.h5 sweep\n  strut evaluate model.h5 other_sweep --part all --json");
  arguments.add_option("part", "PART",
                       "test: the cases that training left aside, of the data it had; all: every\n"
                       "case. By itself test where DATA is of the plan trained on, else all");
  arguments.add_switch("partial", "take a sweep folder that lacks shards as it is");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

}  // namespace

Json make_json(const Model& model, const ModelEvaluation& evaluation) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < evaluation.metrics.size(); ++i) {
    const Metrics& m = evaluation.metrics[i];
    Json values = Json::object();
    values.set("ME", m.largest_error)
        .set("MAE", m.mean_absolute_error)
        .set("MAPE", m.mean_absolute_percentage)
        .set("RMSE", m.rms_error)
        .set("R2", m.r2);
    parameters.set(model.targets[i].name, values);
  }
  Json json = Json::object();
  json.set("parameters", parameters)
      .set("samples", static_cast<long>(evaluation.samples))
      .set("out_of_range", static_cast<long>(evaluation.out_of_range));
  return json;
}

void print_table(const Model& model, const ModelEvaluation& evaluation) {
  std::printf("%-24s%-8s%12s%12s%12s%12s%12s\n", "parameter", "unit", "ME", "MAE", "MAPE %", "RMSE",
              "1 - R2");
  for (std::size_t i = 0; i < evaluation.metrics.size(); ++i) {
    const Metrics& m = evaluation.metrics[i];
    std::printf("%-24s%-8s%12.4g%12.4g%12.4g%12.4g%12.4g\n", model.targets[i].name.c_str(),
                model.targets[i].unit.c_str(), m.largest_error, m.mean_absolute_error,
                m.mean_absolute_percentage, m.rms_error, 1.0 - m.r2);
  }
  std::fflush(stdout);
  if (evaluation.out_of_range > 0) {
    std::cerr << "strut: " << format_count(evaluation.out_of_range) << " of "
              << format_count(evaluation.samples)
              << " cases have inputs outside of the range trained on\n";
  }
}

int run_evaluate(const std::vector<std::string>& words) {
  Arguments arguments = make_arguments();
  if (!arguments.parse(words)) return kExitDone;
  const auto& names = arguments.positional();
  if (names.size() < 2) throw arguments.usage_error("expected MODEL and DATA");
  const Model model = read_model(names.front());
  DatasetOptions options;
  options.partial = arguments.is_on("partial");
  options.histories = model.window.has_value();
  Dataset dataset({names.begin() + 1, names.end()}, options);
  const int own = dataset.plan_hash() == model.plan_hash ? 0 : 1;
  const bool all = arguments.choice_or("part", own, {"test", "all"}) == 1;
  const EvaluatedPart part = all ? EvaluatedPart::kAll : EvaluatedPart::kTest;
  const ModelEvaluation evaluation = evaluate_model(model, dataset, part);
  if (arguments.is_on("json")) {
    std::cout << make_json(model, evaluation).dump() << "\n";
    return kExitDone;
  }
  std::cout << format_count(evaluation.samples) << (all ? " cases\n" : " cases of the test part\n");
  print_table(model, evaluation);
  return kExitDone;
}

}  // namespace strut
