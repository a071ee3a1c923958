#include "diagnose/noise/noise_floor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

/// The color of a channel's sensor in the runs of a fit; white where none of them has the channel.
SensorColor find_color(const std::vector<NoiseSpectrum>& fitted, int channel) {
  for (const NoiseSpectrum& s : fitted) {
    for (const SensorColor& color : s.color) {
      if (color.channel == channel) return color;
    }
  }
  return {};
}

/// What a run kept apart has in common with those of a fit.
void share_noise(const std::vector<NoiseSpectrum>& fitted,
                 const std::vector<MeasuredChannel>& channels, NoiseSpectrum& kept) {
  for (const MeasuredChannel& c : channels) kept.color.push_back(find_color(fitted, c.channel));
  kept.level = fitted.front().level;
  kept.response_error = fitted.front().response_error;
  for (std::size_t b = 0; b < kept.excess.size(); ++b) {
    double sum = 0.0;
    for (const NoiseSpectrum& s : fitted) sum += s.excess[b];
    kept.excess[b] = sum / static_cast<double>(fitted.size());
  }
}

/// Floors of one run by the sensors alone, for a run that cannot be simulated.
std::vector<NoiseFloor> list_sensor_floors(const CampaignData& data, std::size_t run) {
  std::vector<NoiseFloor> floors;
  for (const MeasuredChannel& c : data.channels(run)) {
    floors.push_back({c.sigma, 0.0, data.find_noise(c.channel).uncertainty});
  }
  return floors;
}

std::vector<NoiseFloor> list_floors(const CampaignData& data, std::size_t run,
                                    const NoiseSpectrum& spectrum) {
  std::vector<NoiseFloor> floors;
  for (std::size_t k = 0; k < data.channels(run).size(); ++k) {
    floors.push_back(calc_noise_floor(data, run, k, spectrum));
  }
  return floors;
}

/// Variance of a sensor beyond its white noise, over sigma^2.
double calc_color_variance(const NoiseSpectrum& s, std::size_t channel) {
  if (s.color.empty() || s.samples == 0) return 0.0;
  const double samples = static_cast<double>(s.samples);
  double variance = 0.0;
  for (std::size_t k = 1; 2 * k <= s.samples; ++k) {
    // Every frequency stands for its negative, too, but for the end of the spectrum.
    const double both = 2 * k == s.samples ? 1.0 : 2.0;
    const double frequency = static_cast<double>(k) / (samples * s.interval);
    variance += both / samples * calc_color(s.color[channel], frequency, s.samples, s.interval);
  }
  return variance;
}

/// Null for a run that cannot be simulated; evaluating it reports the failure.
std::optional<NoiseSpectrum> try_spectrum(const CampaignData& data, std::size_t run,
                                          const std::vector<NoiseSpectrum>& fitted,
                                          const SharedValues& shared) {
  try {
    return make_spectrum_of_run(data, run, fitted, shared);
  } catch (const InputError&) {
  } catch (const ModelError&) {
  }
  return std::nullopt;
}

}  // namespace

double calc_floor_tolerance(const NoiseFloor& floor, std::size_t count) {
  if (count == 0) return 0.0;
  const double level =
      1.0 + 2.0 * floor.uncertainty + floor.common_tolerance * floor.common_fraction;
  const double scatter = kAdequateSigmas * std::sqrt(2.0 / static_cast<double>(count));
  return level * std::sqrt(1.0 + scatter) - 1.0;
}

bool is_mostly_white(const std::vector<NoiseFloor>& floors) {
  return std::all_of(floors.begin(), floors.end(),
                     [](const NoiseFloor& floor) { return floor.common_fraction < 0.5; });
}

NoiseFloor calc_noise_floor(const CampaignData& data, std::size_t run, std::size_t channel,
                            const NoiseSpectrum& spectrum) {
  const int number = data.channels(run)[channel].channel;
  const double white = spectrum.sigma[channel] * spectrum.sigma[channel];
  const double color = white * calc_color_variance(spectrum, channel);
  const double through_model = calc_noise_variance(spectrum, channel) - white;
  const double variance = white + color + through_model;
  if (!std::isfinite(variance) || !(variance > 0.0)) {
    throw InputError(fmt::format("{}: {}: its noise has the variance {}; expected a positive one",
                                 data.campaign.runs[run].name, data.info(number).name, variance));
  }
  NoiseFloor floor{std::sqrt(variance), (color + through_model) / variance,
                   data.find_noise(number).uncertainty};
  if (floor.common_fraction > 0.0) {
    const double tolerance = data.has_inputs() ? kInputTolerance : kRoadTolerance;
    floor.common_tolerance =
        (kColorTolerance * color + tolerance * through_model) / (color + through_model);
  }
  return floor;
}

NoiseSpectrum make_spectrum_of_run(const CampaignData& data, std::size_t run,
                                   const std::vector<NoiseSpectrum>& fitted,
                                   const SharedValues& shared) {
  const CampaignData one = pin_run(data, run, shared);
  const std::vector<Unknown> unknowns = make_run_unknowns(one, {0}, shared.unknowns);
  NoiseSpectrum spectrum = make_noise_spectra(one, {0}, unknowns, list_starts(unknowns)).front();
  share_noise(fitted, one.channels(0), spectrum);
  return spectrum;
}

NoiseFloors list_sensor_floors(const CampaignData& data) {
  NoiseFloors floors;
  for (std::size_t r = 0; r < data.run_count(); ++r) floors.push_back(list_sensor_floors(data, r));
  return floors;
}

NoiseFloors calc_noise_floors(const CampaignData& data, const std::vector<std::size_t>& runs,
                              const std::vector<NoiseSpectrum>& spectra, const SharedValues& shared,
                              int threads) {
  NoiseFloors floors(data.run_count());
  share_items(threads, floors.size(), [&](std::size_t r, int /*thread*/) {
    const auto found = std::find(runs.begin(), runs.end(), r);
    const auto spectrum =
        found != runs.end() ? std::optional(spectra[static_cast<std::size_t>(found - runs.begin())])
                            : try_spectrum(data, r, spectra, shared);
    floors[r] = spectrum ? list_floors(data, r, *spectrum) : list_sensor_floors(data, r);
  });
  return floors;
}

}  // namespace strut
