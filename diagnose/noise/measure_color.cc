#include "diagnose/noise/measure_color.h"

#include <map>
#include <numeric>
#include <utility>

#include "diagnose/noise/whitened_fit.h"

namespace strut {
namespace {

/// Residual spectra of one channel by run; runs without it are left out.
using ChannelSpectra = std::map<int, std::vector<ResidualSpectrum>>;

/// Periodograms of the residuals, by channel of the model, without the channels' correlation.
ChannelSpectra calc_residual_spectra(const ReadingModel& model, const Eigen::VectorXd& residual,
                                     std::vector<NoiseSpectrum> spectra) {
  const std::vector<NoiseSpectrum> noise = spectra;
  for (NoiseSpectrum& s : spectra) s.common.clear();
  const Whitener whitener(model, std::move(spectra));
  const Eigen::VectorXd whitened = whitener.apply_residual(residual);
  ChannelSpectra list;
  std::size_t run = noise.size();
  for (std::size_t i = 0; i < whitener.whitened_count(); ++i) {
    const ReadingPlace& place = whitener.places()[i];
    const NoiseSpectrum& s = noise[place.run];
    const std::vector<int>& channels = model.channels()[place.run];
    if (place.run != run) {
      run = place.run;
      const std::vector<double> none(s.samples / 2 + 1, 0.0);
      for (const int channel : channels)
        list[channel].push_back({s.samples, s.interval, none, none});
    }
    ResidualSpectrum& of = list[channels[place.channel]].back();
    const bool is_real = place.time == 0 || 2 * place.time == s.samples;
    const auto at = static_cast<Eigen::Index>(place.channel);
    const double w = whitened(static_cast<Eigen::Index>(i));
    const double common = place.time < s.common.size()
                              ? s.level * s.common[place.time](at, at).real() /
                                    (s.sigma[place.channel] * s.sigma[place.channel])
                              : 0.0;
    of.power[place.time] += (is_real ? 1.0 : 0.5) * w * w;
    of.expected[place.time] = whitener.get_share(place.run) * (1.0 + common);
  }
  return list;
}

/// Whether the model's error is far larger than the noise.
bool is_dominated(const ChannelSpectra& list) {
  double power = 0.0, expected = 0.0;
  for (const auto& [channel, runs] : list) {
    for (const ResidualSpectrum& s : runs) {
      power += std::accumulate(s.power.begin(), s.power.end(), 0.0);
      expected += std::accumulate(s.expected.begin(), s.expected.end(), 0.0);
    }
  }
  return power > kDominated * expected;
}

}  // namespace

void measure_color(const ReadingModel& model, const Eigen::VectorXd& residual,
                   std::vector<NoiseSpectrum>& spectra) {
  const ChannelSpectra list = calc_residual_spectra(model, residual, spectra);
  if (is_dominated(list)) return;
  std::map<int, SensorColor> colors;
  for (const auto& [channel, runs] : list) colors[channel] = estimate_color(channel, runs);
  for (std::size_t r = 0; r < spectra.size(); ++r) {
    for (const int channel : model.channels()[r]) spectra[r].color.push_back(colors[channel]);
  }
}

}  // namespace strut
