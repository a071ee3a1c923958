#include "jobs/simulate/options.h"

#include <fmt/format.h>

#include <cmath>
#include <system_error>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/step_warning.h"
#include "model/longest_step.h"
#include "report/page_file.h"
#include "sweep/step_count.h"

namespace strut {
namespace {

constexpr double kMaxSamples = 2e6;  // one gigabyte of history

void read_integration(const Arguments& arguments, SimulateOptions& options) {
  options.integrator = static_cast<Integrator>(arguments.choice_or("integrator", 0));
  if (options.integrator == Integrator::kCvode) {
    refuse_options(arguments, {"step", "coarse-step", "spin", "no-events"},
                   "cvode chooses its own steps; allowed with rk4 and abm4");
  }
  IntegrateOptions& integrate = options.integrate;
  StepOptions& step = integrate.step;
  step.step = arguments.number_or("step", step.step,
                                  {.low = 0.0, .high = kMaxStep, .open_low = true, .unit = "s"});
  options.chose_step = arguments.has("step");
  step.coarse_step = arguments.number_or("coarse-step", 0.0, between(step.step, kMaxStep, "s"));
  if (options.integrator != Integrator::kCvode) step.stepper = to_stepper(options.integrator);
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
    throw InputError(
        fmt::format("--output = {}: among the figures of --report; name another folder",
                    options.output.string()));
  }
}

}  // namespace

void refuse_options(const Arguments& arguments, std::initializer_list<const char*> names,
                    const std::string& reason) {
  for (const std::string name : names) {
    const bool given = name == "no-events" ? arguments.is_on(name) : arguments.has(name);
    if (given) throw InputError(fmt::format("--{}: {}", name, reason));
  }
}

SimulateOptions read_simulate_options(const Arguments& arguments) {
  SimulateOptions options;
  const auto& files = arguments.positional();
  options.kinematics = arguments.is_on("kinematics");
  options.json = arguments.is_on("json");
  options.force = arguments.is_on("force");
  const std::size_t expected = options.kinematics ? 1 : 2;
  if (files.size() != expected) {
    throw arguments.usage_error(
        fmt::format("{} files; expected {}", files.size(),
                    options.kinematics ? "VEHICLE" : "VEHICLE and MANEUVER"));
  }
  options.source.vehicle = files[0];
  if (!options.kinematics) options.source.maneuver = files[1];
  options.source.settings = arguments.list("set");
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the file to write with -o");
  options.output = arguments.text("output");
  if (arguments.has("report")) options.report = arguments.text("report");
  if (arguments.has("beside")) {
    options.beside = arguments.text("beside");
    if (options.report.empty()) {
      throw arguments.usage_error("--beside: draws a run in the report; needs --report DIR");
    }
  }
  if (arguments.has("channels")) options.channels = split_list(arguments.text("channels"));
  if (!options.report.empty()) check_report(options);
  if (options.kinematics) {
    refuse_options(arguments,
                   {"integrator", "step", "coarse-step", "closure", "spin", "no-events", "rate",
                    "channels", "report"},
                   "--kinematics does not simulate over time; allowed without it");
  }
  read_integration(arguments, options);
  return options;
}

void check_rate(double rate, double duration) {
  if (duration * rate <= kMaxSamples) return;
  throw InputError(
      fmt::format("--rate = {} Hz: must be at most {} Hz for {} s", format_number(rate),
                  format_number(std::floor(kMaxSamples / duration)), format_number(duration)));
}

void check_step_count(const SimulateOptions& options, double duration) {
  if (options.integrator == Integrator::kCvode) return;
  const double step = options.integrate.step.step;
  const std::string fault = find_step_count_fault(duration, step);
  if (!fault.empty()) {
    throw InputError(fmt::format("--step = {} s: {}", format_number(step), fault));
  }
}

SimulateOptions adapt_steps(SimulateOptions options, double longest) {
  if (options.integrator == Integrator::kCvode) return options;
  StepOptions& step = options.integrate.step;
  if (!options.chose_step) step.step = shorten_step(step.step, longest);
  const std::string model = options.source.vehicle.string();
  warn_of_long_step("--step", step.step, model, longest);
  warn_of_long_step("--coarse-step", step.coarse_step, model, longest);
  return options;
}

RunFormat check_output(const SimulateOptions& options) {
  const RunFormat format = find_run_format(options.output);
  check_output_file("output", options.output,
                    list_files_read({options.source.vehicle, options.source.maneuver}),
                    options.force);
  std::error_code ignored;
  if (!options.beside.empty() &&
      std::filesystem::equivalent(options.output, options.beside, ignored)) {
    throw InputError(fmt::format("--output = {}: is the run of --beside; name another file",
                                 options.output.string()));
  }
  return format;
}

}  // namespace strut
