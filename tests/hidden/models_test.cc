// The generator's equations against closed forms, its integrator against itself.
#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <vector>

#include "tests/hidden/car.h"
#include "tests/hidden/dormand_prince.h"
#include "tests/hidden/faults.h"
#include "tests/hidden/rigs.h"
#include "tests/hidden/road.h"
#include "tests/support/tolerance.h"

namespace strut::hidden {
namespace {

using test::tolerance;

constexpr double kTwoPi = 6.28318530717958647692;

std::vector<double> make_times(double begin, double end, double step) {
  std::vector<double> times;
  const int count = static_cast<int>(std::lround((end - begin) / step));
  for (int i = 0; i <= count; ++i) times.push_back(begin + step * i);
  return times;
}

RoadMotion make_sine(double amplitude, double rate) {
  return {[=](double t) { return amplitude * std::sin(rate * t); },
          [=](double t) { return amplitude * rate * std::cos(rate * t); }};
}

QuarterCar make_rig() {
  QuarterCar car;
  car.strut.stiffness = 900.0;
  car.strut.damping = 7.5;
  return car;
}

/// Largest difference of the sprung mass between two sequences of samples [m].
double calc_distance(const std::vector<QuarterCarSample>& a,
                     const std::vector<QuarterCarSample>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::fabs(a[i].sprung - b[i].sprung));
  }
  return largest;
}

}  // namespace

TEST_CASE("Hidden data: a disc touches the nearest point of the bare road", "[unit]") {
  const double radius = 0.32;
  const Curve smooth = make_bare_bump({BumpForm::kCosine, 0.08, 0.9, 0.0});
  const Track gentle{&smooth, 2.0, nullptr};
  for (const double u : {-0.3, -0.1, 0.2}) {
    const double z = 0.04 * (1.0 + std::cos(kTwoPi * u / 0.9));
    const double slope = -0.04 * kTwoPi / 0.9 * std::sin(kTwoPi * u / 0.9);
    const double root = std::hypot(1.0, slope), distance = 0.31;
    const Support support = gentle.find_support(Contact::kDisc, 2.0 + u - distance * slope / root,
                                                z + distance / root, radius);
    CHECK(support.distance == Approx(distance).margin(tolerance(1e-6)));
    CHECK(support.slope == Approx(slope).margin(tolerance(1e-4)));
  }
  // Before the foot of an arc a wheel has two nearest points: on level ground and on the arc,
  // whose center is 0.425 - 0.05 m below ground.
  const Curve arc = make_bare_bump({BumpForm::kArc, 0.05, 0.4, 0.0});
  const Track steep{&arc, 0.0, nullptr};
  for (const double x : {-0.30, -0.24, -0.15}) {
    const double to_arc = std::hypot(x, 0.31 + 0.375) - 0.425;
    const Support support = steep.find_support(Contact::kDisc, x, 0.31, radius);
    CHECK(support.distance == Approx(std::min(0.31, to_arc)).margin(tolerance(1e-4)));
    CHECK((support.slope > 0.0) == (to_arc < 0.31));
  }
  const Support level = gentle.find_support(Contact::kFelt, 0.0, 0.31, radius);
  CHECK(level.distance == Approx(0.31).margin(tolerance(1e-12)));
  CHECK(gentle.find_support(Contact::kDisc, 0.0, 0.31, radius).distance ==
        Approx(0.31).margin(tolerance(1e-12)));
}

TEST_CASE("Hidden data: the integrator follows an oscillator, between its steps too", "[unit]") {
  const auto rates = [](double, const std::vector<double>& y, std::vector<double>& dy) {
    dy[0] = y[1];
    dy[1] = -y[0];
  };
  for (const double wanted : {1e-6, 1e-9}) {
    DormandPrinceOptions options;
    options.tolerance = wanted;
    options.largest_step = 1.0;
    double worst = 0.0;
    integrate_dormand_prince(rates, {0.0, 1.0}, make_times(0.0, 20.0, 0.01), options,
                             [&](std::size_t, double t, const std::vector<double>& y) {
                               worst = std::max(worst, std::fabs(y[0] - std::sin(t)));
                             });
    // The local error is held; some tens of steps add up.
    CHECK(worst < tolerance(100.0 * wanted));
  }
}

TEST_CASE("Hidden data: the integrator finds kinks", "[unit]") {
  // y' = 1 before t = 1/3, -2 after it: y(1) = 1/3 - 4/3.
  DormandPrinceOptions options;
  options.largest_step = 0.2;
  double last = 0.0;
  integrate_dormand_prince([](double t, const std::vector<double>&,
                              std::vector<double>& dy) { dy[0] = t < 1.0 / 3.0 ? 1.0 : -2.0; },
                           {0.0}, {0.0, 1.0}, options,
                           [&](std::size_t, double, const std::vector<double>& y) { last = y[0]; });
  CHECK(last == Approx(-1.0).margin(tolerance(1e-7)));
}

TEST_CASE("Hidden data: a shaken quarter car follows its transfer functions", "[reference]") {
  const QuarterCar car = make_rig();
  for (const double frequency : {2.0, 5.0, 9.0}) {
    const double w = kTwoPi * frequency;
    const std::complex<double> s(0.0, w);
    const auto strut = car.strut.stiffness + s * car.strut.damping;
    const auto tire = car.tire_stiffness + s * car.tire_damping;
    const auto sprung = strut / (car.sprung_mass * s * s + strut);
    const auto unsprung = tire / (car.unsprung_mass * s * s + tire + strut * (1.0 - sprung));
    const std::complex<double> body = sprung * unsprung;
    const auto samples = simulate_quarter_car(car, make_sine(1e-3, w), make_times(0.0, 40.0, 0.01));
    // 40 s after the start the free motion has decayed to e^-25.
    for (std::size_t i = 3900; i < samples.size(); ++i) {
      const double expected =
          std::imag(1e-3 * body * std::exp(s * (0.01 * static_cast<double>(i))));
      REQUIRE(samples[i].sprung == Approx(expected).margin(tolerance(1e-8)));
    }
  }
}

TEST_CASE("Hidden data: without dampers a quarter car keeps its energy", "[property]") {
  QuarterCar car = make_rig();
  car.strut.damping = car.tire_damping = 0.0;
  const double rate = kTwoPi * 3.0;
  // The road stops at t = 1 s where it stands still.
  const RoadMotion road = {
      [=](double t) { return 1e-3 * (t < 1.0 ? 1.0 - std::cos(rate * t) : 0.0); },
      [=](double t) { return t < 1.0 ? 1e-3 * rate * std::sin(rate * t) : 0.0; }};
  const auto samples = simulate_quarter_car(car, road, make_times(0.0, 6.0, 0.01), 1e-10);
  const double energy = calc_quarter_car_energy(car, samples[110]);
  REQUIRE(energy > 1e-5);
  for (std::size_t i = 110; i < samples.size(); ++i) {
    REQUIRE(calc_quarter_car_energy(car, samples[i]) == Approx(energy).epsilon(tolerance(1e-6)));
  }
}

TEST_CASE("Hidden data: every faulty strut keeps within the tolerance of a finer integration",
          "[property]") {
  const auto shake = [](const StrutFaults& faults, double wanted) {
    QuarterCar car = make_rig();
    car.strut.scale = {0.012, 0.15, 15.0, 8000.0, 1e-4, 15.0, 0.05, 0.006};
    car.strut.faults = faults;
    return simulate_quarter_car(car, make_sine(4e-3, kTwoPi * 3.0), make_times(0.0, 3.0, 0.01),
                                wanted);
  };
  const auto check = [&](const char* name, const StrutFaults& faults) {
    INFO(name);
    // Kinks cost accuracy: 0.2 micrometers of 10 mm, a hundredth of the sensor's noise.
    CHECK(calc_distance(shake(faults, 1e-8), shake(faults, 1e-10)) < tolerance(2e-7));
    CHECK(calc_distance(shake(faults, 1e-8), shake({}, 1e-8)) > 2e-5);
  };
  check("asymmetry", {.asymmetry = 0.3});
  check("knee", {.knee_loss = 0.4});
  check("leak", {.leak = 1e-3});
  check("friction", {.friction = 0.5});
  check("hardening", {.hardening = 0.5});
  check("stop", {.stop = 0.5});
  check("mount", {.mount = 1.0});
  check("lag", {.gas_lag = 5e-3});
  check("selective", {.selective = 0.4});
  check("side friction", {.side_friction = 2.0});
  check("inerter", {.inerter = 0.1});
  check("play", {.play = 5e-4});
  check("gas", {.gas = 0.3});
}

TEST_CASE("Hidden data: friction, knee, asymmetry and stop have the forces they promise",
          "[unit]") {
  StrutLaw law;
  law.stiffness = 0.0;
  law.damping = 1000.0;
  law.faults.asymmetry = 0.3;
  CHECK(calc_damper_force(law, 0.5) == Approx(350.0).epsilon(tolerance(1e-12)));
  CHECK(calc_damper_force(law, -0.5) == Approx(-650.0).epsilon(tolerance(1e-12)));
  law.faults = {.knee_loss = 0.4};
  CHECK(calc_damper_force(law, 0.15) == Approx(150.0).epsilon(tolerance(1e-12)));
  CHECK(calc_damper_force(law, 1.15) == Approx(150.0 + 600.0).epsilon(tolerance(1e-12)));
  law.faults = {.stop = 1.0};
  CHECK(calc_stop_force(law, 0.024, 0.0) == 0.0);
  CHECK(calc_stop_force(law, 0.025 + 0.5 * 0.06, 0.0) == Approx(4500.0).epsilon(tolerance(1e-12)));
  // LuGre in steady sliding, far above Stribeck's speed: the sliding force against the motion.
  law.faults = {.friction = 80.0};
  law.damping = 0.0;
  const auto drive = RoadMotion{[](double t) { return 0.8 * t; }, [](double) { return 0.8; }};
  CHECK(simulate_strut(law, drive, make_times(0.0, 0.1, 0.01)).back() ==
        Approx(80.0).epsilon(tolerance(1e-6)));
}

/// At 0.8 m/s one way for 0.1 s, then back.
RoadMotion make_reversal() {
  return {[](double t) { return 0.8 * std::fmin(t, 0.2 - t); },
          [](double t) { return t < 0.1 ? 0.8 : -0.8; }};
}

TEST_CASE("Hidden data: a leaking damper is idle for its stroke after each reversal", "[unit]") {
  StrutLaw law;
  law.damping = 1000.0;
  law.faults.leak = 4e-3;
  // At constant speed the stroke is used up after 5 ms, in either direction.
  const auto force = simulate_strut(law, make_reversal(), make_times(0.0, 0.2, 1e-3));
  CHECK(force[3] == Approx(0.0).margin(tolerance(1e-9)));
  CHECK(force[50] == Approx(800.0).epsilon(tolerance(1e-6)));
  CHECK(force[103] == Approx(0.0).margin(tolerance(1e-9)));
  CHECK(force[150] == Approx(-800.0).epsilon(tolerance(1e-6)));
}

TEST_CASE("Hidden data: behind a worn joint the damper stands while the rod crosses the gap",
          "[unit]") {
  StrutLaw law;
  law.damping = 1000.0;
  law.faults.play = 4e-3;
  // From the middle of the gap half of it, after the reversal all of it; then metal, which yields
  // by less than 800 N over 3e6 N/m and gives the joint another 0.5 ms.
  const auto force = simulate_strut(law, make_reversal(), make_times(0.0, 0.2, 1e-3));
  CHECK(force[2] == Approx(0.0).margin(tolerance(1e-9)));
  CHECK(force[50] == Approx(800.0).epsilon(tolerance(1e-6)));
  CHECK(force[104] == Approx(0.0).margin(tolerance(1e-9)));
  CHECK(force[150] == Approx(-800.0).epsilon(tolerance(1e-6)));
}

TEST_CASE("Hidden data: compressed gas is stiffer than drawn-out gas and nothing at rest",
          "[unit]") {
  StrutLaw law;
  law.faults.gas = 0.1;
  CHECK(calc_gas_force(law, 0.0) == 0.0);
  // 200 N at rest, a column of 0.24 m, halved.
  CHECK(calc_gas_force(law, 0.12) ==
        Approx(200.0 * (std::pow(2.0, 1.35) - 1.0)).epsilon(tolerance(1e-12)));
  CHECK(calc_gas_force(law, 0.03) > -calc_gas_force(law, -0.03));
}

TEST_CASE("Hidden data: a leaning sensor reads gravity forward", "[unit]") {
  Car car = make_nominal_car();
  const CarModel straight(car);
  apply({Fault::kImuPosition, 0, 0.1, 0.0}, car);
  const CarModel leaning(car);
  const Drive flat;
  const auto before = straight.calc_sample(flat, straight.make_start(0.0, 0.0)).imu_acceleration;
  const auto after = leaning.calc_sample(flat, leaning.make_start(0.0, 0.0)).imu_acceleration;
  // 0.02 rad nose down: the x axis looks down, and reads less of the acceleration upward.
  CHECK(after.x() - before.x() == Approx(-9.81 * std::sin(0.02)).epsilon(tolerance(1e-3)));
  CHECK(after.norm() == Approx(before.norm()).epsilon(tolerance(1e-12)));
}

TEST_CASE("Hidden data: the car at rest carries its weight where statics say", "[reference]") {
  Car car = make_nominal_car();
  car.payload = 80.0;
  const CarModel model(car);
  const Drive flat;
  const CarSample s = model.calc_sample(flat, model.make_start(0.0, 0.0));
  const double wheelbase = 2.6;
  const double all = (car.mass + car.payload) * 9.81;
  // The body pitches by some mrad, nose up (< 0), which moves its weight over
  // the wheels' centers rearwards.
  const double rear = (car.mass * 1.15 + car.payload * (1.15 + 0.9)) * 9.81 / wheelbase -
                      all * -car.wheel[0].position.z() * s.pitch / wheelbase;
  CHECK(s.pitch < 0.0);
  CHECK(s.load[2] + s.load[3] == Approx(rear).epsilon(tolerance(2e-4)));
  CHECK(s.load[0] + s.load[1] == Approx(all - rear).epsilon(tolerance(2e-4)));
  CHECK(s.load[0] == Approx(s.load[1]).epsilon(tolerance(1e-9)));
  CHECK(s.imu_acceleration.z() == Approx(9.81).epsilon(tolerance(1e-4)));
}

TEST_CASE("Hidden data: the car's heave and pitch frequencies are the textbook's", "[reference]") {
  const Car car = make_nominal_car();
  const CarModel model(car);
  const std::vector<double> start = model.make_start(0.0, 0.0);
  // Unknowns: height, pitch, travels of the front and of the rear wheels; nothing rolls.
  using Matrix = Eigen::Matrix4d;
  const auto calc = [&](int which, double step) {
    std::vector<double> y = start, dy(y.size());
    if (which == 0) y[CarState::kPosition + 2] += step;
    if (which == 1) y[CarState::kQuaternion + 2] += 0.5 * step;
    for (int side = 0; side < 2 && which > 1; ++side) {
      const int travel = CarState::kTravel + 2 * (which - 2) + side;
      y[static_cast<std::size_t>(travel)] += step;
    }
    model.calc_rates(Drive{}, y, dy);
    return Eigen::Vector4d(dy[CarState::kVelocity + 2], dy[CarState::kRate + 1],
                           dy[CarState::kTravelRate], dy[CarState::kTravelRate + 2]);
  };
  Matrix measured;
  for (int i = 0; i < 4; ++i) measured.col(i) = (calc(i, 1e-6) - calc(i, -1e-6)) / 2e-6;
  // Textbook: wheel heights z_i = z - x_i pitch + q_i on tires, q_i on struts.
  Matrix mass = Matrix::Zero(), stiffness = Matrix::Zero();
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  double wheels = 0.0, own_inertia = 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const Wheel& w = car.wheel[i];
    const double x = w.position.x(), z = w.position.z();
    wheels += w.mass;
    first += w.mass * w.position;
    own_inertia += w.mass * (x * x + z * z) + w.spin_inertia;
    Eigen::Vector4d height(1.0, -x, 0.0, 0.0);
    height[i < 2 ? 2 : 3] = 1.0;
    mass += w.mass * height * height.transpose();
    mass(1, 1) += w.mass * z * z;
    stiffness += w.tire.stiffness * height * height.transpose();
    stiffness(i < 2 ? 2 : 3, i < 2 ? 2 : 3) += w.strut.stiffness;
  }
  mass(0, 0) += car.mass - wheels;
  mass(1, 1) += car.inertia.y() - own_inertia;
  mass(0, 1) += first.x();
  mass(1, 0) += first.x();
  // Gravity and the tires' loads at their arms shift pitch by less than a percent.
  Eigen::VectorXd own = (-measured).eval().eigenvalues().real();
  Eigen::VectorXd textbook = mass.llt().solve(stiffness).eval().eigenvalues().real();
  std::sort(own.data(), own.data() + 4);
  std::sort(textbook.data(), textbook.data() + 4);
  for (int i = 0; i < 4; ++i) {
    CHECK(own[i] == Approx(textbook[i]).epsilon(tolerance(i < 2 ? 0.02 : 1e-3)));
  }
  CHECK(std::sqrt(textbook[0]) / kTwoPi == Approx(1.3).epsilon(tolerance(0.15)));  // a car's heave
}

TEST_CASE("Hidden data: a car in the air keeps its energy", "[property]") {
  Car car = make_nominal_car();
  for (Wheel& w : car.wheel) w.strut.damping = 0.0;
  const CarModel model(car);
  std::vector<double> y = model.make_start(0.0, 0.0);
  y[CarState::kPosition + 2] += 5.0;
  const std::array<double, 6> twist = {3.0, -0.5, 1.0, 0.9, -0.7, 0.5};
  for (std::size_t i = 0; i < 6; ++i) y[CarState::kVelocity + i] = twist[i];
  for (std::size_t i = 0; i < kWheels; ++i) {
    y[CarState::kTravelRate + i] = 0.3 - 0.2 * static_cast<double>(i);
    y[CarState::kSpin + i] = 20.0;
  }
  const double energy = model.calc_energy(y);
  DormandPrinceOptions options;
  options.tolerance = 1e-11;
  integrate_dormand_prince(
      [&](double, const std::vector<double>& at, std::vector<double>& dy) {
        model.calc_rates(Drive{}, at, dy);
      },
      y, make_times(0.0, 0.5, 0.1), options,
      [&](std::size_t, double, const std::vector<double>& at) {
        CHECK(model.calc_energy(at) == Approx(energy).epsilon(tolerance(1e-9)));
      });
}

TEST_CASE("Hidden data: spinning wheels turn a rolling car by their momentum", "[reference]") {
  const Car car = make_nominal_car();
  const CarModel model(car);
  std::vector<double> y = model.make_start(0.0, 0.0), still(y.size()), spinning(y.size());
  y[CarState::kPosition + 2] += 5.0;
  const double roll_rate = 0.3, spin = 50.0;
  y[CarState::kRate] = roll_rate;
  model.calc_rates(Drive{}, y, still);
  for (std::size_t i = 0; i < kWheels; ++i) y[CarState::kSpin + i] = spin;
  model.calc_rates(Drive{}, y, spinning);
  // I_zz dw_z/dt = -w_x h, the momentum h of four wheels pointing left.
  const double expected = -roll_rate * 4.0 * car.wheel[0].spin_inertia * spin / car.inertia.z();
  CHECK(spinning[CarState::kRate + 2] - still[CarState::kRate + 2] ==
        Approx(expected).epsilon(tolerance(1e-9)));
}

}  // namespace strut::hidden
