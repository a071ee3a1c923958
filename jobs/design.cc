#include "jobs/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "base/text/format_number.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/design/json.h"
#include "jobs/design/tables.h"
#include "model_files/find_channel.h"
#include "sweep/request.h"

namespace strut {
namespace {

constexpr double kMaxSamples = 20000.0;  // per run: histories of at most 2 GB in total

std::vector<std::string> list_or_empty(const Arguments& arguments, const std::string& name) {
  return arguments.has(name) ? split_list(arguments.text(name)) : std::vector<std::string>{};
}

/// Calls `function` and puts the option in front of its InputErrors.
template <class Function>
auto name_option(const std::string& option, const Function& function) {
  try {
    return function();
  } catch (const InputError& e) {
    throw InputError(fmt::format("{} {}", option, e.what()));
  }
}

SensorNoise read_noise(const Arguments& arguments) {
  SensorNoise noise = make_default_noise();
  for (const std::string& setting : arguments.list("noise")) {
    name_option("--noise:", [&] { apply_noise(noise, setting); });
  }
  return noise;
}

std::vector<int> read_channels(const Arguments& arguments, const SweepRequest& request) {
  if (!arguments.has("channels")) return request.snapshot.channels;
  std::vector<int> channels;
  for (const std::string& name : list_or_empty(arguments, "channels")) {
    const int channel = name_option("--channels:", [&] { return find_car_channel(name); });
    if (std::find(channels.begin(), channels.end(), channel) != channels.end()) {
      throw InputError(fmt::format("--channels: '{}' is given twice; must be given once", name));
    }
    channels.push_back(channel);
  }
  return channels;
}

SensitivityOptions read_options(const Arguments& arguments, const SweepRequest& request,
                                double duration) {
  SensitivityOptions options;
  options.rate = arguments.number_or("rate", options.rate, between(20.0, 5000.0, "Hz"));
  if (options.rate * duration > kMaxSamples) {
    throw InputError(fmt::format("--rate = {} Hz: must be at most {} Hz for {} s",
                                 format_number(options.rate), format_number(kMaxSamples / duration),
                                 format_number(duration)));
  }
  options.relative_step =
      arguments.number_or("difference", options.relative_step, between(1e-7, 0.1));
  options.integrate =
      arguments.is_on("as-requested") ? request.integrate : make_accurate(request.integrate);
  return options;
}

void suggest_next_step(const std::string& sweep, const DesignReport& report) {
  const Design& design = report.design;
  const Instant& best = report.sensitivity.instants[design.best[0].instants[0]];
  suggest_next({"strut", "plan", sweep, "-o", "cars"},
               design.best[0].bounds.rms < design.snapshot.rms
                   ? fmt::format("with offset = {:.3f} in its [record]", best.offset)
                   : "its instant is the best one");
}

}  // namespace

Arguments describe_design() {
  Arguments arguments(
      "strut design SWEEP.toml [OPTIONS]",
      "Finds the instant, window and sensors that identify the parameters of a sweep's grid best:\n"
      "computes the sensitivity of every channel to every grid parameter and, for given sensor\n"
      "noise, the Cramer-Rao bounds of the sweep's snapshot, of every instant along the way, of\n"
      "the best one, two and three instants, and of the whole window. Proposes the best instant.",
      "  strut design examples/sweeps/paper.toml\n"
      "  strut design examples/sweeps/paper.toml --at front_stiffness=38000,rear_damping=1850 \\\n"
      "      --noise pitch_rate=0.002 --csv sensitivity.csv --json");
  arguments.add_operand(ArgumentValue::file("SWEEP.toml", {"toml"}));
  arguments.add_option("at", "NAME=VALUE,...", "base point; other axes: their middle");
  arguments.add_list("set", ArgumentValue::setting(), "parameter at the base point, repeatable");
  arguments.add_option("channels", "NAME,...", "measured channels (default: the snapshot's)");
  arguments.add_list("noise", "CHANNEL=SIGMA",
                     "standard deviation of a sensor's white noise per sample, repeatable");
  arguments.add_option("rate", "HZ", "instants per second (default 1000)");
  arguments.add_option("difference", "FRACTION",
                       "step of the differences as a fraction of the base value (default 1e-4)");
  arguments.add_switch("as-requested",
                       "integrate as the sweep does, not by RK4 1 ms with Newton closure");
  arguments.add_option("csv", ArgumentValue::file("FILE", {"csv"}), "write the sensitivity curves");
  arguments.add_switch("force", "replace the file of --csv where it exists");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_design(const Arguments& arguments) {
  const SweepRequest request = read_request(arguments.only_operand());
  if (arguments.has("csv")) {
    check_output_file("csv", arguments.text("csv"),
                      list_files_read({request.path, request.vehicle, request.maneuver}),
                      arguments.is_on("force"));
  }
  DesignReport report;
  report.noise = read_noise(arguments);
  report.channels = read_channels(arguments, request);
  const Case base = make_base_point(request.base, request.grid, list_or_empty(arguments, "at"),
                                    arguments.list("set"));
  const SensitivityOptions options = read_options(arguments, request, base.maneuver.duration);
  report.sensitivity = name_option(request.path.string() + ":", [&] {
    const Stage stage("sensitivities");
    const ProgressLine line("simulating the sensitivities");
    return calc_sensitivity(base, request.grid.axes(), request.snapshot.offset, options);
  });
  report.design = calc_design(report.sensitivity, report.channels, report.noise);
  if (arguments.has("csv")) {
    const InterruptGuard guard;
    write_design_csv(arguments.text("csv"), report);
  }
  if (arguments.is_on("json")) {
    std::cout << format_json(make_design_json(report)) << "\n";
  } else {
    print_design(report);
  }
  suggest_next_step(arguments.only_operand(), report);
  return kExitDone;
}

}  // namespace strut
