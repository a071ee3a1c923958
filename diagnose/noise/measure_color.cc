#include "diagnose/noise/measure_color.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "base/parallel/team.h"
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

bool measure_drift_beside_roads(const ReadingModel& model, const Whitener& sensors,
                                const Eigen::VectorXd& residual,
                                std::vector<NoiseSpectrum>& spectra, int threads) {
  std::vector<Eigen::VectorXd> leverages(spectra.size());
  share_items(threads, spectra.size(),
              [&](std::size_t r, int) { leverages[r] = calc_leverage(*sensors.roads()[r]); });
  ChannelSpectra list;
  for (std::size_t r = 0; r < spectra.size(); ++r) {
    const NoiseSpectrum& s = spectra[r];
    const std::vector<int>& channels = model.channels()[r];
    const std::vector<double> none(s.samples / 2 + 1, 0.0);
    std::vector<ResidualSpectrum> of_run(channels.size(),
                                         {s.samples, s.interval, none, none, none});
    const Eigen::VectorXd whitened = sensors.apply_sensors(r, residual);
    const std::size_t begin = sensors.run_begin()[r];
    for (std::size_t i = begin; i < sensors.run_begin()[r + 1]; ++i) {
      const ReadingPlace& place = sensors.places()[i];
      const auto at = static_cast<Eigen::Index>(i - begin);
      const bool is_real = place.time == 0 || 2 * place.time == s.samples;
      const double part = is_real ? 1.0 : 0.5;
      ResidualSpectrum& of = of_run[place.channel];
      of.power[place.time] += part * whitened(at) * whitened(at);
      of.freedom[place.time] += part * (1.0 - leverages[r](at));
      of.expected[place.time] = sensors.get_share(r);
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      ResidualSpectrum& of = of_run[c];
      for (std::size_t k = 0; k < of.power.size(); ++k) {
        if (of.expected[k] > 0.0) of.power[k] /= std::max(of.freedom[k], 1e-6);
      }
      list[channels[c]].push_back(std::move(of));
    }
  }
  std::map<int, double> corners;
  for (const auto& [channel, runs] : list) corners[channel] = estimate_corner(runs);
  for (std::size_t r = 0; r < spectra.size(); ++r) {
    std::vector<SensorColor>& colors = spectra[r].color;
    if (colors.empty()) {
      for (const int channel : model.channels()[r]) colors.push_back({channel, 0.0, {}});
    }
    for (SensorColor& color : colors) color.corner = corners[color.channel];
  }
  return std::any_of(corners.begin(), corners.end(), [](const auto& c) { return c.second > 0.0; });
}

}  // namespace strut
