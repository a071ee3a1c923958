// Effects of masses, tires and road.
#include "model/effects/tables.h"

namespace strut {
namespace {

EffectInfo make_payload() {
  return {EffectName::kPayload,
          "load that the file does not include, a point mass on the body",
          "m_body + m_p at x_p, z_p from the whole car's centroid",
          "rigid load; the car sinks on its springs",
          kOnBody,
          {make_switch("mass", "kg", "m_p: the load", -500.0, 2000.0, 50.0, kHasSprungMass),
           make_shape("x", "m", "x_p: ahead of the centroid", 0.0, -5.0, 5.0, 1.0, kHasCar),
           make_shape("z", "m", "z_p: above the centroid", 0.0, -2.0, 3.0, 0.5, kHasCar)}};
}

EffectInfo make_center_of_mass_shift() {
  return {EffectName::kCenterOfMassShift,
          "the whole car's center of mass is not where the file states",
          "r_body + (m / m_body) (x, 0, z)",
          "masses and inertia are unchanged; 1 to 10 cm between model and car",
          kOnBody,
          {make_switch("x", "m", "shift forward", -1.0, 1.0, 0.05, kHasCar),
           make_switch("z", "m", "shift upward", -0.5, 0.5, 0.05, kHasCar)}};
}

EffectInfo make_pitch_inertia() {
  return {EffectName::kPitchInertia,
          "the whole car's pitch inertia is not what the file states",
          "I_yy (1 + e)",
          "4 to 15 % by estimates from size and mass",
          kOnBody,
          {make_switch("gain", "1", "e: relative error", -0.3, 1.0, 0.1, kHasCar)}};
}

EffectInfo make_unsprung_mass() {
  return {
      EffectName::kUnsprungMass,
      "each wheel of the axle weighs more than the file states, the body as much less",
      "m_wheel + m_e; quarter_car: m_unsprung + m_e",
      "point mass at the wheel center; 5 to 25 % of the unsprung mass",
      kOnAxle,
      {make_switch("mass", "kg", "m_e: additional mass of a wheel", -30.0, 300.0, 5.0, kHasTire)}};
}

EffectInfo make_tire_stiffness() {
  return {EffectName::kTireStiffness,
          "inflation pressure: the tires' vertical stiffness is not what the file states",
          "k_t (1 + e)",
          "nearly proportional to pressure; 5 to 20 %",
          kOnAxle,
          {make_switch("gain", "1", "e: relative error", -0.7, 3.0, 0.1, kHasTire)}};
}

EffectInfo make_tire_progressive() {
  return {
      EffectName::kTireProgressive,
      "the tire's vertical stiffness grows with its deflection",
      "F = k_t (x + q x abs(x)), rate k_t (1 + 2 q abs(x))",
      "quadratic term of PAC2002's load (QFZ2); +10 to +30 % stiffness at bump loads",
      kOnAxle,
      {make_switch("progression", "1/m", "q: growth of the stiffness", 0.0, 200.0, 4.0, kHasTire)}};
}

EffectInfo make_tire_damping() {
  return {EffectName::kTireDamping,
          "the tires damp more than the file states",
          "c_t + c_e",
          "50 to 2000 N s/m in the literature",
          kOnAxle,
          {make_switch("rate", "N s/m", "c_e: additional damping of a tire", -5000.0, 50000.0,
                       200.0, kHasTire)}};
}

EffectInfo make_tire_enveloping() {
  return {
      EffectName::kTireEnveloping,
      "the contact patch that smooths short obstacles is longer than the file states",
      "footprint + l",
      "averaging over the patch, docs/design/0003-road-contact.md; patches of 0.08 to 0.15 m",
      kOnRoad,
      {make_switch("length", "m", "l: additional length averaged over", -0.5, 0.8, 0.04, kHasCar)}};
}

EffectInfo make_wheel_runout() {
  return {EffectName::kWheelRunout,
          "the wheels of the axle are out of round",
          "x + a cos(theta + phi), theta: angle of the wheel since the start",
          "first harmonic of radial run-out; 0.3 to 0.5 mm for 80 N of radial force variation",
          kOnAxle | kOnCorner,
          {make_switch("amplitude", "m", "a: amplitude of the radius", 0.0, 0.02, 4e-4, kHasCar),
           make_shape("phase", "rad", "phi: phase at the start", 0.0, -6.4, 6.4, 1.0, kHasCar)}};
}

EffectInfo make_bump_height() {
  return {EffectName::kBumpHeight,
          "the bump is higher than surveyed",
          "h (1 + e)",
          "2 to 8 % as built",
          kOnRoad,
          {make_switch("gain", "1", "e: relative error", -0.9, 3.0, 0.05, kHasCar)}};
}

EffectInfo make_bump_length() {
  return {EffectName::kBumpLength,
          "the bump is longer than surveyed",
          "L (1 + e), flanks as well",
          "2 to 8 % as built",
          kOnRoad,
          {make_switch("gain", "1", "e: relative error", -0.9, 3.0, 0.05, kHasCar)}};
}

EffectInfo make_speed_error() {
  return {EffectName::kSpeedError,
          "the car drives faster than the speedometer indicates",
          "v (1 + e)",
          "wheel speed and effective radius; 0.2 to 2 %",
          kOnRoad,
          {make_switch("gain", "1", "e: relative error", -0.5, 1.0, 0.01, kHasCar)}};
}

EffectInfo make_road_gain() {
  return {
      EffectName::kRoadGain,
      "the road moves the rig more than recorded",
      "z_road (1 + e)",
      "gain of the stand's displacement sensor; for e < 0 a spring and a damper from the lowest "
      "mass to ground, of -e times the rates below it, give the same motion",
      kOnRoad,
      {make_switch("gain", "1", "e: relative error", -0.9, 3.0, 0.02, kHasGroundInput)}};
}

EffectInfo make_aerodynamic_lift() {
  return {
      EffectName::kAerodynamicLift,
      "air lifts the axle, along the body's vertical through the axle's wheel centers",
      "F = rho / 2 A_l v^2, rho = 1.2 kg/m^3",
      "A_l: lift coefficient times frontal area, -0.1 to 0.3 m^2 an axle; Hucho, Aerodynamics of "
      "Road Vehicles",
      kOnAxle,
      {make_switch("area", "m^2", "A_l: lift area of the axle", -5.0, 5.0, 0.1, kHasCar)}};
}

}  // namespace

std::vector<EffectInfo> make_body_effects() {
  return {make_payload(),       make_center_of_mass_shift(), make_pitch_inertia(),
          make_unsprung_mass(), make_tire_stiffness(),       make_tire_progressive(),
          make_tire_damping(),  make_tire_enveloping(),      make_wheel_runout(),
          make_bump_height(),   make_bump_length(),          make_speed_error(),
          make_road_gain(),     make_aerodynamic_lift()};
}

}  // namespace strut
