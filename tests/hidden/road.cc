#include "tests/hidden/road.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "tests/hidden/random_stream.h"

namespace strut::hidden {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGrid = 5e-4;  // m, of the bump's profile

std::vector<double> roll_disc(const std::vector<double>& profile, double radius) {
  const auto reach = static_cast<std::ptrdiff_t>(radius / kGrid) - 1;
  std::vector<double> drop(static_cast<std::size_t>(reach + 1));
  for (std::size_t i = 0; i < drop.size(); ++i) {
    const double s = kGrid * static_cast<double>(i);
    drop[i] = s * s / (radius + std::sqrt(radius * radius - s * s));
  }
  const double top = *std::max_element(profile.begin(), profile.end());
  const auto count = static_cast<std::ptrdiff_t>(profile.size());
  std::vector<double> center(profile.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double highest = profile[static_cast<std::size_t>(i)];
    for (std::ptrdiff_t k = 1; k <= reach && drop[static_cast<std::size_t>(k)] < top - highest;
         ++k) {
      const double fall = drop[static_cast<std::size_t>(k)];
      if (i >= k) highest = std::max(highest, profile[static_cast<std::size_t>(i - k)] - fall);
      if (i + k < count)
        highest = std::max(highest, profile[static_cast<std::size_t>(i + k)] - fall);
    }
    center[static_cast<std::size_t>(i)] = highest;
  }
  return center;
}

/// Mean over `cells` cells, trapezoidal, so that an even width stays centered.
std::vector<double> average(const std::vector<double>& z, std::size_t cells) {
  std::vector<double> sum(z.size() + 1, 0.0);
  for (std::size_t i = 0; i < z.size(); ++i) sum[i + 1] = sum[i] + z[i];
  std::vector<double> mean(z.size(), 0.0);
  const std::size_t half = cells / 2;
  for (std::size_t i = half + 1; i + half + 1 < z.size(); ++i) {
    const double inner = sum[i + half] - sum[i - half + 1];
    mean[i] = (inner + 0.5 * (z[i - half] + z[i + half])) / static_cast<double>(2 * half);
  }
  return mean;
}

}  // namespace

void Curve::evaluate(double x, double& z, double& z_x) const {
  const double place = (x - begin) / spacing;
  const double last = static_cast<double>(height.size()) - 1.0;
  if (!(place > 0.0) || place >= last) {
    z = height.empty() ? 0.0 : place > 0.0 ? height.back() : height.front();
    z_x = 0.0;
    return;
  }
  const auto i = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(i), h = spacing;
  const double rise = height[i + 1] - height[i];
  const double a = h * slope[i] - rise, b = -h * slope[i + 1] + rise, u = 1.0 - t;
  z = height[i] + t * rise + t * u * (a * u + b * t);
  z_x = (rise + (1.0 - 2.0 * t) * (a * u + b * t) + t * u * (b - a)) / h;
}

Curve make_curve(double begin, double spacing, std::vector<double> height) {
  Curve curve{begin, spacing, std::move(height), {}};
  const std::vector<double>& z = curve.height;
  curve.slope.assign(z.size(), 0.0);
  for (std::size_t i = 2; i + 2 < z.size(); ++i) {
    curve.slope[i] = (8.0 * (z[i + 1] - z[i - 1]) - (z[i + 2] - z[i - 2])) / (12.0 * spacing);
  }
  return curve;
}

double calc_bump_height(const Bump& bump, double x) {
  const double half = 0.5 * bump.length, u = std::fabs(x) / half;
  if (u >= 1.0) return 0.0;
  switch (bump.form) {
    case BumpForm::kArc: {
      const double radius = (half * half + bump.height * bump.height) / (2.0 * bump.height);
      return std::sqrt(radius * radius - x * x) - radius + bump.height;
    }
    case BumpForm::kCosine:
      return 0.5 * bump.height * (1.0 + std::cos(kPi * u));
    case BumpForm::kHalfSine:
      return bump.height * std::cos(0.5 * kPi * u);
    case BumpForm::kParabola:
      return bump.height * (1.0 - u * u);
    case BumpForm::kTrapezoid:
      return bump.height * std::min(1.0, (half - std::fabs(x)) / bump.ramp);
    case BumpForm::kTruncated:
      return bump.height * std::min(1.0, 1.5 * (1.0 - u));
  }
  return 0.0;
}

Curve make_felt_bump(const Bump& bump, double radius, double footprint) {
  const double reach = 0.5 * bump.length + radius + footprint;
  const auto half = static_cast<std::size_t>(std::ceil(reach / kGrid));
  std::vector<double> z(2 * half + 1);
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = calc_bump_height(bump, kGrid * (static_cast<double>(i) - static_cast<double>(half)));
  }
  z = roll_disc(z, radius);
  const auto cells = static_cast<std::size_t>(std::lround(0.25 * footprint / kGrid));
  for (int pass = 0; pass < 4; ++pass) z = average(z, cells);
  std::vector<double> knots;
  constexpr std::size_t kEvery = 4;
  for (std::size_t i = 0; i < z.size(); i += kEvery) knots.push_back(z[i]);
  return make_curve(-kGrid * static_cast<double>(half), kEvery * kGrid, std::move(knots));
}

Curve make_bare_bump(const Bump& bump) {
  constexpr double kSpacing = 1e-3;  // m, which rounds the ends of an arc
  const double half = std::ceil(0.5 * bump.length / kSpacing) + 4.0;
  std::vector<double> z;
  for (double i = -half; i <= half; ++i) z.push_back(calc_bump_height(bump, kSpacing * i));
  return make_curve(-kSpacing * half, kSpacing, std::move(z));
}

Curve spread_cams(const Curve& curve, double spread) {
  const auto margin = static_cast<std::size_t>(std::ceil(spread / curve.spacing)) + 2;
  std::vector<double> height(curve.height.size() + 2 * margin);
  const double begin = curve.begin - static_cast<double>(margin) * curve.spacing;
  for (std::size_t i = 0; i < height.size(); ++i) {
    const double x = begin + curve.spacing * static_cast<double>(i);
    double before = 0.0, behind = 0.0, slope = 0.0;
    curve.evaluate(x + 0.5 * spread, before, slope);
    curve.evaluate(x - 0.5 * spread, behind, slope);
    height[i] = 0.5 * (before + behind);
  }
  return make_curve(begin, curve.spacing, std::move(height));
}

double calc_roughness_density(const Roughness& roughness, double wave_number) {
  if (wave_number < roughness.lowest || wave_number > roughness.highest) return 0.0;
  const double ratio = wave_number / 0.1;
  return roughness.degree / (ratio * ratio);
}

RoughTracks make_rough_tracks(const Roughness& roughness, double begin, double length,
                              double footprint, std::uint64_t seed) {
  constexpr double kSpacing = 0.02;  // m, eight points in the shortest wave
  std::size_t count = 1;
  while (static_cast<double>(count) * kSpacing < length) count *= 2;
  const double step = 1.0 / (static_cast<double>(count) * kSpacing);
  std::vector<std::complex<double>> left(count), right(count);
  RandomStream draws(seed, "roughness");
  for (std::size_t k = 1; k < count / 2; ++k) {
    const double n = step * static_cast<double>(k);
    const double a = 2.0 * kPi * draws.draw_uniform(), b = 2.0 * kPi * draws.draw_uniform();
    const double width = 0.25 * footprint * kPi * n;
    const double felt = width > 0.0 ? std::pow(std::sin(width) / width, 4) : 1.0;
    // A harmonic of amplitude A has the mean square A^2 / 2 = G dn; two terms of the transform.
    const double amplitude = std::sqrt(2.0 * calc_roughness_density(roughness, n) * step) * felt;
    const double common = std::exp(-0.5 * n / roughness.coherence);
    const std::complex<double> first = std::polar(0.5 * amplitude, a);
    const std::complex<double> second = std::polar(0.5 * amplitude, b);
    left[k] = first;
    right[k] = common * first + std::sqrt(1.0 - common * common) * second;
    left[count - k] = std::conj(left[k]);
    right[count - k] = std::conj(right[k]);
  }
  Eigen::FFT<double> transform;
  const auto make_track = [&](const std::vector<std::complex<double>>& terms) {
    std::vector<std::complex<double>> waves;
    transform.inv(waves, terms);
    std::vector<double> z(count);
    for (std::size_t i = 0; i < count; ++i) z[i] = waves[i].real() * static_cast<double>(count);
    return make_curve(begin, kSpacing, std::move(z));
  };
  return {make_track(left), make_track(right)};
}

}  // namespace strut::hidden
