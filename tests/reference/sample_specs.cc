#include "tests/reference/sample_specs.h"

namespace strut::reference {
namespace {

Sym3<double> make_diagonal(double xx, double yy, double zz) { return {xx, yy, zz, 0.0, 0.0, 0.0}; }

RodSpec make_rod(const Vec3<double>& chassis, const Vec3<double>& upright, double mass) {
  RodSpec rod;
  rod.chassis = chassis;
  rod.upright = upright;
  rod.mass = mass;
  return rod;
}

MountSpec make_mount(MountBody body, const Vec3<double>& position, int rod = 0) {
  MountSpec mount;
  mount.body = body;
  mount.rod = rod;
  mount.position = position;
  return mount;
}

void set_wheel(SuspensionSpec* axle) {
  axle->wheel_mass = 22.0;
  axle->wheel_spin_inertia = 1.4;
  axle->wheel_transverse_inertia = 0.8;
}

/// Hardpoints: public MacPherson model (vehicledynamics, Suspensions.mo), moved to its wheel
/// center.
SuspensionSpec make_front() {
  SuspensionSpec front;
  front.kind = SuspensionKind::kMacPherson;
  const Vec3<double> center{-0.00013, 0.0, 0.045};
  front.arm_front = Vec3<double>{-0.0075, 0.3753, -0.0358} - center;
  front.arm_rear = Vec3<double>{-0.3175, 0.3535, -0.02735} - center;
  front.ball_joint = Vec3<double>{0.0058556, 0.69905, -0.0725} - center;
  front.strut_top = Vec3<double>{-0.0291, 0.541, 0.561} - center;
  front.strut_bottom = Vec3<double>{-0.00012, 0.5791, 0.042} - center;
  front.rods = {make_rod(Vec3<double>{-0.164, 0.3047, 0.0945} - center,
                         Vec3<double>{-0.1283, 0.643, 0.07344} - center, 1.1)};
  front.lower_arm = {4.0, {-0.06, 0.52, -0.095}, make_diagonal(0.03, 0.025, 0.05)};
  front.strut_rod = {2.5, {-0.022, 0.55, 0.40}, make_diagonal(0.03, 0.03, 0.004)};
  front.upright = {17.0, {0.002, 0.66, 0.03}, {0.30, 0.26, 0.12, 0.004, -0.006, 0.02}};
  set_wheel(&front);
  front.wheel_center_y = 0.725;
  front.static_toe = 0.001;
  front.static_camber = -0.008;
  front.spring_upper = front.damper_upper = make_mount(MountBody::kChassis, front.strut_top);
  front.spring_lower = front.damper_lower = make_mount(MountBody::kUpright, front.strut_bottom);
  front.strut[0] = front.strut[1] = {40000.0, 1980.0};
  front.drive_share = 1.0;
  return front;
}

/// Hardpoints: public five-link rear axle (Chrono, Sedan_MultiLink.json), arm read as two rods.
SuspensionSpec make_rear() {
  SuspensionSpec rear;
  rear.kind = SuspensionKind::kMultilink;
  rear.rods = {make_rod({0.060, 0.397, 0.082}, {0.056, 0.714, 0.151}, 1.5),
               make_rod({-0.157, 0.358, 0.062}, {0.056, 0.714, 0.151}, 1.5),
               make_rod({0.036, 0.188, -0.133}, {0.029, 0.692, -0.093}, 1.9),
               make_rod({0.723, 0.449, -0.072}, {0.0, 0.714, -0.156}, 3.0),
               make_rod({-0.257, 0.170, -0.116}, {-0.144, 0.712, -0.056}, 1.2)};
  rear.rods[3].center_fraction = 0.55;
  rear.rods[3].transverse_inertia = 0.17;
  rear.tie_rod = 4;
  rear.upright = {16.0, {-0.005, 0.73, 0.005}, {0.16, 0.14, 0.15, -0.003, 0.004, 0.005}};
  set_wheel(&rear);
  rear.wheel_center_y = 0.80;
  rear.static_toe = 0.0015;
  rear.static_camber = -0.015;
  rear.spring_upper = make_mount(MountBody::kChassis, {0.030, 0.50, 0.25});
  const RodSpec& link = rear.rods[2];  // the reference car has mounts on the lines of rods alone
  const Vec3<double> along = link.upright - link.chassis;
  const double fraction =
      dot(Vec3<double>{0.032, 0.56, -0.10} - link.chassis, along) / dot(along, along);
  rear.spring_lower = make_mount(MountBody::kRod, link.chassis + fraction * along, 2);
  rear.damper_upper = make_mount(MountBody::kChassis, {-0.05, 0.56, 0.38});
  rear.damper_lower = make_mount(MountBody::kUpright, {-0.05, 0.66, -0.08});
  rear.strut[0] = rear.strut[1] = {35000.0, 1980.0};
  return rear;
}

}  // namespace

Pac2002<double> make_sedan_tire(double unloaded_radius) {
  Pac2002<double> p;
  p.UNLOADED_RADIUS = unloaded_radius;
  p.FNOMIN = 4850.0;
  p.LFZO = 0.81;
  p.PCX1 = 1.6411, p.PDX1 = 1.1739, p.PDX2 = -0.16395;
  p.PEX1 = 0.46403, p.PEX2 = 0.25022, p.PEX3 = 0.067842, p.PEX4 = -3.76e-5;
  p.PKX1 = 22.303, p.PKX2 = 0.48896, p.PKX3 = 0.21253;
  p.PHX1 = 0.0012297, p.PHX2 = 0.0004318, p.PVX1 = -8.81e-6, p.PVX2 = 1.862e-5;
  p.RBX1 = 13.276, p.RBX2 = -13.778, p.RCX1 = 1.2568, p.REX1 = 0.65225, p.RHX1 = 0.0050722;
  p.PCY1 = 1.3507, p.PDY1 = 1.0489, p.PDY2 = -0.18033, p.PDY3 = -2.8821, p.PEY1 = -0.0074722;
  p.PKY1 = -21.92, p.PKY2 = 2.0012, p.PKY3 = -0.024778, p.PHY1 = 0.0026747, p.PVY1 = 0.037318;
  p.RBY1 = 7.1433, p.RBY2 = 9.1916, p.RBY3 = -0.027856, p.RCY1 = 1.0719, p.RHY1 = 5.7e-6;
  p.RVY1 = -0.027825;
  p.QSX2 = 0.7, p.QSX3 = 0.05, p.QSY1 = 0.01;
  p.QBZ1 = 10.0, p.QCZ1 = 1.1, p.QDZ1 = 0.09, p.QDZ6 = 0.001, p.QBZ10 = 0.1;
  return p;
}

VehicleSpec make_paper_sedan_spec() {
  VehicleSpec spec;
  spec.name = "paper sedan";
  spec.whole = {1155.0, 0.7209, 2.0791, 0.5373, {220.0, 1560.0, 1790.0, 0.0, 15.0, 0.0}};
  spec.suspension = {make_front(), make_rear()};
  spec.tire.unloaded_radius = 0.4673;
  spec.tire.stiffness = 200000.0;
  spec.tire.damping = 500.0;
  spec.pacejka = make_sedan_tire(spec.tire.unloaded_radius);
  return spec;
}

}  // namespace strut::reference
