#include "study/noise/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "estimate/design.h"
#include "estimate/readings.h"
#include "model_files/parameters.h"
#include "train/data/split.h"
#include "train/window/records.h"

namespace strut {
namespace {

std::vector<std::int64_t> choose_cases(const NoiseStudyRequest& request, const SplitChoice& choice,
                                       std::size_t usable) {
  const Split split = make_split(static_cast<std::int64_t>(usable), choice);
  const auto count = static_cast<std::size_t>(request.fits);
  std::vector<std::int64_t> rows;
  rows.reserve(count);
  for (std::int64_t row = 0; row < split.size() && rows.size() < count; ++row) {
    if (split.find_part(row) == Part::kTest) rows.push_back(row);
  }
  return rows;
}

/// The middle of the grid with `values` of its axes.
Case make_setup(const SweepRequest& sweep, std::span<const double> values) {
  Case setup = make_base_point(sweep.base, sweep.grid, {}, {});
  for (std::size_t a = 0; a < values.size(); ++a) {
    set_parameter(setup, sweep.grid.axes()[a].name, values[a]);
  }
  return setup;
}

/// The last columns of a row.
std::span<const double> take_end(std::span<const double> row, std::size_t count) {
  return row.subspan(row.size() - count);
}

/// Test cases among rows whose last columns are the values of the axes.
std::vector<TestCase> make_cases(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                 const SweepRequest& sweep, const RowStore& rows) {
  std::vector<TestCase> cases;
  std::vector<double> row(rows.columns());
  for (const std::int64_t number : choose_cases(request, data.common.split, rows.row_count())) {
    rows.read(static_cast<std::size_t>(number), 1, row.data());
    cases.push_back({number, make_setup(sweep, take_end(row, sweep.grid.axes().size()))});
  }
  return cases;
}

/// Residuals of a noise-free record against readings of zero, simulated with a fourth of the step
/// and four times the samples of a fit. The remaining error is a hundredth of the noise of real
/// sensors (docs/fit.md).
Eigen::VectorXd simulate_readings(const MeasuredRun& run, const std::string& parameter) {
  LinearizeOptions options;
  options.integrate.options.step.step /= 4.0;
  options.integrate.options.step.coarse_step = 0.0;
  options.rate *= 4.0;
  // The readings need an unknown; which one does not matter.
  const auto model = make_readings({run}, {make_parameter({run}, parameter)}, options);
  const Linearization at = model->linearize({get_parameter(run.setup.car(), parameter)});
  if (!at.failure.empty()) throw InputError(fmt::format("{}: {}", run.name, at.failure));
  return at.residual;
}

}  // namespace

std::vector<TestCase> list_test_cases(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                      const NoiseSnapshots& snapshots) {
  Dataset dataset({snapshots.data});
  const UsableRows usable =
      read_usable_rows(dataset, {data.inputs, list_axes(snapshots.sweep)}, data.common.store);
  return make_cases(request, data, snapshots.sweep, usable.rows);
}

std::vector<TestCase> list_window_cases(const NoiseStudyRequest& request,
                                        const NoiseStudyData& data) {
  const NoiseModel noise = make_window_noise(request, list_history_channels(data.window), 1.0);
  Dataset dataset({data.window_data}, {.histories = true});
  const std::size_t spare = count_spare(dataset.schema(), noise);
  const WindowGrid grid = make_window_grid(dataset.schema(), request.window, spare);
  const WindowRecords records =
      read_window_records(dataset, {list_history_channels(data.window), list_axes(data.window)},
                          grid, spare, data.common.store);
  return make_cases(request, data, data.window, records.rows);
}

MeasuredRun draw_record(const NoiseStudyRequest& request, const NoiseStudyData& data, double scale,
                        const TestCase& test) {
  const NoiseModel noise = *make_window_training(request, data, scale).request.noise;
  const NoiseDraw draw(noise, test.number, 0);
  MeasuredRun run = make_planned_run(test.setup, make_default_noise(), data.window.history.rate,
                                     request.window.from, request.window.to);
  run.channels.clear();  // replaced by those of the histories, in their order
  for (std::size_t c = 0; c < noise.sigma.size(); ++c) {
    run.channels.push_back({data.window.history.channels[c], noise.sigma[c],
                            std::vector<double>(run.times.size(), 0.0)});
  }
  run.name = fmt::format("case {}", test.number);
  const std::vector<double> times = run.times;
  for (double& time : run.times) time -= draw.calc_hit_time();
  const Eigen::VectorXd residuals = simulate_readings(run, list_axes(data.window).front());
  run.times = times;
  run.setup = Model(make_base_point(data.window.base, data.window.grid, {}, {}));
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    for (MeasuredChannel& c : run.channels) c.values[i] = c.sigma * residuals(next++);
  }
  for (std::size_t c = 0; c < run.channels.size(); ++c) draw.add(c, run.channels[c].values);
  return run;
}

}  // namespace strut
