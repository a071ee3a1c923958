#include "base/math/local_polynomial.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
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

/// Legendre polynomials up to a degree, and two derivatives of each, at s.
struct Legendre {
  Terms value, rate, second_rate;

  Legendre(int degree, double s) : value(Terms::Zero(degree + 1)), rate(value), second_rate(value) {
    value(0) = 1.0;
    value(1) = s;
    rate(1) = 1.0;
    for (int k = 1; k < degree; ++k) {
      const double a = (2.0 * k + 1.0) / (k + 1.0), b = k / (k + 1.0);
      value(k + 1) = a * s * value(k) - b * value(k - 1);
      rate(k + 1) = a * (value(k) + s * rate(k)) - b * rate(k - 1);
      second_rate(k + 1) = a * (2.0 * rate(k) + s * second_rate(k)) - b * second_rate(k - 1);
    }
  }
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

/// Coefficients of the Legendre polynomials in (t - middle) / half_width.
Terms fit(std::span<const double> times, std::span<const double> values, double middle,
          const LocalPolynomial& by) {
  Gram gram = Gram::Zero(by.degree + 1, by.degree + 1);
  Terms moment = Terms::Zero(by.degree + 1);
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    const Terms at = Legendre(by.degree, (times[k] - middle) / by.half_width).value;
    gram += at * at.transpose();
    moment += values[k] * at;
  }
  return gram.ldlt().solve(moment);
}

/// Of white noise of 1 sigma, 1 sigma of the value and of the rate times the interval in the middle
/// of 2 m + 1 even readings.
struct NoiseGain {
  double value = 0.0, rate = 0.0;
};

NoiseGain calc_noise_gain(int m, int degree) {
  Gram gram = Gram::Zero(degree + 1, degree + 1);
  for (int k = -m; k <= m; ++k) {
    const Terms at = Legendre(degree, static_cast<double>(k) / m).value;
    gram += at * at.transpose();
  }
  const Legendre middle(degree, 0.0);
  const auto solver = gram.ldlt();
  return {std::sqrt(middle.value.dot(solver.solve(middle.value))),
          std::sqrt(middle.rate.dot(solver.solve(middle.rate))) / m};
}

}  // namespace

SmoothCurve smooth(std::span<const double> times, std::span<const double> values,
                   const LocalPolynomial& by, CurveEnds ends) {
  STRUT_CHECK(by.degree >= 1 && by.degree <= kMaxDegree, "a degree from 1 to 7");
  const std::size_t least = static_cast<std::size_t>(by.degree) + 1 + kSpare;
  const std::vector<double> none(times.size(), std::numeric_limits<double>::quiet_NaN());
  SmoothCurve curve{none, none, none};
  const double half_width = by.half_width, reach = half_width * (1.0 + 1e-9);
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    // At an end the window stays a whole one and its polynomial is read off its middle.
    const double middle =
        std::max(times.front() + half_width, std::min(times[i], times.back() - half_width));
    if (ends == CurveEnds::kNone && std::abs(middle - times[i]) > 1e-3 * half_width) continue;
    while (first < i && times[first] < middle - reach) ++first;
    while (last < times.size() && times[last] <= middle + reach) ++last;
    std::size_t begin = first, end = last;
    if (ends == CurveEnds::kOneSided) widen(times, values, i, least, begin, end);
    const auto inside = values.subspan(begin, end - begin);
    if (count_readings(inside) < least) continue;
    const Terms terms = fit(times.subspan(begin, end - begin), inside, middle, by);
    const Legendre here(by.degree, (times[i] - middle) / half_width);
    curve.value[i] = here.value.dot(terms);
    curve.rate[i] = here.rate.dot(terms) / half_width;
    curve.second_rate[i] = here.second_rate.dot(terms) / (half_width * half_width);
  }
  return curve;
}

namespace {

/// Half the widest window [intervals] of polynomials that remove at most a tenth of sigma of the
/// signal itself; 0: none.
int find_widest(std::span<const double> times, std::span<const double> values, double sigma,
                int degree) {
  constexpr std::array kWidths = {3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
  constexpr double kClear = 1.7;  // of the noise's rms
  constexpr double kMaxRemoved = 0.1;
  const double duration = times.back() - times.front();
  const double interval = duration / static_cast<double>(times.size() - 1);
  double max_width = std::numeric_limits<double>::infinity();
  std::vector<int> widths;
  for (const int m : kWidths) {
    if (2 * m < degree + static_cast<int>(kSpare)) continue;
    const double half_width = m * interval;
    if (half_width * 4.0 > duration) break;
    const SmoothCurve curve = smooth(times, values, {half_width, degree});
    std::vector<double> left(values.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = values[i] - curve.value[i];
    const double kept = calc_noise_gain(m, degree).value;
    const double noise = sigma * std::sqrt(1.0 - kept * kept), rms = calc_rms(left);
    widths.push_back(m);
    if (rms <= kClear * noise) continue;
    const double removed = std::sqrt(rms * rms - noise * noise);
    max_width = half_width * std::pow(kMaxRemoved * sigma / removed, 1.0 / (degree + 1));
    break;
  }
  const auto is_narrower = [&](int m) { return m * interval <= max_width; };
  const auto found = std::find_if(widths.rbegin(), widths.rend(), is_narrower);
  return found == widths.rend() ? 0 : *found;
}

}  // namespace

LocalPolynomial choose_smoothing(std::span<const double> times, std::span<const double> values,
                                 double sigma) {
  const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  LocalPolynomial best;
  double least = std::numeric_limits<double>::infinity();
  for (const int degree : {3, 5, kMaxDegree}) {
    const int m = find_widest(times, values, sigma, degree);
    if (m == 0) continue;
    const double noise = calc_noise_gain(m, degree).rate;
    if (noise >= least) continue;
    least = noise;
    best = {m * interval, degree};
  }
  return best;
}

double calc_second_rate_gain(double half_width, double interval) {
  const auto m = static_cast<int>(std::floor(half_width / interval + 1e-9));
  double n = 0.0, second = 0.0, fourth = 0.0;
  for (int k = -m; k <= m; ++k) {
    const double s = k * interval;
    n += 1.0;
    second += s * s;
    fourth += s * s * s * s;
  }
  // Variance of the quadratic's coefficient, whose basis shares only the constant with it.
  return 2.0 / std::sqrt(fourth - second * second / n);
}

}  // namespace strut
