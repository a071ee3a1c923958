#include "diagnose/discrepancy/leftover.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

namespace strut {
namespace {

using Index = Eigen::Index;

/// Whitened numbers that are judged together.
struct Cell {
  double chi2 = 0.0, count = 0.0;
  double allowed = 0.0;  // of chi2: the count and what the noise's level may be off

  void add(const Cell& other) {
    chi2 += other.chi2;
    count += other.count;
    allowed += other.allowed;
  }
  double calc_significance() const { return calc_chi2_significance(chi2, allowed, count); }
};

/// The bands of the noise, and lines two steps of the shortest run's spectrum wide, half over each
/// other: a tone is seen in a line of its own long before it is in a band.
std::vector<FrequencyBand> list_bands(const Whitener& whitener) {
  std::vector<FrequencyBand> bands;
  for (std::size_t b = 0; b < kNoiseBands.size(); ++b) {
    bands.push_back({b == 0 ? 0.0 : kNoiseBands[b - 1], kNoiseBands[b]});
  }
  double step = 0.0, highest = 0.0;
  for (const NoiseSpectrum& s : whitener.spectra()) {
    step = std::max(step, 1.0 / (static_cast<double>(s.samples) * s.interval));
  }
  for (const ReadingPlace& place : whitener.places()) {
    highest = std::max(highest, whitener.get_frequency(place));
  }
  for (double from = 0.0; from < highest; from += step) bands.push_back({from, from + 2.0 * step});
  return bands;
}

/// Each whitened number with what it may be.
std::vector<Cell> list_numbers(const CampaignData& data, const TestBench& bench,
                               const LeftoverOptions& options) {
  const Whitener& whitener = bench.whitener();
  const bool is_road_noise = !data.has_inputs() && whitener.roads().empty();
  std::vector<std::vector<double>> allowed(bench.run_count());  // by run and band
  for (std::size_t r = 0; r < allowed.size(); ++r) {
    for (std::size_t b = 0; b < kNoiseBands.size(); ++b) {
      const double road = is_road_noise ? calc_road_ratio(whitener.spectra()[r], b) : 0.0;
      allowed[r].push_back(1.0 + options.noise_tolerance + options.road_tolerance * road);
    }
  }
  std::vector<Cell> numbers;
  numbers.reserve(whitener.whitened_count());
  for (std::size_t i = 0; i < whitener.whitened_count(); ++i) {
    const ReadingPlace& place = whitener.places()[i];
    const std::size_t band = find_noise_band(whitener.get_frequency(place));
    const double w = bench.residual()(static_cast<Index>(i));
    const double share = whitener.get_share(place.run);
    numbers.push_back({w * w * whitener.spectra()[place.run].excess[band], share,
                       share * allowed[place.run][band]});
  }
  return numbers;
}

/// Of all runs.
Cell sum_band(const Whitener& whitener, const std::vector<Cell>& numbers,
              const FrequencyBand& band) {
  Cell sum;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double frequency = whitener.get_frequency(whitener.places()[i]);
    if (frequency >= band.from && frequency < band.to) sum.add(numbers[i]);
  }
  return sum;
}

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

std::vector<Actor> list_actors(const std::vector<Hypothesis>& hypotheses,
                               const std::vector<HypothesisTrial>& trials) {
  std::vector<Actor> actors;
  for (const HypothesisTrial& trial : trials) {
    const Hypothesis& h = hypotheses[trial.hypothesis];
    const bool is_body = h.effect == "payload";
    const bool is_road = h.effect == "bump_height" || h.effect == "bump_length";
    LeftoverPlace place;
    place.kind = is_body ? "body" : is_road ? "road" : "strut";
    place.name = is_body ? "body" : h.place;
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
  for (Hypothesis& h : list_hypotheses(data, shared)) {
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
  const std::vector<Actor> actors = list_actors(forces, trials);
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
      // All is chi2 of 2 count degrees, energy its part in 2 rank of them.
      place.sigma = std::hypot(place.sigma, 2.0 * std::sqrt(count * share / (1.0 - share)));
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

const LeftoverPlace* find_clear_place(const Leftover& left) {
  constexpr double kClear = 5.0;
  const auto found =
      std::find_if(left.places.begin(), left.places.end(),
                   [](const LeftoverPlace& place) { return place.energy >= kClear * place.sigma; });
  return found == left.places.end() ? nullptr : &*found;
}

bool is_significant(const Leftover& left, const LeftoverOptions& options) {
  return left.significance >= options.significant;
}

double calc_chi2_significance(double chi2, double allowed, double count) {
  if (count < 1.0) return 0.0;
  const double variance = 2.0 / (9.0 * count);
  return (std::cbrt(chi2 / allowed) - (1.0 - variance)) / std::sqrt(variance);
}

double calc_road_ratio(const NoiseSpectrum& s, std::size_t band) {
  double sum = 0.0, count = 0.0;
  for (std::size_t f = 0; f < s.common.size(); ++f) {
    const double frequency = static_cast<double>(f) / (static_cast<double>(s.samples) * s.interval);
    if (find_noise_band(frequency) != band) continue;
    const Eigen::VectorXd power = s.common[f].diagonal().real();
    for (Index c = 0; c < power.size(); ++c) {
      sum += s.level * power(c) / std::pow(s.sigma[static_cast<std::size_t>(c)], 2);
    }
    count += static_cast<double>(power.size());
  }
  return count > 0.0 ? sum / count : 0.0;
}

Leftover measure_leftover(const CampaignData& data, TestBench& bench,
                          const LeftoverOptions& options) {
  const std::vector<Cell> numbers = list_numbers(data, bench, options);
  const Whitener& whitener = bench.whitener();
  std::vector<std::vector<Cell>> cells(bench.run_count(), std::vector<Cell>(kNoiseBands.size()));
  Cell all;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const ReadingPlace& place = whitener.places()[i];
    cells[place.run][find_noise_band(whitener.get_frequency(place))].add(numbers[i]);
    all.add(numbers[i]);
  }
  Leftover left;
  const auto judge = [&](const Cell& cell, const FrequencyBand& band) {
    const double significance = cell.calc_significance();
    if (significance <= left.significance) return;
    left.significance = significance;
    left.band = band;
  };
  judge(all, {0.0, kNoiseBands.back()});
  const std::vector<FrequencyBand> bands = list_bands(whitener);
  for (const FrequencyBand& band : bands) {
    judge(sum_band(whitener, numbers, band), band);
  }
  for (const std::vector<Cell>& run : cells) {
    for (std::size_t b = 0; b < run.size(); ++b) judge(run[b], bands[b]);
  }
  if (!is_significant(left, options)) return left;
  const auto stands_out = [&](const ReadingPlace& place) {
    const double frequency = whitener.get_frequency(place);
    if (frequency >= left.band.from && frequency < left.band.to) return true;
    return cells[place.run][find_noise_band(frequency)].calc_significance() >
           0.5 * options.significant;
  };
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (stands_out(whitener.places()[i])) left.energy += numbers[i].chi2 - numbers[i].count;
  }
  std::vector<Bin> bins;
  for (const Bin& bin : list_bins(whitener)) {
    if (stands_out(bin.place)) bins.push_back(bin);
  }
  locate(data, bench, bins, left.places);
  std::stable_sort(
      left.places.begin(), left.places.end(),
      [](const LeftoverPlace& a, const LeftoverPlace& b) { return a.energy > b.energy; });
  return left;
}

}  // namespace strut
