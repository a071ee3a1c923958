#include "jobs/simulate/car.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>

#include "base/text/format_number.h"
#include "io/format/json.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"
#include "jobs/simulate/run_file.h"
#include "jobs/simulate/run_report.h"
#include "jobs/simulate/step_check.h"
#include "model/car/car_info.h"
#include "model/longest_step.h"
#include "model_files/parameters.h"
#include "sweep/simulate_case.h"

namespace strut {
namespace {

/// The channels of the printed snapshot: the network inputs of the paper.
constexpr std::array<int, 5> kInputs = {CarChannel::kBodyPositionZ, CarChannel::kBodyVelocityZ,
                                        CarChannel::kBodyAccelerationZ, CarChannel::kPitchAngle,
                                        CarChannel::kPitchRate};

LaneResults integrate(const PreparedCase& c, const SimulateOptions& options,
                      const StepOptions& step) {
  SolverOptions request;
  request.solver = options.integrator == Integrator::kCvode ? Solver::kCvode : Solver::kLanes;
  request.options = options.integrate;
  request.options.step = step;
  request.reference.closure = options.integrate.closure;
  return simulate_case(c, request, 1.0 / options.rate);
}

/// Reports a failed run: throws InputError if a shorter step succeeds; otherwise prints the cause
/// and returns exit code 1.
int explain_failure(const Arguments& arguments, const Case& given, const PreparedCase& c,
                    const SimulateOptions& options, const LaneResults& results) {
  const std::string at = format_number(results.get_failure_time()) + " s";
  if (options.integrator != Integrator::kCvode) {
    const StepOptions& step = options.integrate.step;
    StepOptions shorter = step;
    shorter.step = kRetryFraction * step.step;
    shorter.coarse_step = 0.0;
    if (integrate(c, options, shorter).is_done()) {
      throw make_step_error(options, "--step", step.step, "failed at t = " + at,
                            fmt::format("a step of {} s {}succeeds", format_number(shorter.step),
                                        step.coarse_step > 0.0 ? "without --coarse-step " : ""));
    }
  }
  const bool is_out = results.get_status() == RunStatus::kOutOfTravel;
  print_error(fmt::format("the run failed at t = {}: {}; nothing was written", at,
                          is_out
                              ? "a wheel left the +/-100 mm over which its suspension is modeled; "
                                "a lower bump, a lower "
                                "speed or a stiffer spring keeps it inside"
                              : "the motion is no longer finite; a shorter --step does not help"));
  const bool has_bump = given.maneuver.road.has_formula();
  suggest_again_with_setting(
      arguments, !is_out ? "NAME=VALUE" : (has_bump ? "bump_height=VALUE" : "speed=VALUE"),
      !is_out ? "with a parameter closer to that of a real car"
              : (has_bump ? "with a lower bump, or --set speed=VALUE" : "or on a smoother road"));
  return kExitNegative;
}

std::vector<std::pair<std::string, std::string>> describe_run(const SimulateOptions& options,
                                                              const LaneResults& results) {
  const IntegrateOptions& integrate = options.integrate;
  const bool cvode = options.integrator == Integrator::kCvode;
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

void print_snapshot(const Case& c, const LaneResults& results) {
  if (c.maneuver.road.shape == BumpShape::kNone && c.maneuver.profile.data) {
    std::cout << "snapshot: none, the maneuver has no bump\n";
    return;
  }
  if (!results.has_snapshot()) {
    std::cout << "snapshot: the rear wheels do not reach the bump\n";
    return;
  }
  std::cout << fmt::format("{:<22} {:>14}  {}\n", "snapshot", "value", "unit");
  const auto print = [](const std::string& name, double value, const std::string& unit) {
    std::cout << fmt::format("{:<22} {:>14.7g}  {}\n", name, value, unit);
  };
  print("event_time", results.get_event_time(), "s");
  for (const int channel : kInputs) {
    const ChannelInfo& info = list_car_channels()[static_cast<std::size_t>(channel)];
    print(info.name, results.get_snapshot(channel), info.unit);
  }
}

void print_json(const LaneResults& results, double duration, double seconds) {
  Json snapshot = Json::object();
  for (const int channel : kInputs) {
    const ChannelInfo& info = list_car_channels()[static_cast<std::size_t>(channel)];
    snapshot[info.name] = results.get_snapshot(channel);
  }
  const Json json = Json{{"event_time", results.get_event_time()},
                         {"snapshot", results.has_snapshot() ? snapshot : Json()},
                         {"events", results.event_count},
                         {"seconds", seconds},
                         {"real_time_factor", duration / seconds}};
  std::cout << format_json(json) << "\n";
}

void print_summary(const SimulateOptions& options, const LaneResults& results, double duration,
                   double seconds) {
  double travel = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    const int channel = CarChannel::get_corner_channel(corner, CarChannel::kSuspensionDeflection);
    for (const double d : results.get_history(channel)) travel = std::max(travel, std::fabs(d));
  }
  print_note(
      fmt::format("{}: {} samples, {} contact events, suspension deflection up to {:.1f} mm; "
                  "{:.4g} s simulated "
                  "in {:.3g} s ({:.4g} x real time)",
                  options.output.string(), results.sample_count, results.event_count, 1e3 * travel,
                  duration, seconds, duration / seconds));
}

}  // namespace

int run_car(const Arguments& arguments, const SimulateOptions& given) {
  const Case input = load_case(given.source);
  const SimulateOptions options = adapt_steps(given, calc_longest_step(input));
  const RunFormat format = check_output(options);
  const double duration = input.maneuver.duration;
  check_rate(options.rate, duration);
  check_step_count(options, duration);
  std::optional<OtherRun> other;
  if (!options.beside.empty()) other = read_other_run(options.beside);
  const PreparedCase prepared = prepare_case(options.source, input);
  check_steps(prepared, options);

  RunRecord run;
  run.channels = &list_car_channels();
  run.kept = list_kept(get_car_info(), options.channels);
  const double start = now();
  {
    const ProgressLine line("simulating " + format_duration(duration));
    run.results = integrate(prepared, options, options.integrate.step);
  }
  const double seconds = now() - start;
  if (!run.results.is_done()) {
    return explain_failure(arguments, input, prepared, options, run.results);
  }

  run.parameters = list_case_parameters(input);
  run.provenance = describe_run(options, run.results);
  write_run(options.output, format, run);
  if (!options.report.empty()) {
    write_run_report(options.report, options.source, input, run, options.rate, other);
    suggest_page((options.report / "report.html").string());
  }
  options.json ? print_json(run.results, duration, seconds) : print_snapshot(input, run.results);
  print_summary(options, run.results, duration, seconds);
  if (options.report.empty()) {
    suggest_next({"strut", "plan", "SWEEP.toml", "-o", "cars"},
                 "for many such runs; or repeat this one with --report DIR to see it");
  }
  return kExitDone;
}

}  // namespace strut
