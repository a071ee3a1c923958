#include "jobs/simulate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <iostream>
#include <system_error>

#include "base/text/format_number.h"
#include "io/format/json.h"
#include "jobs/case/run_file.h"
#include "jobs/case/step_check.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/simulate/kinematics.h"
#include "jobs/simulate/rig.h"
#include "jobs/simulate/run_report.h"
#include "model_files/parameters.h"
#include "model_files/read_model.h"
#include "report/page_file.h"
#include "sweep/simulate_case.h"

namespace strut {
namespace {

/// The network inputs of the paper.
constexpr std::array<int, 5> kInputs = {CarChannel::kBodyPositionZ, CarChannel::kBodyVelocityZ,
                                        CarChannel::kBodyAccelerationZ, CarChannel::kPitchAngle,
                                        CarChannel::kPitchRate};

/// What would have no effect is refused: `why` says what makes it so.
void refuse_options(const Arguments& arguments, std::initializer_list<const char*> names,
                    const std::string& why) {
  for (const std::string name : names) {
    const bool given = name == "no-events" ? arguments.is_on(name) : arguments.has(name);
    if (given) throw InputError("--" + name + ": " + why);
  }
}

void read_integration(const Arguments& arguments, SimulateOptions& options) {
  options.integrator = arguments.choice_or("integrator", 0);
  if (options.integrator == kIntegratorCvode) {
    refuse_options(arguments, {"step", "coarse-step", "spin", "no-events"},
                   "cvode chooses its own; allowed with rk4, abm4");
  }
  IntegrateOptions& integrate = options.integrate;
  StepOptions& step = integrate.step;
  step.step = arguments.number_or("step", step.step,
                                  {.low = 0.0, .high = kMaxStep, .open_low = true, .unit = "s"});
  step.coarse_step = arguments.number_or("coarse-step", 0.0, between(step.step, kMaxStep, "s"));
  step.stepper = options.integrator == kIntegratorAbm4 ? Stepper::kAbm4 : Stepper::kRk4;
  step.locate_events = !arguments.is_on("no-events");
  integrate.closure = static_cast<Closure>(arguments.choice_or("closure", 0));
  integrate.spin = static_cast<SpinTreatment>(arguments.choice_or("spin", 0));
  options.rate = arguments.number_or("rate", options.rate, between(1.0, 1e6, "Hz"));
}

void check_report(const SimulateOptions& options) {
  const PageFolder folder{options.report.lexically_normal()};
  check_output_folder("report", folder.root);
  check_page_folder("report", folder, kRunContent, {});
  std::error_code ignored;
  if (std::filesystem::equivalent(std::filesystem::absolute(options.output).parent_path(),
                                  folder.figures(), ignored)) {
    throw InputError("--output = " + options.output.string() +
                     ": would be among the figures of --report; must be another folder");
  }
}

SimulateOptions read_options(const Arguments& arguments) {
  SimulateOptions options;
  const auto& files = arguments.positional();
  options.kinematics = arguments.is_on("kinematics");
  options.json = arguments.is_on("json");
  options.force = arguments.is_on("force");
  const std::size_t expected = options.kinematics ? 1 : 2;
  if (files.size() != expected) {
    throw arguments.usage_error(std::to_string(files.size()) + " files; expected " +
                                (options.kinematics ? "VEHICLE" : "VEHICLE and MANEUVER"));
  }
  options.source.vehicle = files[0];
  if (!options.kinematics) options.source.maneuver = files[1];
  options.source.settings = arguments.list("set");
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the file to write with -o");
  options.output = arguments.text("output");
  if (arguments.has("report")) options.report = arguments.text("report");
  if (!options.report.empty()) check_report(options);
  if (options.kinematics) {
    refuse_options(
        arguments,
        {"integrator", "step", "coarse-step", "closure", "spin", "no-events", "rate", "report"},
        "--kinematics runs nothing over time; allowed without it");
  }
  read_integration(arguments, options);
  return options;
}

LaneResults integrate(const PreparedCase& c, const SimulateOptions& options,
                      const StepOptions& step) {
  SolverOptions request;
  request.solver = options.integrator == kIntegratorCvode ? Solver::kCvode : Solver::kLanes;
  request.options = options.integrate;
  request.options.step = step;
  request.reference.closure = options.integrate.closure;
  return simulate_case(c, request, 1.0 / options.rate);
}

/// Why a run failed: its step, if a shorter one gets through; else exit code 1 is the answer.
int explain_failure(const Arguments& arguments, const PreparedCase& c,
                    const SimulateOptions& options, const LaneResults& results) {
  const std::string at = format_number(results.failure_time[0]) + " s";
  const bool out = results.status[0] == static_cast<int>(RunStatus::kOutOfTravel);
  if (options.integrator != kIntegratorCvode) {
    const StepOptions& step = options.integrate.step;
    StepOptions shorter = step;
    shorter.step = kRetryFraction * step.step;
    shorter.coarse_step = 0.0;
    if (integrate(c, options, shorter).status[0] == 0) {
      throw make_step_error(options, "--step", step.step, "failed at t = " + at,
                            "a step of " + format_number(shorter.step) + " s " +
                                (step.coarse_step > 0.0 ? "without --coarse-step " : "") +
                                "runs through");
    }
  }
  print_error(
      "the run failed at t = " + at + ": " +
      (out ? "a wheel left the +-100 mm over which its suspension is modeled; a lower bump, "
             "a lower speed or a stiffer spring keeps it inside"
           : "the motion is no longer finite; a shorter --step does not help") +
      "; nothing was written");
  suggest_again_with_setting(
      arguments, out ? "bump_height=VALUE" : "NAME=VALUE",
      out ? "with less of a bump, or --set speed=VALUE" : "with a parameter nearer to a car's");
  return kExitNegative;
}

std::vector<std::pair<std::string, std::string>> describe_run(const SimulateOptions& options,
                                                              const LaneResults& results) {
  const IntegrateOptions& integrate = options.integrate;
  const bool cvode = options.integrator == kIntegratorCvode;
  auto list = describe_program(options.source);
  list.insert(
      list.end(),
      {{"integrator", options.integrator_name()},
       {"step", cvode ? "adaptive, tolerance 1e-12" : format_number(integrate.step.step) + " s"},
       {"closure", options.closure_name()},
       {"spin", cvode ? "explicit" : options.spin_name()},
       {"events", cvode || integrate.step.locate_events ? "located" : "not located"},
       {"event_count", std::to_string(results.event_count)}});
  if (integrate.step.coarse_step > 0.0) {
    list.emplace_back("coarse_step", format_number(integrate.step.coarse_step) + " s");
  }
  return list;
}

std::vector<RunParameter> list_case_parameters(const Case& c) {
  std::vector<RunParameter> parameters;
  for (const ParameterInfo* p : list_parameters_in_use(c)) {
    parameters.push_back({p->name, p->unit, p->description, p->get(c)});
  }
  return parameters;
}

void print_snapshot(const LaneResults& results) {
  if (!has_snapshot(results)) {
    std::cout << "snapshot: the rear wheels do not reach the bump\n";
    return;
  }
  char line[96];
  std::snprintf(line, sizeof line, "%-22s %20s  %s\n", "snapshot", "value", "unit");
  std::cout << line;
  std::snprintf(line, sizeof line, "%-22s %20.13g  s\n", "event_time", results.event_time[0]);
  std::cout << line;
  for (const int channel : kInputs) {
    const auto at = static_cast<std::size_t>(channel);
    const ChannelInfo& info = list_car_channels()[at];
    std::snprintf(line, sizeof line, "%-22s %20.13g  %s\n", info.name.c_str(), results.snapshot[at],
                  info.unit.c_str());
    std::cout << line;
  }
}

void print_json(const LaneResults& results, double duration, double seconds) {
  Json snapshot = Json::object();
  for (const int channel : kInputs) {
    const auto at = static_cast<std::size_t>(channel);
    snapshot[list_car_channels()[at].name] = results.snapshot[at];
  }
  const Json json = Json{{"event_time", results.event_time[0]},
                         {"snapshot", has_snapshot(results) ? snapshot : Json()},
                         {"events", results.event_count},
                         {"seconds", seconds},
                         {"real_time_factor", duration / seconds}};
  std::cout << format_json(json) << "\n";
}

void print_summary(const SimulateOptions& options, const LaneResults& results, double duration,
                   double seconds) {
  double travel = 0.0;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const std::size_t channel = CarChannel::kCornerBegin + corner * CarChannel::kCornerChannels +
                                CarChannel::kSuspensionDeflection;
    for (const double d : get_history(results, CarChannel::kCount, channel))
      travel = std::max(travel, std::fabs(d));
  }
  char line[256];
  std::snprintf(line, sizeof line,
                ": %d samples, %ld contact events, suspension deflection up to %.1f mm; %.4g s "
                "simulated in %.3g s (%.4g x real time)",
                results.sample_count, results.event_count, 1e3 * travel, duration, seconds,
                duration / seconds);
  print_note(options.output.string() + line);
}

int run_case(const Arguments& arguments, const SimulateOptions& options) {
  const Case input = load_case(options.source);
  const RunFormat format = check_output(options);
  const double duration = input.maneuver.duration;
  check_rate(options.rate, duration);
  check_step_count(options, duration);
  const PreparedCase prepared = prepare_case(options.source, input);
  check_steps(prepared, options);

  RunRecord run;
  run.channels = &list_car_channels();
  const auto start = std::chrono::steady_clock::now();
  {
    const ProgressLine line("simulating " + format_duration(duration));
    run.results = integrate(prepared, options, options.integrate.step);
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (run.results.status[0] != 0) {
    return explain_failure(arguments, prepared, options, run.results);
  }

  run.parameters = list_case_parameters(input);
  run.provenance = describe_run(options, run.results);
  write_run(options.output, format, run);
  if (!options.report.empty()) {
    write_run_report(options.report, options.source, input, run);
    suggest_page((options.report / "report.html").string());
  }
  options.json ? print_json(run.results, duration, seconds) : print_snapshot(run.results);
  print_summary(options, run.results, duration, seconds);
  if (options.report.empty()) {
    suggest_next({"strut", "plan", "SWEEP.toml", "-o", "cars"},
                 "many such runs; or this one with --report DIR, to see it");
  }
  return kExitDone;
}

int run_kinematics(const SimulateOptions& options) {
  if (options.output.extension() != ".csv") {
    throw InputError("--output = " + options.output.string() + ": the name must end in .csv");
  }
  check_output_file("output", options.output, list_files_read({options.source.vehicle}),
                    options.force);
  write_kinematics(options.source, options.output);
  print_note(options.output.string() + ": front and rear left corner, -100 to +100 mm");
  suggest_next(
      {"strut", "simulate", options.source.vehicle.string(), "MANEUVER.toml", "-o", "run.csv"});
  return kExitDone;
}

}  // namespace

Arguments describe_simulate() {
  Arguments arguments(
      "strut simulate VEHICLE MANEUVER -o FILE [OPTIONS]\n"
      "       strut simulate --kinematics VEHICLE -o FILE.csv",
      "Runs a car through a maneuver. Writes all channels over time with their units to FILE "
      "(.csv\n"
      "or .h5) and prints the snapshot: the body's motion when the rear wheels are on the bump.\n"
      "With --kinematics: wheel travel -100 to +100 mm against camber, toe, wheel center, caster,\n"
      "spring, damper and track of the left corners.",
      "  strut simulate examples/vehicles/paper_sedan.toml examples/maneuvers/bump_20mps.toml \\\n"
      "      --set front_stiffness=38000 -o run.h5\n"
      "  strut simulate --kinematics examples/vehicles/paper_sedan.toml -o curves.csv");
  arguments.add_operand(ArgumentValue::file("VEHICLE", {"toml"}));
  arguments.add_operand(ArgumentValue::file("MANEUVER", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"csv", "h5", "hdf5"}),
                       "file to write: .csv, .h5 or .hdf5");
  arguments.add_option("integrator", ArgumentValue::one_of(kIntegrators),
                       "rk4 (default); abm4: Adams-Bashforth-Moulton; cvode: SUNDIALS, 1e-12");
  arguments.add_option("step", "S", "step of rk4 and abm4 [s], in (0, 0.02] (default 0.001)");
  arguments.add_option(
      "coarse-step", "S",
      "longer step [s], from --step to 0.02, away from the bump (default: --step)");
  arguments.add_option("closure", ArgumentValue::one_of(kClosures),
                       "newton (default): loops closed in every step; table: corner kinematics "
                       "tabulated over their coordinate");
  arguments.add_option("spin", ArgumentValue::one_of(kSpins),
                       "wheel spin: exponential (default), stable at any speed; or explicit");
  arguments.add_switch("no-events", "do not end steps where a wheel lifts off or meets a kink");
  arguments.add_option("rate", "HZ", "samples a second in FILE (default 1000)");
  arguments.add_list("set", ArgumentValue::setting(),
                     "change a parameter, e.g. front_stiffness=38000; may be "
                     "repeated");
  arguments.add_option("report", ArgumentValue::folder("DIR"),
                       "also write DIR/report.html: the car crossing the bump, and its curves");
  arguments.add_switch("force", "replace FILE where it exists");
  arguments.add_switch("json", "print the snapshot as JSON");
  arguments.add_switch("kinematics", "write the suspension's kinematics instead of a run");
  return arguments;
}

int run_simulate(const Arguments& arguments) {
  const SimulateOptions options = read_options(arguments);
  if (options.kinematics) return run_kinematics(options);
  print_detail("integrator " + options.integrator_name());
  if (read_model_info(options.source.vehicle).is_driven_by_inputs()) {
    refuse_options(arguments, {"coarse-step", "closure", "spin", "report"},
                   options.source.vehicle.string() + " is a rig; allowed for cars");
    return run_rig(arguments, options);
  }
  return run_case(arguments, options);
}

}  // namespace strut
