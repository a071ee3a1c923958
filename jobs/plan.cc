#include "jobs/plan.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "base/text/format_number.h"
#include "io/format/json.h"
#include "jobs/case/plan_estimate.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/failures.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/step_warning.h"
#include "model_files/parameters.h"
#include "sweep/case_order.h"
#include "sweep/choose_settings.h"
#include "sweep/folder.h"

namespace strut {
namespace {

std::string describe_order(const Plan& plan) {
  const SweepRequest& request = plan.request();
  if (request.sample.method != SampleMethod::kGrid) return "by number";
  if (request.shuffle) {
    return "shuffled: any part that has run is a random sample of the whole";
  }
  std::string slow;
  for (const std::size_t a : find_slow_axes(request)) {
    slow += (slow.empty() ? "" : ", ") + request.grid.axes()[a].name;
  }
  return fmt::format("the grid's, slowest {}, which each take a new mechanism or duration", slow);
}

std::string describe_cases(const Plan& plan) {
  const std::int64_t count = plan.case_count();
  switch (plan.request().sample.method) {
    case SampleMethod::kLatinHypercube:
      return fmt::format("{}, a Latin hypercube", count);
    case SampleMethod::kSobol:
      return fmt::format("{}, a Sobol sequence", count);
    case SampleMethod::kGrid:
      break;
  }
  return fmt::format("{} of the grid's {} points", count, plan.point_count());
}

void print_strata(const Plan& plan) {
  std::cout << fmt::format("strata    {} by {}\n", plan.strata().size(), plan.request().sample.by);
  std::cout << fmt::format("{:>9} {:>14} {:>14} {:>16} {:>16}\n", "stratum", "from", "to", "cases",
                           "drawn");
  std::size_t number = 0;
  for (const Stratum& stratum : plan.strata()) {
    std::cout << fmt::format("{:>9} {:>14.7g} {:>14.7g} {:>16} {:>16}\n", ++number, stratum.lower,
                             stratum.upper, stratum.population, stratum.drawn);
  }
}

/// "abm4 1 ms, table, given" or with the error by which it was chosen.
std::string describe_setting(const Plan& plan, const std::optional<IntegratorChoice>& choice,
                             const std::optional<double>& step_error) {
  const SweepRequest& request = plan.request();
  const std::string setting = describe_integrator(request.integrate);
  if (!choice && request.accuracy > 0.0) return setting + ", as it was planned";
  if (!choice && !step_error) return setting + ", as the file says";
  if (!choice) {
    return fmt::format(
        "{}, as the file says; a quarter of the step changes results by {:.1e} of what a channel "
        "moves in a run",
        setting, *step_error);
  }
  if (choice->cases == 0) return setting + ", since none of a few cases has a result";
  if (std::isinf(choice->error)) return setting + ", since no candidate is stable";
  return fmt::format(
      "{}: error {:.1e} of what a channel moves in a run ({} the {:g} asked), on {} cases", setting,
      choice->error, choice->error <= request.accuracy ? "below" : "above", request.accuracy,
      choice->cases);
}

void print_text(const Plan& plan, const std::optional<IntegratorChoice>& choice,
                const std::optional<double>& step_error, const SweepEstimate& estimate) {
  std::cout << fmt::format("cases     {}\n", describe_cases(plan));
  print_strata(plan);
  std::cout << fmt::format(
      "order     {}\n"
      "runs      {}\n"
      "setting   {}\n"
      "shards    {} of up to {}\n"
      "time      about {}, {} on {} (an estimate, from {})\n"
      "size      about {} (an estimate)\n"
      "plan      {}\n",
      describe_order(plan),
      ends_at_snapshot(plan.request()) ? "each until its snapshot; nothing after it is recorded"
                                       : "each for its duration",
      describe_setting(plan, choice, step_error), plan.shard_count(),
      format_count(plan.request().shard_cases, "case"),
      describe_core_seconds(estimate.core_seconds), format_duration(estimate.seconds()),
      format_count(estimate.cores, "core"), format_count(estimate.measured, "case"),
      format_bytes(estimate.bytes), plan.hash());
}

void print_json(const Plan& plan, const std::optional<IntegratorChoice>& choice,
                const std::optional<double>& step_error, const SweepEstimate& estimate,
                const std::optional<SweepFolder>& folder) {
  Json layers = Json::array();
  for (const Stratum& stratum : plan.strata()) {
    layers.push_back(Json{{"lower", stratum.lower},
                          {"upper", stratum.upper},
                          {"population", stratum.population},
                          {"drawn", stratum.drawn}});
  }
  std::cout << format_json(
                   Json{{"points", plan.point_count()},
                        {"cases", plan.case_count()},
                        {"by", plan.request().sample.by},
                        {"layers", layers},
                        {"shuffled", plan.request().shuffle},
                        {"until_snapshot", ends_at_snapshot(plan.request())},
                        {"setting", describe_integrator(plan.request().integrate)},
                        {"setting_error",
                         choice && std::isfinite(choice->error) ? Json(choice->error) : Json()},
                        {"step_error",
                         step_error && std::isfinite(*step_error) ? Json(*step_error) : Json()},
                        {"shards", plan.shard_count()},
                        {"shard_cases", plan.request().shard_cases},
                        {"estimated_seconds", estimate.seconds()},
                        {"estimated_core_hours", estimate.core_seconds / 3600.0},
                        {"estimated_bytes", estimate.bytes},
                        {"cores", estimate.cores},
                        {"plan_hash", plan.hash()},
                        {"folder", folder ? Json(folder->root.string()) : Json()}})
            << "\n";
}

void warn_of_step(const SweepRequest& request) {
  if (request.integrate.solver == Solver::kCvode) return;
  const StepOptions& step = request.integrate.options.step;
  const double longest = find_longest_step(request);
  const auto warn = [&](const char* key, double value) {
    return warn_of_long_step(fmt::format("{}: integrate.{}", request.path.string(), key), value,
                             "some cases", longest);
  };
  if (!warn("step", step.step)) warn("coarse_step", step.coarse_step);
}

void warn_of_step_error(const std::optional<double>& error) {
  constexpr double kLarge = 0.01;
  if (!error || *error <= kLarge) return;
  print_note(fmt::format(
      "warning: the step that the file gives is too long: results change by {} of what a channel "
      "moves in a run if it is quartered; without the keys of [integrate], plan chooses a setting",
      std::isfinite(*error) ? fmt::format("{:.2g}", *error) : "all"));
}

void warn_of_snapshot(const SweepRequest& request) {
  const ManeuverSpec& maneuver = request.base.maneuver;
  if (!request.snapshot.on || maneuver.road.shape != BumpShape::kNone) return;
  print_note(
      fmt::format("warning: the maneuver has no bump; snapshots are taken where one would be, {} "
                  "m ahead; record.history keeps whole runs",
                  format_number(maneuver.bump_distance)));
}

void warn(const Plan& plan, const SweepEstimate& estimate) {
  if (estimate.without_event > 0) {
    print_note(fmt::format(
        "warning: {} of {} simulated end before the snapshot's line; a longer duration may help",
        estimate.without_event, format_count(estimate.measured, "case")));
  }
  for (const ImpossibleCase& end : find_impossible_ends(plan)) {
    print_note(fmt::format("warning: the end of {} is impossible; {}", end.axis,
                           describe_case(plan, end.case_id, end.reason)));
  }
  if (estimate.failed == 0) return;
  print_note(fmt::format("warning: failures among {} simulated: {}; the first is {}",
                         format_count(estimate.measured, "case"), estimate.failed,
                         describe_case(plan, estimate.first_failed, estimate.first_reason)));
}

/// Chooses what the sweep file leaves open, by simulating a few cases.
std::optional<IntegratorChoice> choose(SweepRequest& request) {
  const Stage stage("choose");
  const ProgressLine line(request.accuracy > 0.0
                              ? "measuring the error of integrators on a few cases"
                              : "choosing the size of shards");
  return choose_settings(request);
}

/// Simulates a few cases for the estimate.
SweepEstimate estimate_time(const Plan& plan) {
  const Stage stage("estimate");
  const ProgressLine line("simulating a few cases for an estimate");
  return estimate_sweep(plan, list_kernels().front());
}

}  // namespace

Arguments describe_plan() {
  Arguments arguments(
      "strut plan SWEEP.toml -o DIR [OPTIONS]",
      "Reads a sweep file (all keys: docs/sweeps.md), draws its cases and creates the folder DIR,\n"
      "which `strut run` fills. The folder contains copies of all files that the sweep names. "
      "Planning\n"
      "the same sweep again changes nothing; a different sweep in the same folder is refused.",
      "  strut plan examples/sweeps/paper.toml --dry-run\n"
      "  strut plan examples/sweeps/paper.toml -o cars");
  arguments.add_operand(ArgumentValue::file("SWEEP.toml", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::folder("DIR"), "folder to create");
  arguments.add_switch("dry-run", "print strata, shards, estimated time and bytes; write nothing");
  arguments.add_switch("json", "print JSON instead of text");
  return arguments;
}

int run_plan(const Arguments& arguments) {
  const std::string& sweep = arguments.only_operand();
  const bool dry = arguments.is_on("dry-run");
  if (!dry && !arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");

  if (!dry) check_output_folder("output", arguments.text("output"));
  SweepRequest request = read_request(sweep);
  // A folder that is planned keeps its choices.
  const bool is_planned =
      !dry && std::filesystem::exists(SweepFolder{arguments.text("output")}.plan());
  const std::optional<IntegratorChoice> choice = is_planned ? std::nullopt : choose(request);
  Plan plan(request);
  check_plan(plan);
  std::optional<SweepFolder> folder;
  if (!dry) {
    folder = make_sweep_folder(arguments.text("output"), plan);
    plan = open_sweep_folder(*folder);  // an earlier version may have planned it
  }
  const bool is_given = !is_planned && !choice;
  const std::optional<double> step_error =
      is_given ? measure_step_error(plan.request()) : std::nullopt;
  const SweepEstimate estimate = estimate_time(plan);
  arguments.is_on("json") ? print_json(plan, choice, step_error, estimate, folder)
                          : print_text(plan, choice, step_error, estimate);
  warn_of_step_error(step_error);
  warn_of_step(plan.request());
  warn_of_snapshot(plan.request());
  warn(plan, estimate);
  if (folder) {
    print_note(folder->root.string() + ": planned");
    suggest_next({"strut", "run", folder->root.string()});
  } else {
    suggest_next({"strut", "plan", sweep, "-o", arguments.text_or("output", "cars")});
  }
  return kExitDone;
}

}  // namespace strut
