#include "tests/hidden/detect.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace strut::hidden {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A step over which tangents are straight: wheels that land do so at another instant.
constexpr double kStep = 1e-3, kTimeStep = 2e-4;  // 1, s

double get_step(const Nuisance& nuisance) {
  const bool is_time =
      nuisance.kind == Nuisance::Kind::kTime || nuisance.kind == Nuisance::Kind::kSensorSkew;
  return is_time ? kTimeStep : kStep;
}

Truth without_faults(Truth truth) {
  truth.faults.clear();
  return truth;
}

bool is_sensor_error(const Nuisance& nuisance) {
  return nuisance.kind == Nuisance::Kind::kSensorGain ||
         nuisance.kind == Nuisance::Kind::kSensorSkew;
}

/// Changes the error of one sensor. A stand is driven by its measured input: an error of that one
/// acts as the opposite error of all outputs.
void add_to_sensor(const Kit& kit, std::size_t sensor, double change, std::vector<double>& errors) {
  errors.resize(kit.sensors.size(), 0.0);
  for (std::size_t c = 0; c < errors.size(); ++c) {
    if (kit.sensors[sensor].input && !kit.sensors[c].input) errors[c] -= change;
    if (!kit.sensors[sensor].input && c == sensor) errors[c] += change;
  }
}

void add(const Kit& kit, Truth& truth, const Nuisance& nuisance, double change) {
  const auto add_to_run = [&](std::vector<double>& of_runs) {
    of_runs.resize(truth.speed_error.size(), 0.0);
    of_runs[nuisance.index] += change;
  };
  if (nuisance.kind == Nuisance::Kind::kFactor) truth.factors[nuisance.index] += change;
  if (nuisance.kind == Nuisance::Kind::kSpeed) add_to_run(truth.speed_change);
  if (nuisance.kind == Nuisance::Kind::kTime) add_to_run(truth.time_shift);
  if (nuisance.kind == Nuisance::Kind::kSensorGain) {
    add_to_sensor(kit, nuisance.index, change, truth.sensor_gain);
  }
  if (nuisance.kind == Nuisance::Kind::kSensorSkew) {
    add_to_sensor(kit, nuisance.index, change, truth.sensor_skew);
  }
}

/// Whether a run depends on a nuisance.
bool affects(const Kit& kit, const Nuisance& nuisance, std::size_t run) {
  if (is_sensor_error(nuisance)) return true;
  if (nuisance.kind != Nuisance::Kind::kFactor) return nuisance.index == run;
  const KitParameter& parameter = kit.parameters[nuisance.index];
  if (!parameter.survey) return true;
  return kit.runs[run].excitation == Excitation::kBump &&
         parameter.name.ends_with(std::to_string(kit.runs[run].bump_number));
}

/// Central difference per unit of a nuisance.
Runs calc_tangent(const Kit& kit, const Truth& truth, const Nuisance& nuisance, const Runs& base) {
  const double step = get_step(nuisance);
  // Errors of sensors are added to the signals that are there.
  Truth up = is_sensor_error(nuisance) ? make_nominal_truth(kit) : truth, down = up;
  add(kit, up, nuisance, step);
  add(kit, down, nuisance, -step);
  const std::vector<std::size_t> runs = find_fit_runs(kit);
  Runs tangent = base;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const bool depends = affects(kit, nuisance, runs[r]);
    const auto simulate = [&](const Truth& t) {
      if (!is_sensor_error(nuisance)) {
        return depends ? simulate_run(kit, t, runs[r], kit.rate, kMargin) : base[r];
      }
      std::vector<Signal> signals = base[r];
      add_sensor_errors(t, signals);
      return signals;
    };
    const std::vector<Signal> high = simulate(up), low = simulate(down);
    for (std::size_t c = 0; c < base[r].size(); ++c) {
      for (std::size_t i = 0; i < base[r][c].value.size(); ++i) {
        tangent[r][c].value[i] = 0.5 * nuisance.unit / step * (high[c].value[i] - low[c].value[i]);
      }
    }
  }
  return tangent;
}

}  // namespace

char find_grade(double ratio) {
  return ratio >= 30.0 ? 'A' : ratio >= 10.0 ? 'B' : ratio >= 5.0 ? 'C' : 'D';
}

std::vector<Nuisance> list_nuisances(const Kit& kit) {
  using K = Nuisance::Kind;
  std::vector<Nuisance> list;
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    const double sigma = kit.parameters[i].prior;
    list.push_back({K::kFactor, i, sigma > 0.0 ? sigma : 1e-3, sigma > 0.0});
  }
  for (const std::size_t run : find_fit_runs(kit)) {
    if (kit.speed_sigma > 0.0) list.push_back({K::kSpeed, run, kit.speed_sigma, true});
    if (kit.time_sigma > 0.0) list.push_back({K::kTime, run, kit.time_sigma, true});
  }
  for (std::size_t c = 0; c < kit.sensors.size(); ++c) {
    const Sensor& s = kit.sensors[c];
    if (s.gain > 0.0) list.push_back({K::kSensorGain, c, s.gain, true});
    if (s.skew > 0.0) list.push_back({K::kSensorSkew, c, s.skew, true});
  }
  return list;
}

Detector::Detector(const Kit& kit, const Truth& truth, std::vector<Nuisance> nuisances)
    : kit_(kit),
      truth_(without_faults(truth)),
      nuisances_(std::move(nuisances)),
      base_(simulate_fit_runs(kit_, truth_)),
      whitener_(kit_, truth_, base_) {
  const auto count = static_cast<Eigen::Index>(nuisances_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Nuisance& nuisance = nuisances_[static_cast<std::size_t>(i)];
    const VectorXd column = whitener_.whiten(calc_tangent(kit_, truth_, nuisance, base_));
    if (i == 0) jacobian_ = MatrixXd::Zero(column.size() + count, count);
    jacobian_.col(i).head(column.size()) = column;
    if (nuisance.has_prior) jacobian_(column.size() + i, i) = 1.0;
  }
  const Eigen::HouseholderQR<MatrixXd> qr(jacobian_);
  orthonormal_ = qr.householderQ() * MatrixXd::Identity(jacobian_.rows(), count);
  root_ = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  const MatrixXd inverse =
      root_.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(count, count));
  for (Eigen::Index i = 0; i < count; ++i) {
    bounds_.push_back(nuisances_[static_cast<std::size_t>(i)].unit * inverse.row(i).norm());
  }
}

VectorXd Detector::calc_deviation(const std::vector<FaultSetting>& faults,
                                  const VectorXd& x) const {
  Truth off = truth_;
  off.faults = faults;
  for (std::size_t i = 0; i < nuisances_.size(); ++i) {
    add(kit_, off, nuisances_[i], nuisances_[i].unit * x[static_cast<Eigen::Index>(i)]);
  }
  const VectorXd d = whitener_.whiten(subtract(simulate_fit_runs(kit_, off), base_));
  VectorXd padded = VectorXd::Zero(jacobian_.rows());
  padded.head(d.size()) = d;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (nuisances_[static_cast<std::size_t>(i)].has_prior) padded[d.size() + i] = x[i];
  }
  return padded;
}

VectorXd Detector::calc_deviation(const std::vector<FaultSetting>& faults) const {
  return calc_deviation(faults, VectorXd::Zero(jacobian_.cols()));
}

VectorXd Detector::project(const VectorXd& deviation) const {
  return deviation - orthonormal_ * (orthonormal_.transpose() * deviation);
}

VectorXd Detector::fit(const VectorXd& deviation) const {
  // Gauss and Newton with the tangents at the truth, which a wheel that lands bends: steps are
  // halved until they improve.
  constexpr int kSteps = 8;
  VectorXd x = VectorXd::Zero(jacobian_.cols()), residual = deviation;
  for (int i = 0; i < kSteps; ++i) {
    const double before = residual.norm();
    VectorXd step = root_.triangularView<Eigen::Upper>().solve(orthonormal_.transpose() * residual);
    if (!improve(deviation, step, x, residual)) break;
    if (before - residual.norm() < 0.005 * before) break;
  }
  return project(residual);
}

bool Detector::improve(const VectorXd& deviation, VectorXd step, VectorXd& x,
                       VectorXd& residual) const {
  constexpr int kHalvings = 5;
  for (int i = 0; i < kHalvings; ++i, step *= 0.5) {
    VectorXd tried;
    try {
      tried = deviation - calc_deviation({}, x + step);
    } catch (const std::runtime_error&) {
      continue;  // no car: a speed or a rate far off
    }
    if (!(tried.norm() < residual.norm())) continue;
    x += step;
    residual = tried;
    return true;
  }
  return false;
}

SignalToNoise Detector::calc(const FaultSetting& fault) const {
  const VectorXd d = calc_deviation({fault});
  return {fit(d).norm(), d.norm()};
}

}  // namespace strut::hidden
