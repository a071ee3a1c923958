#include "diagnose/leftover.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

namespace strut {
namespace {

using Index = Eigen::Index;

struct Cell {
  double chi2 = 0.0, count = 0.0;
};

/// Whitened numbers of one run at one frequency: rows begin, begin + 1 the real and imaginary part
/// of the first channel, and so on.
struct Bin {
  Index begin = 0, channels = 0;
  ReadingPlace place{};  // of its first number

  Eigen::VectorXcd get(const Eigen::Ref<const Eigen::VectorXd>& column) const {
    Eigen::VectorXcd values(channels);
    for (Index c = 0; c < channels; ++c) {
      values(c) = {column(begin + 2 * c), column(begin + 2 * c + 1)};
    }
    return values;
  }
};

/// All with two parts; those at the ends of the spectrum have but one.
std::vector<Bin> list_bins(const Whitener& whitener) {
  std::vector<Bin> bins;
  const std::vector<ReadingPlace>& places = whitener.places();
  for (std::size_t i = 0; i < places.size();) {
    std::size_t end = i;
    while (end < places.size() && places[end].run == places[i].run &&
           places[end].time == places[i].time) {
      ++end;
    }
    const auto channels = static_cast<Index>(places[end - 1].channel + 1);
    if (static_cast<Index>(end - i) == 2 * channels) {
      bins.push_back({static_cast<Index>(i), channels, places[i]});
    }
    i = end;
  }
  return bins;
}

/// Energy of w in the span of some directions.
double calc_energy(const Eigen::VectorXcd& w, const Eigen::MatrixXcd& directions, Index& rank) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(directions);
  rank = qr.rank();
  const Eigen::VectorXcd rotated = qr.householderQ().adjoint() * w;
  return rotated.head(rank).squaredNorm();
}

/// What stands for a force at a place: effects through which it acts.
struct Actor {
  LeftoverPlace place;
  std::vector<Index> columns;
};

std::vector<Actor> list_actors(const CampaignData& data, const std::vector<Hypothesis>& hypotheses,
                               const std::vector<HypothesisTrial>& trials) {
  std::vector<Actor> actors;
  for (const HypothesisTrial& trial : trials) {
    const Hypothesis& h = hypotheses[trial.hypothesis];
    const bool is_body = h.effect == "payload";
    const bool is_road = h.effect == "bump_height" || h.effect == "bump_length";
    LeftoverPlace place;
    place.kind = is_body ? "body" : is_road ? "road" : "strut";
    place.name = data.is_rig() && is_body ? "body" : h.place;
    const auto found = std::find_if(actors.begin(), actors.end(), [&](const Actor& a) {
      return a.place.kind == place.kind && a.place.name == place.name;
    });
    Actor& actor = found == actors.end() ? actors.emplace_back(Actor{place, {}}) : *found;
    for (const std::size_t c : trial.columns) actor.columns.push_back(static_cast<Index>(c));
  }
  return actors;
}

/// Forces in struts, on the body, from the road; each by the effect that is simplest.
std::vector<Hypothesis> list_forces(const CampaignData& data, const SharedValues& shared) {
  std::vector<Hypothesis> chosen;
  for (Hypothesis& h :
       list_hypotheses(data, shared, list_effects_on(data, shared), shared.unknowns)) {
    const bool is_strut = h.effect == "damper_fade" || h.effect == "damper_asymmetry";
    const bool is_other =
        h.effect == "payload" || h.effect == "bump_height" || h.effect == "bump_length";
    if ((is_strut && !is_corner(h.place)) || is_other) chosen.push_back(std::move(h));
  }
  return chosen;
}

/// How much of what stands out in the bins lies where each place can reach, less what as many
/// directions of no meaning would hold.
void locate(const CampaignData& data, TestBench& bench, const std::vector<Bin>& bins,
            std::vector<LeftoverPlace>& places) {
  const auto shared = static_cast<std::ptrdiff_t>(bench.shared_count());
  const SharedValues at{{bench.unknowns().begin(), bench.unknowns().begin() + shared},
                        {bench.values().begin(), bench.values().begin() + shared}};
  const std::vector<Hypothesis> forces = list_forces(data, at);
  std::vector<HypothesisTrial> trials;
  const Eigen::MatrixXd columns = bench.simulate_columns(forces, trials);
  const std::vector<Actor> actors = list_actors(data, forces, trials);
  for (const Actor& actor : actors) places.push_back(actor.place);
  const Whitener& whitener = bench.whitener();
  std::map<int, std::size_t> sensors;  // by channel of the model
  for (const Bin& bin : bins) {
    const Eigen::VectorXcd w = bin.get(bench.residual());
    const double all = w.squaredNorm(), count = static_cast<double>(bin.channels);
    const auto add = [&](LeftoverPlace& place, const Eigen::MatrixXcd& directions) {
      Index rank = 0;
      const double energy = calc_energy(w, directions, rank);
      const double share = static_cast<double>(rank) / count;
      if (share >= 1.0 || rank == 0) return;
      place.energy += (energy - share * all) / (1.0 - share);
      place.sigma = std::hypot(place.sigma, 2.0 * std::sqrt(share / (1.0 - share)));
    };
    for (std::size_t a = 0; a < actors.size(); ++a) {
      Eigen::MatrixXcd directions(bin.channels, static_cast<Index>(actors[a].columns.size()));
      for (Index c = 0; c < directions.cols(); ++c) {
        directions.col(c) = bin.get(columns.col(actors[a].columns[static_cast<std::size_t>(c)]));
      }
      add(places[a], directions);
    }
    for (Index c = 0; c < bin.channels; ++c) {
      const std::vector<MeasuredChannel>& channels = data.channels(bench.get_run(bin.place.run));
      const int channel = channels[static_cast<std::size_t>(c)].channel;
      if (sensors.count(channel) == 0) {
        sensors[channel] = places.size();
        places.push_back({data.info(channel).name, "sensor", 0.0, 0.0});
      }
      add(places[sensors[channel]],
          whitener.get_sensor_direction(bin.place, static_cast<std::size_t>(c)));
    }
  }
}

}  // namespace

double calc_road_ratio(const NoiseSpectrum& s, std::size_t band) {
  double sum = 0.0, count = 0.0;
  for (const Eigen::MatrixXcd& source : s.sources) {
    for (Index f = 0; f < source.cols(); ++f) {
      const double frequency =
          static_cast<double>(f) / (static_cast<double>(s.samples) * s.interval);
      if (find_noise_band(frequency) != band) continue;
      for (Index c = 0; c < source.rows(); ++c) {
        sum +=
            s.level * std::norm(source(c, f)) / std::pow(s.sigma[static_cast<std::size_t>(c)], 2);
      }
      if (&source == &s.sources.front()) count += static_cast<double>(source.rows());
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

Leftover measure_leftover(const CampaignData& data, TestBench& bench,
                          const LeftoverOptions& options) {
  const double significant = options.significant;
  const Whitener& whitener = bench.whitener();
  const std::size_t bands = kNoiseBands.size();
  std::vector<std::vector<Cell>> cells(bench.run_count(), std::vector<Cell>(bands));
  for (std::size_t i = 0; i < whitener.whitened_count(); ++i) {
    const ReadingPlace& place = whitener.places()[i];
    const std::size_t band = find_noise_band(whitener.get_frequency(place));
    const double w = bench.residual()(static_cast<Index>(i));
    const double chi2 = w * w * whitener.spectra()[place.run].excess[band];
    const double share = whitener.get_share(place.run);
    cells[place.run][band].chi2 += chi2;
    cells[place.run][band].count += share;
  }
  Leftover left;
  std::vector<std::vector<bool>> stands_out(cells.size(), std::vector<bool>(bands, false));
  for (std::size_t r = 0; r < cells.size(); ++r) {
    for (std::size_t b = 0; b < bands; ++b) {
      const Cell& cell = cells[r][b];
      if (cell.count < 1.0) continue;
      const double road = data.is_rig() ? 0.0 : calc_road_ratio(whitener.spectra()[r], b);
      const double tolerance = options.noise_tolerance + options.road_tolerance * road;
      const double excess = cell.chi2 - (1.0 + tolerance) * cell.count;
      const double significance = excess / std::sqrt(2.0 * cell.count);
      stands_out[r][b] = significance > 0.5 * significant;
      if (stands_out[r][b]) left.energy += cell.chi2 - cell.count;
      if (significance <= left.significance) continue;
      left.significance = significance;
      left.band = b;
    }
  }
  if (left.significance < significant) return left;
  std::vector<Bin> bins;
  for (const Bin& bin : list_bins(whitener)) {
    const std::size_t band = find_noise_band(whitener.get_frequency(bin.place));
    if (stands_out[bin.place.run][band]) bins.push_back(bin);
  }
  locate(data, bench, bins, left.places);
  std::stable_sort(
      left.places.begin(), left.places.end(),
      [](const LeftoverPlace& a, const LeftoverPlace& b) { return a.energy > b.energy; });
  return left;
}

}  // namespace strut
