#include "tests/hidden/simulate_kit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace strut::hidden {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kKmh = 1.0 / 3.6;
constexpr double kPreroll = 1.5;       // s of road before a recording, which starts in mid-drive
constexpr double kRoomToShift = 0.05;  // s

std::vector<double> make_grid(double begin, double end, double rate) {
  const auto count = static_cast<std::size_t>(std::lround((end - begin) * rate)) + 1;
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = begin + static_cast<double>(i) / rate;
  return times;
}

/// An adjustment of a run; 0 where there is none.
double get_adjustment(const std::vector<double>& of_runs, std::size_t run) {
  return of_runs.empty() ? 0.0 : of_runs[run];
}

double find_factor(const Kit& kit, const Truth& truth, const std::string& name) {
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    if (kit.parameters[i].name == name) return truth.factors[i];
  }
  return 1.0;
}

// --- the car ------------------------------------------------------------------------------------

double find_magnitude(const Truth& truth, Fault fault) {
  for (const FaultSetting& s : truth.faults) {
    if (s.fault == fault) return s.magnitude;
  }
  return 0.0;
}

/// A bump as tires meet it.
Curve make_bump(const Kit& kit, const Bump& bump, double radius) {
  return kit.contact == Contact::kDisc ? make_bare_bump(bump)
                                       : make_felt_bump(bump, radius, kFootprint);
}

/// The bump of a run as built, as tires meet it.
Curve make_true_bump(const Kit& kit, const Truth& truth, const RunPlan& run, double radius) {
  Bump bump = run.bump;
  const std::string number = std::to_string(run.bump_number);
  bump.height *= find_factor(kit, truth, "bump_height" + number) *
                 (1.0 + find_magnitude(truth, Fault::kBumpHeight));
  const double stretch = find_factor(kit, truth, "bump_length" + number) *
                         (1.0 + find_magnitude(truth, Fault::kBumpLength));
  bump.length *= stretch;
  bump.ramp *= stretch;
  Curve met = make_bump(kit, bump, radius);
  for (const Fault fault : {Fault::kParabola, Fault::kTruncatedRamp}) {
    const double share = find_magnitude(truth, fault);
    if (share == 0.0) continue;
    Bump other = bump;
    other.form = fault == Fault::kParabola ? BumpForm::kParabola : BumpForm::kTruncated;
    const Curve otherwise = make_bump(kit, other, radius);
    for (std::size_t i = 0; i < met.height.size(); ++i) {
      met.height[i] += share * (otherwise.height[i] - met.height[i]);
    }
    met = make_curve(met.begin, met.spacing, met.height);
  }
  const double spread = find_magnitude(truth, Fault::kCams);
  return spread > 0.0 ? spread_cams(met, spread) : met;
}

/// Takes from a warming damper's rate what it has lost by this run: it falls evenly from the first
/// run to the last. Other faults take nothing.
void warm(const Kit& kit, const FaultSetting& s, std::size_t run, StrutLaw& law) {
  if (s.fault != Fault::kWarming) return;
  const double last = static_cast<double>(kit.runs.size()) - 1.0;
  law.damping *= 1.0 - s.magnitude * static_cast<double>(run) / last;
}

/// A speedometer that is right at a standstill and wrong in proportion to the speed: relative
/// error.
double calc_speed_error(const FaultSetting& setting, double speed) {
  return setting.fault == Fault::kSpeedometer ? setting.magnitude * speed / (20.0 * kKmh) : 0.0;
}

void scale_forces(Car& car, double scale) {
  car.mass *= scale;
  car.inertia *= scale;
  for (Wheel& w : car.wheel) {
    for (double* value : {&w.mass, &w.transverse_inertia, &w.spin_inertia, &w.tire.stiffness,
                          &w.tire.damping, &w.strut.stiffness, &w.strut.damping}) {
      *value *= scale;
    }
  }
}

std::vector<double> select_channel(const std::vector<CarSample>& samples, const std::string& name) {
  static const std::vector<std::string> corners = {"front_left_", "front_right_", "rear_left_",
                                                   "rear_right_"};
  std::size_t corner = kWheels;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (name.rfind(corners[i], 0) == 0) corner = i;
  }
  std::vector<double> values;
  values.reserve(samples.size());
  for (const CarSample& s : samples) {
    if (corner < kWheels) {
      const bool deflection = name.find("deflection") != std::string::npos;
      values.push_back(deflection ? s.deflection[corner] : s.wheel_acceleration[corner]);
    } else {
      const Eigen::Vector3d& v =
          name.find("rate") != std::string::npos ? s.imu_rate : s.imu_acceleration;
      values.push_back(name.back() == 'x' ? v.x() : name.back() == 'y' ? v.y() : v.z());
    }
  }
  return values;
}

std::vector<Signal> simulate_car_run(const Kit& kit, const Truth& truth, std::size_t number,
                                     double rate, double margin) {
  const RunPlan& run = kit.runs[number];
  Car car = make_car(kit, truth);
  for (const FaultSetting& s : truth.faults) {
    for (std::size_t i = 0; i < kWheels; ++i) {
      if (static_cast<int>(i / 2) == s.place) warm(kit, s, number, car.wheel[i].strut);
    }
  }
  const CarModel model(car);
  const double front = car.wheel[0].position.x(), rear = car.wheel[2].position.x();
  Drive drive;
  drive.contact = kit.contact;
  const double laid_at = run.speed * (1.0 + truth.speed_error[number]);
  drive.speed = laid_at * (1.0 + get_adjustment(truth.speed_change, number));
  for (const FaultSetting& s : truth.faults) {
    drive.speed += run.speed * calc_speed_error(s, run.speed);
  }
  Curve bump;
  if (run.excitation == Excitation::kBump) {
    bump = make_true_bump(kit, truth, run, car.wheel[0].tire.radius);
    for (std::size_t i = 0; i < kWheels; ++i) {
      if (run.one_sided && i % 2 == 1) continue;
      drive.track[i].bump = &bump;
      drive.track[i].bump_center = front + run.distance;
    }
  }
  RoughTracks rough;
  const bool is_rough = truth.roughness > 0.0;
  const double before = is_rough ? kPreroll + margin : margin;
  if (is_rough) {
    // The road does not depend on what a fit adjusts.
    const double begin = rear - 1.0 - laid_at * before;
    const double length = laid_at * (run.duration + before + margin) + front - rear + 10.0;
    Roughness roughness;
    roughness.degree = truth.roughness;
    rough = make_rough_tracks(roughness, begin, length, get_footprint(kit),
                              truth.seed + 1000003 * number);
    for (std::size_t i = 0; i < kWheels; ++i) {
      drive.track[i].rough = i % 2 == 0 ? &rough.left : &rough.right;
    }
  }
  const std::vector<double> times = make_grid(-margin, run.duration + margin, rate);
  std::vector<double> all = times;
  for (double& t : all) t += get_adjustment(truth.time_shift, number);
  all.insert(all.begin(), -before - kRoomToShift);
  std::vector<CarSample> samples =
      simulate_car(model, drive, model.make_start(drive.speed, drive.speed * all.front()), all);
  samples.erase(samples.begin());
  std::vector<Signal> signals;
  for (const Sensor& sensor : kit.sensors) {
    signals.push_back({times.front(), 1.0 / rate, select_channel(samples, sensor.channel)});
  }
  return signals;
}

// --- stands -------------------------------------------------------------------------------------

/// Position and velocity of the plate or crank over time; at rest before t = 0.
RoadMotion make_drive(const RunPlan& run, const Truth& truth, std::size_t number) {
  const double a = run.amplitude, w = kTwoPi * run.low_frequency;
  if (run.excitation == Excitation::kSine) {
    // The crank starts over one second.
    const auto ramp = [](double t) { return t < 1.0 ? t * t * (3.0 - 2.0 * t) : 1.0; };
    const auto rise = [](double t) { return t < 1.0 ? 6.0 * t * (1.0 - t) : 0.0; };
    return {[=](double t) { return t <= 0.0 ? 0.0 : a * ramp(t) * std::sin(w * t); },
            [=](double t) {
              return t <= 0.0 ? 0.0
                              : a * (rise(t) * std::sin(w * t) + w * ramp(t) * std::cos(w * t));
            }};
  }
  if (run.excitation == Excitation::kChirp) {
    const double sweep = kTwoPi * (run.high_frequency - run.low_frequency) / run.duration;
    const auto phase = [=](double t) { return w * t + 0.5 * sweep * t * t; };
    return {[=](double t) { return t <= 0.0 ? 0.0 : a * std::sin(phase(t)); },
            [=](double t) { return t <= 0.0 ? 0.0 : a * (w + sweep * t) * std::cos(phase(t)); }};
  }
  if (run.excitation == Excitation::kStep) {
    // A square wave whose flanks take 40 ms, as a motor's stage does.
    const double period = 1.0 / run.low_frequency, flank = 0.04;
    const auto place = [=](double t) {
      return t / (0.5 * period) - std::floor(t / (0.5 * period));
    };
    const auto sign = [=](double t) {
      return std::fmod(std::floor(t / (0.5 * period)), 2.0) < 0.5 ? 1.0 : -1.0;
    };
    return {[=](double t) {
              if (t <= 0.5) return 0.0;
              const double s = std::min(place(t - 0.5) * 0.5 * period / flank, 1.0);
              const double shape = 0.5 * (1.0 - std::cos(0.5 * kTwoPi * s));
              const double from = t - 0.5 < 0.5 * period ? 0.0 : -sign(t - 0.5) * a;
              return from + (sign(t - 0.5) * a - from) * shape;
            },
            [=](double t) {
              if (t <= 0.5) return 0.0;
              const double s = place(t - 0.5) * 0.5 * period / flank;
              if (s >= 1.0) return 0.0;
              const double from = t - 0.5 < 0.5 * period ? 0.0 : -sign(t - 0.5) * a;
              return (sign(t - 0.5) * a - from) * 0.25 * kTwoPi / flank *
                     std::sin(0.5 * kTwoPi * s);
            }};
  }
  // ISO roughness at 10 m/s, scaled so that its standard deviation is the amplitude.
  Roughness roughness;
  roughness.lowest = run.low_frequency / 10.0;
  roughness.highest = run.high_frequency / 10.0;
  const double variance =
      roughness.degree * 0.01 * (1.0 / roughness.lowest - 1.0 / roughness.highest);
  roughness.degree *= a * a / variance;
  const Curve track = make_rough_tracks(roughness, -1.0, 10.0 * (run.duration + 2.0), 0.0,
                                        truth.seed + 1000003 * number)
                          .left;
  const auto window = [](double t) { return std::clamp(t, 0.0, 1.0); };
  return {[=](double t) {
            double z = 0.0, slope = 0.0;
            track.evaluate(10.0 * t, z, slope);
            return std::pow(window(t), 2) * (3.0 - 2.0 * window(t)) * z;
          },
          [=](double t) {
            double z = 0.0, slope = 0.0;
            track.evaluate(10.0 * t, z, slope);
            const double s = window(t);
            return s * s * (3.0 - 2.0 * s) * 10.0 * slope + 6.0 * s * (1.0 - s) * z;
          }};
}

const StrutScale kRigScale{0.012, 0.15, 15.0, 8000.0, 1e-4, 15.0, 0.05, 0.006};

QuarterCar make_quarter_car(const Kit& kit, const Truth& truth, std::size_t run) {
  QuarterCar car;
  const auto value = [&](std::size_t i) { return kit.parameters[i].nominal * truth.factors[i]; };
  car.sprung_mass = value(0);
  car.unsprung_mass = value(1);
  car.strut.stiffness = value(2);
  car.strut.damping = value(3);
  car.tire_stiffness = value(4);
  car.tire_damping = value(5);
  car.strut.scale = kRigScale;
  for (const FaultSetting& s : truth.faults) {
    apply(s, car);
    warm(kit, s, run, car.strut);
  }
  return car;
}

std::vector<Signal> simulate_rig_run(const Kit& kit, const Truth& truth, std::size_t number,
                                     double rate, double margin) {
  const RunPlan& run = kit.runs[number];
  // The plate moves more than its sensor reads.
  const double gain = 1.0 + find_magnitude(truth, Fault::kRoadGain);
  RunPlan moved = run;
  moved.amplitude *= gain;
  const RoadMotion drive = make_drive(moved, truth, number);
  const std::vector<double> times = make_grid(-margin, run.duration + margin, rate);
  std::vector<Signal> signals(kit.sensors.size(), {times.front(), 1.0 / rate, {}});
  if (kit.kind == KitKind::kDyno) {
    StrutLaw law;
    law.stiffness = kit.parameters[0].nominal * truth.factors[0];
    law.damping = kit.parameters[1].nominal * truth.factors[1];
    for (const FaultSetting& s : truth.faults) {
      apply(s, law);
      warm(kit, s, number, law);
    }
    signals[1].value = simulate_strut(law, drive, times);
    for (const double t : times) signals[0].value.push_back(drive.position(t));
    return signals;
  }
  for (const QuarterCarSample& s :
       simulate_quarter_car(make_quarter_car(kit, truth, number), drive, times)) {
    signals[0].value.push_back(s.road / gain);
    signals[1].value.push_back(s.unsprung);
    signals[2].value.push_back(s.sprung);
  }
  return signals;
}

}  // namespace

Truth make_nominal_truth(const Kit& kit) {
  Truth truth;
  truth.factors.assign(kit.parameters.size(), 1.0);
  truth.speed_error.assign(kit.runs.size(), 0.0);
  return truth;
}

double get_footprint(const Kit& kit) { return kit.contact == Contact::kDisc ? 0.0 : kFootprint; }

Car make_car(const Kit& kit, const Truth& truth) {
  Car car = make_nominal_car();
  car.mass *= find_factor(kit, truth, "mass");
  for (std::size_t i = 0; i < kWheels; ++i) {
    const std::string axle = i < 2 ? "front" : "rear";
    car.wheel[i].strut.stiffness *= find_factor(kit, truth, axle + "_stiffness");
    car.wheel[i].strut.damping *= find_factor(kit, truth, axle + "_damping");
  }
  scale_forces(car, truth.force_scale);
  for (const FaultSetting& s : truth.faults) apply(s, car);
  return car;
}

std::vector<Signal> simulate_run(const Kit& kit, const Truth& truth, std::size_t run, double rate,
                                 double margin) {
  std::vector<Signal> signals = kit.kind == KitKind::kCar
                                    ? simulate_car_run(kit, truth, run, rate, margin)
                                    : simulate_rig_run(kit, truth, run, rate, margin);
  for (const FaultSetting& s : truth.faults) {
    if (get_info(s.fault).where != Where::kChannel) continue;
    Signal& signal = signals[static_cast<std::size_t>(s.place)];
    signal = distort(signal, s);
  }
  add_sensor_errors(truth, signals);
  return signals;
}

void add_sensor_errors(const Truth& truth, std::vector<Signal>& signals) {
  const auto add = [&](Fault fault, const std::vector<double>& sizes) {
    for (std::size_t c = 0; c < sizes.size(); ++c) {
      if (sizes[c] != 0.0) signals[c] = distort(signals[c], {fault, 0, sizes[c], 0.0});
    }
  };
  add(Fault::kSensorGain, truth.sensor_gain);
  add(Fault::kSensorDelay, truth.sensor_skew);
}

}  // namespace strut::hidden
