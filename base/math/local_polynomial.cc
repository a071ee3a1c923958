#include "base/math/local_polynomial.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/error/check.h"
#include "base/math/spread.h"

namespace strut {
namespace {

constexpr int kMaxDegree = 7;
/// Readings of a window beyond the numbers of its polynomial.
constexpr std::size_t kSpare = 2;

using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDegree + 1, 1>;
using Gram =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxDegree + 1, kMaxDegree + 1>;

/// Legendre polynomials up to a degree at s.
Terms calc_legendre(int degree, double s) {
  Terms value(degree + 1);
  value(0) = 1.0;
  value(1) = s;
  for (int k = 1; k < degree; ++k) {
    value(k + 1) = ((2.0 * k + 1.0) * s * value(k) - k * value(k - 1)) / (k + 1.0);
  }
  return value;
}

/// Legendre polynomials up to a degree at s, with two derivatives of each.
struct Legendre {
  Terms value, rate, second_rate;

  Legendre(int degree, double s)
      : value(calc_legendre(degree, s)), rate(Terms::Zero(degree + 1)), second_rate(rate) {
    rate(1) = 1.0;
    for (int k = 1; k < degree; ++k) {
      const double a = (2.0 * k + 1.0) / (k + 1.0), b = k / (k + 1.0);
      rate(k + 1) = a * (value(k) + s * rate(k)) - b * rate(k - 1);
      second_rate(k + 1) = a * (2.0 * rate(k) + s * second_rate(k)) - b * second_rate(k - 1);
    }
  }
};

/// Readings of one window; its polynomial is one of (time - middle) / reach.
struct Window {
  std::span<const double> times, values;
  double middle = 0.0, reach = 0.0;
};

/// Extends the readings [first, last) of a window around time i to the next ones on either side
/// until `least` of them are there or no others are left: a clock with jitter leaves narrow
/// windows a reading short.
void widen(std::span<const double> times, std::span<const double> values, std::size_t i,
           std::size_t least, std::size_t& first, std::size_t& last) {
  std::size_t count = count_readings(values.subspan(first, last - first));
  while (count < least && (first > 0 || last < times.size())) {
    const bool back =
        last == times.size() || (first > 0 && times[i] - times[first - 1] < times[last] - times[i]);
    const std::size_t next = back ? --first : last++;
    count += std::isfinite(values[next]) ? 1 : 0;
  }
}

/// Coefficients of the window's Legendre polynomials.
Terms fit(const Window& window, int degree) {
  Gram gram = Gram::Zero(degree + 1, degree + 1);
  Terms moment = Terms::Zero(degree + 1);
  for (std::size_t k = 0; k < window.times.size(); ++k) {
    if (!std::isfinite(window.values[k])) continue;
    const Terms at = calc_legendre(degree, (window.times[k] - window.middle) / window.reach);
    gram += at * at.transpose();
    moment += window.values[k] * at;
  }
  return gram.ldlt().solve(moment);
}

/// The curve at every `stride`-th time; NaN between.
SmoothCurve calc_curve(std::span<const double> times, std::span<const double> values,
                       const LocalPolynomial& by, CurveEnds ends, std::size_t stride) {
  STRUT_CHECK(by.degree >= 1 && by.degree <= kMaxDegree, "a degree from 1 to 7");
  const std::size_t least = static_cast<std::size_t>(by.degree) + 1 + kSpare;
  const std::vector<double> none(times.size(), std::numeric_limits<double>::quiet_NaN());
  SmoothCurve curve{none, none, none};
  if (times.size() < least) return curve;
  const double half_width = std::min(by.half_width, 0.5 * (times.back() - times.front()));
  const double reach = half_width * (1.0 + 1e-9);
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < times.size(); i += stride) {
    // At an end the window stays a whole one and its polynomial is read off its middle.
    const double middle =
        std::max(times.front() + half_width, std::min(times[i], times.back() - half_width));
    if (ends == CurveEnds::kNone && std::abs(middle - times[i]) > 1e-3 * half_width) continue;
    while (first < i && times[first] < middle - reach) ++first;
    while (last < times.size() && times[last] <= middle + reach) ++last;
    std::size_t begin = first, end = last;
    if (ends == CurveEnds::kOneSided) widen(times, values, i, least, begin, end);
    Window window{times.subspan(begin, end - begin), values.subspan(begin, end - begin), middle,
                  half_width};
    if (count_readings(window.values) < least) continue;
    // A window that was widened across a gap reaches further.
    window.reach = std::max({half_width, middle - times[begin], times[end - 1] - middle});
    const Terms terms = fit(window, by.degree);
    const Legendre here(by.degree, (times[i] - middle) / window.reach);
    curve.value[i] = here.value.dot(terms);
    curve.rate[i] = here.rate.dot(terms) / window.reach;
    curve.second_rate[i] = here.second_rate.dot(terms) / (window.reach * window.reach);
  }
  return curve;
}

/// Noise of a polynomial through 2 m + 1 even readings, each with white noise of variance 1.
class NoiseGain {
 public:
  NoiseGain(int m, int degree) : m_(m), degree_(degree) {
    Gram gram = Gram::Zero(degree + 1, degree + 1);
    for (int k = -m; k <= m; ++k) {
      const Terms at = calc_legendre(degree, static_cast<double>(k) / m);
      gram += at * at.transpose();
    }
    solver_.compute(gram);
  }

  /// Variance of the value in the middle.
  double calc_value() const { return calc_variance(Legendre(degree_, 0.0).value); }
  /// Variance of the rate times the interval, mean over a record of `count` readings.
  double calc_rate(std::size_t count) const {
    const double per_interval = 1.0 / (static_cast<double>(m_) * m_);
    const double middle = calc_variance(Legendre(degree_, 0.0).rate);
    double sum = middle * (static_cast<double>(count) - 2.0 * m_);
    for (int k = 1; k <= m_; ++k) {
      sum += 2.0 * calc_variance(Legendre(degree_, static_cast<double>(k) / m_).rate);
    }
    return per_interval * sum / static_cast<double>(count);
  }
  /// Variance of the second rate in the middle times the interval squared.
  double calc_second_rate() const {
    return calc_variance(Legendre(degree_, 0.0).second_rate) / std::pow(m_, 4);
  }

 private:
  double calc_variance(const Terms& terms) const { return terms.dot(solver_.solve(terms)); }

  int m_, degree_;
  Eigen::LDLT<Gram> solver_;
};

/// Half the widest window [intervals] of polynomials that remove at most a tenth of sigma of the
/// signal itself; 0: none.
int find_widest(std::span<const double> times, std::span<const double> values, double interval,
                double sigma, int degree) {
  constexpr std::array kWidths = {3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128};
  constexpr double kClear = 1.7;  // of the noise's rms
  constexpr double kMaxRemoved = 0.1;
  constexpr std::size_t kEnough = 1000;  // places, for an rms
  const double duration = times.back() - times.front();
  const std::size_t stride = 1 + times.size() / kEnough;
  double max_width = 0.0;
  std::vector<int> widths;
  for (const int m : kWidths) {
    if (2 * m < degree + static_cast<int>(kSpare)) continue;
    const double half_width = m * interval;
    if (!(half_width * 4.0 <= duration)) break;
    const SmoothCurve curve =
        calc_curve(times, values, {half_width, degree}, CurveEnds::kNone, stride);
    std::vector<double> left(values.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = values[i] - curve.value[i];
    if (count_readings(left) == 0) break;
    const double noise = sigma * std::sqrt(1.0 - NoiseGain(m, degree).calc_value());
    const double rms = calc_rms(left);
    widths.push_back(m);
    // Signal that is removed is visible only where the residual is clearly larger than the noise.
    const double seen = std::max(rms, kClear * noise);
    const double removed = std::sqrt(seen * seen - noise * noise);
    max_width = half_width * std::pow(kMaxRemoved * sigma / removed, 1.0 / (degree + 1));
    if (rms > kClear * noise) break;
  }
  const auto is_narrower = [&](int m) { return m * interval <= max_width; };
  const auto found = std::find_if(widths.rbegin(), widths.rend(), is_narrower);
  return found == widths.rend() ? 0 : *found;
}

}  // namespace

SmoothCurve calc_local_polynomial(std::span<const double> times, std::span<const double> values,
                                  const LocalPolynomial& by, CurveEnds ends) {
  return calc_curve(times, values, by, ends, 1);
}

LocalPolynomial choose_smoothing(std::span<const double> times, std::span<const double> values,
                                 double sigma) {
  LocalPolynomial best;
  if (times.size() < 2) return best;
  const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  double least = std::numeric_limits<double>::infinity();
  for (const int degree : {3, 5, kMaxDegree}) {
    const int m = find_widest(times, values, interval, sigma, degree);
    if (m == 0) continue;
    const double noise = NoiseGain(m, degree).calc_rate(times.size());
    if (noise >= least) continue;
    least = noise;
    best = {m * interval, degree};
  }
  return best;
}

double calc_second_rate_gain(double half_width, double interval) {
  const auto m = static_cast<int>(std::floor(half_width / interval + 1e-9));
  return std::sqrt(NoiseGain(m, 3).calc_second_rate()) / (interval * interval);
}

}  // namespace strut
