#include "diagnose/baseline/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "estimate/search_start.h"
#include "estimate/sensor_error.h"

namespace strut {
namespace {

/// The error of a channel's sensor that all runs share.
SensorError collect_shared_error(const SharedValues& shared, int channel) {
  return collect_sensor_error(shared.unknowns, shared.values, 0, channel);
}

/// Removes the shared errors of the sensors from the readings.
void correct_readings(const SharedValues& shared, MeasuredRun& run) {
  for (MeasuredChannel& c : run.channels) {
    const SensorError error = collect_shared_error(shared, c.channel);
    add_sensor_error({-error.gain, -error.skew, -error.bias}, run.times, c.values);
  }
}

/// Adds the shared errors of the sensors to the simulated channels, for comparison with the
/// readings.
void add_shared_errors(const SharedValues& shared, const std::vector<double>& times,
                       RunCurves& curves) {
  for (std::size_t c = 0; c < curves.channel.size(); ++c) {
    add_sensor_error(collect_shared_error(shared, static_cast<int>(c)), times, curves.channel[c]);
  }
}

void fill_residual(const CampaignData& data, std::size_t run, RunEvaluation& evaluation) {
  const std::vector<MeasuredChannel>& channels = data.channels(run);
  evaluation.residual.reserve(channels.size());
  for (const MeasuredChannel& c : channels) {
    const std::vector<double>& simulated =
        evaluation.curves.channel[static_cast<std::size_t>(c.channel)];
    std::vector<double> residual(c.values.size());
    for (std::size_t t = 0; t < residual.size(); ++t) residual[t] = c.values[t] - simulated[t];
    evaluation.residual.push_back(std::move(residual));
  }
}

/// Why the residuals cannot be judged, or "". A simulation may begin late or end early, by the hit
/// time or the maneuver's duration; it may not have gaps, nor miss a tenth of its start.
std::string find_gap(const CampaignData& data, std::size_t run, const RunEvaluation& evaluation) {
  constexpr double kMaxLate = 0.1;
  for (std::size_t k = 0; k < data.channels(run).size(); ++k) {
    const MeasuredChannel& c = data.channels(run)[k];
    const auto& simulated = evaluation.curves.channel[static_cast<std::size_t>(c.channel)];
    const auto is_simulated = [](double value) { return std::isfinite(value); };
    const auto first = std::find_if(simulated.begin(), simulated.end(), is_simulated);
    const auto end = std::find_if(simulated.rbegin(), simulated.rend(), is_simulated).base();
    const bool is_late = static_cast<double>(first - simulated.begin()) >
                         kMaxLate * static_cast<double>(simulated.size());
    if (!is_late && std::all_of(first, end, is_simulated)) continue;
    const auto missing = std::count_if(simulated.begin(), simulated.end(),
                                       [](double value) { return !std::isfinite(value); });
    return fmt::format("{}: {}: {} of {} simulated samples are not finite",
                       data.campaign.runs[run].name, data.info(c.channel).name, missing,
                       simulated.size());
  }
  return "";
}

}  // namespace

CampaignData pin_run(const CampaignData& data, std::size_t run, const SharedValues& shared) {
  CampaignData one = take_run(data, run);
  one.runs[0] = set_unknowns(std::move(one.runs[0]), shared.unknowns, shared.values);
  correct_readings(shared, one.runs[0]);
  return one;
}

double Baseline::calc_sigma(std::size_t i) const { return fit.widened.sigma[i]; }

Baseline calibrate_baseline(const CampaignData& data, int threads, const FitOptions& options) {
  Baseline baseline;
  baseline.runs = data.list_runs(RunUse::kFit);
  baseline.nominal.unknowns = make_free_unknowns(data, baseline.runs);
  baseline.calibrated.unknowns = baseline.nominal.unknowns;
  // A prior may start the search elsewhere than at the value of the model's file.
  for (const Unknown& u : baseline.nominal.unknowns) {
    baseline.nominal.values.push_back(get_nominal(data, u));
  }
  baseline.calibrated.values = baseline.nominal.values;
  if (baseline.nominal.unknowns.empty()) return baseline;
  std::vector<Unknown> unknowns = baseline.nominal.unknowns;
  for (Unknown& u : make_run_unknowns(data, baseline.runs, unknowns)) {
    unknowns.push_back(std::move(u));
  }
  const auto model = make_reading_model(data, baseline.runs, std::move(unknowns), threads);
  FitOptions chosen = options;
  if (data.has_inputs()) chosen.start = search_start(*model);
  baseline.fit = fit_readings(*model, chosen);
  baseline.is_fitted = true;
  const auto shared = static_cast<std::ptrdiff_t>(baseline.shared_count());
  baseline.calibrated.values.assign(baseline.fit.values.begin(),
                                    baseline.fit.values.begin() + shared);
  return baseline;
}

RunEvaluation evaluate_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                           int threads) {
  RunEvaluation evaluation;
  const CampaignData one = pin_run(data, run, shared);
  evaluation.unknowns = make_run_unknowns(one, {0}, shared.unknowns);
  evaluation.values = list_starts(evaluation.unknowns);
  if (!evaluation.unknowns.empty()) {
    const auto model = make_reading_model(one, {0}, evaluation.unknowns, threads);
    try {
      evaluation.values = fit_readings(*model).values;
    } catch (const InputError& e) {
      evaluation.failure = e.what();
      return evaluation;
    }
  }
  evaluation.curves = simulate_run(one.runs[0], evaluation.unknowns, evaluation.values);
  evaluation.failure = evaluation.curves.failure;
  if (!evaluation.failure.empty()) return evaluation;
  add_shared_errors(shared, data.times(run), evaluation.curves);
  evaluation.failure = find_gap(data, run, evaluation);
  if (evaluation.failure.empty()) fill_residual(data, run, evaluation);
  return evaluation;
}

}  // namespace strut
