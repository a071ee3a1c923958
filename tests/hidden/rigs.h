// The generator's own test stands: a quarter car on a moving plate, a strut on a crank.
#pragma once

#include <functional>
#include <vector>

#include "tests/hidden/strut_law.h"

namespace strut::hidden {

/// Two masses: road - tire - unsprung - strut - sprung. Positions from rest, so gravity is absent;
/// the tire's springs are fixed at both ends and cannot lift off.
struct QuarterCar {
  double sprung_mass = 2.45;       // kg
  double unsprung_mass = 1.0;      // kg
  double tire_stiffness = 1250.0;  // N/m
  double tire_damping = 5.0;       // N s/m
  StrutLaw strut;
  // Faults besides the strut's:
  double tire_exponent = 0.0;  // 1, tire force k d (|d| / d0)^e, rounded within 0.02 d0
  double tire_travel = 0.01;   // m, d0
  double hum_force = 0.0;      // N on the sprung mass, unknown to every catalogue
  double hum_rate = 2.0;       // Hz, where it begins; it sweeps up by a fifth in 10 s
};

/// The road plate [m] with its velocity [m/s] over time.
struct RoadMotion {
  std::function<double(double t)> position, velocity;
};

/// Motion of the two masses at one instant.
struct QuarterCarSample {
  double road = 0.0, unsprung = 0.0, sprung = 0.0;                // m
  double unsprung_velocity = 0.0, sprung_velocity = 0.0;          // m/s
  double unsprung_acceleration = 0.0, sprung_acceleration = 0.0;  // m/s^2
};

/// Samples at `times` [s] from rest.
std::vector<QuarterCarSample> simulate_quarter_car(const QuarterCar& car, const RoadMotion& road,
                                                   const std::vector<double>& times,
                                                   double tolerance = 1e-8);

/// Kinetic energy and energy of linear springs [J].
double calc_quarter_car_energy(const QuarterCar& car, const QuarterCarSample& sample);

/// A strut driven along displacement(t): its force at `times` [N].
std::vector<double> simulate_strut(const StrutLaw& law, const RoadMotion& drive,
                                   const std::vector<double>& times, double tolerance = 1e-8);

}  // namespace strut::hidden
