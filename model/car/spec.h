// Specification of a car: plain data in SI units, as in its file. `assemble.h` turns it into the
// parameters of the equations; no physics here.
//
// Axes: chassis axes x forward, y left, z up. Suspension points are given for the LEFT corner of an
// axle, relative to the axle reference: x of the wheel center, the car's center plane, z of the
// wheel center, all at nominal trim. The right corner is the mirror image.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/math/spatial.h"
#include "base/names/corners.h"
#include "model/effects/force_map.h"
#include "model/effects/setting.h"
#include "model/force/force_curve.h"
#include "model/force/pac2002.h"
#include "model/multibody/corner.h"
#include "model/scenario/road.h"

namespace strut {

/// Rigid body: mass [kg], center of mass [m], inertia about it [kg m^2] in chassis axes.
struct BodySpec {
  double mass = 0.0;
  Vec3<double> center_of_mass{};
  Sym3<double> inertia{};
  bool operator==(const BodySpec&) const = default;
};

/// Slender link between a chassis ball joint and an upright ball joint, removed from the tree.
struct RodSpec {
  Vec3<double> chassis{};          // m
  Vec3<double> upright{};          // m
  double mass = 0.0;               // kg
  double center_fraction = 0.5;    // center of mass: 0 at the chassis end, 1 at the upright end
  double transverse_inertia = -1;  // kg m^2 about the center of mass; < 0: uniform, m L^2 / 12
  bool operator==(const RodSpec&) const = default;
};

/// The body to which one end of a spring or damper is fixed.
enum class MountBody { kChassis, kUpright, kLowerArm, kRod };

struct MountSpec {
  MountBody body = MountBody::kChassis;
  int rod = 0;              // for kRod: its number; the point is projected onto the rod
  Vec3<double> position{};  // m, at nominal trim
  bool operator==(const MountSpec&) const = default;
};

/// Spring and damper of one corner; the rate of each element is along its own axis.
struct StrutSpec {
  double stiffness = 0.0;          // N/m
  double damping = 0.0;            // N s/m
  double nominal_stiffness = 0.0;  // N/m, of the new spring; determines the free length
  bool operator==(const StrutSpec&) const = default;
};

struct SuspensionSpec {
  SuspensionKind kind = SuspensionKind::kMacPherson;

  // MacPherson: one lower arm, the strut that guides the upright, one tie rod.
  Vec3<double> arm_front{}, arm_rear{}, ball_joint{};  // m
  Vec3<double> strut_top{}, strut_bottom{};            // m; the slide runs along this line
  BodySpec lower_arm;
  BodySpec strut_rod;  // upper part, rotates about strut_top; may be massless

  std::vector<RodSpec> rods;  // MacPherson: the tie rod; multilink: five links
  int tie_rod = 0;            // the rod whose chassis end moves with the steering rack

  BodySpec upright;                       // with hub, brake and lower strut; without the wheel
  double wheel_mass = 0.0;                // kg, wheel with tire
  double wheel_spin_inertia = 0.0;        // kg m^2 about the spin axis
  double wheel_transverse_inertia = 0.0;  // kg m^2 about a diameter
  double wheel_center_y = 0.0;            // m, half track at nominal trim
  double static_toe = 0.0;                // rad, + toe-in
  double static_camber = 0.0;             // rad, + top outwards

  MountSpec spring_upper, spring_lower, damper_upper, damper_lower;
  std::array<StrutSpec, 2> strut;  // left, right
  ForceCurveSpec damper_curve;     // that the dampers' rates scale; empty: a straight line
  double drive_share = 0.0;        // fraction of the drive torque on this axle, half to each wheel
  bool operator==(const SuspensionSpec&) const = default;
};

enum class PreloadKind { kFreeLength, kTrimmed };

/// Vertical tire spring and contact; in-plane forces by PAC2002.
struct TireContactSpec {
  double unloaded_radius = 0.0;  // m
  double stiffness = 0.0;        // N/m
  double damping = 0.0;          // N s/m
  ForceCurveSpec curve;          // that `stiffness` scales; empty: a straight line
  double footprint = 0.12;       // m, contact patch length that smooths short obstacles
  ContactKind contact = ContactKind::kEnvelope;
  bool relaxation = false;  // first-order slip dynamics (PTX*, PTY*)
  bool operator==(const TireContactSpec&) const = default;
};

/// The whole car at nominal trim, at rest, standing on flat ground: Table 1 of the paper.
struct WholeCarSpec {
  double mass = 0.0;               // kg
  double centroid_to_front = 0.0;  // m
  double centroid_to_rear = 0.0;   // m
  double centroid_height = 0.0;    // m
  Sym3<double> inertia{};          // kg m^2 about the centroid

  double wheelbase() const { return centroid_to_front + centroid_to_rear; }  // m
  bool operator==(const WholeCarSpec&) const = default;
};

struct VehicleSpec {
  std::string name;
  WholeCarSpec whole;
  std::array<SuspensionSpec, kAxles> suspension;
  TireContactSpec tire;
  Pac2002<double> pacejka;     // in-plane forces, from a .tir file
  double rack_position = 0.0;  // m, + left; fixed during a run
  PreloadKind preload = PreloadKind::kFreeLength;
  Vec3<double> imu_position{};  // m from the centroid at nominal trim
  EffectSettings effects;
  ForceMaps force_maps;
  bool operator==(const VehicleSpec&) const = default;
};

}  // namespace strut
