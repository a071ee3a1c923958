#include "model/car/assemble.h"

#include <fmt/format.h>

#include <cmath>

#include "model/car/dynamics.h"

namespace strut {
namespace {

/// Minimum change of the spring length per unit of a corner's coordinate.
constexpr double kMinSpringRatio = 0.05;

TireVertical<double> make_tire(const TireContactSpec& spec) {
  return {spec.unloaded_radius, spec.stiffness, spec.damping, 0.0};
}

/// Height of a wheel center over flat ground under a load; the camber tilts the wheel's axis.
double calc_center_height(const VehicleSpec& spec, const Vec3<double>& axis, double load) {
  const double deflection =
      calc_static_deflection(make_tire(spec.tire), make_force_curve(spec.tire.curve).get(), load);
  const double loaded_radius = spec.tire.unloaded_radius - deflection;
  return loaded_radius * std::sqrt(1.0 - square(axis.z));
}

/// Sets the geometry and inertia of all corners for a position of the steering rack [m].
void build_corners(const VehicleSpec& spec, double gravity, double rack, AssembledVehicle& car) {
  for (int c = 0; c < kCorners; ++c) {
    car.nominal_load[c] = calc_nominal_load(spec, gravity, axle_of(c));
    const Vec3<double> reference = calc_wheel_reference(spec, gravity, c);
    const BuiltCorner parts = build_corner(spec, c, reference, rack);
    car.layout.predictor[c] = parts.predictor;
    car.layout.corner[c] = parts.topology;
    car.numbers.geometry[c] = parts.geometry;
    car.numbers.inertia[c] = parts.inertia;
  }
}

double calc_corner_mass(const CornerTopology& topology, const CornerInertia<double>& inertia) {
  const int rods = get_tree(topology.kind).rod_count;
  double mass = 0.0;
  for (int i = 0; i < topology.body_count; ++i) mass += inertia.body[i].mass;
  for (int i = 0; i < rods; ++i) {
    mass += inertia.rod[i].aa + 2.0 * inertia.rod[i].ab + inertia.rod[i].bb;
  }
  return mass;
}

/// Sets mass, center and inertia of the chassis so that the whole car meets its specification, and
/// the nominal lengths of the lines.
void fit_chassis(const VehicleSpec& spec, AssembledVehicle& car) {
  VehicleParameters<double>& numbers = car.numbers;
  const NewtonClosure<double> closure{&car.layout, &numbers};
  numbers.mass = spec.whole.mass;
  double mass = spec.whole.mass;
  Vec3<double> moment{0.0, 0.0, 0.0};
  Sym3<double> inertia = spec.whole.inertia;
  for (int c = 0; c < kCorners; ++c) {
    CornerMotion<double> motion;
    closure(c, 0.0, motion);
    mass -= calc_corner_mass(car.layout.corner[c], numbers.inertia[c]);
    moment -= motion.moment;
    inertia = inertia - motion.inertia -
              (0.5 * numbers.inertia[c].spin_inertia) * symmetric_outer(motion.axis, motion.axis);
    for (int line = 0; line < kLines; ++line) {
      numbers.nominal_length[c * kLines + line] = motion.length[line];
    }
  }
  if (!(mass > 0.0)) {
    throw ModelError(
        fmt::format("whole_car.mass = {:g} kg: the chassis would have a mass of {:g} kg; allowed: "
                    "more than the mass of wheels and suspension",
                    spec.whole.mass, mass));
  }
  const Vec3<double> center = (1.0 / mass) * moment;
  inertia = inertia - (0.5 * mass) * inertia_form(center, center);
  check_chassis_inertia(inertia);
  numbers.chassis = {mass, center, inertia};
}

State<double> make_rest_state(double center_height) {
  State<double> x{};
  x[StateIndex::kPosition + 2] = center_height;
  x[StateIndex::kQuaternion] = 1.0;
  return x;
}

/// Sets the spring forces at nominal trim, from the equilibrium of each corner.
void fit_preload(AssembledVehicle& car) {
  Vehicle<double> bare{car.layout, car.numbers, car.pacejka, {}, {}};
  bare.layout.on_bump.fill(false);
  Workspace<double> ws{};
  State<double> x = make_rest_state(car.center_height), dx{};
  calc_derivative(bare, NewtonClosure<double>{&bare.layout, &bare.numbers}, TireMode::kFrictionless,
                  x.data(), dx.data(), ws);
  GeneralizedForce<double> rhs;
  calc_forces(bare, x.data(), ws, rhs);
  for (int c = 0; c < kCorners; ++c) {
    const double ratio = ws.motion[c].length_q[kSpringLine];
    if (std::abs(ratio) < kMinSpringRatio) {
      throw ModelError(
          fmt::format("{}.spring: its length changes by only {:g} m per m of travel; "
                      "allowed: at least {:g}",
                      get_axle_key(axle_of(c)), std::abs(ratio), kMinSpringRatio));
    }
    car.preload[c] = -rhs.corner[c] / ratio;
  }
}

std::array<bool, kCorners> find_wheels_on_bump(const RoadSpec& road) {
  const bool has_bump = road.shape != BumpShape::kNone;
  const bool left = has_bump && road.side != BumpSide::kRight;
  const bool right = has_bump && road.side != BumpSide::kLeft;
  return {left, right, left, right};
}

}  // namespace

double calc_nominal_load(const VehicleSpec& spec, double gravity, int axle) {
  const WholeCarSpec& whole = spec.whole;
  const double lever = axle == kFront ? whole.centroid_to_rear : whole.centroid_to_front;
  return 0.5 * whole.mass * gravity * lever / whole.wheelbase();
}

Vec3<double> calc_wheel_reference(const VehicleSpec& spec, double gravity, int corner) {
  const int axle = axle_of(corner);
  const WholeCarSpec& whole = spec.whole;
  const Vec3<double> axis = calc_spin_axis(spec.suspension[axle], is_right(corner));
  const double load = calc_nominal_load(spec, gravity, axle);
  return {axle == kFront ? whole.centroid_to_front : -whole.centroid_to_rear, 0.0,
          calc_center_height(spec, axis, load) - whole.centroid_height};
}

// Sylvester's criterion.
void check_chassis_inertia(const Sym3<double>& j) {
  const double minor = j.xx * j.yy - j.xy * j.xy;
  const double det = j.xx * (j.yy * j.zz - j.yz * j.yz) - j.xy * (j.xy * j.zz - j.yz * j.xz) +
                     j.xz * (j.xy * j.yz - j.yy * j.xz);
  if (j.xx > 0.0 && minor > 0.0 && det > 0.0) return;
  throw ModelError(
      fmt::format("whole_car.inertia: the inertia of the chassis would not be positive definite "
                  "({:g}, {:g}, {:g} kg m^2); allowed: more than that of wheels and suspension",
                  j.xx, j.yy, j.zz));
}

AssembledVehicle assemble_vehicle(const VehicleSpec& spec, const ManeuverSpec& maneuver) {
  AssembledVehicle car{};
  car.numbers.tire.fill(make_tire(spec.tire));
  car.pacejka = spec.pacejka;
  car.numbers.gravity = maneuver.gravity;
  car.numbers.imu = spec.imu_position;
  car.center_height = spec.whole.centroid_height;
  car.layout.contact = spec.tire.contact;
  car.layout.tire_curve = make_force_curve(spec.tire.curve);
  car.layout.relaxation = spec.tire.relaxation;
  car.layout.tire_parts = find_parts(spec.pacejka);
  car.layout.on_bump = find_wheels_on_bump(maneuver.road);
  // Nominal trim is straight ahead: chassis and preload are fitted before the rack moves.
  build_corners(spec, maneuver.gravity, 0.0, car);
  fit_chassis(spec, car);
  fit_preload(car);
  if (spec.rack_position != 0.0) build_corners(spec, maneuver.gravity, spec.rack_position, car);
  set_operating_parameters(spec, maneuver, car, car.numbers);
  return car;
}

void set_operating_parameters(const VehicleSpec& spec, const ManeuverSpec& maneuver,
                              const AssembledVehicle& car, VehicleParameters<double>& numbers) {
  for (int c = 0; c < kCorners; ++c) {
    const SuspensionSpec& suspension = spec.suspension[axle_of(c)];
    const StrutSpec& strut = suspension.strut[is_right(c) ? 1 : 0];
    // A worn spring keeps the free length of the new one, so the car sags.
    const bool keeps_free_length =
        spec.preload == PreloadKind::kFreeLength && strut.nominal_stiffness > 0.0;
    const double rate = keeps_free_length ? strut.nominal_stiffness : strut.stiffness;
    const double length = numbers.nominal_length[c * kLines + kSpringLine];
    numbers.spring[c] = {strut.stiffness, length + car.preload[c] / rate};
    numbers.damper[c] = {strut.damping};
    numbers.drive_torque[c] = 0.5 * suspension.drive_share * maneuver.drive_torque;
  }
  numbers.drive_reaction = maneuver.drive_reaction;
}

ContactGeometry make_contact(const VehicleSpec& spec) {
  return {spec.tire.contact, spec.tire.unloaded_radius, spec.tire.footprint};
}

Surface make_surface(const VehicleSpec& spec, const ManeuverSpec& maneuver) {
  return make_surface(maneuver.road, make_contact(spec));
}

double calc_bump_center(const AssembledVehicle& car, const ManeuverSpec& maneuver) {
  return car.numbers.geometry[kFrontLeft].wheel_center.x + maneuver.bump_distance +
         calc_lead(maneuver);
}

}  // namespace strut
