#include "identify/plate.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error/input_error.h"

namespace strut {
namespace {

using Eigen::Index;
using std::numbers::pi;

constexpr int kHarmonics = 3, kDegree = 2;  // of p and q
constexpr Index kColumns = (2 * kHarmonics + 1) * (kDegree + 1);
constexpr int kMinCycles = 8;
/// Half width of a window as a fraction of its frequency, and its limits in cycles.
constexpr double kWindowWidth = 0.05;
constexpr int kMaxHalf = 8;

/// Times at which the plate passes its middle upwards. A pass counts once the plate has been a
/// fifth of its amplitude below, so that noise there does not count twice.
std::vector<double> find_cycles(const PlateRecord& record) {
  const auto [low, high] = std::minmax_element(record.position.begin(), record.position.end());
  const double middle = 0.5 * (*low + *high), arm = middle - 0.1 * (*high - *low);
  std::vector<double> cycles;
  bool armed = false;
  for (std::size_t i = 1; i < record.times.size(); ++i) {
    const double before = record.position[i - 1], after = record.position[i];
    armed = armed || before < arm;
    if (!armed || !(before < middle && after >= middle)) continue;
    armed = false;
    const double part = (middle - before) / (after - before);
    cycles.push_back(record.times[i - 1] + part * (record.times[i] - record.times[i - 1]));
  }
  if (static_cast<int>(cycles.size()) > kMinCycles) return cycles;
  throw InputError(fmt::format("{}: the plate makes {} cycles; must be at least {}", record.name,
                               std::max<std::size_t>(cycles.size(), 1) - 1, kMinCycles));
}

/// A least-squares fit: coefficients, their covariance, and the residuals' standard deviation.
struct LinearFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  double noise = 0.0;
};

/// Positively correlated neighbors carry less information than white noise: the covariance grows by
/// (1 + r) / (1 - r), as for a first-order autoregression.
LinearFit fit_linear(const Eigen::MatrixXd& basis, const Eigen::VectorXd& y) {
  LinearFit fit;
  const Eigen::MatrixXd normal = basis.transpose() * basis;
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  fit.coefficients = solver.solve(basis.transpose() * y);
  const Eigen::VectorXd rest = y - basis * fit.coefficients;
  const Index n = rest.size();
  const double power = rest.squaredNorm();
  const double variance = power / static_cast<double>(n - basis.cols());
  const double neighbors = rest.head(n - 1).dot(rest.tail(n - 1));
  const double r = power > 0.0 ? std::clamp(neighbors / power, 0.0, 0.9) : 0.0;
  fit.noise = std::sqrt(variance);
  fit.covariance = solver.solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())) *
                   (variance * (1.0 + r) / (1.0 - r));
  return fit;
}

/// cos and sin of the harmonics at phase `theta` and relative time `tau`, a polynomial each.
Eigen::RowVectorXd make_row(double theta, double tau) {
  Eigen::RowVectorXd row(kColumns);
  Index at = 0;
  double power = 1.0;
  for (int d = 0; d <= kDegree; ++d, power *= tau) {
    row(at++) = power;
    for (int n = 1; n <= kHarmonics; ++n) {
      row(at++) = power * std::cos(n * theta);
      row(at++) = power * std::sin(n * theta);
    }
  }
  return row;
}

/// A window of whole cycles: its first and last cycle, and the plate's phase within it.
struct Window {
  double center = 0.0, half_width = 0.0;  // s
  double frequency = 0.0;                 // Hz, at the center
  double slope = 0.0, bend = 0.0;         // cycles = slope tau + bend tau^2

  double calc_tau(double t) const { return (t - center) / half_width; }
  double calc_theta(double tau) const { return 2.0 * pi * (slope * tau + bend * tau * tau); }
};

Window make_window(const std::vector<double>& cycles, std::size_t i, int half) {
  Window w;
  const std::size_t h = static_cast<std::size_t>(half);
  w.center = cycles[i];
  w.half_width = std::max(cycles[i] - cycles[i - h], cycles[i + h] - cycles[i]);
  Eigen::MatrixXd basis(2 * half, 2);
  Eigen::VectorXd counts(2 * half);
  for (int k = -half, row = 0; k <= half; ++k) {
    if (k == 0) continue;
    const double tau = w.calc_tau(cycles[i - h + static_cast<std::size_t>(k + half)]);
    basis.row(row) << tau, tau * tau;
    counts(row++) = k;
  }
  const Eigen::VectorXd fit = basis.colPivHouseholderQr().solve(counts);
  w.slope = fit(0);
  w.bend = fit(1);
  w.frequency = w.slope / w.half_width;
  return w;
}

int choose_half(const std::vector<double>& cycles, std::size_t i) {
  const double before = 1.0 / (cycles[i] - cycles[i - 1]),
               after = 1.0 / (cycles[i + 1] - cycles[i]);
  const double wide = kWindowWidth * 0.5 * (before + after);
  const double step = std::max(std::abs(after - before), wide / kMaxHalf);
  const int most = static_cast<int>(std::min(i, cycles.size() - 1 - i));
  return std::clamp(static_cast<int>(std::lround(wide / step)), 1, std::min(kMaxHalf, most));
}

/// The angle of p cos theta + q sin theta as that of a leading sine [rad], and its variance.
PlateFigure calc_angle(const LinearFit& fit) {
  const double p = fit.coefficients(1), q = fit.coefficients(2), size = p * p + q * q;
  const Eigen::Vector2d gradient(q / size, -p / size);
  const double variance = gradient.dot(fit.covariance.block<2, 2>(1, 1) * gradient);
  return {std::atan2(p, q), std::sqrt(std::max(variance, 0.0)), 0.0};
}

/// Lowest point of the fitted wave at the window's center.
PlateFigure find_min_force(const LinearFit& fit) {
  constexpr int kPoints = 720;
  PlateFigure lowest{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  Eigen::RowVectorXd at;
  for (int k = 0; k < kPoints; ++k) {
    const Eigen::RowVectorXd row = make_row(2.0 * pi * k / kPoints, 0.0);
    const double force = row * fit.coefficients;
    if (force >= lowest.value) continue;
    lowest.value = force;
    at = row;
  }
  lowest.sigma = std::sqrt(std::max((at * fit.covariance * at.transpose()).value(), 0.0));
  return lowest;
}

PlateResponse calc_response(const PlateRecord& record, const Window& w) {
  const auto begin =
      std::lower_bound(record.times.begin(), record.times.end(), w.center - w.half_width) -
      record.times.begin();
  const auto end =
      std::upper_bound(record.times.begin(), record.times.end(), w.center + w.half_width) -
      record.times.begin();
  if (end - begin < 2 * kColumns) {
    throw InputError(
        fmt::format("{}: {} readings around t = {:.4g} s, where the plate moves at {:.3g} "
                    "Hz; must be at least {}: record faster",
                    record.name, end - begin, w.center, w.frequency, 2 * kColumns));
  }
  Eigen::MatrixXd basis(end - begin, kColumns);
  Eigen::VectorXd position(end - begin), force(end - begin);
  for (auto i = begin; i < end; ++i) {
    const double tau = w.calc_tau(record.times[static_cast<std::size_t>(i)]);
    basis.row(i - begin) = make_row(w.calc_theta(tau), tau);
    position(i - begin) = record.position[static_cast<std::size_t>(i)];
    force(i - begin) = record.force[static_cast<std::size_t>(i)];
  }
  const LinearFit plate = fit_linear(basis, position), contact = fit_linear(basis, force);
  const PlateFigure from = calc_angle(plate), to = calc_angle(contact);
  const double lead = std::fmod(to.value - from.value + 4.0 * pi, 2.0 * pi);
  PlateResponse response{w.frequency, find_min_force(contact), {}, contact.noise};
  response.phase = {lead * 180.0 / pi, std::hypot(from.sigma, to.sigma) * 180.0 / pi, w.frequency};
  response.min_force.frequency = w.frequency;
  return response;
}

/// Phase at the frequency `f` between two neighboring responses; `sigma_f`: standard error of `f`.
PlateFigure interpolate_phase(const PlateResponse& a, const PlateResponse& b, double f,
                              double sigma_f) {
  const double part = (f - a.frequency) / (b.frequency - a.frequency);
  const double slope = (b.phase.value - a.phase.value) / (b.frequency - a.frequency);
  // Neighbors share most of their readings: their errors are alike.
  const double sigma = (1.0 - part) * a.phase.sigma + part * b.phase.sigma;
  return {a.phase.value + part * (b.phase.value - a.phase.value),
          std::hypot(sigma, slope * sigma_f), f};
}

/// Lowest phase within the band, whose upper end counts too.
PlateFigure find_phase_angle(const std::vector<PlateResponse>& responses, const PhaseBand& band) {
  PlateFigure least{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  const auto keep = [&](const PlateFigure& phase) {
    if (phase.value < least.value) least = phase;
  };
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const PlateResponse& r = responses[i];
    if (r.frequency >= band.body && r.frequency <= band.wheel) keep(r.phase);
    if (i == 0) continue;
    const PlateResponse& before = responses[i - 1];
    if ((before.frequency - band.wheel) * (r.frequency - band.wheel) < 0.0) {
      keep(interpolate_phase(before, r, band.wheel, band.wheel_sigma));
    }
  }
  return least;
}

}  // namespace

std::vector<PlateResponse> calc_plate_responses(const PlateRecord& record) {
  const std::vector<double> cycles = find_cycles(record);
  std::vector<PlateResponse> responses;
  for (std::size_t i = 1; i + 1 < cycles.size(); ++i) {
    responses.push_back(calc_response(record, make_window(cycles, i, choose_half(cycles, i))));
  }
  return responses;
}

double calc_plate_noise(const std::vector<PlateResponse>& responses) {
  std::vector<double> noise(responses.size());
  std::transform(responses.begin(), responses.end(), noise.begin(),
                 [](const PlateResponse& r) { return r.noise; });
  const auto middle = noise.begin() + static_cast<Index>(noise.size() / 2);
  std::nth_element(noise.begin(), middle, noise.end());
  return *middle;
}

double calc_static_load(const PlateRecord& record) {
  const std::vector<double> cycles = find_cycles(record);
  double sum = 0.0, duration = 0.0;
  for (std::size_t i = 1; i < record.times.size(); ++i) {
    if (record.times[i - 1] < cycles.front() || record.times[i] > cycles.back()) continue;
    const double step = record.times[i] - record.times[i - 1];
    sum += 0.5 * (record.force[i - 1] + record.force[i]) * step;
    duration += step;
  }
  const double load = sum / duration;
  if (load > 0.0) return load;
  throw InputError(
      fmt::format("{}: mean contact force {:.4g} N: must be the static load, > 0; wrong sign?",
                  record.name, load));
}

PlateFigures calc_plate_figures(const std::vector<PlateResponse>& responses, double static_load,
                                const PhaseBand& band, const std::string& name) {
  PlateFigures figures;
  figures.static_load = static_load;
  const auto lowest = std::min_element(
      responses.begin(), responses.end(),
      [](const auto& a, const auto& b) { return a.min_force.value < b.min_force.value; });
  const double percent = 100.0 / static_load;
  figures.eusama = {percent * std::max(lowest->min_force.value, 0.0),
                    percent * lowest->min_force.sigma, lowest->frequency};
  figures.phase_angle = find_phase_angle(responses, band);
  if (!std::isfinite(figures.phase_angle.value)) {
    throw InputError(
        fmt::format("{}: no cycle of the plate between the body's {:.3g} Hz and the "
                    "wheel's {:.3g} Hz; must sweep from 25 Hz down to rest",
                    name, band.body, band.wheel));
  }
  figures.at_wheel_mode = figures.phase_angle.frequency == band.wheel;
  return figures;
}

}  // namespace strut
