#include "tests/reference/car_forces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace strut::reference {
namespace {

constexpr double kSpeedFloor = 0.5;      // m/s, slips at walking pace
constexpr double kDampingOnset = 0.002;  // m, over which the tire damper comes in

const BodyState& at(const std::vector<BodyState>& state, int body) {
  return state[static_cast<std::size_t>(body)];
}

const CornerLayout& get_corner(const CarLayout& layout, int corner) {
  return layout.corners[static_cast<std::size_t>(corner)];
}

double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// Directions at a contact: road normal, along the wheel, across, and towards the wheel center.
struct ContactAxes {
  Vector3d n, x, y, radial;
};

ContactAxes make_axes(double slope, const Vector3d& u) {
  ContactAxes e;
  e.n = Vector3d(-slope, 0.0, 1.0).normalized();
  e.x = u.cross(e.n).normalized();
  e.y = e.n.cross(e.x);
  e.radial = e.x.cross(u);
  return e;
}

double calc_plane_distance(const TireContactSpec& tire, const RoadPoint<double>& road,
                           const Vector3d& center, double nz) {
  if (tire.contact == ContactKind::kPoint) return (center.z() - road.height) * nz;
  return tire.unloaded_radius - (road.height + tire.unloaded_radius - center.z()) * nz;
}

LineElement calc_line(const MountPoint& upper, const MountPoint& lower,
                      const std::vector<BodyState>& state) {
  const BodyState& a = at(state, upper.body);
  const BodyState& b = at(state, lower.body);
  LineElement line;
  const Vector3d d = b.point(lower.s) - a.point(upper.s);
  line.length = d.norm();
  line.direction = d / line.length;
  line.rate = line.direction.dot(b.point_velocity(lower.s) - a.point_velocity(upper.s));
  return line;
}

void add_contact(const WheelContact& contact, const BodyState& wheel, Wrench* wrench) {
  wrench->force += contact.force;
  wrench->moment += (contact.point - wheel.position).cross(contact.force) + contact.moment;
}

}  // namespace

WheelContact calc_contact(const CarForces& forces, const CarLayout& layout, int corner,
                          const std::vector<BodyState>& state) {
  const CornerLayout& c = get_corner(layout, corner);
  const BodyState& upright = at(state, c.upright);
  const BodyState& wheel = at(state, c.wheel);
  const TireContactSpec& tire = forces.tire;
  const Vector3d u = upright.rotate(c.spin_axis);
  const RoadPoint<double> road = forces.laws.ground(corner, wheel.position.x());
  const ContactAxes e = make_axes(road.slope, u);
  const double lean = e.radial.dot(e.n);

  WheelContact contact;
  const double loaded = calc_plane_distance(tire, road, wheel.position, e.n.z()) / lean;
  contact.deflection = tire.unloaded_radius - loaded;
  contact.deflection_rate = -wheel.velocity.dot(e.n) / lean;
  contact.point = wheel.position - loaded * e.radial;
  contact.raw_load =
      tire.stiffness * contact.deflection +
      tire.damping * smooth_step(contact.deflection / kDampingOnset) * contact.deflection_rate;
  contact.load = contact.deflection > 0.0 ? std::max(0.0, contact.raw_load) : 0.0;
  contact.force = contact.load * e.n;
  if (forces.frictionless) return contact;

  const Vector3d carried =
      wheel.velocity + upright.angular_velocity.cross(contact.point - wheel.position);
  const double vx = wheel.velocity.dot(e.x), vy = carried.dot(e.y);
  const double speed = std::max(std::fabs(vx), kSpeedFloor);
  const double radius = forces.laws.rolling_radius(std::max(contact.deflection, 0.0));
  const double spin = wheel.angular_velocity.dot(u);
  contact.slip = {contact.load, (spin * radius - vx) / speed, std::atan(vy / speed), u.dot(e.n),
                  vx};
  contact.in_plane = forces.laws.tire_force(corner, contact.slip);
  const TireForce<double>& f = contact.in_plane;
  contact.force += f.fx * e.x + f.fy * e.y;
  contact.moment = f.mx * e.x + f.my * e.y + f.mz * e.n;
  return contact;
}

LineElement calc_spring(const CarForces& forces, const CarLayout& layout, int corner,
                        const std::vector<BodyState>& state) {
  const CornerLayout& c = get_corner(layout, corner);
  const CornerStrut& strut = forces.strut[static_cast<std::size_t>(corner)];
  LineElement spring = calc_line(c.spring_upper, c.spring_lower, state);
  spring.force = strut.stiffness * (strut.free_length - spring.length);
  return spring;
}

LineElement calc_damper(const CarForces& forces, const CarLayout& layout, int corner,
                        const std::vector<BodyState>& state) {
  const CornerLayout& c = get_corner(layout, corner);
  LineElement damper = calc_line(c.damper_upper, c.damper_lower, state);
  damper.force = -forces.strut[static_cast<std::size_t>(corner)].damping * damper.rate;
  return damper;
}

void add_line_force(const LineElement& element, double force, const MountPoint& upper,
                    const MountPoint& lower, const std::vector<BodyState>& state,
                    std::vector<Wrench>* wrenches) {
  const auto a = static_cast<std::size_t>(upper.body), b = static_cast<std::size_t>(lower.body);
  add_force_at(state[a], upper.s, -force * element.direction, &(*wrenches)[a]);
  add_force_at(state[b], lower.s, force * element.direction, &(*wrenches)[b]);
}

std::vector<Wrench> calc_wrenches(const CarForces& forces, const CarLayout& layout,
                                  const std::vector<BodyState>& state) {
  std::vector<Wrench> wrenches(state.size());
  for (std::size_t k = 0; k < state.size(); ++k) {
    wrenches[k].force.z() -= layout.bodies[k].mass * forces.gravity;
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    const CornerLayout& c = get_corner(layout, corner);
    const LineElement spring = calc_spring(forces, layout, corner, state);
    add_line_force(spring, spring.force, c.spring_upper, c.spring_lower, state, &wrenches);
    const LineElement damper = calc_damper(forces, layout, corner, state);
    add_line_force(damper, damper.force, c.damper_upper, c.damper_lower, state, &wrenches);
    Wrench& wheel = wrenches[static_cast<std::size_t>(c.wheel)];
    const Vector3d torque =
        c.drive_share * forces.drive_torque * at(state, c.upright).rotate(c.spin_axis);
    wheel.moment += torque;
    wrenches[0].moment -= forces.drive_reaction * torque;
    add_contact(calc_contact(forces, layout, corner, state), at(state, c.wheel), &wheel);
  }
  return wrenches;
}

}  // namespace strut::reference
