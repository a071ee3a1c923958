#include "sweep/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/text/range.h"
#include "io/format/toml_document.h"
#include "model/longest_step.h"
#include "model_files/file_kind.h"
#include "model_files/find_channel.h"
#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "sweep/case_order.h"
#include "sweep/choices.h"
#include "sweep/choose_settings.h"
#include "sweep/read_grid.h"
#include "sweep/step_count.h"

namespace strut {
namespace {

constexpr std::int64_t kMaxStrata = 100000;
constexpr std::int64_t kMaxShardCases = 65536;
/// Maximum history of a case [samples] and of a shard [bytes], which workers hold in memory.
constexpr double kMaxSamples = 20000;
constexpr double kMaxShardBytes = 64e6;

SampleRequest read_sample(const std::optional<Table>& table) {
  SampleRequest sample;
  if (!table) return sample;
  sample.method =
      static_cast<SampleMethod>(table->choice_or("method", 0, list_names(kSampleMethods)));
  sample.strata = static_cast<int>(table->integer_or("strata", sample.strata, 1, kMaxStrata));
  const std::int64_t max = std::numeric_limits<std::int64_t>::max();
  sample.seed = static_cast<std::uint64_t>(table->integer_or("seed", 1, 0, max));
  if (table->is_text("count")) {
    table->choice("count", {"all"});
  } else if (table->has("count")) {
    sample.count = table->integer("count", 1, max);
  }
  if (sample.method != SampleMethod::kGrid && sample.count < 0) {
    throw table->error("count", fmt::format("must be a number of samples for method \"{}\"",
                                            table->text("method")));
  }
  return sample;
}

/// Reads `by`, after the grid, whose axes are the allowed names.
void read_by(const std::optional<Table>& table, const Grid& grid, SampleRequest& sample) {
  sample.by = grid.axes().front().name;
  if (!table || !table->has("by")) return;
  std::vector<std::string> names;
  names.reserve(grid.axes().size() + 1);
  for (const Axis& axis : grid.axes()) names.push_back(axis.name);
  names.push_back(kDegradation);
  sample.by = names[static_cast<std::size_t>(table->choice("by", names))];
  if (sample.by != kDegradation) return;
  for (const Axis& axis : grid.axes()) {
    if (axis.from != 0.0) continue;
    throw table->error(
        "by", fmt::format("needs grid.{}.from other than 0: losses are relative to it", axis.name));
  }
}

/// Limits the default number of strata to the number of levels, points and samples.
void limit_default_strata(const std::optional<Table>& table, const Grid& grid,
                          SampleRequest& sample) {
  if (table && table->has("strata")) return;
  std::int64_t max = sample.method == SampleMethod::kGrid ? grid.size() : sample.count;
  if (sample.count > 0) max = std::min(max, sample.count);
  for (const Axis& axis : grid.axes()) {
    const bool levels = sample.method == SampleMethod::kGrid && axis.name == sample.by;
    if (levels) max = std::min(max, axis.count);
  }
  sample.strata = static_cast<int>(std::min<std::int64_t>(sample.strata, max));
}

/// Default bound of the error of the integrator that `strut plan` chooses.
constexpr double kDefaultAccuracy = 1e-3;

/// The bound of the error where the table leaves the integrator open; 0 where it names one.
double read_accuracy(const std::optional<Table>& table) {
  if (!table) return kDefaultAccuracy;
  const bool is_given = table->has("accuracy");
  for (const char* key : {"method", "step", "coarse_step", "closure", "locate_events"}) {
    if (!table->has(key)) continue;
    if (!is_given) return 0.0;
    throw table->error(key, "not allowed beside accuracy, with which `strut plan` chooses it");
  }
  return table->number_or("accuracy", kDefaultAccuracy, between(kFinestAccuracy, 0.1, "1"));
}

SolverOptions read_integrate(const std::optional<Table>& table, double longest_duration,
                             double longest_step) {
  SolverOptions request;
  request.options.symmetry = true;
  request.options.step.step = shorten_step(request.options.step.step, longest_step);
  if (!table) return request;
  const auto method =
      static_cast<Integrator>(table->choice_or("method", 0, list_names(kIntegrators)));
  const auto closure = static_cast<Closure>(table->choice_or("closure", 0, list_names(kClosures)));
  request.options.closure = request.reference.closure = closure;
  if (method == Integrator::kCvode) {
    request.solver = Solver::kCvode;
    for (const char* key : {"step", "coarse_step", "locate_events", "symmetry"}) {
      if (table->has(key))
        throw table->error(key,
                           "not allowed with cvode, which controls its steps and computes the "
                           "whole car; allowed with rk4, abm4");
    }
    return request;
  }
  request.options.symmetry = table->boolean_or("symmetry", request.options.symmetry);
  StepOptions& step = request.options.step;
  step.stepper = to_stepper(method);
  step.step = table->number_or("step", step.step,
                               {.low = 0.0, .high = kMaxStep, .open_low = true, .unit = "s"});
  const std::string fault = find_step_count_fault(longest_duration, step.step);
  if (!fault.empty()) throw table->error("step", fault);
  step.coarse_step = table->number_or("coarse_step", 0.0, between(step.step, kMaxStep, "s"));
  step.locate_events = table->boolean_or("locate_events", step.locate_events);
  return request;
}

int read_channel(const Table& table, const std::string& name) {
  try {
    return find_car_channel(name);
  } catch (const InputError& e) {
    throw table.error("channels", e.what());
  }
}

std::vector<int> read_channels(const Table& table) {
  std::vector<int> channels;
  for (const std::string& name : table.texts("channels")) {
    const int channel = read_channel(table, name);
    if (std::find(channels.begin(), channels.end(), channel) != channels.end()) {
      throw table.error("channels", fmt::format("'{}' twice; allowed: once", name));
    }
    channels.push_back(channel);
  }
  if (channels.empty()) throw table.error("channels", "must name at least one channel");
  return channels;
}

void read_history(const Table& table, SweepRequest& request) {
  const double duration = request.base.maneuver.duration;
  const double max_rate = std::floor(kMaxSamples / duration);
  request.history.rate = table.number("rate", between(1.0 / duration, max_rate, "1/s"));
  request.history.channels = read_channels(table);
  for (const Axis& axis : request.grid.axes()) {
    if (axis.name != "duration") continue;
    throw table.error(
        "must not be recorded if 'duration' is a grid axis: all cases of a shard need the same "
        "number of samples");
  }
}

void read_record(const Table& record, SweepRequest& request) {
  const auto snapshot = record.find_table("snapshot");
  request.snapshot.on = snapshot.has_value();
  if (snapshot) {
    snapshot->choice("when", kInstants);
    request.snapshot.offset = snapshot->number_or("offset", 0.0, between(-1000.0, 1000.0, "m"));
    request.snapshot.channels = read_channels(*snapshot);
  }
  if (const auto history = record.find_table("history")) read_history(*history, request);
  if (snapshot || request.history.rate > 0.0) return;
  throw record.error("nothing to record; allowed: snapshot, history, or both");
}

/// Reads the number of cases per shard, limited by the history that a worker holds in memory.
void read_shards(const std::optional<Table>& table, SweepRequest& request) {
  const double bytes = 8.0 * static_cast<double>(request.history.channels.size()) *
                       static_cast<double>(count_samples(make_sample_plan(request)));
  std::int64_t max = kMaxShardCases;
  if (bytes * static_cast<double>(max) > kMaxShardBytes) {
    max = std::max(std::int64_t{1}, static_cast<std::int64_t>(kMaxShardBytes / bytes));
  }
  const std::int64_t usual = std::min<std::int64_t>(max, request.shard_cases);
  request.chooses_shards = !table || !table->has("cases");
  request.shard_cases = static_cast<int>(table ? table->integer_or("cases", usual, 1, max) : usual);
}

}  // namespace

SweepRequest read_request(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = open_root(document, kSweepFile);
  SweepRequest request;
  request.path = path;
  request.vehicle = root.file("vehicle");
  request.maneuver = root.file("maneuver");
  request.base.vehicle = read_vehicle(request.vehicle);
  request.base.maneuver = read_maneuver(request.maneuver);
  const auto sample = root.find_table("sample");
  request.sample = read_sample(sample);
  request.grid = read_grid(root.table("grid"), request.sample.method, request.base);
  read_by(sample, request.grid, request.sample);
  limit_default_strata(sample, request.grid, request.sample);
  const auto integrate = root.find_table("integrate");
  request.accuracy = read_accuracy(integrate);
  request.integrate =
      read_integrate(integrate, find_longest_duration(request), find_longest_step(request));
  read_record(root.table("record"), request);
  read_shards(root.find_table("shards"), request);
  request.shuffle = request.sample.method == SampleMethod::kGrid && find_slow_axes(request).empty();
  document.check_all_read();
  return request;
}

double find_longest_step(const SweepRequest& request) {
  // The step is monotone in every parameter. Twice, since a friction's speed matters only once its
  // force is on.
  constexpr int kPasses = 2;
  Case stiffest = request.base;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const Axis& axis : request.grid.axes()) {
      if (!find_parameter(axis.name).is_effect) continue;
      for (const double end : {axis.from, axis.last()}) {
        Case c = stiffest;
        set_parameter(c, axis.name, end);
        if (calc_longest_step(c) <= calc_longest_step(stiffest)) stiffest = std::move(c);
      }
    }
  }
  return calc_longest_step(stiffest);
}

double find_longest_duration(const SweepRequest& request) {
  double longest = request.base.maneuver.duration;
  for (const Axis& axis : request.grid.axes()) {
    if (axis.name == "duration") longest = std::max(axis.from, axis.last());
  }
  return longest;
}

bool ends_at_snapshot(const SweepRequest& request) {
  return request.results_version > 1 && request.snapshot.on && !(request.history.rate > 0.0);
}

StartMethod get_start_method(const SweepRequest& request) {
  return request.results_version > 1 ? StartMethod::kLanes : StartMethod::kKinsol;
}

SamplePlan make_sample_plan(const SweepRequest& request) {
  SamplePlan plan;
  plan.duration = request.base.maneuver.duration;
  plan.interval = request.history.rate > 0.0 ? 1.0 / request.history.rate : 0.0;
  plan.snapshot = request.snapshot.on;
  plan.until_snapshot = ends_at_snapshot(request);
  plan.channel_count = CarChannel::kCount;
  return plan;
}

}  // namespace strut
