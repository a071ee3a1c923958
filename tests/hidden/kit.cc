#include "tests/hidden/kit.h"

#include <array>
#include <stdexcept>

namespace strut::hidden {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kKmh = 1.0 / 3.6;
constexpr double kG = 9.80665;

Sensor make_accelerometer(const std::string& channel, const std::string& column, double noise,
                          double bias, double range) {
  return {channel, column, "g", "m/s^2", kG, noise, bias, range / 32768.0, range, false};
}

RunPlan make_crossing(const std::string& name, bool fit, const Bump& bump, int number, double kmh) {
  RunPlan run;
  run.name = name;
  run.fit = fit;
  run.speed = kmh * kKmh;
  run.bump = bump;
  run.bump_number = number;
  run.distance = 0.5 * run.speed + 0.5 * bump.length + 0.4;
  return run;
}

RunPlan make_rig_run(const std::string& name, bool fit, Excitation excitation, double duration,
                     double amplitude, double low, double high) {
  RunPlan run;
  run.name = name;
  run.fit = fit;
  run.excitation = excitation;
  run.duration = duration;
  run.amplitude = amplitude;
  run.low_frequency = low;
  run.high_frequency = high;
  return run;
}

Kit make_car_kit() {
  Kit kit;
  kit.name = "car";
  kit.time_sigma = 4e-3;
  kit.speed_sigma = 4.5e-3;
  const Car car = make_nominal_car();
  kit.parameters = {{"front_stiffness", "N/m", car.wheel[0].strut.stiffness, 0.8, 1.05, 0.0, false},
                    {"front_damping", "N s/m", car.wheel[0].strut.damping, 0.6, 1.05, 0.0, false},
                    {"rear_stiffness", "N/m", car.wheel[2].strut.stiffness, 0.8, 1.05, 0.0, false},
                    {"rear_damping", "N s/m", car.wheel[2].strut.damping, 0.6, 1.05, 0.0, false},
                    {"mass", "kg", car.mass, 0.994, 1.006, 3e-3, false}};
  for (int bump = 0; bump < 3; ++bump) {
    const std::string number = std::to_string(bump);
    kit.parameters.push_back({"bump_height" + number, "1", 1.0, 0.98, 1.02, 0.012, true});
    kit.parameters.push_back({"bump_length" + number, "1", 1.0, 0.98, 1.02, 0.012, true});
  }
  kit.sensors = {make_accelerometer("imu_acceleration_x", "Acc_X", 0.025, 0.3, 4.0 * kG),
                 make_accelerometer("imu_acceleration_z", "Acc_Z", 0.025, 0.3, 4.0 * kG)};
  const double degree = kTwoPi / 360.0;
  for (const char* axis : {"x", "y"}) {
    kit.sensors.push_back({std::string("imu_rate_") + axis,
                           std::string("Gyro_") + (*axis == 'x' ? "X" : "Y"), "deg/s", "rad/s",
                           degree, 0.002, 0.015, 250.0 * degree / 32768.0, 250.0 * degree, false});
  }
  const std::array<std::array<const char*, 2>, 4> corners = {
      {{"front_left", "FL"}, {"front_right", "FR"}, {"rear_left", "RL"}, {"rear_right", "RR"}}};
  for (const auto& [name, mark] : corners) {
    kit.sensors.push_back({std::string(name) + "_suspension_deflection",
                           std::string("RideHeight_") + mark, "mm", "m", 1e-3, 3e-4, 2e-3, 5e-5,
                           0.15, false});
    kit.sensors.push_back(make_accelerometer(std::string(name) + "_wheel_acceleration_z",
                                             std::string("Hub_") + mark, 0.2, 0.5, 50.0 * kG));
  }
  const Bump low{BumpForm::kArc, 0.05, 0.4, 0.0}, middle{BumpForm::kCosine, 0.08, 0.9, 0.0},
      high{BumpForm::kHalfSine, 0.10, 3.7, 0.0};
  kit.runs = {make_crossing("low_12", true, low, 0, 12.0),
              make_crossing("middle_20", true, middle, 1, 20.0),
              make_crossing("middle_30", true, middle, 1, 30.0),
              make_crossing("high_30", true, high, 2, 30.0),
              make_crossing("left_15", true, middle, 1, 15.0)};
  kit.runs.back().one_sided = true;
  RunPlan flat = make_crossing("flat_20", true, {}, 0, 20.0);
  flat.excitation = Excitation::kFlat;
  flat.duration = 10.0;
  kit.runs.push_back(flat);
  kit.runs.push_back(make_crossing("middle_22", false, middle, 1, 22.0));
  kit.runs.push_back(make_crossing("low_14", false, low, 0, 14.0));
  kit.runs.push_back(make_crossing("high_24", false, high, 2, 24.0));
  return kit;
}

Kit make_quarter_car_kit() {
  Kit kit;
  kit.kind = KitKind::kQuarterCar;
  kit.name = "quarter_car";
  kit.bit = kInQuarterCar;
  kit.parameters = {{"sprung_mass", "kg", 2.45, 0.99, 1.01, 5e-3, false},
                    {"unsprung_mass", "kg", 1.0, 0.8, 1.2, 0.0, false},
                    {"stiffness", "N/m", 900.0, 0.75, 1.25, 0.0, false},
                    {"damping", "N s/m", 7.5, 0.7, 1.4, 0.0, false},
                    {"tire_stiffness", "N/m", 1250.0, 0.75, 1.25, 0.0, false},
                    {"tire_damping", "N s/m", 5.0, 0.7, 1.4, 0.0, false}};
  // Encoders, zeroed at rest; the plate's has twice the counts.
  const double count = 2e-5;  // m
  kit.sensors = {
      {"road_position", "z_plate", "mm", "m", 1e-3, 0.5 * count, 0.0, 0.5 * count, 1.0, true},
      {"unsprung_position", "z_wheel", "mm", "m", 1e-3, count, 0.0, count, 1.0, false},
      {"sprung_position", "z_body", "mm", "m", 1e-3, count, 0.0, count, 1.0, false}};
  kit.runs = {make_rig_run("chirp_A", true, Excitation::kChirp, 20.0, 1.5e-3, 1.0, 9.0),
              make_rig_run("step_A", true, Excitation::kStep, 10.0, 8e-3, 0.3, 0.0),
              make_rig_run("rough_A", true, Excitation::kRough, 12.0, 4e-3, 0.3, 20.0),
              make_rig_run("chirp_B", false, Excitation::kChirp, 15.0, 2.5e-3, 1.2, 7.0),
              make_rig_run("rough_B", false, Excitation::kRough, 10.0, 3e-3, 0.3, 20.0)};
  return kit;
}

Kit make_dyno_kit() {
  Kit kit;
  kit.kind = KitKind::kDyno;
  kit.name = "dyno";
  kit.bit = kInDyno;
  kit.parameters = {{"stiffness", "N/m", 24000.0, 0.8, 1.1, 0.0, false},
                    {"damping", "N s/m", 1700.0, 0.6, 1.2, 0.0, false}};
  kit.sensors = {{"displacement", "stroke", "mm", "m", 1e-3, 2e-6, 0.0, 1e-6, 1.0, true},
                 {"force", "load_cell", "kN", "N", 1e3, 4.0, 0.0, 0.5, 2e4, false}};
  kit.runs = {make_rig_run("slow", true, Excitation::kSine, 8.0, 0.03, 0.5, 0.0),
              make_rig_run("medium", true, Excitation::kSine, 6.0, 0.03, 1.5, 0.0),
              make_rig_run("fast", true, Excitation::kSine, 4.0, 0.03, 4.0, 0.0),
              make_rig_run("between", false, Excitation::kSine, 5.0, 0.03, 2.5, 0.0),
              make_rig_run("short", false, Excitation::kSine, 5.0, 0.015, 3.0, 0.0)};
  return kit;
}

Kit make_disc_kit() {
  Kit kit = make_car_kit();
  kit.name = "car_disc";
  kit.contact = Contact::kDisc;
  return kit;
}

Kit make_exact_kit(const std::string& name) {
  if (name == "car") return make_car_kit();
  if (name == "car_disc") return make_disc_kit();
  if (name == "quarter_car") return make_quarter_car_kit();
  if (name == "dyno") return make_dyno_kit();
  throw std::invalid_argument("kit '" + name + "': must be car, car_disc, quarter_car or dyno");
}

}  // namespace

Kit make_kit(const std::string& name, Regime regime) {
  Kit kit = make_exact_kit(name);
  kit.regime = regime;
  if (regime == Regime::kExact) return kit;
  for (Sensor& sensor : kit.sensors) {
    sensor.gain = 1e-3;
    sensor.skew = 2e-5;
    sensor.drift = 0.3;
    sensor.hum = 0.2;
  }
  return kit;
}

}  // namespace strut::hidden
