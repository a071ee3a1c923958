#include "diagnose/compare/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error/input_error.h"
#include "base/math/spread.h"
#include "diagnose/baseline/model_states.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "diagnose/compare/deciding_noise.h"
#include "diagnose/noise/whitened_fit.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

ChannelComparison compare_channel(const CampaignData& data, std::size_t run, std::size_t k,
                                  const RunEvaluation& evaluation, const NoiseFloor& floor,
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
  c.adequacy = {floor, c.count, c.rms};
  const double limit = c.adequacy.calc_limit() * floor.sigma / c.sigma;
  c.limit = limit * limit;
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

/// Where nothing is free, the runs' own values are fitted for the measurement of the noise.
NoiseFloors measure_floors(const CampaignData& data, const Baseline& baseline, int threads) {
  try {
    Baseline fitted = baseline;
    if (!baseline.is_fitted) {
      fitted.fit = fit_readings(*make_reading_model(
          data, baseline.runs, make_run_unknowns(data, baseline.runs, {}), threads));
    }
    return calc_noise_floors(data, baseline.runs, measure_noise(data, fitted, threads),
                             baseline.calibrated, threads);
  } catch (const InputError&) {  // comparing the runs reports the failure
    return list_sensor_floors(data);
  }
}

}  // namespace

void add_misfits(const CampaignData& data, const std::vector<PriorConflict>& conflicts,
                 std::vector<Misfit>& misfits) {
  for (const PriorConflict& c : conflicts) {
    if (c.calc_distance() > kMaxDistance) misfits.push_back({c.run, describe_conflict(data, c)});
  }
}

void add_misfits(const CampaignData& data, std::size_t run, const ModelComparison& model,
                 std::vector<Misfit>& misfits) {
  std::string failure = model.evaluation.failure;
  if (failure.empty() && model.channels.empty()) {
    failure = data.campaign.runs[run].name + ": no channel is compared";
  }
  if (!failure.empty()) {
    misfits.push_back({run, std::move(failure)});
    return;
  }
  for (const ChannelComparison& c : model.channels) {
    if (c.is_adequate()) continue;
    misfits.push_back({run, "", c.channel, c.adequacy.calc_times_noise(), c.adequacy.calc_limit(),
                       c.rms, c.nrmse});
  }
  add_misfits(data, model.conflicts, misfits);
}

ModelComparison compare_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                            const std::vector<NoiseFloor>& floors,
                            const std::vector<TimeWindow>& windows, int threads) {
  ModelComparison result{evaluate_run(data, run, shared, threads), {}, {}};
  if (!result.evaluation.failure.empty()) return result;
  if (is_mostly_white(floors)) {
    result.conflicts =
        list_prior_conflicts(result.evaluation.unknowns, result.evaluation.values, run);
  }
  const std::vector<StateCurve> states = list_states(data, result.evaluation.curves);
  const std::size_t count = data.channels(run).size();
  result.channels.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    result.channels.push_back(
        compare_channel(data, run, k, result.evaluation, floors[k], states, windows));
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
  const NoiseFloors floors = measure_floors(data, baseline, threads);
  comparison.conflicts =
      list_prior_conflicts(baseline.calibrated.unknowns, baseline.calibrated.values, 0);
  add_misfits(data, comparison.conflicts, comparison.misfits);
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    RunComparison run;
    run.run = r;
    run.windows = make_time_windows(data, r);
    run.nominal = compare_run(data, r, baseline.nominal, floors[r], run.windows, threads);
    run.calibrated = compare_run(data, r, baseline.calibrated, floors[r], run.windows, threads);
    run.balance = calc_body_balance(
        set_unknowns(data.runs[r], baseline.calibrated.unknowns, baseline.calibrated.values));
    run.car_balance =
        calc_car_balance(data, r, baseline.calibrated, run.calibrated.evaluation, threads);
    add_misfits(data, r, run.calibrated, comparison.misfits);
    comparison.conflicts.insert(comparison.conflicts.end(), run.calibrated.conflicts.begin(),
                                run.calibrated.conflicts.end());
    comparison.runs.push_back(std::move(run));
  }
  std::vector<const ModelComparison*> models;
  models.reserve(comparison.runs.size());
  for (const RunComparison& run : comparison.runs) models.push_back(&run.calibrated);
  comparison.notes = describe_deciding_noise(data, models);
  return comparison;
}

}  // namespace strut
