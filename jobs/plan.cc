#include "jobs/plan.h"

#include <cstdio>
#include <iostream>
#include <optional>

#include "io/format/json.h"
#include "jobs/case/plan_estimate.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "model_files/parameters.h"
#include "sweep/case_order.h"
#include "sweep/folder.h"

namespace strut {
namespace {

std::string describe_order(const Plan& plan) {
  const SweepRequest& request = plan.request();
  if (request.sample.method != SampleMethod::kGrid) return "by number";
  if (request.shuffle) {
    return "shuffled: whatever part of it has run is a random sample of the whole";
  }
  std::string slow;
  for (const std::size_t a : find_slow_axes(request)) {
    slow += (slow.empty() ? "" : ", ") + request.grid.axes()[a].name;
  }
  return "the grid's, slowest " + slow + ", which each take a new mechanism or duration";
}

std::string describe_cases(const Plan& plan) {
  const std::string count = std::to_string(plan.case_count());
  if (plan.request().sample.method == SampleMethod::kLatinHypercube) {
    return count + ", a Latin hypercube";
  }
  if (plan.request().sample.method == SampleMethod::kSobol) return count + ", a Sobol sequence";
  return count + " of the grid's " + std::to_string(plan.point_count()) + " points";
}

void print_layers(const Plan& plan) {
  std::cout << "layers    " << plan.strata().size() << " by " << plan.request().sample.by << "\n";
  char line[160];
  std::snprintf(line, sizeof line, "%9s %14s %14s %16s %16s\n", "layer", "from", "to", "cases",
                "drawn");
  std::cout << line;
  std::size_t number = 0;
  for (const Stratum& layer : plan.strata()) {
    std::snprintf(line, sizeof line, "%9zu %14.7g %14.7g %16lld %16lld\n", ++number, layer.lower,
                  layer.upper, static_cast<long long>(layer.population),
                  static_cast<long long>(layer.drawn));
    std::cout << line;
  }
}

void print_text(const Plan& plan, const SweepEstimate& estimate) {
  std::cout << "cases     " << describe_cases(plan) << "\n";
  print_layers(plan);
  std::cout << "order     " << describe_order(plan) << "\nshards    " << plan.shard_count()
            << " of up to " << plan.request().shard_cases << " cases\ntime      about "
            << format_duration(estimate.seconds) << " on " << estimate.cores
            << " cores (an estimate, from " << estimate.measured << " cases)\nsize      about "
            << format_bytes(estimate.bytes) << " (an estimate, before compression)\nplan      "
            << plan.hash() << "\n";
}

void print_json(const Plan& plan, const SweepEstimate& estimate,
                const std::optional<SweepFolder>& folder) {
  Json layers = Json::array();
  for (const Stratum& layer : plan.strata()) {
    layers.push_back(Json{{"lower", layer.lower},
                          {"upper", layer.upper},
                          {"population", layer.population},
                          {"drawn", layer.drawn}});
  }
  std::cout << format_json(Json{{"points", plan.point_count()},
                                {"cases", plan.case_count()},
                                {"by", plan.request().sample.by},
                                {"layers", layers},
                                {"shuffled", plan.request().shuffle},
                                {"shards", plan.shard_count()},
                                {"shard_cases", plan.request().shard_cases},
                                {"estimated_seconds", estimate.seconds},
                                {"estimated_bytes", estimate.bytes},
                                {"cores", estimate.cores},
                                {"plan_hash", plan.hash()},
                                {"folder", folder ? Json(folder->root.string()) : Json()}})
            << "\n";
}

void warn(const SweepEstimate& estimate) {
  if (estimate.without_event == estimate.measured) {
    print_note("warning: none of the " + std::to_string(estimate.measured) +
               " cases looked at meets the snapshot's line; a longer duration may");
  }
  if (estimate.failed == estimate.measured) {
    print_note("warning: all of the " + std::to_string(estimate.measured) +
               " cases looked at fail; `strut simulate` on one of them says why");
  }
}

/// From a few cases simulated right now.
SweepEstimate estimate_time(const Plan& plan) {
  const Stage stage("estimate");
  const ProgressLine line("simulating a few cases for an estimate");
  return estimate_sweep(plan, list_kernels().front());
}

}  // namespace

Arguments describe_plan() {
  Arguments arguments(
      "strut plan SWEEP.toml -o DIR [OPTIONS]",
      "Reads a sweep file (every key: docs/sweeps.md), draws its cases and makes the folder DIR\n"
      "that `strut run` fills. The folder holds copies of every file that the sweep names. "
      "Planning\n"
      "the same again changes nothing; another sweep in the same folder is refused.",
      "  strut plan examples/sweeps/paper.toml --dry-run\n"
      "  strut plan examples/sweeps/paper.toml -o cars");
  arguments.add_operand(ArgumentValue::file("SWEEP.toml", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::folder("DIR"), "folder to make");
  arguments.add_switch("dry-run", "print layers, shards, estimated time and bytes; write nothing");
  arguments.add_switch("json", "print JSON instead of text");
  return arguments;
}

int run_plan(const Arguments& arguments) {
  if (arguments.positional().size() != 1) {
    throw arguments.usage_error(std::to_string(arguments.positional().size()) +
                                " files; expected SWEEP.toml");
  }
  const bool dry = arguments.is_on("dry-run");
  if (!dry && !arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");

  if (!dry) check_output_folder("output", arguments.text("output"));
  const Plan plan(read_request(arguments.positional().front()));
  check_plan(plan);
  std::optional<SweepFolder> folder;
  if (!dry) folder = make_sweep_folder(arguments.text("output"), plan);
  const SweepEstimate estimate = estimate_time(plan);
  arguments.is_on("json") ? print_json(plan, estimate, folder) : print_text(plan, estimate);
  warn(estimate);
  if (folder) {
    print_note(folder->root.string() + ": planned");
    suggest_next({"strut", "run", folder->root.string()});
  } else {
    suggest_next({"strut", "plan", arguments.positional().front(), "-o",
                  arguments.text_or("output", "cars")});
  }
  return kExitDone;
}

}  // namespace strut
