#include "tests/hidden/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <utility>

namespace strut::hidden {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr double kTwoPi = 6.28318530717958647692;

/// A road of constant height and slope under one wheel.
Curve make_ramp(double height, double slope) {
  constexpr double kReach = 1e4;
  return {
      -kReach, 2.0 * kReach, {height - slope * kReach, height + slope * kReach}, {slope, slope}};
}

VectorXd read_sample(const Kit& kit, const CarSample& s) {
  VectorXd out(static_cast<Eigen::Index>(kit.sensors.size()));
  const double body[4] = {s.imu_acceleration.x(), s.imu_acceleration.z(), s.imu_rate.x(),
                          s.imu_rate.y()};
  for (Eigen::Index i = 0; i < 4; ++i) out[i] = body[i];
  for (std::size_t w = 0; w < kWheels; ++w) {
    out[4 + 2 * static_cast<Eigen::Index>(w)] = s.deflection[w];
    out[5 + 2 * static_cast<Eigen::Index>(w)] = s.wheel_acceleration[w];
  }
  return out;
}

/// Response of a stand's outputs to its input.
VectorXcd calc_rig_response(const Kit& kit, const Truth& truth, Complex rate) {
  const auto value = [&](std::size_t i) { return kit.parameters[i].nominal * truth.factors[i]; };
  if (kit.kind == KitKind::kDyno) return VectorXcd::Constant(1, value(0) + value(1) * rate);
  const Complex strut = value(2) + value(3) * rate, tire = value(4) + value(5) * rate;
  const Complex sprung = value(0) * rate * rate + strut;
  const Complex unsprung = value(1) * rate * rate + strut + tire;
  VectorXcd h(2);
  h[0] = tire * sprung / (sprung * unsprung - strut * strut);
  h[1] = strut * h[0] / sprung;
  return h;
}

std::size_t count_samples(const Kit& kit, const RunPlan& run) {
  return static_cast<std::size_t>(std::lround(run.duration * kit.rate));
}

std::size_t count_bins(const Kit& kit, const RunPlan& run) {
  return count_samples(kit, run) / 2 - 1;
}

/// Covariance of a sample of all channels: sensors, converters, and the clock's jitter.
MatrixXd calc_reading_noise(const Kit& kit, const std::vector<Signal>& signals) {
  const auto channels = static_cast<Eigen::Index>(signals.size());
  const auto count = static_cast<Eigen::Index>(signals.front().value.size());
  MatrixXd rates(count - 2, channels);
  MatrixXd noise = MatrixXd::Zero(channels, channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    const Signal& signal = signals[static_cast<std::size_t>(c)];
    const Eigen::Map<const VectorXd> y(signal.value.data(), count);
    rates.col(c) = (y.tail(count - 2) - y.head(count - 2)) / (2.0 * signal.spacing);
    const Sensor& sensor = kit.sensors[static_cast<std::size_t>(c)];
    noise(c, c) = sensor.noise * sensor.noise + sensor.quantum * sensor.quantum / 12.0;
  }
  return noise +
         kit.jitter * kit.jitter / static_cast<double>(count - 2) * (rates.transpose() * rates);
}

/// Weight of sample i of `count`: 1, and at the ends of a car's run a cosine.
double calc_fade(const Kit& kit, std::size_t i, std::size_t count) {
  if (kit.kind != KitKind::kCar) return 1.0;
  const double reach = 0.05 * static_cast<double>(count);
  const double end = std::min(static_cast<double>(i), static_cast<double>(count - i));
  return end >= reach ? 1.0 : 0.5 * (1.0 - std::cos(0.5 * kTwoPi * end / reach));
}

/// Samples of the recording less their mean, faded.
std::vector<double> get_samples(const Kit& kit, const Signal& signal, std::size_t count) {
  const auto begin = std::lround(-signal.begin / signal.spacing);
  std::vector<double> x(signal.value.begin() + begin,
                        signal.value.begin() + begin + static_cast<std::ptrdiff_t>(count));
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double w = calc_fade(kit, i, count);
    sum += w * x[i];
    weight += w;
  }
  for (std::size_t i = 0; i < count; ++i) x[i] = calc_fade(kit, i, count) * (x[i] - sum / weight);
  return x;
}

bool is_rough(const Kit& kit, const Truth& truth) {
  return kit.kind == KitKind::kCar && truth.roughness > 0.0;
}

}  // namespace

std::vector<std::size_t> find_fit_runs(const Kit& kit) {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < kit.runs.size(); ++i) {
    if (kit.runs[i].fit) runs.push_back(i);
  }
  return runs;
}

Runs simulate_fit_runs(const Kit& kit, const Truth& truth) {
  Runs runs;
  for (const std::size_t r : find_fit_runs(kit)) {
    runs.push_back(simulate_run(kit, truth, r, kit.rate, kMargin));
  }
  return runs;
}

Runs subtract(Runs a, const Runs& b) {
  for (std::size_t r = 0; r < a.size(); ++r) {
    for (std::size_t c = 0; c < a[r].size(); ++c) {
      for (std::size_t i = 0; i < a[r][c].value.size(); ++i) {
        a[r][c].value[i] -= b[r][c].value[i];
      }
    }
  }
  return a;
}

NoiseSpectrum::NoiseSpectrum(const Kit& kit, const Truth& truth, std::size_t run,
                             const std::vector<Signal>& signals)
    : kit_(kit),
      truth_(truth),
      run_(kit.runs[run]),
      speed_(run_.speed * (1.0 + truth.speed_error[run])),
      readings_(calc_reading_noise(kit, signals)) {
  if (!is_rough(kit, truth)) return;
  truth_.faults.clear();
  const Car car = make_car(kit, truth_);
  const CarModel model(car);
  const std::vector<double> start = model.make_start(speed_, 0.0);
  const auto n = static_cast<Eigen::Index>(start.size());
  const auto outputs = static_cast<Eigen::Index>(kit.sensors.size());
  a_.resize(n, n);
  b_.resize(n, 2 * kWheels);
  c_.resize(outputs, n);
  d_.resize(outputs, 2 * kWheels);
  Drive flat;
  flat.speed = speed_;
  std::vector<double> up(start.size()), down(start.size());
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double> high = start, low = start;
    high[static_cast<std::size_t>(i)] += kStep;
    low[static_cast<std::size_t>(i)] -= kStep;
    model.calc_rates(flat, high, up);
    model.calc_rates(flat, low, down);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      a_(k, i) = (up[at] - down[at]) / (2.0 * kStep);
    }
    c_.col(i) = (read_sample(kit, model.calc_sample(flat, high)) -
                 read_sample(kit, model.calc_sample(flat, low))) /
                (2.0 * kStep);
  }
  for (std::size_t w = 0; w < kWheels; ++w) {
    for (int kind = 0; kind < 2; ++kind) {
      const auto at = static_cast<Eigen::Index>(2 * w) + kind;
      const Curve high = make_ramp(kind == 0 ? kStep : 0.0, kind == 1 ? kStep : 0.0);
      Curve low = high;
      for (double& v : low.height) v = -v;
      for (double& v : low.slope) v = -v;
      // A slope must not raise the road under a wheel that is not at x = 0.
      std::vector<double> state = start;
      state[CarState::kPosition] -= car.wheel[w].position.x();
      Drive drive = flat;
      drive.track[w].rough = &high;
      model.calc_rates(drive, state, up);
      const VectorXd above = read_sample(kit, model.calc_sample(drive, state));
      drive.track[w].rough = &low;
      model.calc_rates(drive, state, down);
      const VectorXd below = read_sample(kit, model.calc_sample(drive, state));
      d_.col(at) = (above - below) / (2.0 * kStep);
      for (Eigen::Index k = 0; k < n; ++k) {
        const auto i = static_cast<std::size_t>(k);
        b_(k, at) = (up[i] - down[i]) / (2.0 * kStep);
      }
    }
  }
}

MatrixXcd NoiseSpectrum::calc(double frequency) const {
  if (kit_.kind != KitKind::kCar) return calc_rig(frequency);
  return calc_readings(frequency).cast<Complex>() + calc_road(frequency);
}

MatrixXd NoiseSpectrum::calc_readings(double frequency) const {
  MatrixXd noise = readings_;
  for (Eigen::Index c = 0; c < noise.rows(); ++c) {
    const Sensor& s = kit_.sensors[static_cast<std::size_t>(c)];
    noise(c, c) += s.noise * s.noise * calc_drift_spectrum(s, frequency, kit_.rate);
  }
  return noise;
}

MatrixXcd NoiseSpectrum::calc_rig(double frequency) const {
  const VectorXcd h = calc_rig_response(kit_, truth_, {0.0, kTwoPi * frequency});
  MatrixXcd t(h.size(), h.size() + 1);
  t << -h, MatrixXcd::Identity(h.size(), h.size());
  return t * calc_readings(frequency).cast<Complex>() * t.adjoint();
}

MatrixXcd NoiseSpectrum::calc_road(double frequency) const {
  const auto count = static_cast<Eigen::Index>(kit_.sensors.size());
  Roughness roughness;
  roughness.degree = truth_.roughness;
  const double n = frequency / speed_;
  if (a_.size() == 0 || n < roughness.lowest || n > roughness.highest) {
    return MatrixXcd::Zero(count, count);
  }
  MatrixXcd shifted = -a_.cast<Complex>();
  shifted.diagonal().array() += Complex(0.0, kTwoPi * frequency);
  const MatrixXcd response =
      c_.cast<Complex>() * shifted.partialPivLu().solve(b_.cast<Complex>()) + d_.cast<Complex>();
  // Left and right track to the eight inputs; a wheel sees z(x + x_w) and its slope i 2 pi n z.
  const Car car = make_nominal_car();
  MatrixXcd tracks = MatrixXcd::Zero(2 * kWheels, 2);
  for (std::size_t w = 0; w < kWheels; ++w) {
    const auto at = static_cast<Eigen::Index>(2 * w);
    const Complex ahead = std::polar(1.0, kTwoPi * n * car.wheel[w].position.x());
    tracks(at, static_cast<Eigen::Index>(w % 2)) = ahead;
    tracks(at + 1, static_cast<Eigen::Index>(w % 2)) = ahead * Complex(0.0, kTwoPi * n);
  }
  const double width = 0.25 * get_footprint(kit_) * 0.5 * kTwoPi * n;
  const double felt = width > 0.0 ? std::pow(std::sin(width) / width, 8) : 1.0;
  const double density = calc_roughness_density(roughness, n) / speed_ * felt;
  const double common = std::exp(-0.5 * n / roughness.coherence);
  Eigen::Matrix2cd road;
  road << density, common * density, common * density, density;
  const MatrixXcd h = response * tracks;
  // One-sided density G [1/Hz] against variance a sample: G rate / 2.
  return 0.5 * kit_.rate * (h * road * h.adjoint());
}

Whitener::Whitener(const Kit& kit, const Truth& truth, const Runs& base)
    : kit_(kit), truth_(truth), fit_runs_(find_fit_runs(kit)) {
  for (std::size_t i = 0; i < fit_runs_.size(); ++i) {
    const RunPlan& run = kit.runs[fit_runs_[i]];
    const NoiseSpectrum spectrum(kit, truth, fit_runs_[i], base[i]);
    const auto samples = static_cast<double>(count_samples(kit, run));
    std::vector<MatrixXcd>& roots = inverse_root_.emplace_back();
    for (std::size_t k = 1; k <= count_bins(kit, run); ++k) {
      const MatrixXcd s = samples * spectrum.calc(static_cast<double>(k) / run.duration);
      const MatrixXcd root = s.llt().matrixL();
      roots.push_back(std::sqrt(2.0) * root.triangularView<Eigen::Lower>().solve(
                                           MatrixXcd::Identity(s.rows(), s.cols())));
    }
  }
}

VectorXd Whitener::whiten(const Runs& runs) const { return whiten(runs, false); }

VectorXd Whitener::whiten_residuals(const Runs& runs) const { return whiten(runs, true); }

VectorXd Whitener::whiten(const Runs& runs, bool has_measured_input) const {
  Eigen::FFT<double> transform;
  std::vector<double> parts;
  for (std::size_t r = 0; r < fit_runs_.size(); ++r) {
    const RunPlan& run = kit_.runs[fit_runs_[r]];
    const std::size_t samples = count_samples(kit_, run);
    std::vector<std::vector<Complex>> outputs;
    std::vector<Complex> input;
    for (std::size_t c = 0; c < runs[r].size(); ++c) {
      std::vector<Complex>& spectrum = kit_.sensors[c].input ? input : outputs.emplace_back();
      transform.fwd(spectrum, get_samples(kit_, runs[r][c], samples));
    }
    for (std::size_t k = 0; k < inverse_root_[r].size(); ++k) {
      VectorXcd bin(static_cast<Eigen::Index>(outputs.size()));
      for (Eigen::Index c = 0; c < bin.size(); ++c) {
        bin[c] = outputs[static_cast<std::size_t>(c)][k + 1];
      }
      if (has_measured_input && !input.empty()) {
        const double frequency = static_cast<double>(k + 1) / run.duration;
        bin -= input[k + 1] * calc_rig_response(kit_, truth_, {0.0, kTwoPi * frequency});
      }
      const VectorXcd white = inverse_root_[r][k] * bin;
      for (const Complex& w : white) parts.insert(parts.end(), {w.real(), w.imag()});
    }
  }
  return Eigen::Map<VectorXd>(parts.data(), static_cast<Eigen::Index>(parts.size()));
}

}  // namespace strut::hidden
