#include "jobs/simulate/rig.h"

#include <fmt/format.h>

#include "base/text/format_number.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"
#include "jobs/simulate/rig_report.h"
#include "jobs/simulate/run_file.h"
#include "model/longest_step.h"
#include "model/rig/rig_system.h"
#include "model/sensor/read_out.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"

namespace strut {
namespace {

RigSpec load_rig(const CaseSource& source) {
  RigSpec rig = read_rig(source.vehicle);
  for (const std::string& setting : source.settings) {
    apply_rig_setting(rig, setting);
  }
  return rig;
}

/// Reports a failed run: throws InputError if a shorter step succeeds; otherwise prints the cause
/// and returns exit code 1.
int explain_failure(const Arguments& arguments, const SimulateOptions& options, const RigSpec& rig,
                    const RigManeuver& maneuver, const SamplePlan& plan, double failure_time) {
  const std::string at = format_number(failure_time) + " s";
  StepOptions shorter = options.integrate.step;
  shorter.step *= kRetryFraction;
  if (simulate_rig(rig, maneuver.inputs, shorter, plan).is_done()) {
    throw InputError(
        fmt::format("--step = {} s: {} in {} diverged at t = {}; a step of {} s succeeds",
                    format_number(options.integrate.step.step), options.source.vehicle.string(),
                    options.source.maneuver.string(), at, format_number(shorter.step)));
  }
  print_error(
      fmt::format("the run failed at t = {}: the motion is no longer finite, even with a step of "
                  "{} s; nothing was "
                  "written",
                  at, format_number(shorter.step)));
  suggest_again_with_setting(arguments, "NAME=VALUE",
                             "with a parameter closer to that of a real rig");
  return kExitNegative;
}

void describe_run(const SimulateOptions& options, const RigSpec& rig, RunRecord& run) {
  for (const RigParameter& p : list_rig_parameters(rig.kind)) {
    if (p.is_effect && p.get(rig) == p.default_value) continue;
    run.parameters.push_back({p.name, p.unit, p.description, p.get(rig)});
  }
  const StepOptions& step = options.integrate.step;
  run.provenance = describe_program(options.source);
  run.provenance.insert(run.provenance.end(),
                        {{"integrator", options.integrator_name()},
                         {"step", format_number(step.step) + " s"},
                         {"events", step.locate_events ? "located" : "not located"},
                         {"event_count", std::to_string(run.results.event_count)}});
}

}  // namespace

int run_rig(const Arguments& arguments, const SimulateOptions& given) {
  if (given.integrator == Integrator::kCvode) {
    throw InputError("--integrator = cvode: for cars only; must be rk4 or abm4 for a rig");
  }
  const RigSpec rig = load_rig(given.source);
  const SimulateOptions options = adapt_steps(given, calc_longest_step(rig));
  const RigManeuver maneuver = read_rig_maneuver(options.source.maneuver, rig.kind);
  const RunFormat format = check_output(options);
  check_rate(options.rate, maneuver.duration);
  check_step_count(options, maneuver.duration);
  SamplePlan plan;
  plan.duration = maneuver.duration;
  plan.interval = 1.0 / options.rate;
  plan.snapshot = false;

  RunRecord run;
  run.channels = &get_rig_info(rig.kind).channels;
  run.kept = list_kept(get_rig_info(rig.kind), options.channels);
  const double start = now();
  const ReadOut out(*run.channels, {&rig.effects});
  {
    const ProgressLine line("simulating " + format_duration(maneuver.duration));
    run.results = simulate_readings(out, plan, [&](const SamplePlan& record) {
      return simulate_rig(rig, maneuver.inputs, options.integrate.step, record);
    });
  }
  const double seconds = now() - start;
  if (!run.results.is_done()) {
    return explain_failure(arguments, options, rig, maneuver, plan, run.results.get_failure_time());
  }
  describe_run(options, rig, run);
  write_run(options.output, format, run);
  if (!options.report.empty()) {
    write_rig_report(options, run);
    suggest_page((options.report / "report.html").string());
  }
  print_note(fmt::format("{}: {} samples of {} channels; {:.4g} s simulated in {:.3g} s",
                         options.output.string(), run.results.sample_count, run.kept.size(),
                         maneuver.duration, seconds));
  if (options.report.empty()) {
    suggest_next({"strut", "compare", "CAMPAIGN.toml", "-o", "comparison"},
                 "to compare measured runs with this rig; or repeat this one with --report DIR");
  }
  return kExitDone;
}

}  // namespace strut
