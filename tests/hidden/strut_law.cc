#include "tests/hidden/strut_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace strut::hidden {
namespace {

enum State : int { kBristle, kMount, kIdle, kLag, kSlow };

/// LuGre: C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, IEEE Trans. Automatic Control
/// 40 (1995) 419, with breakaway 1.3 times the sliding force.
double calc_lugre(const StrutLaw& law, double sliding, double speed, double z, double& z_rate) {
  const double stribeck = 0.05 * law.scale.speed;
  const double level = sliding * (1.0 + 0.3 * std::exp(-std::pow(speed / stribeck, 2)));
  const double bristle = sliding / law.scale.breakaway;
  z_rate = speed - bristle * std::fabs(speed) / level * z;
  const double micro = 0.05 * bristle * law.scale.breakaway / law.scale.speed;
  return bristle * z + micro * z_rate;
}

/// Share of the damper that is engaged with `left` of the leak's stroke to go: it grips over the
/// last tenth.
double calc_engagement(double leak, double left) {
  return std::clamp(1.0 - left / (0.1 * leak), 0.0, 1.0);
}

/// Rate of the mount, or of a bare joint's metal on metal [N/m].
double get_mount_rate(const StrutLaw& law) {
  constexpr double kMetal = 10.0;
  return law.faults.mount > 0.0 ? law.scale.mount_rate / law.faults.mount
                                : kMetal * law.scale.mount_rate;
}

/// Speed of the damper behind the mount: damper(w) + m w = k x + k3 x^3 + m v, by Newton; x beyond
/// the joint's gap, in which the damper stands.
double solve_mount(const StrutLaw& law, double rate, double place, double speed, double& force) {
  const double gap = 0.5 * law.faults.play;
  const double x = std::copysign(std::max(std::fabs(place) - gap, 0.0), place);
  const double cubic = rate / std::pow(0.02 * law.scale.travel, 2);
  const double touch = gap > 0.0 ? std::min(std::fabs(x) / (0.1 * gap), 1.0) : 1.0;
  const double viscous = 0.05 * law.damping * touch;
  const double spring = rate * x + cubic * x * x * x;
  double w = speed;
  for (int i = 0; i < 30; ++i) {
    const double miss = calc_damper_force(law, w) - spring - viscous * (speed - w);
    const double h = 1e-6 * law.scale.speed;
    const double slope =
        (calc_damper_force(law, w + h) - calc_damper_force(law, w - h)) / (2.0 * h) + viscous;
    const double change = miss / slope;
    w -= change;
    if (std::fabs(change) < 1e-13 * law.scale.speed) break;
  }
  force = spring + viscous * (speed - w);
  return w;
}

double calc_fast_damper(const StrutLaw& law, double speed, const double* states, double* rates) {
  const StrutFaults& f = law.faults;
  double seen = speed, force = 0.0;
  rates[kMount] = 0.0;
  if (f.mount > 0.0 || f.play > 0.0) {
    seen = solve_mount(law, get_mount_rate(law), states[kMount], speed, force);
    rates[kMount] = speed - seen;
  } else {
    force = calc_damper_force(law, speed);
  }
  rates[kIdle] = 0.0;
  if (f.leak > 0.0) {
    // The stroke is used up at the speed of the damper and stands still at its ends.
    const double left = seen > 0.0 ? f.leak - states[kIdle] : states[kIdle];
    rates[kIdle] = left > 0.0 ? seen : 0.0;
    force *= calc_engagement(f.leak, left);
  }
  return force;
}

}  // namespace

double calc_damper_force(const StrutLaw& law, double speed) {
  const StrutFaults& f = law.faults;
  double slope = law.damping;
  if (f.asymmetry != 0.0) {
    // The valves hand over within a hundredth of the usual speed.
    const double side = std::clamp(speed / (0.01 * law.scale.speed), -1.0, 1.0);
    slope *= 1.0 - f.asymmetry * side;
  }
  const double fast = std::max(std::fabs(speed) - law.scale.knee, 0.0);
  return slope * (speed - std::copysign(f.knee_loss * fast, speed));
}

double calc_stop_force(const StrutLaw& law, double travel, double speed) {
  // Rates of a jounce bumper's table, over travel and force of the strut.
  static constexpr std::array<double, 6> kAt{0.0, 0.03, 0.17, 0.33, 0.5, 0.83};
  static constexpr std::array<double, 6> kForce{0.0, 0.1, 0.5, 1.25, 2.25, 6.25};
  const double x = (travel - law.scale.stop_gap) / law.scale.travel;
  if (x <= 0.0) return 0.0;
  std::size_t i = 0;
  while (i + 2 < kAt.size() && x > kAt[i + 1]) ++i;
  const double slope = (kForce[i + 1] - kForce[i]) / (kAt[i + 1] - kAt[i]);
  const double table = law.scale.force * (kForce[i] + slope * (x - kAt[i]));
  const double turn = speed / (std::fabs(speed) + 0.1 * law.scale.speed);
  return law.faults.stop * table * (1.0 + 0.25 * turn);
}

double calc_gas_force(const StrutLaw& law, double travel) {
  constexpr double kExponent = 1.35;
  const double column = 4.0 * law.scale.travel;
  const double left = std::max(1.0 - travel / column, 0.2);
  return law.faults.gas * law.scale.force * (std::pow(left, -kExponent) - 1.0);
}

double calc_strut_force(const StrutLaw& law, double travel, double speed, const double* states,
                        double* rates) {
  const StrutFaults& f = law.faults;
  double damper = calc_fast_damper(law, speed, states, rates);
  rates[kLag] = 0.0;
  if (f.gas_lag > 0.0) {
    rates[kLag] = (damper - states[kLag]) / f.gas_lag;
    damper = states[kLag];
  }
  rates[kSlow] = law.scale.selective_rate * (speed - states[kSlow]);
  damper -= f.selective * law.damping * (speed - states[kSlow]);
  double force = law.stiffness * travel + damper;
  if (f.hardening != 0.0) {
    const double u = travel / law.scale.travel;
    force += f.hardening * law.stiffness * law.scale.travel * (std::sinh(u) - u);
  }
  if (f.stop != 0.0) force += calc_stop_force(law, travel, speed);
  if (f.gas != 0.0) force += calc_gas_force(law, travel);
  rates[kBristle] = 0.0;
  const double sliding =
      f.friction + f.side_friction * std::min(std::pow(travel / law.scale.travel, 2), 4.0);
  if (f.friction + f.side_friction > 0.0) {
    force += calc_lugre(law, std::max(sliding, 0.02 * (f.friction + f.side_friction)), speed,
                        states[kBristle], rates[kBristle]);
  }
  return force;
}

}  // namespace strut::hidden
