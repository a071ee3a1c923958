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

/// Periodograms of whitened residuals, by channel of the model and run. `add(spectrum, number,
/// part)` adds what is known of each whitened number, which stands for `part` of a frequency.
template <class Add>
ChannelSpectra gather_spectra(const ReadingModel& model, const Whitener& whitener,
                              const Eigen::VectorXd& whitened, const Add& add) {
  ChannelSpectra list;
  std::size_t run = whitener.spectra().size();
  for (std::size_t i = 0; i < whitener.whitened_count(); ++i) {
    const ReadingPlace& place = whitener.places()[i];
    const NoiseSpectrum& s = whitener.spectra()[place.run];
    const std::vector<int>& channels = model.channels()[place.run];
    if (place.run != run) {
      run = place.run;
      const std::vector<double> none(s.samples / 2 + 1, 0.0);
      for (const int channel : channels) {
        list[channel].push_back({s.samples, s.interval, none, none, none});
      }
    }
    ResidualSpectrum& of = list[channels[place.channel]].back();
    const bool is_real = place.time == 0 || 2 * place.time == s.samples;
    const double part = is_real ? 1.0 : 0.5, w = whitened(static_cast<Eigen::Index>(i));
    of.power[place.time] += part * w * w;
    add(of, i, part);
  }
  return list;
}

/// Without the channels' correlation.
ChannelSpectra calc_residual_spectra(const ReadingModel& model, const Eigen::VectorXd& residual,
                                     const std::vector<NoiseSpectrum>& noise) {
  std::vector<NoiseSpectrum> alone = noise;
  for (NoiseSpectrum& s : alone) s.common.clear();
  const Whitener whitener(model, std::move(alone));
  const auto add = [&](ResidualSpectrum& of, std::size_t i, double part) {
    const ReadingPlace& place = whitener.places()[i];
    const NoiseSpectrum& s = noise[place.run];
    const auto at = static_cast<Eigen::Index>(place.channel);
    const double common = place.time < s.common.size()
                              ? s.level * s.common[place.time](at, at).real() /
                                    (s.sigma[place.channel] * s.sigma[place.channel])
                              : 0.0;
    of.expected[place.time] = whitener.get_share(place.run) * (1.0 + common);
    of.freedom[place.time] += part;
  };
  return gather_spectra(model, whitener, whitener.apply_residual(residual), add);
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
  Eigen::VectorXd whitened(static_cast<Eigen::Index>(sensors.whitened_count()));
  Eigen::VectorXd leverage(whitened.size());
  share_items(threads, spectra.size(), [&](std::size_t r, int) {
    const auto begin = static_cast<Eigen::Index>(sensors.run_begin()[r]);
    const auto count = static_cast<Eigen::Index>(sensors.run_begin()[r + 1]) - begin;
    whitened.segment(begin, count) = sensors.apply_sensors(r, residual);
    leverage.segment(begin, count) = calc_leverage(*sensors.roads()[r]);
  });
  const auto add = [&](ResidualSpectrum& of, std::size_t i, double part) {
    const ReadingPlace& place = sensors.places()[i];
    of.expected[place.time] = sensors.get_share(place.run);
    of.freedom[place.time] += part * (1.0 - leverage(static_cast<Eigen::Index>(i)));
  };
  ChannelSpectra list = gather_spectra(model, sensors, whitened, add);
  for (auto& [channel, runs] : list) {
    for (ResidualSpectrum& of : runs) {
      for (std::size_t k = 0; k < of.power.size(); ++k) {
        if (of.expected[k] > 0.0) of.power[k] /= std::max(of.freedom[k], 1e-6);
      }
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
