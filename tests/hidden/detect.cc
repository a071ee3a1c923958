#include "tests/hidden/detect.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <unsupported/Eigen/FFT>
#include <utility>

namespace strut::hidden {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Runs = std::vector<std::vector<Signal>>;
using Complex = std::complex<double>;

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kHighest = 80.0;  // Hz

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

/// Response of a stand's sensors to its input, whose sensor noise is fed to the model.
Eigen::VectorXcd calc_rig_response(const Kit& kit, Complex rate) {
  Eigen::VectorXcd h = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(kit.sensors.size()));
  const auto value = [&](std::size_t i) { return kit.parameters[i].nominal; };
  if (kit.kind == KitKind::kDyno) {
    h[1] = value(0) + value(1) * rate;
    return h;
  }
  const Complex strut = value(2) + value(3) * rate, tire = value(4) + value(5) * rate;
  const Complex sprung = value(0) * rate * rate + strut;
  const Complex unsprung = value(1) * rate * rate + strut + tire;
  h[1] = tire * sprung / (sprung * unsprung - strut * strut);
  h[2] = strut * h[1] / sprung;
  return h;
}

std::vector<std::size_t> find_fit_runs(const Kit& kit) {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < kit.runs.size(); ++i) {
    if (kit.runs[i].fit) runs.push_back(i);
  }
  return runs;
}

std::size_t count_samples(const Kit& kit, const RunPlan& run) {
  return static_cast<std::size_t>(std::lround(run.duration * kit.rate));
}

/// Bins 1 .. count of the transform that are used.
std::size_t count_bins(const Kit& kit, const RunPlan& run) {
  const std::size_t half = count_samples(kit, run) / 2 - 1;
  return std::min(half, static_cast<std::size_t>(kHighest * run.duration));
}

/// Samples of a run less their mean, the last tenth faded out.
std::vector<double> get_faded(const Signal& signal, std::size_t count) {
  std::vector<double> x(signal.value.begin(),
                        signal.value.begin() + static_cast<std::ptrdiff_t>(count));
  double mean = 0.0;
  for (const double v : x) mean += v / static_cast<double>(count);
  const std::size_t tail = count / 10;
  for (double& v : x) v -= mean;
  for (std::size_t i = 0; i < tail; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(tail);
    x[count - tail + i] *= 0.5 * (1.0 + std::cos(0.5 * kTwoPi * s));
  }
  return x;
}

Signal differentiate(const Signal& signal) {
  Signal rate = signal;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    const double t = signal.begin + signal.spacing * static_cast<double>(i),
                 h = 0.5 * signal.spacing;
    rate.value[i] = (signal.evaluate(t + h) - signal.evaluate(t - h)) / (2.0 * h);
  }
  return rate;
}

void scale(Runs& runs, double factor) {
  for (auto& run : runs) {
    for (Signal& s : run) {
      for (double& v : s.value) v *= factor;
    }
  }
}

}  // namespace

char find_grade(double ratio) {
  return ratio >= 30.0 ? 'A' : ratio >= 10.0 ? 'B' : ratio >= 5.0 ? 'C' : 'D';
}

NoiseSpectrum::NoiseSpectrum(const Kit& kit, const RunPlan& run, double roughness)
    : kit_(kit), run_(run), roughness_(roughness) {
  if (kit.kind != KitKind::kCar || roughness == 0.0) return;
  const CarModel model(make_nominal_car());
  const std::vector<double> start = model.make_start(run.speed, 0.0);
  const auto n = static_cast<Eigen::Index>(start.size());
  const auto outputs = static_cast<Eigen::Index>(kit.sensors.size());
  a_.resize(n, n);
  b_.resize(n, 2 * kWheels);
  c_.resize(outputs, n);
  d_.resize(outputs, 2 * kWheels);
  Drive flat;
  flat.speed = run.speed;
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
      const double x = make_nominal_car().wheel[w].position.x();
      state[CarState::kPosition] -= x;
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
  const auto count = static_cast<Eigen::Index>(kit_.sensors.size());
  MatrixXcd s = MatrixXcd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Sensor& sensor = kit_.sensors[static_cast<std::size_t>(i)];
    s(i, i) = sensor.noise * sensor.noise + sensor.quantum * sensor.quantum / 12.0;
  }
  const Complex rate(0.0, kTwoPi * frequency);
  if (kit_.kind != KitKind::kCar) {
    const Eigen::VectorXcd h = calc_rig_response(kit_, rate);
    const double noise = kit_.sensors.front().noise;
    return s + noise * noise * (h * h.adjoint());
  }
  if (a_.size() == 0) return s;
  MatrixXcd shifted = -a_.cast<Complex>();
  shifted.diagonal().array() += rate;
  const MatrixXcd response =
      c_.cast<Complex>() * shifted.partialPivLu().solve(b_.cast<Complex>()) + d_.cast<Complex>();
  // Left and right track to the eight inputs; a wheel sees z(x + x_w) and its slope i 2 pi n z.
  const double n = frequency / run_.speed;
  const Car car = make_nominal_car();
  MatrixXcd tracks = MatrixXcd::Zero(2 * kWheels, 2);
  for (std::size_t w = 0; w < kWheels; ++w) {
    const auto at = static_cast<Eigen::Index>(2 * w);
    const Complex ahead = std::polar(1.0, kTwoPi * n * car.wheel[w].position.x());
    tracks(at, static_cast<Eigen::Index>(w % 2)) = ahead;
    tracks(at + 1, static_cast<Eigen::Index>(w % 2)) = ahead * Complex(0.0, kTwoPi * n);
  }
  Roughness roughness;
  roughness.degree = roughness_;
  const double width = 0.25 * kFootprint * 0.5 * kTwoPi * n;
  const double felt = std::pow(std::sin(width) / width, 8);
  const double density = calc_roughness_density(roughness, n) / run_.speed * felt;
  const double common = std::exp(-0.5 * n / roughness.coherence);
  Eigen::Matrix2cd road;
  road << density, common * density, common * density, density;
  const MatrixXcd h = response * tracks;
  // One-sided density G [1/Hz] against variance a sample: G rate / 2.
  s += 0.5 * kit_.rate * (h * road * h.adjoint());
  return s;
}

Whitener::Whitener(const Kit& kit, double roughness) : kit_(kit), fit_runs_(find_fit_runs(kit)) {
  for (const std::size_t r : fit_runs_) {
    const RunPlan& run = kit.runs[r];
    const NoiseSpectrum spectrum(kit, run, roughness);
    const auto samples = static_cast<double>(count_samples(kit, run));
    std::vector<VectorXd>& weights = weight_.emplace_back();
    std::vector<MatrixXcd>& correlations = correlation_.emplace_back();
    for (std::size_t k = 1; k <= count_bins(kit, run); ++k) {
      const MatrixXcd s = samples * spectrum.calc(static_cast<double>(k) / run.duration);
      weights.push_back(s.diagonal().real().cwiseSqrt().cwiseInverse());
      correlations.push_back(weights.back().asDiagonal() * s * weights.back().asDiagonal());
    }
  }
}

VectorXd Whitener::whiten(const Runs& runs) const {
  Eigen::FFT<double> transform;
  std::vector<double> parts;
  for (std::size_t r = 0; r < fit_runs_.size(); ++r) {
    const std::size_t samples = count_samples(kit_, kit_.runs[fit_runs_[r]]);
    std::vector<std::vector<Complex>> spectra(runs[r].size());
    for (std::size_t c = 0; c < runs[r].size(); ++c) {
      if (kit_.sensors[c].input) {
        spectra[c].assign(samples, 0.0);
      } else {
        transform.fwd(spectra[c], get_faded(runs[r][c], samples));
      }
    }
    for (std::size_t k = 0; k < weight_[r].size(); ++k) {
      for (std::size_t c = 0; c < spectra.size(); ++c) {
        const double weight = std::sqrt(2.0) * weight_[r][k][static_cast<Eigen::Index>(c)];
        parts.push_back(weight * spectra[c][k + 1].real());
        parts.push_back(weight * spectra[c][k + 1].imag());
      }
    }
  }
  return Eigen::Map<VectorXd>(parts.data(), static_cast<Eigen::Index>(parts.size()));
}

template <class Visit>
void Whitener::visit_bins(const Visit& visit) const {
  Eigen::Index at = 0;
  for (const std::vector<MatrixXcd>& run : correlation_) {
    for (const MatrixXcd& correlation : run) {
      visit(correlation, at);
      at += 2 * correlation.rows();
    }
  }
}

double Whitener::calc_variance(const VectorXd& r) const {
  double variance = 0.0;
  visit_bins([&](const MatrixXcd& correlation, Eigen::Index at) {
    const Eigen::Map<const Eigen::VectorXcd> part(reinterpret_cast<const Complex*>(r.data() + at),
                                                  correlation.rows());
    variance += part.dot(correlation * part).real();
  });
  return variance;
}

MatrixXd Whitener::calc_information(const MatrixXd& j) const {
  MatrixXd information = MatrixXd::Zero(j.cols(), j.cols());
  visit_bins([&](const MatrixXcd& correlation, Eigen::Index at) {
    MatrixXcd part(correlation.rows(), j.cols());
    for (Eigen::Index i = 0; i < part.rows(); ++i) {
      for (Eigen::Index k = 0; k < part.cols(); ++k) {
        part(i, k) = {j(at + 2 * i, k), j(at + 2 * i + 1, k)};
      }
    }
    information += (part.adjoint() * correlation.llt().solve(part)).real();
  });
  return information;
}

double Whitener::calc_joint_square(const VectorXd& d) const {
  double square = 0.0;
  visit_bins([&](const MatrixXcd& correlation, Eigen::Index at) {
    const Eigen::Map<const Eigen::VectorXcd> part(reinterpret_cast<const Complex*>(d.data() + at),
                                                  correlation.rows());
    square += part.dot(correlation.llt().solve(Eigen::VectorXcd(part))).real();
  });
  return square;
}

Runs simulate_fit_runs(const Kit& kit, const Truth& truth) {
  Truth smooth = truth;
  smooth.roughness = 0.0;
  Runs runs;
  for (const std::size_t r : find_fit_runs(kit)) {
    runs.push_back(simulate_run(kit, smooth, r, kit.rate, 0.0));
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

std::vector<Nuisance> make_nuisances(const Kit& kit) {
  constexpr double kStep = 4e-3;
  const Truth nominal = make_nominal_truth(kit);
  const Runs base = simulate_fit_runs(kit, nominal);
  std::vector<Nuisance> list;
  const auto add = [&](Runs runs, double step, double unit, bool has_prior) {
    scale(runs, unit / step);
    list.push_back({std::move(runs), has_prior, unit});
  };
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    Truth up = nominal, down = nominal;
    up.factors[i] += kStep;
    down.factors[i] -= kStep;
    const double sigma = kit.parameters[i].prior;
    const Runs change = subtract(simulate_fit_runs(kit, up), simulate_fit_runs(kit, down));
    add(change, 2.0 * kStep, sigma > 0.0 ? sigma : 1e-3, sigma > 0.0);
  }
  const std::vector<std::size_t> fit_runs = find_fit_runs(kit);
  Runs faster, slower;
  if (kit.speed_sigma > 0.0) {
    Truth up = nominal, down = nominal;
    std::fill(up.speed_error.begin(), up.speed_error.end(), kStep);
    std::fill(down.speed_error.begin(), down.speed_error.end(), -kStep);
    faster = subtract(simulate_fit_runs(kit, up), simulate_fit_runs(kit, down));
  }
  for (std::size_t r = 0; r < fit_runs.size(); ++r) {
    const auto only = [&](Runs runs) {
      for (std::size_t k = 0; k < runs.size(); ++k) {
        if (k == r) continue;
        for (Signal& s : runs[k]) std::fill(s.value.begin(), s.value.end(), 0.0);
      }
      return runs;
    };
    if (kit.speed_sigma > 0.0) add(only(faster), 2.0 * kStep, kit.speed_sigma, true);
    if (kit.time_sigma > 0.0) {
      Runs rates = base;
      for (Signal& s : rates[r]) s = differentiate(s);
      add(only(std::move(rates)), 1.0, kit.time_sigma, true);
    }
  }
  return list;
}

Detector::Detector(const Kit& kit, const std::vector<Nuisance>& nuisances, double roughness)
    : whitener_(kit, roughness) {
  VectorXd prior(static_cast<Eigen::Index>(nuisances.size()));
  for (std::size_t i = 0; i < nuisances.size(); ++i) {
    const VectorXd column = whitener_.whiten(nuisances[i].deviation);
    if (i == 0) jacobian_.resize(column.size(), prior.size());
    jacobian_.col(static_cast<Eigen::Index>(i)) = column;
    prior[static_cast<Eigen::Index>(i)] = nuisances[i].has_prior ? 1.0 : 0.0;
  }
  MatrixXd normal = jacobian_.transpose() * jacobian_;
  normal.diagonal() += prior;
  normal_.compute(normal);
  MatrixXd information = whitener_.calc_information(jacobian_);
  information.diagonal() += prior;
  const VectorXd variance =
      information.ldlt().solve(MatrixXd::Identity(prior.size(), prior.size())).diagonal();
  for (std::size_t i = 0; i < nuisances.size(); ++i) {
    bounds_.push_back(nuisances[i].unit * std::sqrt(variance[static_cast<Eigen::Index>(i)]));
  }
}

SignalToNoise Detector::calc(const Runs& deviation) const {
  const VectorXd d = whitener_.whiten(deviation);
  const VectorXd r = d - jacobian_ * normal_.solve(jacobian_.transpose() * d);
  const auto calc_ratio = [&](const VectorXd& x) {
    const double variance = whitener_.calc_variance(x);
    return variance > 0.0 ? x.squaredNorm() / std::sqrt(variance) : 0.0;
  };
  return {calc_ratio(r), std::sqrt(whitener_.calc_joint_square(r)), calc_ratio(d)};
}

}  // namespace strut::hidden
