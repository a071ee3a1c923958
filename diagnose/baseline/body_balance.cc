#include "diagnose/baseline/body_balance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/math/local_polynomial.h"
#include "base/math/spread.h"
#include "estimate/simulate_run.h"
#include "model/rig/rigs.h"

namespace strut {
namespace {

using Values = std::vector<double>;

/// The half width of the local cubics in periods of the fastest mode: a tenth keeps its
/// acceleration to some 2 %, and what is lost is lost on both sides of the balance.
constexpr double kHalfPeriods = 0.1;
constexpr double kLeastSamples = 4.0;  // of a half width

const MeasuredChannel* find(const MeasuredRun& run, int channel) {
  const auto found = std::find_if(run.channels.begin(), run.channels.end(),
                                  [&](const MeasuredChannel& c) { return c.channel == channel; });
  return found == run.channels.end() ? nullptr : &*found;
}

double calc_half_width(const MeasuredRun& run) {
  const double interval = run.times.back() / static_cast<double>(run.times.size() - 1);
  const double period = 2.0 * std::numbers::pi / run.setup.calc_fastest_mode();
  return std::max(kLeastSamples * interval, kHalfPeriods * period);
}

Values calc_strut_force(const MeasuredRun& run, const Values& deflection) {
  Values times, moves;
  times.reserve(deflection.size());
  moves.reserve(deflection.size());
  for (std::size_t i = 0; i < deflection.size(); ++i) {
    if (!std::isfinite(deflection[i])) continue;
    times.push_back(run.times[i]);
    moves.push_back(deflection[i]);
  }
  RigCase stand{take_strut(run.setup.rig().rig), {}};
  const RigInfo& info = get_rig_info(stand.rig.kind);
  stand.inputs = {make_signal(info.inputs.front().name, times, moves, Interpolation::kSpline)};
  const MeasuredRun imposed{run.name, std::move(stand), run.times, {}};
  const RunCurves curves = simulate_run(imposed, {}, {});
  const auto force = static_cast<std::size_t>(info.stand_force);
  return curves.failure.empty() ? curves.channel[force] : Values{};
}

/// Twice integrated over time, exactly for the cubic spline through the readings.
Values integrate_twice(const Values& times, const Values& values) {
  const InputSignal spline = make_signal("", times, values, Interpolation::kSpline);
  Values integral(times.size(), 0.0);
  double once = 0.0, twice = 0.0;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const SignalCell& c = spline.cells[i];
    const double s = times[i + 1] - times[i];
    twice += s * (once + s * (c.c0 / 2.0 + s * (c.c1 / 6.0 + s * (c.c2 / 12.0 + s * c.c3 / 20.0))));
    once += s * (c.c0 + s * (c.c1 / 2.0 + s * (c.c2 / 3.0 + s * c.c3 / 4.0)));
    integral[i + 1] = twice;
  }
  return integral;
}

/// What a quantity becomes on the way that leads from a position to its second derivative.
Values filter(const MeasuredRun& run, const Values& values, double half_width) {
  Values times, there;
  times.reserve(values.size());
  there.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    times.push_back(run.times[i]);
    there.push_back(values[i]);
  }
  Values filtered(values.size(), std::numeric_limits<double>::quiet_NaN());
  if (there.size() < 4) return filtered;
  const Values second =
      calc_local_polynomial(times, integrate_twice(times, there), {half_width, 3}).second_rate;
  std::size_t next = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) filtered[i] = second[next++];
  }
  return filtered;
}

/// The rate of the spline through the readings.
Values calc_rate(const MeasuredRun& run, const Values& values) {
  Values times, there;
  times.reserve(values.size());
  there.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    times.push_back(run.times[i]);
    there.push_back(values[i]);
  }
  const InputSignal spline = make_signal("", times, there, Interpolation::kSpline);
  Values rate(values.size());
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = calc_signal(spline, run.times[i]).rate;
  return rate;
}

/// Least squares of force against k deflection + c velocity + constant; sigmas for residuals that
/// are as correlated as they are.
void fit_strut(BodyBalance& b) {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  const auto row = [&](std::size_t i) {
    return Eigen::Vector3d(b.deflection[i], b.velocity[i], 1.0);
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < b.force.size(); ++i) {
    if (!std::isfinite(b.force[i]) || !std::isfinite(b.deflection[i])) continue;
    gram += row(i) * row(i).transpose();
    moment += b.force[i] * row(i);
    ++count;
  }
  if (count < 10) return;
  const Eigen::Vector3d found = gram.ldlt().solve(moment);
  Values left(b.force.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = b.force[i] - row(i).dot(found);
  const double rho = std::clamp(calc_neighbor_correlation(left), 0.0, 0.999);
  const double rms = calc_rms(left);
  const Eigen::Matrix3d covariance = gram.inverse() * (rms * rms * (1.0 + rho) / (1.0 - rho));
  b.stiffness = found(0);
  b.damping = found(1);
  b.stiffness_sigma = std::sqrt(covariance(0, 0));
  b.damping_sigma = std::sqrt(covariance(1, 1));
}

void add_kinematics(const MeasuredRun& run, int position, int acceleration, double half_width,
                    BodyBalance& b) {
  const MeasuredChannel* z = find(run, position);
  const MeasuredChannel* a = find(run, acceleration);
  if (z == nullptr || a == nullptr) return;
  const Values second = calc_local_polynomial(run.times, z->values, {half_width, 3}).second_rate;
  const Values smoothed = filter(run, a->values, half_width);
  KinematicResidual k;
  k.channel = run.setup.info().channels[static_cast<std::size_t>(acceleration)].name;
  k.spread = calc_spread(smoothed);
  double products = 0.0, squares = 0.0;
  Values left(second.size());
  for (std::size_t i = 0; i < second.size(); ++i) {
    left[i] = smoothed[i] - second[i];
    if (!std::isfinite(left[i])) continue;
    products += smoothed[i] * second[i];
    squares += second[i] * second[i];
  }
  k.rms = calc_rms(left);
  k.gain = squares > 0.0 ? products / squares : 1.0;
  b.kinematics.push_back(k);
}

/// Whether forces act on the sprung mass that depend on more than the strut's motion.
bool has_other_forces(const RigSpec& rig) {
  return rig.guide_friction != 0.0 || rig.deflection_feedback != 0.0 ||
         rig.sprung_velocity_feedback != 0.0 || rig.tire_deflection_feedback != 0.0 ||
         rig.unsprung_velocity_feedback != 0.0;
}

}  // namespace

std::optional<BodyBalance> calc_body_balance(const MeasuredRun& run) {
  const ModelInfo& model = run.setup.info();
  if (model.masses.size() != 2 || has_other_forces(run.setup.rig().rig)) return std::nullopt;
  const MassInfo &below = model.masses[kUnsprung], &above = model.masses[kSprung];
  const MeasuredChannel* sprung = find(run, above.position);
  const MeasuredChannel* unsprung = find(run, below.position);
  if (sprung == nullptr || unsprung == nullptr) return std::nullopt;
  BodyBalance b;
  b.half_width = calc_half_width(run);
  Values deflection(run.times.size());
  for (std::size_t i = 0; i < deflection.size(); ++i) {
    deflection[i] = unsprung->values[i] - sprung->values[i];
  }
  b.deflection = filter(run, deflection, b.half_width);
  b.velocity = filter(run, calc_rate(run, deflection), b.half_width);
  b.force = calc_local_polynomial(run.times, sprung->values, {b.half_width, 3}).second_rate;
  const RigCase& rig = run.setup.rig();
  for (double& f : b.force) f *= rig.rig.sprung_mass;
  for (const InputSignal& input : rig.inputs) {
    if (input.channel != "actuator_force") continue;
    Values actuator(run.times.size());
    for (std::size_t i = 0; i < actuator.size(); ++i) {
      actuator[i] = calc_signal(input, run.times[i]).value;
    }
    const Values smoothed = filter(run, actuator, b.half_width);
    for (std::size_t i = 0; i < actuator.size(); ++i) b.force[i] -= smoothed[i];
  }
  const Values strut = calc_strut_force(run, deflection);
  if (strut.empty()) return std::nullopt;
  const Values modeled = filter(run, strut, b.half_width);
  b.residual.resize(modeled.size());
  for (std::size_t i = 0; i < modeled.size(); ++i) b.residual[i] = b.force[i] - modeled[i];
  b.rms = calc_rms(b.residual);
  const double spread = calc_spread(b.force);
  b.nrmse = spread > 0.0 ? b.rms / spread : 0.0;
  const double interval = run.times.back() / static_cast<double>(run.times.size() - 1);
  b.noise_rms = rig.rig.sprung_mass * sprung->sigma * calc_second_rate_gain(b.half_width, interval);
  b.states = {calc_state_residual("suspension_deflection", "m", b.deflection, b.residual),
              calc_state_residual("suspension_velocity", "m/s", b.velocity, b.residual)};
  fit_strut(b);
  add_kinematics(run, above.position, find_channel(model, "sprung_acceleration"), b.half_width, b);
  add_kinematics(run, below.position, find_channel(model, "unsprung_acceleration"), b.half_width,
                 b);
  return b;
}

}  // namespace strut
