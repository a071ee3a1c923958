#include "diagnose/noise/roughness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error/check.h"
#include "diagnose/baseline/time_windows.h"

namespace strut {
namespace {

/// G0 from the samples of a run before its bump; nullopt if there are too few.
std::optional<double> measure_approach(const CampaignData& data, std::size_t run,
                                       std::size_t model_run, const ReadingModel& model,
                                       const NoiseSpectrum& spectrum,
                                       const Eigen::VectorXd& residual) {
  constexpr std::size_t kEnough = 50;  // samples
  const double end = make_time_windows(data, run).front().to;
  const std::size_t channels = spectrum.sigma.size();
  std::vector<double> squares(channels, 0.0), means(channels, 0.0);
  std::vector<std::size_t> counts(channels, 0);
  for (std::size_t k = 0; k < model.reading_count(); ++k) {
    const ReadingPlace& place = model.readings()[k];
    if (place.run != model_run || data.times(run)[place.time] >= end) continue;
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

}  // namespace

Roughness fit_roughness(const ReadingModel& model, const std::vector<NoiseSpectrum>& spectra,
                        const std::vector<bool>& is_level, const Eigen::VectorXd& residual) {
  constexpr double kMin = 1e-7, kMax = 1e-3, kPerDecade = 4.0;
  // Where the car answers to the road; what a tire passes on of shorter waves is less certain, and
  // there would be more of them.
  WhitenerOptions felt;
  felt.highest = 15.0;
  std::vector<Roughness> tried = {{0.0, 0.02}};
  for (const double error : {0.02, 0.1}) {
    for (double level = kMin; level < kMax; level *= std::pow(10.0, 1.0 / kPerDecade)) {
      tried.push_back({level, error});
    }
  }
  // By run, the roughness under which its residual is most likely.
  std::vector<Roughness> best(spectra.size());
  std::vector<double> most(spectra.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t r = 0; r < spectra.size(); ++r) {
    if (!is_level[r]) continue;
    for (const Roughness& roughness : tried) {
      std::vector<NoiseSpectrum> at = spectra;
      for (std::size_t i = 0; i < at.size(); ++i) {
        at[i].level = roughness.level;
        at[i].response_error = roughness.response_error;
        if (i != r) at[i].samples = 2;  // the other runs are not needed
      }
      const Whitener whitener(model, at, {}, felt);
      const double likelihood = whitener.calc_log_likelihood(whitener.apply_residual(residual), r);
      if (likelihood <= most[r]) continue;
      most[r] = likelihood;
      best[r] = roughness;
    }
  }
  std::vector<Roughness> quiet;
  for (std::size_t r = 0; r < spectra.size(); ++r) {
    if (is_level[r]) quiet.push_back(best[r]);
  }
  std::stable_sort(quiet.begin(), quiet.end(),
                   [](const Roughness& a, const Roughness& b) { return a.level < b.level; });
  STRUT_CHECK(!quiet.empty(), "fit_roughness: no run on level ground");
  return quiet[quiet.size() / 4];
}

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

}  // namespace strut
