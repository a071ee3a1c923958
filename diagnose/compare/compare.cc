#include "diagnose/compare/compare.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math/spread.h"
#include "diagnose/baseline/model_states.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

ChannelComparison compare_channel(const CampaignData& data, std::size_t run, std::size_t k,
                                  const RunEvaluation& evaluation,
                                  const std::vector<StateCurve>& states,
                                  const std::vector<TimeWindow>& windows) {
  const MeasuredChannel& measured = data.channels(run)[k];
  const std::vector<double>& residual = evaluation.residual[k];
  const std::vector<double>& times = data.times(run);
  ChannelComparison c;
  c.channel = measured.channel;
  c.count = count_readings(residual);
  c.measured_spread = calc_spread(measured.values);
  c.rms = calc_rms(residual);
  c.nrmse = c.measured_spread > 0.0 ? c.rms / c.measured_spread : 0.0;
  c.mean = calc_mean(residual);
  c.sigma = measured.sigma;
  c.chi2_per_reading = (c.rms / c.sigma) * (c.rms / c.sigma);
  c.limit = calc_adequate_limit(c.count, data.find_noise(c.channel).uncertainty);
  c.neighbor_correlation = calc_neighbor_correlation(residual);
  c.windows = calc_window_residuals(times, residual, c.measured_spread, windows);
  c.bands = calc_band_residuals(times, residual, measured.values, c.sigma);
  c.states.reserve(states.size());
  for (const StateCurve& state : states) {
    c.states.push_back(
        calc_state_residual(state.info->name, state.info->unit, state.values, residual));
  }
  return c;
}

}  // namespace

double calc_adequate_limit(std::size_t count, double noise_uncertainty) {
  if (count == 0) return 1.0;
  const double widened = 1.0 + 2.0 * noise_uncertainty;
  return widened * widened * (1.0 + kAdequateSigmas * std::sqrt(2.0 / static_cast<double>(count)));
}

bool Comparison::is_adequate() const {
  return std::all_of(runs.begin(), runs.end(), [](const RunComparison& run) {
    const auto& channels = run.calibrated.channels;
    return !channels.empty() &&
           std::all_of(channels.begin(), channels.end(),
                       [](const ChannelComparison& c) { return c.is_adequate(); });
  });
}

ModelComparison compare_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                            const std::vector<TimeWindow>& windows, int threads) {
  ModelComparison result{evaluate_run(data, run, shared, threads), {}};
  if (!result.evaluation.failure.empty()) return result;
  const std::vector<StateCurve> states = list_states(data, result.evaluation.curves);
  const std::size_t count = data.channels(run).size();
  result.channels.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    result.channels.push_back(compare_channel(data, run, k, result.evaluation, states, windows));
  }
  return result;
}

Comparison compare_campaign(const CampaignData& data, int threads) {
  Comparison comparison;
  comparison.baseline = calibrate_baseline(data, threads);
  const Baseline& baseline = comparison.baseline;
  if (baseline.is_fitted) {
    comparison.not_identifiable =
        describe_null_directions(baseline.fit.widened, baseline.fit.unknowns);
  }
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    RunComparison run;
    run.run = r;
    run.windows = make_time_windows(data, r);
    run.nominal = compare_run(data, r, baseline.nominal, run.windows, threads);
    run.calibrated = compare_run(data, r, baseline.calibrated, run.windows, threads);
    run.balance = calc_body_balance(
        set_unknowns(data.runs[r], baseline.calibrated.unknowns, baseline.calibrated.values));
    run.car_balance =
        calc_car_balance(data, r, baseline.calibrated, run.calibrated.evaluation, threads);
    comparison.runs.push_back(std::move(run));
  }
  return comparison;
}

}  // namespace strut
