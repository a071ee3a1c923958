#include "study/noise/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/parallel/team.h"
#include "estimate/design.h"
#include "estimate/fit.h"
#include "estimate/nuisances.h"
#include "model_files/find_channel.h"
#include "model_files/parameters.h"
#include "study/noise/limits_file.h"
#include "study/noise/records.h"
#include "sweep/timer.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

void require_finite(double bound, const std::string& name, const std::string& what) {
  if (std::isfinite(bound)) return;
  throw InputError(fmt::format(
      "[noise]: {} leaves {} free, so there is no bound; choose other inputs, channels or "
      "instants",
      what, name));
}

/// Bounds of a snapshot at scale 1.
std::vector<NoiseBound> calc_snapshot_bounds(const NoiseSnapshots& snapshots,
                                             const std::vector<std::string>& inputs,
                                             const Case& setup) {
  SensitivityOptions options;
  options.integrate = make_accurate(snapshots.sweep.integrate);
  const Sensitivity s = calc_sensitivity(setup, snapshots.sweep.grid.axes(),
                                         snapshots.sweep.snapshot.offset, options);
  std::vector<int> channels;
  channels.reserve(inputs.size());
  for (const std::string& name : inputs) channels.push_back(find_car_channel(name));
  const Bounds bounds =
      calc_bounds(calc_information(s, s.snapshot, channels, make_default_noise()));
  std::vector<NoiseBound> result;
  result.reserve(bounds.bound.size());
  for (std::size_t p = 0; p < bounds.bound.size(); ++p) {
    const SensitivityParameter& parameter = s.parameters[p];
    require_finite(bounds.bound[p], parameter.name,
                   fmt::format("the snapshot, preload {},", snapshots.preload));
    result.push_back({parameter.base, 0.01 * bounds.bound[p] * parameter.scale});
  }
  return result;
}

/// Unknowns of the fit to a record, the parameters first.
std::vector<Unknown> list_unknowns(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                   const std::vector<MeasuredRun>& runs) {
  std::vector<Unknown> unknowns;
  for (const std::string& name : list_axes(data.snapshots.front().sweep)) {
    unknowns.push_back(make_parameter(runs, name));
  }
  NuisanceSigmas sigmas;
  sigmas.hit_time = request.hit_time;
  sigmas.speed = 0.0;
  for (const Axis& axis : data.window.grid.axes()) {
    // Standard deviation of the uniform distribution over the axis.
    if (axis.name == kSpeedName) sigmas.speed = std::abs(axis.last() - axis.from) / std::sqrt(12.0);
  }
  for (Unknown& u : make_nuisances(runs, sigmas, unknowns)) unknowns.push_back(std::move(u));
  return unknowns;
}

FittedCase fit_record(const NoiseStudyRequest& request, const NoiseStudyData& data, double scale,
                      const TestCase& test) {
  std::vector<MeasuredRun> runs = {draw_record(request, data, scale, test)};
  FittedCase fitted;
  const FitResult fit = [&] {
    const Timer timer(fitted.seconds);
    return fit_simulation(runs, list_unknowns(request, data, runs));
  }();
  fitted.bounds.number = test.number;
  fitted.chi2_per_degree = fit.chi2_per_degree();
  fitted.converged = fit.converged;
  runs.front().setup = Model(test.setup);
  const std::vector<Unknown> at_truth = list_unknowns(request, data, runs);
  const Uncertainty bounds = calc_fit_bounds(runs, at_truth);
  const std::size_t count = data.snapshots.front().sweep.grid.axes().size();
  for (std::size_t p = 0; p < count; ++p) {
    require_finite(bounds.sigma[p], at_truth[p].name, "the window");
    fitted.bounds.parameters.push_back({at_truth[p].start, bounds.sigma[p]});
    fitted.estimates.push_back(fit.values[p]);
  }
  return fitted;
}

const BoundedCase& get_bounds(const BoundedCase& bounded) { return bounded; }
const BoundedCase& get_bounds(const FittedCase& fit) { return fit.bounds; }

/// Whether the items belong to these test cases. A resumed sweep may have repaired further cases.
template <class Item>
bool match_cases(const std::vector<Item>& items, const std::vector<TestCase>& cases) {
  return std::equal(
      items.begin(), items.end(), cases.begin(), cases.end(),
      [](const Item& item, const TestCase& c) { return get_bounds(item).number == c.number; });
}

/// A file of items, one per test case, and how it is made.
template <class Item>
struct LimitsFile {
  fs::path path;
  std::function<std::vector<Item>()> read;
  std::function<Item(const TestCase&)> calc;
  std::function<void(const std::vector<Item>&)> write;
};

/// True where the file exists and belongs to these cases; adds a note where it must be replaced.
template <class Item>
bool is_done(const LimitsFile<Item>& file, const std::vector<TestCase>& cases,
             std::vector<std::string>& notes) {
  if (!fs::exists(file.path)) return false;
  try {
    if (match_cases(file.read(), cases)) return true;
    notes.push_back(
        fmt::format("{}: computed anew: it belonged to other cases", file.path.string()));
  } catch (const InputError& e) {
    notes.push_back(fmt::format("{}: computed anew: {}", file.path.string(), e.what()));
  }
  return false;
}

/// Computes and writes the file unless it is done; false once halted.
template <class Item>
bool update_file(const LimitsFile<Item>& file, const std::vector<TestCase>& cases, int threads,
                 NoiseLimitsProgress& progress, std::vector<std::string>& notes,
                 std::atomic<bool>& halt) {
  if (is_done(file, cases, notes)) {
    progress.done += cases.size();
    return true;
  }
  std::vector<Item> items(cases.size());
  share_items(threads, cases.size(), [&](std::size_t i, int) {
    if (halt) return;
    items[i] = file.calc(cases[i]);
    ++progress.done;
  });
  if (halt) return false;
  file.write(items);
  return true;
}

LimitsFile<BoundedCase> make_bounds_file(const fs::path& folder, const NoiseStudyData& data,
                                         const NoiseSnapshots& snapshots) {
  const fs::path path = find_bounds_file(folder, snapshots);
  const std::vector<std::string> parameters = list_axes(snapshots.sweep);
  return {
      path, [=] { return read_bounds(path, parameters); },
      [&](const TestCase& test) {
        return BoundedCase{test.number, calc_snapshot_bounds(snapshots, data.inputs, test.setup)};
      },
      [=](const auto& items) { write_bounds(path, parameters, items); }};
}

LimitsFile<FittedCase> make_fits_file(const fs::path& folder, const NoiseStudyRequest& request,
                                      const NoiseStudyData& data, double scale) {
  const fs::path path = find_fits_file(folder, scale);
  const std::vector<std::string> parameters = list_axes(data.snapshots.front().sweep);
  return {path, [=] { return read_fits(path, parameters); },
          [&, scale](const TestCase& test) { return fit_record(request, data, scale, test); },
          [=](const auto& items) { write_fits(path, parameters, items); }};
}

}  // namespace

NoiseLimitsSummary update_noise_limits(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                       const NoiseLimitsOptions& options,
                                       NoiseLimitsProgress& progress, std::atomic<bool>& halt) {
  NoiseLimitsSummary summary;
  const std::vector<TestCase> windows = list_window_cases(request, data);
  progress.total = request.scales.size() * windows.size();
  std::vector<std::vector<TestCase>> snapshots;  // by preload
  snapshots.reserve(data.snapshots.size());
  for (const NoiseSnapshots& s : data.snapshots) {
    snapshots.push_back(list_test_cases(request, data, s));
    progress.total += snapshots.back().size();
  }
  const auto update = [&](const auto& file, const std::vector<TestCase>& cases) {
    return update_file(file, cases, options.threads, progress, summary.notes, halt);
  };
  for (std::size_t i = 0; i < snapshots.size() && !summary.stopped; ++i) {
    const auto file = make_bounds_file(options.folder, data, data.snapshots[i]);
    summary.stopped = !update(file, snapshots[i]);
  }
  for (std::size_t i = 0; i < request.scales.size() && !summary.stopped; ++i) {
    const auto file = make_fits_file(options.folder, request, data, request.scales[i]);
    summary.stopped = !update(file, windows);
  }
  return summary;
}

}  // namespace strut
