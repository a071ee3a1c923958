#include "tests/hidden/vehicle_file.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <sstream>

namespace strut::hidden {
namespace {

std::string format_point(double x, double y, double z) {
  return "[" + format(x) + ", " + format(y) + ", " + format(z) + "]";
}

/// Spring or damper on the vertical through the wheel center.
void add_line(std::ostringstream& out, const std::string& table, const std::string& key,
              double rate, double y) {
  out << "[" << table << "]\n"
      << key << " = " << format(rate) << "\n"
      << "upper = " << format_point(0.0, y, 0.5) << "\nupper_on = \"chassis\"\n"
      << "lower = " << format_point(0.0, y, 0.0) << "\nlower_on = \"upright\"\n\n";
}

void add_axle(std::ostringstream& out, const std::string& name, const Wheel& wheel) {
  constexpr double kFar = 5.0, kDeep = -5.0, kBehind = -2.0;  // m
  const double y = wheel.position.y(), wheel_mass = 0.55 * wheel.mass;
  const std::string axle = name + "_suspension";
  out << "[" << axle << "]\nkind = \"macpherson\"\n"
      << "lower_arm_front = " << format_point(1.0, -kFar, kDeep) << "\n"
      << "lower_arm_rear = " << format_point(-1.0, -kFar, kDeep) << "\n"
      << "ball_joint = " << format_point(0.0, kFar, kDeep) << "\n"
      << "strut_top = " << format_point(0.0, y, 0.5) << "\n"
      << "strut_bottom = " << format_point(0.0, y, 0.0) << "\n\n"
      << "[" << axle << ".tie_rod]\n"
      << "chassis = " << format_point(kBehind, -kFar, kDeep) << "\n"
      << "upright = " << format_point(kBehind, kFar, kDeep) << "\nmass = 0.0\n\n"
      << "[" << axle << ".lower_arm]\nmass = 1e-6\n"
      << "center_of_mass = " << format_point(0.0, kFar, kDeep) << "\n"
      << "inertia = [1e-9, 1e-9, 1e-9]\n\n"
      << "[" << axle << ".upright]\nmass = " << format(wheel.mass - wheel_mass) << "\n"
      << "center_of_mass = " << format_point(0.0, y, 0.0) << "\ninertia = [0.1, 0.1, 0.1]\n\n"
      << "[" << axle << ".wheel]\nhalf_track = " << format(y) << "\nmass = " << format(wheel_mass)
      << "\nspin_inertia = " << format(wheel.spin_inertia)
      << "\ntransverse_inertia = " << format(wheel.transverse_inertia - 0.1) << "\n\n";
  add_line(out, axle + ".spring", "stiffness", wheel.strut.stiffness, y);
  add_line(out, axle + ".damper", "damping", wheel.strut.damping, y);
}

}  // namespace

std::string format(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  std::string text(buffer, result.ptr);
  const bool plain = text.find_first_of(".e") == std::string::npos;
  return plain ? text + ".0" : text;
}

std::string make_vehicle_file(const Car& car, double footprint, const std::string& tire_file) {
  const Wheel &front = car.wheel[0], &rear = car.wheel[2];
  std::ostringstream out;
  out << "# Wheels that go straight up and down: links so long that their arcs are straight.\n"
      << "type = \"full_vehicle\"\nname = \"guided car\"\n\n"
      << "[whole_car]\nmass = " << format(car.mass)
      << "\ncentroid_to_front = " << format(front.position.x())
      << "\ncentroid_to_rear = " << format(-rear.position.x())
      << "\ncentroid_height = " << format(car.centroid_height)
      << "\ninertia = " << format_point(car.inertia.x(), car.inertia.y(), car.inertia.z())
      << "\n\n[drive]\nfront_share = 1.0\n\n[spring]\npreload = \"trimmed\"\n\n"
      << "[imu]\nposition = " << format_point(car.imu.x(), car.imu.y(), car.imu.z())
      << "\n\n[tire]\nfile = \"" << tire_file << "\"\ncontact = \"envelope\"\n"
      << "footprint = " << format(footprint) << "\n\n";
  add_axle(out, "front", front);
  add_axle(out, "rear", rear);
  return out.str();
}

std::string make_tire_file(const Tire& tire, double nominal_load) {
  // A cornering stiffness that peaks at a hundred times the nominal load is in proportion below it.
  constexpr double kPeak = 100.0;
  std::ostringstream out;
  out << "[UNITS]\nLENGTH = 'meter'\nFORCE = 'newton'\nANGLE = 'radian'\nMASS = 'kg'\n"
      << "TIME = 'second'\n[MODEL]\nPROPERTY_FILE_FORMAT = 'PAC2002'\nUSE_MODE = 3\n"
      << "TYRESIDE = 'LEFT'\n[DIMENSION]\nUNLOADED_RADIUS = " << format(tire.radius)
      << "\n[VERTICAL]\nVERTICAL_STIFFNESS = " << format(tire.stiffness)
      << "\nVERTICAL_DAMPING = " << format(tire.damping) << "\nFNOMIN = " << format(nominal_load)
      << "\n[LONGITUDINAL_COEFFICIENTS]\nPCX1 = " << format(tire.along.shape)
      << "\nPDX1 = " << format(tire.along.friction) << "\nPKX1 = " << format(tire.along.stiffness)
      << "\n[LATERAL_COEFFICIENTS]\nPCY1 = " << format(tire.across.shape)
      << "\nPDY1 = " << format(tire.across.friction)
      << "\nPKY1 = " << format(-0.5 * tire.across.stiffness * kPeak) << "\nPKY2 = " << format(kPeak)
      << "\n";
  return out.str();
}

}  // namespace strut::hidden
