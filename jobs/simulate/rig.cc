#include "jobs/simulate/rig.h"

#include <chrono>
#include <cstdio>

#include "base/text/format_number.h"
#include "jobs/case/run_file.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"
#include "model/rig/rig_system.h"
#include "model/sensor/read_out.h"
#include "model_files/parameters.h"
#include "model_files/read_rig.h"

namespace strut {
namespace {

RigSpec load_rig(const CaseSource& source) {
  RigSpec rig = read_rig(source.vehicle);
  for (const std::string& setting : source.settings) {
    const auto [name, value] = parse_setting(setting);
    set_rig_parameter(rig, name, value);
  }
  return rig;
}

/// Its step, if a shorter one gets through; else exit code 1 is the answer.
int explain_failure(const Arguments& arguments, const SimulateOptions& options, const RigSpec& rig,
                    const RigManeuver& maneuver, const SamplePlan& plan, double failure_time) {
  const std::string at = format_number(failure_time) + " s";
  StepOptions shorter = options.integrate.step;
  shorter.step *= kRetryFraction;
  if (simulate_rig(rig, maneuver.inputs, shorter, plan).status[0] == 0) {
    throw InputError("--step = " + format_number(options.integrate.step.step) +
                     " s: " + options.source.vehicle.string() + " in " +
                     options.source.maneuver.string() + " diverged at t = " + at + "; a step of " +
                     format_number(shorter.step) + " s runs through");
  }
  print_error("the run failed at t = " + at +
              ": the motion is no longer finite, nor with a step of " +
              format_number(shorter.step) + " s; nothing was written");
  suggest_again_with_setting(arguments, "NAME=VALUE", "with a parameter nearer to a rig's");
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

int run_rig(const Arguments& arguments, const SimulateOptions& options) {
  if (options.integrator == kIntegratorCvode) {
    throw InputError("--integrator = cvode: drives cars only; allowed for a rig: rk4, abm4");
  }
  const RigSpec rig = load_rig(options.source);
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
  const auto start = std::chrono::steady_clock::now();
  const ReadOut out(*run.channels, {&rig.effects});
  {
    const ProgressLine line("simulating " + format_duration(maneuver.duration));
    run.results = simulate_readings(out, plan, [&](const SamplePlan& record) {
      return simulate_rig(rig, maneuver.inputs, options.integrate.step, record);
    });
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (run.results.status[0] != 0) {
    return explain_failure(arguments, options, rig, maneuver, plan, run.results.failure_time[0]);
  }
  describe_run(options, rig, run);
  write_run(options.output, format, run);
  char line[160];
  std::snprintf(line, sizeof line, ": %d samples of %zu channels; %.4g s simulated in %.3g s",
                run.results.sample_count, run.channels->size(), maneuver.duration, seconds);
  print_note(options.output.string() + line);
  suggest_next({"strut", "compare", "CAMPAIGN.toml", "-o", "comparison"},
               "measured runs against this rig");
  return kExitDone;
}

}  // namespace strut
