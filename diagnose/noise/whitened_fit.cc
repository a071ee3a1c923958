#include "diagnose/noise/whitened_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error/input_error.h"
#include "diagnose/baseline/time_windows.h"
#include "diagnose/noise/chord_search.h"
#include "diagnose/noise/measure_color.h"
#include "diagnose/noise/road_search.h"

namespace strut {

SharedValues WhitenedFit::shared() const {
  const auto count = static_cast<std::ptrdiff_t>(shared_count);
  return {{fit.unknowns.begin(), fit.unknowns.begin() + count},
          {fit.values.begin(), fit.values.begin() + count}};
}

namespace {

/// Of a run before it meets its bump: by how much the mean square of each channel exceeds that of
/// its sensor, over that of a road with G0 = 1 m^3; the median of the channels. Nothing where too
/// little of the run comes before.
std::optional<double> measure_approach(const CampaignData& data, std::size_t run,
                                       std::size_t number, const ReadingModel& model,
                                       const NoiseSpectrum& spectrum,
                                       const Eigen::VectorXd& residual) {
  constexpr std::size_t kEnough = 50;  // samples
  const double end = make_time_windows(data, run).front().to;
  const std::size_t channels = spectrum.sigma.size();
  std::vector<double> squares(channels, 0.0), means(channels, 0.0);
  std::vector<std::size_t> counts(channels, 0);
  for (std::size_t k = 0; k < model.reading_count(); ++k) {
    const ReadingPlace& place = model.readings()[k];
    if (place.run != number || data.times(run)[place.time] >= end) continue;
    const double r = residual(static_cast<Eigen::Index>(k));
    squares[place.channel] += r * r;
    means[place.channel] += r;
    ++counts[place.channel];
  }
  std::vector<double> levels;
  for (std::size_t c = 0; c < channels; ++c) {
    if (counts[c] < kEnough) continue;
    // Variance of the channel over sigma^2 per m^3.
    const double unit = calc_common_variance(spectrum, c) / (spectrum.sigma[c] * spectrum.sigma[c]);
    const auto n = static_cast<double>(counts[c]);
    const double variance = squares[c] / n - (means[c] / n) * (means[c] / n);
    if (unit > 0.0) levels.push_back(std::max(0.0, variance - 1.0) / unit);
  }
  if (levels.empty()) return std::nullopt;
  std::sort(levels.begin(), levels.end());
  return levels[levels.size() / 2];
}

/// By runs over level ground, where there are some; else by what comes before the bumps, which no
/// effect of the car reaches.
Roughness measure_roughness(const CampaignData& data, const std::vector<std::size_t>& runs,
                            const ReadingModel& model, const std::vector<NoiseSpectrum>& spectra,
                            const Eigen::VectorXd& residual) {
  std::vector<bool> is_level;
  std::vector<double> approaches;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    is_level.push_back(!meets_bump(data, runs[i]));
    const auto level = measure_approach(data, runs[i], i, model, spectra[i], residual);
    if (level) approaches.push_back(*level);
  }
  if (std::find(is_level.begin(), is_level.end(), true) != is_level.end()) {
    return fit_roughness(model, spectra, is_level, residual);
  }
  constexpr double kResponseError = 0.02;
  if (approaches.empty()) return {0.0, kResponseError};
  std::sort(approaches.begin(), approaches.end());
  return {approaches[approaches.size() / 2], kResponseError};
}

}  // namespace

std::vector<NoiseSpectrum> measure_noise(const CampaignData& data, const Baseline& baseline) {
  std::vector<NoiseSpectrum> spectra =
      make_noise_spectra(data, baseline.runs, baseline.fit.unknowns, baseline.fit.values);
  const auto model = make_reading_model(data, baseline.runs, baseline.fit.unknowns);
  const Evaluation at = model->evaluate(baseline.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  if (!data.has_inputs()) {
    const Roughness roughness =
        measure_roughness(data, baseline.runs, *model, spectra, at.residual);
    for (NoiseSpectrum& s : spectra) {
      s.level = roughness.level;
      s.response_error = roughness.response_error;
    }
  }
  measure_color(*model, at.residual, spectra);
  return spectra;
}

namespace {

/// Where the inputs are recorded, what is beyond the sensors' noise is what is looked for: nothing
/// of it counts as noise.
void fit_driven(ReadingModel& model, const std::vector<double>& start, WhitenedFit& result) {
  FitOptions options;
  options.start = start;
  const Whitener whitener(model, result.spectra);
  WhitenedModel whitened(model, whitener);
  result.fit = fit_readings(whitened, options);
  result.is_dominated = result.fit.chi2_per_degree() > kDominated;
}

/// The fit where the search stands, with derivatives of there; searches on where they see more of
/// a way than it should be.
void conclude(ChordSearch& search, ReadingModel& model, const Whitener& whitener,
              WhitenedFit& result) {
  constexpr int kTries = 3;
  const WhitenedModel whitened(model, whitener);
  for (int i = 0; i < kTries; ++i) {
    if (i > 0) search.search(whitener);
    search.renew();
    result.linearization = search.linearization();
    const Linearization at = {"", whitener.apply_residual(search.residual()),
                              whitener.apply(result.linearization->jacobian)};
    result.fit =
        describe_fit(whitened, at, search.values(), search.list_at_bound(), search.at_kink());
    if (result.fit.converged || search.at_kink()) break;
  }
  result.fit.iterations = search.steps();
  result.fit.simulations = model.simulation_count();
}

/// By the road's spectrum. A rough road excites what is not linear, too: what a band has beyond its
/// noise counts as noise. It is known only once the fit is there, and moves it.
void fit_crossing(ReadingModel& model, const std::vector<double>& start, WhitenedFit& result) {
  constexpr int kRounds = 2;
  ChordSearch search(model, start);
  for (int round = 0; round < kRounds; ++round) {
    const Whitener whitener(model, result.spectra);
    search.search(whitener);
    const Eigen::VectorXd residual = whitener.apply_residual(search.residual());
    if (round == 0) {
      result.is_dominated =
          residual.squaredNorm() > kDominated * static_cast<double>(residual.size());
      if (!result.is_dominated) {
        count_excess(whitener, residual, result.spectra);
        continue;
      }
    }
    conclude(search, model, whitener, result);
    break;
  }
}

/// Throws InputError where chi2 is not finite, with the run and the channel of the first residual
/// that is not.
void check_finite(const CampaignData& data, ReadingModel& model, const WhitenedFit& result) {
  if (std::isfinite(result.fit.chi2)) return;
  const Evaluation at = model.evaluate(result.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  for (std::size_t i = 0; i < model.reading_count(); ++i) {
    if (std::isfinite(at.residual(static_cast<Eigen::Index>(i)))) continue;
    const ReadingPlace& place = model.readings()[i];
    const std::size_t run = result.runs[place.run];
    throw InputError(fmt::format(
        "{}: {}: the residual at {:.6g} s is not finite", data.campaign.runs[run].name,
        data.info(data.channels(run)[place.channel].channel).name, data.times(run)[place.time]));
  }
  throw InputError(fmt::format("{}: chi2 of the fit is not finite", data.campaign.path.string()));
}

}  // namespace

WhitenedFit fit_whitened(const CampaignData& data, const std::vector<std::size_t>& runs,
                         const RunNoise& noise, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& start, std::size_t shared_count, int threads) {
  WhitenedFit result;
  result.runs = runs;
  result.spectra = noise.spectra;
  result.roads = noise.roads;
  result.shared_count = shared_count;
  if (!result.roads.empty() &&
      !search_roads(data, unknowns, start, noise.is_level_known, threads, result)) {
    result.spectra = noise.spectra;
    result.roads.clear();
  }
  const auto model = make_reading_model(data, runs, result.roads, unknowns, threads);
  if (data.has_inputs()) {
    fit_driven(*model, start, result);
  } else if (result.roads.empty()) {
    fit_crossing(*model, start, result);
  }
  check_finite(data, *model, result);
  return result;
}

}  // namespace strut
