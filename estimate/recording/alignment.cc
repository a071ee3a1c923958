#include "estimate/recording/alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "base/math/spread.h"
#include "base/names/corners.h"
#include "base/parallel/team.h"
#include "estimate/simulate_run.h"

namespace strut {
namespace {

/// Range of the free parameters against the model's file, and the spread that is expected of them.
constexpr double kMaxChange = 2.5, kExpectedChange = 0.35;
/// Least part of a channel that no simulation explains.
constexpr double kFloor = 1e-3;
/// Runs in which the free parameters are searched.
constexpr std::size_t kSearchedRuns = 3;
/// What a lag costs, at most, and the lag from which on it does, nearly [s]: a recording without
/// one is the rule, and damping and lag of a channel have similar effects.
constexpr double kLagCost = 1.0, kSmallLag = 0.005;
/// Unit of the delay of all channels in the search [s].
constexpr double kDelayScale = 0.02;

/// The values at the even times first - delay, first - delay + interval, ...; missing samples are
/// bridged by lines, the ends continue.
std::vector<double> make_even(const std::vector<double>& times, const std::vector<double>& values,
                              double interval, std::size_t count, double delay = 0.0) {
  std::vector<double> even(count, 0.0);
  std::size_t before = 0;
  while (before < values.size() && !std::isfinite(values[before])) ++before;
  if (before == values.size()) return even;
  std::size_t after = before;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = times.front() - delay + interval * static_cast<double>(i);
    while (after + 1 < values.size() && (times[after] < t || !std::isfinite(values[after]))) {
      if (std::isfinite(values[after])) before = after;
      ++after;
    }
    if (!std::isfinite(values[after]) || times[after] <= times[before]) {
      even[i] = values[before];
      continue;
    }
    const double fraction =
        std::clamp((t - times[before]) / (times[after] - times[before]), 0.0, 1.0);
    even[i] = (1.0 - fraction) * values[before] + fraction * values[after];
  }
  return even;
}

/// Subtracts the mean; returns the energy.
double center(std::vector<double>& values) {
  const double mean = calc_mean(values);
  double energy = 0.0;
  for (double& v : values) {
    v -= mean;
    energy += v * v;
  }
  return energy;
}

using Spectrum = std::vector<std::complex<double>>;

std::size_t find_transform_size(std::size_t count) {
  std::size_t size = 1;
  while (size < count) size *= 2;
  return size;
}

Spectrum transform(std::vector<double> values, std::size_t size) {
  values.resize(size, 0.0);
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  Spectrum spectrum;
  fft.fwd(spectrum, values);
  return spectrum;
}

/// A measured channel, ready to be correlated.
struct PreparedChannel {
  std::size_t run = 0, channel = 0;
  int number = 0;  // in ModelInfo::channels
  double interval = 0.0, energy = 0.0;
  double period = 0.0;  // as in ChannelAlignment
  std::size_t count = 0, size = 0;
  std::vector<double> values;  // even, without their mean
  Spectrum spectrum;
};

struct Match {
  double rho = 0.0, lag = 0.0, factor = 1.0, cost = 0.0;
};

struct Correlation {
  Match best, other_sign;
  double rho_without_lag = 0.0;
};

double calc_lag_cost(double lag) { return kLagCost * (1.0 - std::exp(-std::abs(lag) / kSmallLag)); }

double calc_rest(double rho) { return 1.0 - rho * rho + kFloor; }

/// The maximum of the parabola through three values, at -1, 0 and 1; a position within these.
double find_vertex(double left, double middle, double right) {
  const double curvature = left - 2.0 * middle + right;
  if (!(curvature < 0.0)) return 0.0;
  return std::clamp(0.5 * (left - right) / curvature, -1.0, 1.0);
}

/// A channel with its simulation, on the even clock.
struct Simulated {
  Correlation correlation;
  std::vector<double> shape;  // without its mean, of energy 1; empty: not simulated
  double energy = 0.0;
};

/// Against a simulation of energy 1, scaled to `energy`.
Correlation correlate(const PreparedChannel& m, const std::vector<double>& shape, double energy,
                      double max_lag) {
  Correlation result;
  Spectrum product = transform(shape, m.size);
  for (std::size_t k = 0; k < product.size(); ++k) {
    product[k] = m.spectrum[k] * std::conj(product[k]);
  }
  std::vector<double> cross;
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  fft.inv(cross, product);
  const double scale = 1.0 / std::sqrt(m.energy);
  const auto reach = static_cast<std::ptrdiff_t>(
      std::min(max_lag / m.interval, 0.25 * static_cast<double>(m.count)));
  const auto size = static_cast<std::ptrdiff_t>(m.size);
  const auto at = [&](std::ptrdiff_t lag) {
    return scale * cross[static_cast<std::size_t>((lag + size) % size)];
  };
  const auto find = [&](double sign) {
    std::ptrdiff_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::ptrdiff_t lag = -reach; lag <= reach; ++lag) {
      const double rho = std::max(sign * at(lag), 0.0);
      const double time = std::abs(static_cast<double>(lag)) * m.interval;
      const double cost = std::log(calc_rest(rho)) + calc_lag_cost(time);
      if (cost >= least) continue;
      least = cost;
      best = lag;
    }
    const double vertex = find_vertex(sign * at(best - 1), sign * at(best), sign * at(best + 1));
    const double peak = at(best) + 0.25 * vertex * (at(best + 1) - at(best - 1));
    const double rho = sign * std::clamp(sign * peak, 0.0, 1.0);
    return Match{rho, (static_cast<double>(best) + vertex) * m.interval,
                 rho * std::sqrt(m.energy / energy), least};
  };
  const Match positive = find(1.0), negative = find(-1.0);
  const bool is_negative = negative.cost < positive.cost;
  result.best = is_negative ? negative : positive;
  result.other_sign = is_negative ? positive : negative;
  result.rho_without_lag = at(0);
  return result;
}

Simulated compare(const PreparedChannel& m, const std::vector<double>& times,
                  const std::vector<double>& simulated, double max_lag, double delay) {
  Simulated out;
  std::vector<double> even = make_even(times, simulated, m.interval, m.count, delay);
  out.energy = center(even);
  if (!(out.energy > 0.0)) return out;
  for (double& v : even) v /= std::sqrt(out.energy);
  out.shape = std::move(even);
  out.correlation = correlate(m, out.shape, out.energy, max_lag);
  return out;
}

/// Period of a channel that repeats itself: of the largest autocorrelation after its first zero, by
/// the number of samples that overlap; 0 where that is small.
double find_period(const PreparedChannel& m) {
  constexpr double kRepeats = 0.8;
  constexpr std::size_t kLeastOverlap = 3;  // of the record, the inverse
  Spectrum power = m.spectrum;
  for (auto& p : power) p *= std::conj(p);
  std::vector<double> correlation;
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  fft.inv(correlation, power);
  const std::size_t end = m.count - m.count / kLeastOverlap;
  const auto at = [&](std::size_t lag) {
    const double overlap = static_cast<double>(m.count - lag) / static_cast<double>(m.count);
    return correlation[lag] / (m.energy * overlap);
  };
  std::size_t lag = 0;
  while (lag < end && at(lag) > 0.0) ++lag;
  double most = kRepeats;
  std::size_t period = 0;
  for (; lag < end; ++lag) {
    if (at(lag) <= most) continue;
    most = at(lag);
    period = lag;
  }
  return m.interval * static_cast<double>(period);
}

class Search {
 public:
  Search(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& free,
         const AlignmentOptions& options)
      : runs_(runs), free_(free), options_(options) {
    for (std::size_t r = 0; r < runs.size(); ++r) {
      for (std::size_t k = 0; k < runs[r].channels.size(); ++k) prepare(r, k);
    }
  }

  using Points = std::vector<Eigen::VectorXd>;

  /// The simulation at some points, each the logarithms of the parameters' changes, then the delay
  /// of all channels in units of kDelayScale. By point and prepared channel; empty shapes where the
  /// run cannot be simulated, and of runs from number `run_count` on.
  std::vector<std::vector<Simulated>> simulate(const Points& points,
                                               std::size_t run_count = SIZE_MAX) const {
    std::vector<std::vector<double>> values;
    for (const Eigen::VectorXd& point : points) values.push_back(list_values(point));
    std::vector<std::vector<Simulated>> result(points.size(),
                                               std::vector<Simulated>(channels_.size()));
    share_items(options_.threads, std::min(run_count, runs_.size()), [&](std::size_t r, int) {
      const std::vector<RunCurves> curves = simulate_points(runs_[r], free_, values);
      for (std::size_t p = 0; p < points.size(); ++p) {
        if (!curves[p].failure.empty()) continue;
        for (std::size_t k = 0; k < channels_.size(); ++k) {
          if (channels_[k].run != r) continue;
          const auto& simulated = curves[p].channel[static_cast<std::size_t>(channels_[k].number)];
          result[p][k] = compare(channels_[k], runs_[r].times, simulated, options_.max_lag,
                                 get_delay(points[p]));
        }
      }
    });
    return result;
  }

  /// The best of several minima: a start may be in another's valley, and late channels may be
  /// explained by lags or by parameters.
  Eigen::VectorXd minimize() const {
    constexpr std::size_t kStarts = 2;
    std::vector<std::pair<double, Eigen::VectorXd>> starts;
    const Points points = list_starts();
    const std::vector<std::vector<Simulated>> at = simulate(points, kSearchedRuns);
    for (std::size_t i = 0; i < points.size(); ++i) {
      starts.emplace_back(calc_cost(at[i], points[i]), points[i]);
    }
    const std::size_t count = std::min(kStarts, starts.size());
    std::partial_sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count),
                      starts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    auto best = descend(starts.front().second, false);
    for (std::size_t i = 0; i < count; ++i) {
      auto other = descend(starts[i].second, true);
      if (other.second < best.second) best = std::move(other);
    }
    return best.first;
  }

  std::vector<double> list_values(const Eigen::VectorXd& point) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const double value = free_[i].start * std::exp(point[static_cast<Eigen::Index>(i)]);
      values.push_back(std::clamp(value, free_[i].low, free_[i].high));
    }
    return values;
  }

  static double get_delay(const Eigen::VectorXd& point) {
    return kDelayScale * point[point.size() - 1];
  }

  const std::vector<PreparedChannel>& channels() const { return channels_; }

 private:
  void prepare(std::size_t r, std::size_t k) {
    const MeasuredRun& run = runs_[r];
    PreparedChannel c;
    c.run = r;
    c.channel = k;
    c.number = run.channels[k].channel;
    c.count = run.times.size();
    if (c.count < 3) return;
    c.interval = (run.times.back() - run.times.front()) / static_cast<double>(c.count - 1);
    c.values = make_even(run.times, run.channels[k].values, c.interval, c.count);
    c.energy = center(c.values);
    if (!(c.energy > 0.0)) return;
    c.size = find_transform_size(2 * c.count);
    c.spectrum = transform(c.values, c.size);
    c.period = find_period(c);
    channels_.push_back(std::move(c));
  }

  std::vector<Eigen::VectorXd> list_starts() const {
    const auto n = static_cast<Eigen::Index>(free_.size()) + 1;
    std::vector<Eigen::VectorXd> starts = {Eigen::VectorXd::Zero(n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      for (const double side : {1.0, -1.0}) {
        starts.emplace_back(Eigen::VectorXd::Zero(n));
        starts.back()[i] = side * (i + 1 < n ? kExpectedChange : 1.0);
      }
    }
    return starts;
  }

  /// Gauss-Newton steps to a minimum of the cost. `holds_lags`: single channels' lags stay 0 in the
  /// steps, so that the parameters and the delay of all explain what they can.
  std::pair<Eigen::VectorXd, double> descend(Eigen::VectorXd point, bool holds_lags) const {
    constexpr int kMaxSteps = 8, kMaxTries = 4;
    constexpr double kSmallFall = 0.02;
    const double reach = std::log(kMaxChange);
    std::vector<Simulated> at = simulate({point}, kSearchedRuns).front();
    double cost = calc_cost(at, point), damping = 1e-3;
    for (int step = 0; step < kMaxSteps; ++step) {
      const auto [information, gradient] = linearize(at, point, holds_lags);
      const double before = cost;
      for (int tries = 0; tries < kMaxTries; ++tries, damping *= 10.0) {
        Eigen::MatrixXd damped = information;
        damped.diagonal() *= 1.0 + damping;
        Eigen::VectorXd next = point + damped.ldlt().solve(gradient);
        const double most_delay = options_.max_lag / kDelayScale;
        next.head(next.size() - 1) = next.head(next.size() - 1).cwiseMax(-reach).cwiseMin(reach);
        next[next.size() - 1] = std::clamp(next[next.size() - 1], -most_delay, most_delay);
        std::vector<Simulated> there = simulate({next}, kSearchedRuns).front();
        const double changed = calc_cost(there, next);
        if (!(changed < cost)) continue;
        point = next;
        at = std::move(there);
        cost = changed;
        damping *= 0.01;
        break;
      }
      if (before - cost < kSmallFall) break;
    }
    return {point, cost};
  }

  static double calc_cost(const std::vector<Simulated>& at, const Eigen::VectorXd& point) {
    double cost = (point.head(point.size() - 1) / kExpectedChange).squaredNorm() +
                  calc_lag_cost(get_delay(point));
    for (const Simulated& s : at) cost += s.correlation.best.cost;
    return cost;
  }

  /// Half the Hessian of the cost by Gauss-Newton, and half its negative gradient.
  std::pair<Eigen::MatrixXd, Eigen::VectorXd> linearize(const std::vector<Simulated>& at,
                                                        const Eigen::VectorXd& logs,
                                                        bool holds_lags) const {
    constexpr double kStep = 0.01;
    const Eigen::Index n = logs.size();
    Points moved(static_cast<std::size_t>(n), logs);
    for (Eigen::Index i = 0; i < n; ++i) moved[static_cast<std::size_t>(i)][i] += kStep;
    const std::vector<std::vector<Simulated>> beside = simulate(moved, kSearchedRuns);
    const double prior = 1.0 / (kExpectedChange * kExpectedChange);
    Eigen::MatrixXd information = prior * Eigen::MatrixXd::Identity(n, n);
    information(n - 1, n - 1) = 1e-6;  // the delay's cost is no parabola
    Eigen::VectorXd gradient = -prior * logs;
    gradient[n - 1] = 0.0;
    for (std::size_t k = 0; k < channels_.size(); ++k) {
      const auto count = static_cast<Eigen::Index>(at[k].shape.size());
      if (count == 0) continue;
      const Match& best = at[k].correlation.best;
      Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(count, n);
      const Eigen::Map<const Eigen::VectorXd> shape(at[k].shape.data(), count);
      for (Eigen::Index i = 0; i < n; ++i) {
        const std::vector<double>& there = beside[static_cast<std::size_t>(i)][k].shape;
        if (there.empty()) continue;
        slopes.col(i) = std::abs(best.rho) / kStep *
                        (Eigen::Map<const Eigen::VectorXd>(there.data(), count) - shape);
      }
      // m(t + T) has the clock of the simulation.
      const auto shift = holds_lags ? 0 : std::llround(best.lag / channels_[k].interval);
      Eigen::VectorXd measured = Eigen::VectorXd::Zero(count);
      const double scale = (best.rho < 0.0 ? -1.0 : 1.0) / std::sqrt(channels_[k].energy);
      for (Eigen::Index t = 0; t < count; ++t) {
        const Eigen::Index from = t + shift;
        if (from < 0 || from >= count) continue;
        measured[t] = scale * channels_[k].values[static_cast<std::size_t>(from)];
      }
      const double weight = 1.0 / calc_rest(best.rho);
      information += weight * slopes.transpose() * slopes;
      gradient += weight * slopes.transpose() * (measured - std::abs(best.rho) * shape);
    }
    return {information, gradient};
  }

  const std::vector<MeasuredRun>& runs_;
  const std::vector<Unknown>& free_;
  AlignmentOptions options_;
  std::vector<PreparedChannel> channels_;
};

/// The part of a channel's name behind that of its corner; "" where it has none.
std::string get_corner_quantity(const std::string& channel) {
  for (const char* corner : kCornerNames) {
    if (channel.starts_with(corner)) return channel.substr(std::string(corner).size());
  }
  return "";
}

std::vector<PossibleSwap> compare_swapped(const std::vector<MeasuredRun>& runs,
                                          const std::vector<PreparedChannel>& channels,
                                          const std::vector<Simulated>& all, double max_lag) {
  std::vector<PossibleSwap> swaps;
  // Channels of a rig can be swapped if they have the same unit, those of a car if they measure the
  // same quantity at different corners.
  const auto get_quantity = [&](const PreparedChannel& c) {
    const ModelInfo& info = runs[c.run].setup.info();
    const ChannelInfo& channel = info.channels[static_cast<std::size_t>(c.number)];
    return info.is_driven_by_inputs() ? channel.unit : get_corner_quantity(channel.name);
  };
  for (std::size_t a = 0; a < channels.size(); ++a) {
    for (std::size_t b = a + 1; b < channels.size() && channels[b].run == channels[a].run; ++b) {
      const std::string quantity = get_quantity(channels[a]);
      if (quantity.empty() || quantity != get_quantity(channels[b])) continue;
      if (all[a].shape.empty() || all[b].shape.empty()) continue;
      const Correlation first = correlate(channels[a], all[b].shape, all[b].energy, max_lag);
      const Correlation second = correlate(channels[b], all[a].shape, all[a].energy, max_lag);
      swaps.push_back({channels[a].run, channels[a].channel, channels[b].channel,
                       all[a].correlation.best.cost + all[b].correlation.best.cost -
                           first.best.cost - second.best.cost});
    }
  }
  return swaps;
}

}  // namespace

Alignment align_recordings(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& free,
                           const AlignmentOptions& options) {
  const Search search(runs, free, options);
  const Eigen::VectorXd point = search.minimize();
  const double delay = Search::get_delay(point);
  Alignment alignment;
  alignment.values = search.list_values(point);
  // Without the delay, so that lags and what they explain are against the clock as it is.
  Eigen::VectorXd undelayed = point;
  undelayed[point.size() - 1] = 0.0;
  const std::vector<std::vector<Simulated>> at = search.simulate({point, undelayed});
  const std::vector<Simulated>&all = at[0], &bare = at[1];
  alignment.swaps = compare_swapped(runs, search.channels(), all, options.max_lag);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Correlation& c = all[i].correlation;
    if (c.best.rho == 0.0) continue;
    alignment.channels.push_back(
        {search.channels()[i].run, search.channels()[i].channel, std::abs(c.best.rho),
         c.best.factor, std::sqrt(all[i].energy / static_cast<double>(search.channels()[i].count)),
         c.best.lag + delay, calc_rest(c.other_sign.rho) / calc_rest(c.best.rho),
         calc_rest(bare[i].correlation.rho_without_lag) / calc_rest(c.best.rho),
         search.channels()[i].period});
  }
  return alignment;
}

}  // namespace strut
