#include "tests/hidden/rigs.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "tests/hidden/dormand_prince.h"

namespace strut::hidden {
namespace {

constexpr std::size_t kUnsprung = 0, kUnsprungSpeed = 1, kSprung = 2, kSprungSpeed = 3, kInner = 4;
constexpr double kTwoPi = 6.28318530717958647692;

double calc_tire_force(const QuarterCar& car, double deflection, double rate) {
  double force = car.tire_stiffness * deflection;
  if (car.tire_exponent != 0.0) {
    const double u = std::hypot(deflection / car.tire_travel, 0.02);
    force *= std::pow(u, car.tire_exponent);
  }
  return force + car.tire_damping * rate;
}

/// Rates of the state; the inerter couples the two accelerations.
void calc_rates(const QuarterCar& car, const RoadMotion& road, double t,
                const std::vector<double>& y, std::vector<double>& dy) {
  const double travel = y[kUnsprung] - y[kSprung], speed = y[kUnsprungSpeed] - y[kSprungSpeed];
  const double strut = calc_strut_force(car.strut, travel, speed, &y[kInner], &dy[kInner]);
  const double tire =
      calc_tire_force(car, road.position(t) - y[kUnsprung], road.velocity(t) - y[kUnsprungSpeed]);
  const double hum = car.hum_force == 0.0
                         ? 0.0
                         : car.hum_force * std::sin(kTwoPi * car.hum_rate * t * (1.0 + 0.01 * t));
  const double b = car.strut.faults.inerter, mu = car.unsprung_mass, ms = car.sprung_mass;
  const double on_unsprung = tire - strut, on_sprung = strut + hum;
  // (mu + b) au - b as = on_unsprung, (ms + b) as - b au = on_sprung.
  const double scale = 1.0 / (mu * ms + b * (mu + ms));
  dy[kUnsprung] = y[kUnsprungSpeed];
  dy[kSprung] = y[kSprungSpeed];
  dy[kUnsprungSpeed] = scale * ((ms + b) * on_unsprung + b * on_sprung);
  dy[kSprungSpeed] = scale * ((mu + b) * on_sprung + b * on_unsprung);
}

/// Absolute sizes of the states: positions, speeds, the strut's inner ones.
void add_strut_scale(const StrutScale& s, std::vector<double>& scale) {
  scale.insert(scale.end(), {s.breakaway, 0.01 * s.travel, 0.1 * s.travel, s.force, s.speed});
}

}  // namespace

std::vector<QuarterCarSample> simulate_quarter_car(const QuarterCar& car, const RoadMotion& road,
                                                   const std::vector<double>& times,
                                                   double tolerance) {
  DormandPrinceOptions options;
  options.tolerance = tolerance;
  const StrutScale& s = car.strut.scale;
  options.scale = {s.travel, s.speed, s.travel, s.speed};
  add_strut_scale(s, options.scale);
  const auto rates = [&](double t, const std::vector<double>& y, std::vector<double>& dy) {
    calc_rates(car, road, t, y, dy);
  };
  std::vector<QuarterCarSample> samples(times.size());
  std::vector<double> dy(kInner + kStrutStates);
  integrate_dormand_prince(rates, std::vector<double>(dy.size(), 0.0), times, options,
                           [&](std::size_t i, double t, const std::vector<double>& y) {
                             calc_rates(car, road, t, y, dy);
                             samples[i] = {road.position(t),  y[kUnsprung],    y[kSprung],
                                           y[kUnsprungSpeed], y[kSprungSpeed], dy[kUnsprungSpeed],
                                           dy[kSprungSpeed]};
                           });
  return samples;
}

double calc_quarter_car_energy(const QuarterCar& car, const QuarterCarSample& s) {
  const auto half_square = [](double rate, double x) { return 0.5 * rate * x * x; };
  return half_square(car.unsprung_mass, s.unsprung_velocity) +
         half_square(car.sprung_mass, s.sprung_velocity) +
         half_square(car.strut.stiffness, s.unsprung - s.sprung) +
         half_square(car.tire_stiffness, s.road - s.unsprung);
}

std::vector<double> simulate_strut(const StrutLaw& law, const RoadMotion& drive,
                                   const std::vector<double>& times, double tolerance) {
  DormandPrinceOptions options;
  options.tolerance = tolerance;
  add_strut_scale(law.scale, options.scale);
  const auto force = [&](double t, const double* y, double* dy) {
    return calc_strut_force(law, drive.position(t), drive.velocity(t), y, dy);
  };
  const auto rates = [&](double t, const std::vector<double>& y, std::vector<double>& dy) {
    force(t, y.data(), dy.data());
  };
  std::vector<double> forces(times.size());
  StrutStates unused{};
  integrate_dormand_prince(rates, std::vector<double>(kStrutStates, 0.0), times, options,
                           [&](std::size_t i, double t, const std::vector<double>& y) {
                             forces[i] = force(t, y.data(), unused.data());
                           });
  return forces;
}

}  // namespace strut::hidden
