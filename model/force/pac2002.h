// In-plane tire forces by the Magic Formula, version PAC2002.
//
// Sources: [P06] H. B. Pacejka, Tyre and Vehicle Dynamics, 2nd ed., Butterworth-Heinemann 2006,
// section 4.3.2, equations (4.E1) to (4.E78); [ADAMS] Adams/Tire help, "Using the PAC2002 tire
// model", whose coefficient names and scale factors are used here; [MF52] MF-Tyre 5.2 equation
// manual for the relaxation lengths. Where they differ, the comment at the equation cites the one
// that is followed. Not modeled: turn slip, inflation pressure, the gyroscopic couple of the belt.
//
// Axes: ISO W (TYDEX): x forward in the wheel plane along the road, y left, z up the road normal.
// Slip: kappa = (omega R_e - V_x)/|V_x|, positive driving; alpha = atan(V_y/|V_x|), V the velocity
// of the contact point, so that a free tire (PKY1 < 0) moving to the left is pushed to the right;
// camber positive when the top leans to the right (right-hand rotation about x).
#pragma once

#include "base/math/bounded_trig.h"
#include "base/math/lanes.h"
#include "base/math/pair.h"
#include "model/force/pac2002_coefficients.h"

namespace strut {

/// State of the contact, in the wheel's W axes.
template <class T>
struct TireSlip {
  T load;    // N, >= 0
  T kappa;   // 1, longitudinal slip
  T alpha;   // rad, slip angle
  T camber;  // rad
  T speed;   // m/s, forward speed of the contact point
};

/// Force and moment of the road on the tire at the contact point, in W axes.
template <class T>
struct TireForce {
  T fx, fy;          // N
  T mx, my, mz;      // N m
  T slip_stiffness;  // N, dFx/dkappa of pure slip at Fx = S_Vx, K_x >= 0
};

template <class T>
struct RelaxationLength {
  T longitudinal, lateral;  // m
};

/// Parts of the model that are skipped when no tire of a batch has coefficients for them. A part
/// whose coefficients are zero contributes zero, so skipping it changes no result.
struct Pac2002Parts {
  bool combined = true;      // RBX1, RBY1, RVY1 to RVY3
  bool aligning = true;      // QDZ*, SSZ*
  bool overturning = true;   // QSX*
  bool small_shift = false;  // RHX1, RHY*: power series hold for the denominators of the weights
};

/// Whether the shifts of the combined weights are so small that their power series are exact to
/// rounding (see `atan_small`, `cos_small`): |B S_H| <= 0.1, |E| <= 50 and |C| <= 2 at every load.
inline bool has_small_shift(const Pac2002<double>& p) {
  const double max_dfz = max(1.0, p.FZMAX / (p.LFZO * p.FNOMIN) - 1.0);
  const auto bound = [&](double constant, double slope) {
    return abs(constant) + abs(slope) * (slope == 0.0 ? 0.0 : max_dfz);
  };
  return abs(p.RBX1 * p.LXAL * p.RHX1) <= 0.1 &&
         abs(p.RBY1 * p.LYKA) * bound(p.RHY1, p.RHY2) <= 0.1 && bound(p.REX1, p.REX2) <= 50.0 &&
         bound(p.REY1, p.REY2) <= 50.0 && abs(p.RCX1) <= 2.0 && abs(p.RCY1) <= 2.0;
}

/// The parts that `tire` needs.
inline Pac2002Parts find_parts(const Pac2002<double>& tire) {
  const auto& p = tire;
  const auto used = [](auto... x) { return ((x != 0.0) || ...); };
  return {.combined = used(p.RBX1, p.RBY1, p.RVY1, p.RVY2, p.RVY3),
          .aligning =
              used(p.QDZ1, p.QDZ2, p.QDZ6, p.QDZ7, p.QDZ8, p.QDZ9, p.SSZ1, p.SSZ2, p.SSZ3, p.SSZ4),
          .overturning = used(p.QSX1, p.QSX2, p.QSX3),
          .small_shift = has_small_shift(p)};
}

/// The parts that a batch of two tires needs.
inline Pac2002Parts operator|(const Pac2002Parts& a, const Pac2002Parts& b) {
  return {a.combined || b.combined, a.aligning || b.aligning, a.overturning || b.overturning,
          a.small_shift && b.small_shift};
}

namespace pac2002 {

/// Load at which the coefficients are evaluated. Outside [FZMIN, FZMAX] the force per load keeps
/// its value at the limit: the polynomials in load are fits, which make friction negative far
/// outside.
template <class T>
struct LoadPoint {
  T ratio;       // load / (LFZO FNOMIN), limited
  T increment;   // df_z = ratio - 1 (4.E2)
  T per_newton;  // 1 / (LFZO FNOMIN)
};

/// One direction of pure slip, F0 / Fz = mu sin(angle) + S_V / Fz. All forces are per newton of
/// load: nothing is 0/0 at zero load.
template <class T>
struct PureSlip {
  T friction;          // mu
  T stiffness;         // K / Fz
  T slope;             // B C = K / (mu Fz)
  T horizontal_shift;  // S_H
  T vertical_shift;    // S_V / Fz
};

template <class C, class T>
LoadPoint<T> calc_load_point(const Pac2002<C>& p, const T& load) {
  const T per_newton = C(1.0) / (p.LFZO * p.FNOMIN);
  const T ratio = min(max(load, p.FZMIN), p.FZMAX) * per_newton;
  return {ratio, ratio - 1.0, per_newton};
}

template <class T>
T sign(const T& x) {
  return select(x < T(0.0), T(-1.0), T(1.0));
}

/// E limited to 1, beyond which the curve turns back [P06].
template <class T>
T limit_curvature(const T& curvature) {
  return min(curvature, T(1.0));
}

/// The argument of a sine or cosine of the Magic Formula: C arctan(u - E (u - arctan u)), u = B s.
/// Two of them joined (`join_pair`) are evaluated in step, which hides the latency of the
/// arctangents.
template <class T>
struct MagicAngle {
  T slope;      // B
  T shape;      // C
  T curvature;  // E, limited
  T slip;       // s

  [[gnu::always_inline]] T calc() const {
    const T u = slope * slip;
    return shape * atan_any(u - curvature * (u - atan_any(u)));
  }
  /// The same for |B s| <= 0.1 and |E| <= 50.
  [[gnu::always_inline]] T calc_small() const {
    const T u = slope * slip;
    return shape * atan_small(u - curvature * (u - atan_small(u)));
  }
};

/// F_x0 of (4.E9) to (4.E18), its sine's argument in `angle`.
template <class C, class T>
PureSlip<T> calc_pure_longitudinal(const Pac2002<C>& p, const T& dfz, const T& kappa,
                                   const T& camber, MagicAngle<T>& angle) {
  PureSlip<T> x;
  const T gamma = camber * p.LGAX;
  x.horizontal_shift = (p.PHX1 + p.PHX2 * dfz) * p.LHX;
  x.vertical_shift = (p.PVX1 + p.PVX2 * dfz) * (p.LVX * p.LMUX);
  x.friction = (p.PDX1 + p.PDX2 * dfz) * (1.0 - p.PDX3 * gamma * gamma) * p.LMUX;
  x.stiffness = (p.PKX1 + p.PKX2 * dfz) * exp(p.PKX3 * dfz) * p.LKX;
  const T slip = kappa + x.horizontal_shift;
  const T curvature =
      (p.PEX1 + dfz * (p.PEX2 + dfz * p.PEX3)) * (1.0 - p.PEX4 * sign(slip)) * p.LEX;
  const T shape = p.PCX1 * p.LCX;
  const T slope = x.stiffness / (shape * x.friction);
  x.slope = slope * shape;
  angle = {slope, shape, limit_curvature(curvature), slip};
  return x;
}

/// F_y0 of (4.E19) to (4.E30), its sine's argument in `angle`; sin(2 arctan x) = 2 x/(1 + x^2) in
/// the cornering stiffness.
template <class C, class T>
PureSlip<T> calc_pure_lateral(const Pac2002<C>& p, const LoadPoint<T>& at, const T& alpha,
                              const T& camber, MagicAngle<T>& angle) {
  PureSlip<T> y;
  const T& dfz = at.increment;
  const T gamma = camber * p.LGAY;
  y.horizontal_shift = (p.PHY1 + p.PHY2 * dfz) * p.LHY + p.PHY3 * gamma;
  y.vertical_shift = ((p.PVY1 + p.PVY2 * dfz) * p.LVY + (p.PVY3 + p.PVY4 * dfz) * gamma) * p.LMUY;
  y.friction = (p.PDY1 + p.PDY2 * dfz) * (1.0 - p.PDY3 * gamma * gamma) * p.LMUY;
  y.stiffness = 2.0 * p.PKY1 * p.PKY2 / (p.PKY2 * p.PKY2 + at.ratio * at.ratio) *
                (1.0 - p.PKY3 * abs(gamma)) * p.LKY;
  const T slip = alpha + y.horizontal_shift;
  const T curvature =
      (p.PEY1 + p.PEY2 * dfz) * (1.0 - (p.PEY3 + p.PEY4 * gamma) * sign(slip)) * p.LEY;
  const T shape = p.PCY1 * p.LCY;
  const T slope = y.stiffness / (shape * y.friction);
  y.slope = slope * shape;
  angle = {slope, shape, limit_curvature(curvature), slip};
  return y;
}

/// Weight G of combined slip (4.E50), (4.E58): cos(angle at the slip)/cos(angle at the shift).
template <class T>
struct Weight {
  MagicAngle<T> moved;  // at slip + shift
  T shift;

  T calc(bool small_shift) const {
    MagicAngle<T> still = moved;
    still.slip = shift;
    const T cosine = small_shift ? cos_small(still.calc_small()) : cos_bounded(still.calc());
    return cos_bounded(moved.calc()) / cosine;
  }
};

/// G_xalpha of (4.E50) to (4.E56); cos(arctan x) = 1/sqrt(1 + x^2).
template <class C, class T>
Weight<T> make_longitudinal_weight(const Pac2002<C>& p, const T& dfz, const T& kappa,
                                   const T& alpha) {
  const T slope = p.RBX1 * p.LXAL / sqrt(1.0 + square(p.RBX2 * kappa));
  const T curvature = limit_curvature<T>(p.REX1 + p.REX2 * dfz);
  return {{slope, p.RCX1, curvature, alpha + p.RHX1}, p.RHX1};
}

/// G_ykappa of (4.E58) to (4.E65).
template <class C, class T>
Weight<T> make_lateral_weight(const Pac2002<C>& p, const T& dfz, const T& kappa, const T& alpha) {
  const T slope = p.RBY1 * p.LYKA / sqrt(1.0 + square(p.RBY2 * (alpha - p.RBY3)));
  const T shift = p.RHY1 + p.RHY2 * dfz;
  const T curvature = limit_curvature<T>(p.REY1 + p.REY2 * dfz);
  return {{slope, p.RCY1, curvature, kappa + shift}, shift};
}

/// S_Vykappa / Fz of (4.E66), (4.E67): side force induced by longitudinal slip (plysteer).
template <class C, class T>
T calc_induced_side_force(const Pac2002<C>& p, const T& dfz, const T& friction,
                          const TireSlip<T>& s) {
  const T peak =
      friction * (p.RVY1 + p.RVY2 * dfz + p.RVY3 * s.camber) / sqrt(1.0 + square(p.RVY4 * s.alpha));
  return peak * sin_bounded(p.RVY5 * atan_any(p.RVY6 * s.kappa)) * p.LVYKA;
}

/// F_x / Fz and F_y / Fz of combined slip, with the intermediate results for the moments.
template <class T>
struct CombinedSlip {
  T fx, fy;        // 1
  T induced_side;  // S_Vykappa / Fz
  PureSlip<T> x, y;
};

template <class C, class T>
CombinedSlip<T> calc_combined_slip(const Pac2002<C>& p, const LoadPoint<T>& at,
                                   const TireSlip<T>& s, const Pac2002Parts& parts) {
  CombinedSlip<T> c;
  MagicAngle<T> x, y;
  c.x = calc_pure_longitudinal(p, at.increment, s.kappa, s.camber, x);
  c.y = calc_pure_lateral(p, at, s.alpha, s.camber, y);
  const Pair<T> sine = sin_bounded(join_pair(x, y).calc());
  c.fx = c.x.friction * sine.a + c.x.vertical_shift;
  c.fy = c.y.friction * sine.b + c.y.vertical_shift;
  c.induced_side = T(0.0);
  if (!parts.combined) return c;
  const Pair<T> weight = join_pair(make_longitudinal_weight(p, at.increment, s.kappa, s.alpha),
                                   make_lateral_weight(p, at.increment, s.kappa, s.alpha))
                             .calc(parts.small_shift);
  c.induced_side = calc_induced_side_force(p, at.increment, c.y.friction, s);
  c.fx = c.fx * weight.a;
  c.fy = c.fy * weight.b + c.induced_side;
  return c;
}

/// Equivalent slip angle arctan(sqrt(tan^2 alpha + (K_x kappa / K_y)^2)) sgn(alpha) [ADAMS];
/// (4.E77) has the same without the tangents.
template <class T>
T calc_equivalent_slip(const T& alpha, const T& ratio_squared) {
  const T s = sin_bounded(alpha), c = cos_bounded(alpha);
  return sign(alpha) * atan_quadrant(sqrt(s * s + ratio_squared * c * c), abs(c));
}

/// Pneumatic trail t / R0, (4.E33) to (4.E35), (4.E40) to (4.E44), without cos alpha.
/// `slip`: equivalent slip angle; `stiffness`: LKY/LMUY.
template <class C, class T>
T calc_trail(const Pac2002<C>& p, const LoadPoint<T>& at, const T& gamma, const T& slip,
             const C& stiffness) {
  const T& dfz = at.increment;
  const T slope = (p.QBZ1 + dfz * (p.QBZ2 + dfz * p.QBZ3)) *
                  (1.0 + p.QBZ4 * gamma + p.QBZ5 * abs(gamma)) * stiffness;
  const T peak =
      (p.QDZ1 + p.QDZ2 * dfz) * (1.0 + gamma * (p.QDZ3 + gamma * p.QDZ4)) * p.LTR * at.per_newton;
  constexpr double kTwoOverPi = 0.63661977236758134308;
  const T curvature =
      (p.QEZ1 + dfz * (p.QEZ2 + dfz * p.QEZ3)) *
      (1.0 + (p.QEZ4 + p.QEZ5 * gamma) * (kTwoOverPi * atan_any(slope * p.QCZ1 * slip)));
  const MagicAngle<T> angle{slope, p.QCZ1, limit_curvature(curvature), slip};
  return peak * cos_bounded(angle.calc());
}

/// Residual torque M_zr / (Fz R0), (4.E36) to (4.E38), (4.E45) to (4.E47), without cos alpha.
/// `slip`: equivalent slip angle; `stiffness`: LKY/LMUY.
template <class C, class T>
T calc_residual_torque(const Pac2002<C>& p, const LoadPoint<T>& at, const PureSlip<T>& y,
                       const T& gamma, const T& slip, const C& stiffness) {
  const T& dfz = at.increment;
  const T slope = p.QBZ9 * stiffness + p.QBZ10 * y.slope;
  const T peak = ((p.QDZ6 + p.QDZ7 * dfz) * p.LRES + (p.QDZ8 + p.QDZ9 * dfz) * gamma) * p.LMUY;
  return peak / sqrt(1.0 + square(slope * slip));
}

/// M_z = -t (F_y - S_Vykappa) + M_zr + s F_x of (4.E71) to (4.E78) [N m].
template <class C, class T>
T calc_aligning_torque(const Pac2002<C>& p, const LoadPoint<T>& at, const TireSlip<T>& s,
                       const CombinedSlip<T>& c) {
  const T& dfz = at.increment;
  const T gamma = s.camber * p.LGAZ;
  const C stiffness = p.LKY / p.LMUY;
  const T compliance = 1.0 / c.y.stiffness;
  const T trail_shift = p.QHZ1 + p.QHZ2 * dfz + (p.QHZ3 + p.QHZ4 * dfz) * gamma;
  const T residual_shift = c.y.horizontal_shift + c.y.vertical_shift * compliance;
  const T ratio_squared = square(c.x.stiffness * compliance * s.kappa);
  const Pair<T> slip = calc_equivalent_slip(
      Pair<T>(s.alpha + trail_shift, s.alpha + residual_shift), Pair<T>(ratio_squared));
  const T trail = s.load * calc_trail(p, at, gamma, slip.a, stiffness);
  const T residual = calc_residual_torque(p, at, c.y, gamma, slip.b, stiffness);
  const T arm =
      (p.SSZ1 + p.SSZ2 * (s.load * at.per_newton) * c.fy + (p.SSZ3 + p.SSZ4 * dfz) * s.camber) *
      p.LS;
  return s.load * p.UNLOADED_RADIUS *
         ((residual - trail * (c.fy - c.induced_side)) * cos_bounded(s.alpha) + arm * c.fx);
}

/// M_x of (4.E69) [N m].
template <class C, class T>
T calc_overturning_couple(const Pac2002<C>& p, const LoadPoint<T>& at, const TireSlip<T>& s,
                          const T& fy) {
  return s.load * p.UNLOADED_RADIUS * p.LMX *
         (p.QSX1 * p.LVMX - p.QSX2 * s.camber + p.QSX3 * p.LFZO * at.per_newton * fy);
}

/// Rolling resistance M_y [ADAMS] [N m], negative (against the wheel's spin) when rolling forward;
/// it fades below 0.1 m/s, where its direction would jump.
template <class C, class T>
T calc_rolling_resistance(const Pac2002<C>& p, const LoadPoint<T>& at, const TireSlip<T>& s,
                          const T& fx) {
  constexpr double kFullSpeed = 0.1;  // m/s
  const T direction = max(min(s.speed * (1.0 / kFullSpeed), T(1.0)), T(-1.0));
  const C inverse_speed = C(1.0) / p.LONGVL;
  const T speed = abs(s.speed) * inverse_speed;
  const T coefficient = p.QSY1 + p.QSY2 * p.LFZO * at.per_newton * fx +
                        speed * (p.QSY3 + p.QSY4 * speed * speed * speed);
  return -direction * s.load * p.UNLOADED_RADIUS * p.LMY * coefficient;
}

}  // namespace pac2002

/// Force and moment of the road on a tire. Zero load gives exactly zero. No `if` depends on the
/// state; `parts` is common to a batch.
///
/// The attribute `flatten` inlines all calls, so that independent chains of operations overlap.
///
/// @param side +1 left tire, the side of the coefficients; -1 right tire, its mirror image: camber
///   and alpha are given in the same W axes on both sides, f(alpha, camber) becomes f(-alpha,
///   -camber) with the signs of fy, mx and mz changed.
template <class C, class T>
[[gnu::flatten]] TireForce<T> calc_tire_force(const Pac2002<C>& p, const TireSlip<T>& slip,
                                              const T& side, const Pac2002Parts& parts = {}) {
  const TireSlip<T> s{slip.load, slip.kappa, side * slip.alpha, side * slip.camber, slip.speed};
  const pac2002::LoadPoint<T> at = pac2002::calc_load_point(p, s.load);
  const pac2002::CombinedSlip<T> c = pac2002::calc_combined_slip(p, at, s, parts);
  TireForce<T> f;
  f.fx = s.load * c.fx;
  const T fy = s.load * c.fy;
  f.fy = side * fy;
  f.mx = f.mz = T(0.0);
  if (parts.overturning) f.mx = side * pac2002::calc_overturning_couple(p, at, s, fy);
  f.my = pac2002::calc_rolling_resistance(p, at, s, f.fx);
  if (parts.aligning) f.mz = side * pac2002::calc_aligning_torque(p, at, s, c);
  f.slip_stiffness = s.load * c.x.stiffness;
  return f;
}

/// Relaxation lengths, first-order lag of the slips behind the wheel's motion:
///   sigma_kappa = Fz (PTX1 + PTX2 dfz) exp(-PTX3 dfz) R0/Fz0 LSGKP                        [MF52]
///   sigma_alpha = PTY1 sin(2 arctan(Fz/(PTY2 LFZO Fz0))) (1 - PKY3 |camber|) R0 LFZO LSGAL [MF52]
/// Both are zero at zero load. The sign of PTX3 follows [MF52], where a carcass of constant
/// stiffness means PTX3 = -PKX3.
template <class C, class T>
RelaxationLength<T> calc_relaxation_length(const Pac2002<C>& p, const T& load, const T& camber) {
  const pac2002::LoadPoint<T> at = pac2002::calc_load_point(p, load);
  const T x = load / (p.PTY2 * p.LFZO * p.FNOMIN);
  const T gamma = camber * p.LGAY;
  RelaxationLength<T> sigma;
  sigma.longitudinal = load / p.FNOMIN * (p.PTX1 + p.PTX2 * at.increment) *
                       exp(-p.PTX3 * at.increment) * p.UNLOADED_RADIUS * p.LSGKP;
  sigma.lateral = p.PTY1 * (2.0 * x / (1.0 + x * x)) * (1.0 - p.PKY3 * abs(gamma)) *
                  p.UNLOADED_RADIUS * p.LFZO * p.LSGAL;
  return sigma;
}

/// Effective rolling radius R_e = R0 - rho0 (DREFF arctan(BREFF rho/rho0) + FREFF rho/rho0) with
/// rho0 = Fz0/C_z [ADAMS]; R0 - rho/3 for a tire without these coefficients.
///
/// @param deflection rho [m]; a tire off the road (rho < 0) has R_e = R0.
/// @param vertical_stiffness C_z [N/m], > 0.
template <class C, class Tire, class T>
T calc_rolling_radius(const Pac2002<C>& p, const Tire& unloaded_radius, const T& deflection,
                      const Tire& vertical_stiffness) {
  const Tire rho0 = p.FNOMIN / vertical_stiffness, inverse = vertical_stiffness / p.FNOMIN;
  const T rho = max(deflection, T(0.0));
  const T x = rho * inverse;
  const T fitted = rho0 * (p.DREFF * atan_any(p.BREFF * x) + p.FREFF * x);
  const T given = abs(p.BREFF) + abs(p.DREFF) + abs(p.FREFF);
  return unloaded_radius - select(given > T(0.0), fitted, rho * (1.0 / 3.0));
}

}  // namespace strut
