#include "jobs/study/noise_limits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel/team.h"
#include "estimate/design.h"
#include "estimate/fit.h"
#include "estimate/nuisances.h"
#include "jobs/cli/machine.h"
#include "jobs/study/noise_limits_file.h"
#include "jobs/study/noise_records.h"
#include "model_files/find_channel.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

void require_finite(double bound, const std::string& name, const std::string& what) {
  if (std::isfinite(bound)) return;
  throw InputError("[noise]: " + what + " leaves " + name +
                   " free: no bound; needs other inputs, channels or instants");
}

/// The snapshot's bounds at scale 1.
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
    require_finite(bounds.bound[p], parameter.name, "the snapshot, preload " + snapshots.preload);
    result.push_back({parameter.base, 0.01 * bounds.bound[p] * parameter.scale});
  }
  return result;
}

/// What is not known of a record: the unknowns of a fit, the parameters first.
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
    // Of the uniform distribution over the axis.
    if (axis.name == "speed") sigmas.speed = std::abs(axis.last() - axis.from) / std::sqrt(12.0);
  }
  for (Unknown& u : make_nuisances(runs, sigmas, unknowns)) unknowns.push_back(std::move(u));
  return unknowns;
}

FittedCase fit_record(const NoiseStudyRequest& request, const NoiseStudyData& data, double scale,
                      const TestCase& test) {
  std::vector<MeasuredRun> runs = {draw_record(request, data, scale, test)};
  const double begin = now();
  const FitResult fit = fit_simulation(runs, list_unknowns(request, data, runs));
  FittedCase fitted;
  fitted.seconds = now() - begin;
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

/// Computes item after item on several threads; false where it was halted.
template <class Item, class Calc>
bool calc_items(int threads, NoiseLimitsProgress& progress, std::atomic<bool>& halt,
                std::vector<Item>& items, const Calc& calc) {
  share_items(threads, items.size(), [&](std::size_t i, int) {
    if (halt) return;
    items[i] = calc(i);
    ++progress.done;
  });
  return !halt;
}

const BoundedCase& get_bounds(const BoundedCase& bounded) { return bounded; }
const BoundedCase& get_bounds(const FittedCase& fit) { return fit.bounds; }

/// Whether what was computed is of these test cases. A resumed sweep may have mended others.
template <class Item>
bool is_of(const std::vector<Item>& items, const std::vector<TestCase>& cases) {
  return std::equal(
      items.begin(), items.end(), cases.begin(), cases.end(),
      [](const Item& item, const TestCase& c) { return get_bounds(item).number == c.number; });
}

/// True where the file is there and of these cases; a note where it is not what it should be.
template <class Read>
bool is_done(const fs::path& file, const std::vector<TestCase>& cases, const Read& read,
             std::vector<std::string>& notes) {
  if (!fs::exists(file)) return false;
  try {
    if (is_of(read(), cases)) return true;
    notes.push_back(file.string() + ": computed anew, it was of other cases");
  } catch (const InputError& e) {
    notes.push_back(file.string() + ": computed anew: " + e.what());
  }
  return false;
}

/// All that update_noise_limits works with.
struct Work {
  const NoiseStudyRequest& request;
  const NoiseStudyData& data;
  const fs::path& folder;
  int threads;
  NoiseLimitsProgress& progress;
  std::vector<std::string>& notes;
  std::atomic<bool>& halt;
  std::vector<std::string> parameters = list_axes(data.snapshots.front().sweep);
};

bool update_bounds(Work& work, const NoiseSnapshots& snapshots,
                   const std::vector<TestCase>& cases) {
  const fs::path file = find_bounds_file(work.folder, snapshots);
  const auto read = [&] { return read_bounds(file, work.parameters); };
  if (is_done(file, cases, read, work.notes)) {
    work.progress.done += cases.size();
    return true;
  }
  std::vector<BoundedCase> bounded(cases.size());
  const bool whole =
      calc_items(work.threads, work.progress, work.halt, bounded, [&](std::size_t i) {
        return BoundedCase{cases[i].number,
                           calc_snapshot_bounds(snapshots, work.data.inputs, cases[i].setup)};
      });
  if (whole) write_bounds(file, work.parameters, bounded);
  return whole;
}

bool update_fits(Work& work, const std::vector<TestCase>& cases, double scale) {
  const fs::path file = find_fits_file(work.folder, scale);
  const auto read = [&] { return read_fits(file, work.parameters); };
  if (is_done(file, cases, read, work.notes)) {
    work.progress.done += cases.size();
    return true;
  }
  std::vector<FittedCase> fits(cases.size());
  const bool whole = calc_items(work.threads, work.progress, work.halt, fits, [&](std::size_t i) {
    return fit_record(work.request, work.data, scale, cases[i]);
  });
  if (whole) write_fits(file, work.parameters, fits);
  return whole;
}

}  // namespace

bool update_noise_limits(const NoiseStudyRequest& request, const NoiseStudyData& data,
                         const fs::path& folder, int threads, NoiseLimitsProgress& progress,
                         std::vector<std::string>& notes, std::atomic<bool>& halt) {
  Work work{request, data, folder, threads, progress, notes, halt};
  const std::vector<TestCase> windows = list_window_cases(request, data);
  progress.total = request.scales.size() * windows.size();
  std::vector<std::vector<TestCase>> cases;  // of the snapshots
  cases.reserve(data.snapshots.size());
  for (const NoiseSnapshots& snapshots : data.snapshots) {
    cases.push_back(list_test_cases(request, data, snapshots));
    progress.total += cases.back().size();
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!update_bounds(work, data.snapshots[i], cases[i])) return false;
  }
  for (const double scale : request.scales) {
    if (!update_fits(work, windows, scale)) return false;
  }
  return true;
}

}  // namespace strut
