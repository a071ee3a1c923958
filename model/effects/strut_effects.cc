// Effects of springs, dampers and their mounts.
#include "model/effects/tables.h"

namespace strut {
namespace {

constexpr unsigned kOnStrut = kOnAxle | kOnCorner;

EffectInfo make_damper_asymmetry() {
  return {EffectName::kDamperAsymmetry,
          "the damper is stiffer in rebound than in compression",
          "F = c (1 - a sgn v) v",
          "Dixon, The Shock Absorber Handbook, 2nd ed.; 0.2 to 0.5 in passenger cars",
          kOnStrut,
          {make_switch("asymmetry", "1", "a: fraction moved from compression to rebound", -0.9, 0.9,
                       0.3)}};
}

EffectInfo make_damper_blow_off() {
  return {EffectName::kDamperBlowOff,
          "valves open: above a knee the damper is softer (digressive)",
          "F = c ((1 - r) + r / sqrt(1 + (v / v_b)^2)) v",
          "smooth form of two straight lines that meet at v_b; Dixon: v_b 0.05 to 0.2 m/s, "
          "r 0.3 to 0.7",
          kOnStrut,
          {make_switch("loss", "1", "r: fraction of the rate lost far above the knee; < 0: gained",
                       -10.0, 0.98, 0.3),
           make_shape("knee", "m/s", "v_b: speed of the knee", 0.1, 0.03, 2.0, 0.1)}};
}

EffectInfo make_damper_hysteresis() {
  return {EffectName::kDamperHysteresis,
          "the damper's force lags behind its speed: compressible oil, valve dynamics",
          "tau dF/dt + F = f(v), f: the damper's law with all other effects",
          "first-order lag; 1 ms (force), 40 ms (frequency selective) in Project Chrono's FEDA",
          kOnStrut,
          {make_switch("lag", "s", "tau: time constant of the lag", 0.0, 0.05, 2e-3)}};
}

EffectInfo make_damper_leak() {
  return {EffectName::kDamperLeak,
          "a damper short of oil loses stroke: after each reversal it gives no force until it has "
          "moved that far, while the strut's dry friction still acts; without such friction it is "
          "joint_play under another name; where both are on, stroke and play add up",
          "F = f(w), du/dt = v - w, w = r (u - clamp(u, -s / 2, s / 2)), "
          "r^2 = (1 / 1 ms)^2 + (0.5 m/s / s)^2",
          "dead zone in series with the damper, behind it a contact that yields within 1 ms "
          "(stiffness c r of a linear damper); 2 to 12 mm in leaking dampers",
          kOnStrut,
          {make_switch("stroke", "m", "s: lost stroke after each reversal", 0.0, 0.05, 5e-3)}};
}

EffectInfo make_damper_fade() {
  EffectInfo fade = {
      EffectName::kDamperFade,
      "the damper is softer than its rate: warm oil; with a measured temperature, by it",
      "F = c (1 - l) v; on a strut_rig F = c exp(-b (T - 293.15 K)) v",
      "Dixon, The Shock Absorber Handbook, 2nd ed.: 0.2 to 2 %/K",
      kOnStrut,
      {make_switch("loss", "1", "l: fraction of the rate lost; < 0: gained, cold oil", -2.0, 0.95,
                   0.1),
       make_switch("rate", "1/K", "b: relative loss of rate per kelvin", -0.1, 0.1, 5e-3)}};
  fade.parameters[0].without = kHasDamperTemperature;
  fade.parameters[1].needs = kHasDamperTemperature;
  return fade;
}

EffectInfo make_strut_friction() {
  return {
      EffectName::kStrutFriction,
      "dry friction of seals, guide and bushings",
      "F = F_c tanh(v / v_s), behind a joint_play F_c tanh(w / v_s); with a stroke b > 0 F = F_c "
      "z, "
      "z = (s - clamp(s, -p / 2, p / 2)) / b, ds/dt = v - z v / tanh(v / v_s), p the play of "
      "joint_play; explicit steps need h F_c / (v_s m) < 2.7 or h^2 F_c / (b m) < 8",
      "regularized Coulomb friction; 20 to 150 N an axle, mostly in the struts: Deubel and Prokop, "
      "2022; elastic flank: Dahl, 1968",
      kOnStrut,
      {make_switch("force", "N", "F_c: sliding friction", 0.0, 2e4, 50.0),
       make_shape("speed", "m/s", "v_s: speed over which it builds up", 0.01, 1e-3, 0.2, 0.01),
       make_shape("stroke", "m", "b: stroke over which it builds up, elastically; 0: at once", 0.0,
                  0.0, 0.02, 5e-4)}};
}

EffectInfo make_progressive_spring() {
  return {EffectName::kProgressiveSpring,
          "the spring's rate grows with its deflection from nominal trim, in both directions",
          "F = k (d + q d^3), rate k (1 + 3 q d^2)",
          "odd cubic law; +10 to +60 % rate at 50 mm are q = 13 to 80 1/m^2",
          kOnStrut,
          {make_switch("cubic", "1/m^2", "q: growth of the rate", -100.0, 5000.0, 40.0)}};
}

EffectInfo make_bump_stop() {
  return {EffectName::kBumpStop,
          "a jounce bumper comes in beyond a gap, along the spring's line",
          "F = k_b (s + p s^2), s = max(d - g, 0)",
          "70 N/mm and p = 50 1/m follow the table of ADAMS/Car's sedan to 20 % up to 50 mm",
          kOnStrut,
          {make_switch("stiffness", "N/m", "k_b: rate where it comes in", 0.0, 1e6, 5e4),
           make_shape("gap", "m", "g: free compression from nominal trim", 0.04, 0.0, 0.3, 0.04),
           make_shape("progression", "1/m", "p: growth of the rate", 50.0, 0.0, 500.0, 50.0)}};
}

EffectInfo make_top_mount_compliance() {
  return {EffectName::kTopMountCompliance,
          "rubber between damper and body, a Kelvin-Voigt element in series with the damper",
          "F = w + tau_m dw/dt, (tau_m + kappa c_s) dw/dt + w = f(v), c_s = f(v) / v",
          "Kelvin-Voigt mount of stiffness 1 / kappa and damping tau_m / kappa; exact for a linear "
          "damper, by its secant rate c_s for others; mounts of 150 to 1000 N/mm",
          kOnStrut,
          {make_switch("compliance", "m/N", "kappa: 1 / stiffness of the mount", 0.0, 1e-2, 3e-6),
           make_shape("relaxation", "s", "tau_m: damping over stiffness of the mount", 2e-3, 2e-4,
                      0.03, 2e-3)}};
}

EffectInfo make_joint_play() {
  return {
      EffectName::kJointPlay,
      "a worn joint between damper and body or wheel: after a reversal the damper stands until "
      "the rod has crossed the play, and so does the strut's dry friction; without such friction "
      "it is damper_leak under another name; where both are on, stroke and play add up",
      "F = f(w), du/dt = v - w, w = r (u - clamp(u, -p / 2, p / 2)), "
      "r^2 = (1 / 1 ms)^2 + (0.5 m/s / p)^2",
      "dead zone in series with the damper, behind it a contact that yields within 1 ms, at "
      "most by p at 0.5 m/s (stiffness c r of a linear damper); worn joints 0.1 to 1 mm; "
      "clearance with contact spring: Flores et al., Kinematics and Dynamics of Multibody "
      "Systems with Imperfect Joints, 2008",
      kOnStrut,
      {make_switch("play", "m", "p: lost motion from stop to stop", 0.0, 0.02, 3e-4)}};
}

EffectInfo make_gas_force() {
  EffectInfo gas = {
      EffectName::kGasForce,
      "gas pressure on the damper's rod pushes the strut apart; invisible in displacements from "
      "rest, hence not on a quarter_car or single_mass",
      "F = F_g",
      "150 to 300 N a corner in monotube dampers; Dixon",
      kOnStrut,
      {make_switch("force", "N", "F_g: force of the gas at rest", -5000.0, 5000.0, 200.0)}};
  gas.parameters[0].needs = kHasStaticForce;
  return gas;
}

EffectInfo make_anti_roll_bar() {
  EffectInfo bar = {
      EffectName::kAntiRollBar,
      "a bar resists the difference of an axle's two deflections",
      "F_left = k_r (d_left - d_right) = -F_right",
      "linear torsion bar, its rate taken at the springs; Milliken, Race Car Vehicle Dynamics, "
      "ch. 16",
      kOnAxle,
      {make_switch("stiffness", "N/m", "k_r: force on each spring's line by their difference", 0.0,
                   1e6, 1e4)}};
  bar.parameters[0].needs = kHasCar;
  return bar;
}

}  // namespace

std::vector<EffectInfo> make_strut_effects() {
  return {make_damper_asymmetry(),   make_damper_blow_off(), make_damper_hysteresis(),
          make_damper_leak(),        make_damper_fade(),     make_strut_friction(),
          make_progressive_spring(), make_bump_stop(),       make_top_mount_compliance(),
          make_joint_play(),         make_gas_force(),       make_anti_roll_bar()};
}

}  // namespace strut
