#include "jobs/bench/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text/format_number.h"
#include "jobs/cli/clock.h"
#include "model_files/parameters.h"
#include "sweep/choices.h"
#include "sweep/choose_settings.h"

namespace strut {
namespace {

/// The axes of the paper's grid, from new to most degraded.
struct Axis {
  const char* name;
  double from, to;
};
constexpr Axis kAxes[] = {{"front_stiffness", 40000.0, 35500.0},
                          {"front_damping", 1980.0, 1800.0},
                          {"rear_stiffness", 35000.0, 30500.0},
                          {"rear_damping", 1980.0, 1800.0}};
/// Steps of an additive recurrence; as they are irrational, every case differs in every parameter.
constexpr double kSteps[] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                             0.5385972572236101};

SamplePlan make_reference_plan() {
  SamplePlan plan;
  plan.interval = 1.0 / kBenchRate;
  return plan;
}

/// Acceleration of the body in one lane [m/s^2], sampled at kBenchRate.
std::vector<double> get_acceleration(const LaneResults& results, std::size_t lane) {
  return results.get_history(CarChannel::kBodyAccelerationZ, static_cast<int>(lane));
}

/// rms(values - reference) / rms(reference).
double calc_relative_error(const std::vector<double>& values,
                           const std::vector<double>& reference) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    difference += square(values[i] - reference[i]);
    size += square(reference[i]);
  }
  return std::sqrt(difference / size);
}

}  // namespace

std::string describe(const IntegrateOptions& options) {
  return fmt::format("{}, {} spin, events {}{}", describe_integrator({Solver::kLanes, options, {}}),
                     find_name(kSpins, options.spin),
                     options.step.locate_events ? "located" : "not located",
                     options.symmetry ? ", one side" : "");
}

BenchCases make_bench_cases(const CaseSource& source, int count) {
  BenchCases bench;
  Case c = load_case(source);
  bench.duration = c.maneuver.duration;
  CasePreparer preparer;  // prepares the mechanism once, as in a sweep
  bench.cases.push_back(prepare_case(source, c, preparer));
  const double start = now();
  for (int i = 1; i < count; ++i) {
    for (std::size_t p = 0; p < std::size(kAxes); ++p) {
      const double fraction = std::fmod(i * kSteps[p], 1.0);
      set_parameter(c, kAxes[p].name, kAxes[p].from + fraction * (kAxes[p].to - kAxes[p].from));
    }
    bench.cases.push_back(prepare_case(source, c, preparer));
  }
  bench.seconds_to_prepare = (now() - start) / std::max(1, count - 1);
  for (const PreparedCase& prepared : bench.cases) {
    const LaneResults reference = run_cvode(prepared, {}, make_reference_plan());
    bench.acceleration.push_back(get_acceleration(reference, 0));
  }
  return bench;
}

LaneResults run_cases(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting,
                      const SamplePlan& plan) {
  if (!setting.in_lanes) return kernel.run_scalar(bench.cases[0], setting.options, plan);
  std::vector<const PreparedCase*> pointers;
  for (const PreparedCase& c : bench.cases) pointers.push_back(&c);
  return kernel.run_lanes(pointers.data(), static_cast<int>(pointers.size()), setting.options,
                          plan);
}

double measure_error(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting) {
  const LaneResults results = run_cases(bench, kernel, setting, make_reference_plan());
  for (const int status : results.status) {
    if (status != 0) return std::numeric_limits<double>::infinity();
  }
  double worst = 0.0;
  const std::size_t count = setting.in_lanes ? bench.cases.size() : 1;
  for (std::size_t lane = 0; lane < count; ++lane) {
    const double error =
        calc_relative_error(get_acceleration(results, lane), bench.acceleration[lane]);
    // A NaN counts as the worst and is kept, since every comparison with it is false.
    if (std::isnan(error) || error > worst) worst = error;
  }
  return worst;
}

double count_right_hand_sides(const BenchCases& bench, const Kernel& kernel,
                              const BenchSetting& setting) {
  return static_cast<double>(run_cases(bench, kernel, setting, {}).derivative_count);
}

std::vector<BenchSetting> list_standard_settings() {
  IntegrateOptions newton, table, side;
  newton.step.step = table.step.step = side.step.step = 1e-3;
  table.closure = Closure::kTable;
  side.symmetry = true;
  return {{"double", describe(newton), newton, false},
          {"lanes", describe(newton), newton},
          {"lanes_tabulated", describe(table), table},
          {"lanes_one_side", describe(side), side}};
}

std::vector<BenchSetting> list_fast_settings(bool quick) {
  std::vector<double> steps = {0.5e-3, 0.75e-3, 1e-3, 1.25e-3, 1.5e-3, 2e-3, 2.5e-3};
  std::vector<double> coarse_steps = {0.0, 4e-3, 6e-3, 8e-3};
  if (quick) steps = {1e-3, 1.5e-3, 2e-3}, coarse_steps = {0.0, 6e-3};
  std::vector<BenchSetting> settings;
  for (const double step : steps) {
    for (const double coarse : coarse_steps) {
      for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
        for (const bool events : {true, false}) {
          IntegrateOptions options;
          options.step = {stepper, step, events, coarse};
          options.closure = Closure::kTable;
          options.symmetry = true;
          settings.push_back({"candidate", describe(options), options});
        }
      }
    }
  }
  return settings;
}

}  // namespace strut
