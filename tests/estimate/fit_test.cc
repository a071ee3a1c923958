// Fitting the simulation: its derivatives against CVODE's, closed forms, laws of information.

#include "estimate/fit.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "estimate/nuisances.h"
#include "estimate/readings.h"
#include "estimate/sampled_curve.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using C = CarChannel;
using test::Distortion;
using test::tolerance;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Largest error of interpolating sin(t) halfway between samples.
CurvePoint calc_sine_error(double step) {
  CurvePoint worst;
  for (std::size_t i = kCurveMargin; i < 60; ++i) {
    const auto get = [&](std::size_t k) { return std::sin(static_cast<double>(k) * step); };
    const CurvePoint p = interpolate_curve(get, i, 0.5, step);
    const double t = (static_cast<double>(i) + 0.5) * step;
    worst.value = std::max(worst.value, std::abs(p.value - std::sin(t)));
    worst.slope = std::max(worst.slope, std::abs(p.slope - std::cos(t)));
  }
  return worst;
}

TEST_CASE("A sampled curve is exact for cubics, with its slope", "[unit]") {
  const double h = 0.3;
  const auto f = [](double t) { return 1.0 - 2.0 * t + 0.5 * t * t - 0.7 * t * t * t; };
  const auto get = [&](std::size_t i) { return f(static_cast<double>(i) * h); };
  for (const double theta : {0.0, 0.25, 0.8, 1.0}) {
    const double t = (4.0 + theta) * h;
    const CurvePoint p = interpolate_curve(get, 4, theta, h);
    CHECK(p.value == Approx(f(t)).epsilon(tolerance(1e-14)));
    CHECK(p.slope == Approx(-2.0 + t - 2.1 * t * t).epsilon(tolerance(1e-13)));
  }
}

TEST_CASE("Samples are interpolated up to both ends", "[unit]") {
  constexpr std::size_t kCount = 9;
  const auto f = [](double x) { return 1.0 + x * (2.0 - x * (0.5 - x * 0.1)); };
  const auto get = [&](std::size_t i) { return f(static_cast<double>(i)); };
  for (const double at : {0.0, 0.3, 1.7, 2.2, 5.9, 6.4, 7.5, 8.0}) {
    CHECK(interpolate_samples(get, kCount, at) == Approx(f(at)).epsilon(tolerance(1e-13)));
  }
  // At the ends the polynomial of degree 5 is exact where the cubic in the middle is not.
  const auto power = [](std::size_t i) { return std::pow(static_cast<double>(i), 5.0); };
  CHECK(interpolate_samples(power, kCount, 0.5) == Approx(std::pow(0.5, 5.0)));
  CHECK(interpolate_samples(power, kCount, 7.5) == Approx(std::pow(7.5, 5.0)));
  CHECK(std::abs(interpolate_samples(power, kCount, 4.5) - std::pow(4.5, 5.0)) > 0.1);
}

TEST_CASE("The error of a sampled curve falls with the fourth power of its step", "[property]") {
  const CurvePoint coarse = calc_sine_error(0.1), fine = calc_sine_error(0.05);
  CHECK(coarse.value / fine.value == Approx(16.0).epsilon(tolerance(0.05)));
  CHECK(coarse.value == Approx(std::pow(0.1, 4) / 384.0).epsilon(tolerance(0.05)));
}

TEST_CASE("A fit of readings without noise recovers the parameters", "[reference]") {
  Case truth = test::make_bump_case();
  set_parameter(truth, "speed", 20.1);
  const Distortion distortion{0.0037, 0.1, -0.01, 0.0, 1};
  const bool cvode = GENERATE(true, false);
  const std::vector<MeasuredRun> runs{
      test::measure(test::make_known_case(), truth, distortion, cvode)};
  FitOptions options;
  options.linearize.integrate.options.step.step = 0.5e-3;
  options.linearize.rate = 4000.0;
  // Too weak to bias the fit.
  std::vector<Unknown> unknowns = test::make_all_unknowns(runs);
  for (std::size_t i = 4; i < unknowns.size(); ++i) unknowns[i].prior.sigma *= 10.0;
  const FitResult fit = fit_simulation(runs, unknowns, options);
  REQUIRE(fit.converged);
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(fit.unknowns[i].name);
    // The bump's edges, rounded by RK4: measured 5e-6.
    const double expected = get_parameter(truth, fit.unknowns[i].name);
    CHECK(std::abs(fit.values[i] / expected - 1.0) < tolerance(1e-5));
  }
  CHECK(fit.values[4] == Approx(distortion.hit_time).margin(tolerance(1e-6)));
  CHECK(fit.values[5] == Approx(20.1).margin(tolerance(1e-4)));
  CHECK(fit.values[6] == Approx(distortion.acceleration_bias).margin(tolerance(1e-4)));
  CHECK(fit.values[7] == Approx(distortion.rate_bias).margin(tolerance(1e-5)));
}

/// Readings of a measurement without noise, run by CVODE: by time and channel.
std::vector<double> read_cvode(const Case& c) {
  const MeasuredRun run = test::measure(c, c, {}, true);
  std::vector<double> values;
  for (std::size_t t = 0; t < run.times.size(); ++t) {
    for (const MeasuredChannel& channel : run.channels) {
      values.push_back(channel.values[t] / channel.sigma);
    }
  }
  return values;
}

/// |a - b| / |b|
double calc_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return std::sqrt(error / size);
}

TEST_CASE("The Jacobian of a fit is that of CVODE runs", "[reference]") {
  const Case base = test::make_bump_case();
  const std::vector<MeasuredRun> runs{test::measure(base, base, {})};
  std::vector<Unknown> unknowns = test::make_suspension(runs);
  unknowns.push_back(make_parameter(runs, "speed"));
  unknowns.push_back(make_parameter(runs, "bump_height"));  // shapes the mechanism
  const auto model = make_readings(runs, unknowns, {});
  std::vector<double> values;
  values.reserve(unknowns.size());
  for (const Unknown& u : unknowns) values.push_back(u.start);
  const Linearization point = model->linearize(values);
  REQUIRE(point.failure.empty());
  const std::size_t first = model->readings().front().time;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    constexpr double kShare = 1e-5;
    std::vector<double> sides[2];
    for (const int side : {0, 1}) {
      Case c = base;
      set_parameter(c, unknowns[i].name,
                    unknowns[i].start * (1.0 + (side == 0 ? kShare : -kShare)));
      sides[side] = read_cvode(c);
    }
    std::vector<double> expected, found;
    for (std::size_t k = 0; k < model->reading_count(); ++k) {
      const std::size_t place = k + 2 * first;
      expected.push_back((sides[0][place] - sides[1][place]) / (2.0 * kShare));
      found.push_back(point.jacobian(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)));
    }
    INFO(unknowns[i].name);
    // RK4 at 1 ms rounds the edges of the bump, over which 20 m/s carries a wheel in 1/50 s.
    CHECK(calc_difference(found, expected) < tolerance(i < 4 ? 2e-3 : 1e-2));
  }
}

TEST_CASE("Hit time and bias have the derivatives of their definition", "[property]") {
  const Case base = test::make_bump_case();
  const std::vector<MeasuredRun> runs{test::measure(base, base, {})};
  const std::vector<Unknown> unknowns{make_hit_time(0, {0.0, 0.005}),
                                      make_bias(get_car_info(), 0, C::kImuRateY, {0.0, 0.02})};
  const auto model = make_readings(runs, unknowns, {});
  const double step = 1e-7;  // s
  const Linearization point = model->linearize({0.0013, 0.004});
  const Linearization later = model->linearize({0.0013 + step, 0.004});
  const Linearization earlier = model->linearize({0.0013 - step, 0.004});
  for (std::size_t k = 0; k < model->reading_count(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double slope = (later.residual(row) - earlier.residual(row)) / (2.0 * step) * 0.005;
    REQUIRE(point.jacobian(row, 0) == Approx(slope).margin(tolerance(1e-3)));
    const bool biased = model->readings()[k].channel == 1;
    REQUIRE(point.jacobian(row, 1) == Approx(biased ? 0.02 / 1e-3 : 0.0));
  }
  // Simulated time is measured time plus hit time: a clock that starts late reads small times.
  const Linearization still = model->linearize({0.0, 0.0});
  CHECK(still.residual.head(static_cast<Eigen::Index>(model->reading_count())).norm() <
        point.residual.head(static_cast<Eigen::Index>(model->reading_count())).norm());
}

TEST_CASE("A fit of a bias alone is the weighted mean", "[reference]") {
  const Case base = test::make_bump_case();
  const MeasuredRun run = test::measure(base, base, {0.0, 0.3, 0.0, 1.0, 5});
  const Prior prior{0.1, 1e-3};
  const std::vector<Unknown> unknowns{make_bias(get_car_info(), 0, C::kImuAccelerationZ, prior)};
  const FitResult fit = fit_simulation({run}, unknowns);
  REQUIRE(fit.converged);
  // Residuals without bias, by the same simulation.
  const auto model = make_readings({run}, unknowns, {});
  const Linearization point = model->linearize({0.0});
  const double sigma = run.channels[0].sigma;
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < model->reading_count(); ++k) {
    if (model->readings()[k].channel != 0) continue;
    sum -= point.residual(static_cast<Eigen::Index>(k)) * sigma;
    ++count;
  }
  const double weight = count / (sigma * sigma), own = 1.0 / (prior.sigma * prior.sigma);
  const double mean = (weight * sum / count + own * prior.mean) / (weight + own);
  CHECK(fit.values[0] == Approx(mean).epsilon(tolerance(1e-9)));
  CHECK(fit.uncertainty.sigma[0] == Approx(1.0 / std::sqrt(weight + own)).epsilon(tolerance(1e-9)));
  CHECK(fit.degrees == static_cast<long>(model->reading_count()));  // with the prior, less one
}

TEST_CASE("Bounds agree with the information matrix", "[property]") {
  const Case base = test::make_bump_case();
  const MeasuredRun run = test::measure(base, base, {});
  const std::vector<Unknown> unknowns = test::make_suspension({run});
  const Uncertainty one = calc_fit_bounds({run}, unknowns);
  SECTION("two equal runs know the car sqrt(2) times better") {
    const Uncertainty two = calc_fit_bounds({run, run}, unknowns);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(two.sigma[i] == Approx(one.sigma[i] / std::sqrt(2.0)).epsilon(tolerance(1e-9)));
    }
  }
  SECTION("noise of half the size halves them") {
    MeasuredRun quiet = run;
    for (MeasuredChannel& c : quiet.channels) c.sigma *= 0.5;
    const Uncertainty half = calc_fit_bounds({quiet}, unknowns);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(half.sigma[i] == Approx(0.5 * one.sigma[i]).epsilon(tolerance(1e-9)));
    }
  }
  SECTION("what else is not known only makes them wider") {
    const Uncertainty all = calc_fit_bounds({run}, test::make_all_unknowns({run}));
    for (std::size_t i = 0; i < 4; ++i) CHECK(all.sigma[i] > one.sigma[i]);
  }
  SECTION("a planned measurement has those of the measured one") {
    SensorNoise noise(C::kCount, 0.0);
    noise[at(C::kImuAccelerationZ)] = 0.02;
    noise[at(C::kImuRateY)] = 1e-3;
    const MeasuredRun plan = make_planned_run(base, noise, 200.0, 0.0, 1.3);
    REQUIRE(plan.times.size() == run.times.size());
    CHECK(calc_fit_bounds({plan}, unknowns).sigma[0] ==
          Approx(one.sigma[0]).epsilon(tolerance(1e-12)));
  }
}

TEST_CASE("A combination that no reading identifies is reported as a null direction",
          "[property]") {
  const Case base = test::make_bump_case();
  const MeasuredRun run = test::measure(base, base, {0.0, 0.0, 0.0, 1.0, 3});
  SECTION("a parameter without influence") {
    const FitResult fit = fit_simulation(
        {run}, {make_parameter({run}, "yaw_inertia"), make_parameter({run}, "rear_damping")});
    REQUIRE(fit.uncertainty.null_directions.size() == 1);
    CHECK(describe_direction(fit.uncertainty.null_directions[0], fit.unknowns) == "yaw_inertia");
    CHECK(fit.values[0] == fit.unknowns[0].start);
    CHECK_FALSE(fit.uncertainty.identifiable[0]);
    CHECK(fit.uncertainty.identifiable[1]);
    CHECK(fit.uncertainty.rank == 1);
    CHECK(fit.converged);
  }
  SECTION("left against right where nothing rolls") {
    const std::vector<Unknown> unknowns{make_parameter({run}, "front_left_stiffness"),
                                        make_parameter({run}, "front_right_stiffness")};
    const Uncertainty bounds = calc_fit_bounds({run}, unknowns);
    REQUIRE(bounds.null_directions.size() == 1);
    const std::vector<double>& parts = bounds.null_directions[0].parts;
    CHECK(parts[0] + parts[1] == Approx(0.0).margin(tolerance(1e-3)));
    CHECK(bounds.null_directions[0].sigma > 1.0);
  }
}

TEST_CASE("A bound holds a parameter while the others are fitted", "[property]") {
  const Case truth = test::make_bump_case();
  const std::vector<MeasuredRun> runs{test::measure(test::make_known_case(), truth, {})};
  std::vector<Unknown> unknowns = test::make_suspension(runs);
  unknowns[0].high = 39000.0;  // the truth has 40000
  const FitResult fit = fit_simulation(runs, unknowns);
  CHECK(fit.values[0] == 39000.0);
  CHECK(fit.at_bound[0]);
  CHECK_FALSE(fit.at_bound[2]);
  CHECK(fit.converged);
  CHECK(fit.chi2 > 10.0);
  unknowns[0].start = 39000.0;
  unknowns[0].high = 1e6;
  unknowns[0].low = 38000.0;
  CHECK(fit_simulation(runs, unknowns).values[0] == Approx(40000.0).epsilon(tolerance(1e-3)));
}

TEST_CASE("A fit that starts at its minimum on a bound, where chi2 falls outwards, has converged",
          "[property]") {
  const Case base = test::make_bump_case();
  MeasuredRun run = test::measure(base, base, {});
  for (double& value : run.channels[0].values) value *= 1.01;
  const int channel = run.channels[0].channel;
  const std::vector<Unknown> unknowns{
      make_sensor_unknown(UnknownKind::kSensorGain, get_car_info(), 0, channel, 1e-3),
      make_bias(get_car_info(), 0, channel, {})};
  FitOptions options;
  options.start = fit_simulation({run}, unknowns).values;
  REQUIRE(options.start[0] == unknowns[0].high);
  // Linear: no step of the bias lowers chi2 any more, and none of the gain is allowed.
  const FitResult fit = fit_simulation({run}, unknowns, options);
  CHECK(fit.converged);
  CHECK(fit.at_bound[0]);
  CHECK_FALSE(fit.at_bound[1]);
  CHECK(fit.values[1] == Approx(options.start[1]).epsilon(tolerance(1e-9)));
}

TEST_CASE("Derivatives on a bound are taken from inside", "[property]") {
  const Case base = test::make_bump_case();
  const std::vector<MeasuredRun> runs{test::measure(base, base, {})};
  const std::vector<Unknown> unknowns{make_parameter(runs, "front_damping")};
  REQUIRE(unknowns[0].low == 0.0);
  const auto model = make_readings(runs, unknowns, {});
  const Linearization on = model->linearize({0.0}), near = model->linearize({1.0});
  REQUIRE(on.failure.empty());
  // The slope changes little over 1 N s/m of 1980.
  CHECK((on.jacobian - near.jacobian).norm() < tolerance(0.02) * near.jacobian.norm());
}

TEST_CASE("A bound that the search meets on its way is released", "[property]") {
  const Case truth = test::make_bump_case();
  Case far = truth;
  const double damping = GENERATE(300.0, 8000.0);
  set_parameter(far, "front_stiffness", 20000.0);
  set_parameter(far, "front_damping", damping);
  set_parameter(far, "rear_damping", damping);
  const std::vector<MeasuredRun> runs{test::measure(far, truth, {})};
  std::vector<Unknown> unknowns = test::make_suspension(runs);
  for (Unknown& u : unknowns) {
    const double target = get_parameter(truth, u.name);
    u.low = std::min(u.start, 0.99 * target);
    u.high = std::max(u.start, 1.01 * target);
  }
  const FitResult fit = fit_simulation(runs, unknowns);
  CHECK(fit.converged);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK_FALSE(fit.at_bound[i]);
    CHECK(fit.values[i] == Approx(get_parameter(truth, unknowns[i].name)).epsilon(tolerance(3e-4)));
  }
}

TEST_CASE("A far initial guess leads to the same minimum as a near one", "[property]") {
  const Case truth = test::make_bump_case();
  Case far = truth;
  set_parameter(far, "front_stiffness", 90000.0);
  set_parameter(far, "rear_damping", 500.0);
  const std::vector<MeasuredRun> runs{test::measure(far, truth, {})};
  const FitResult fit = fit_simulation(runs, test::make_suspension(runs));
  CHECK(fit.converged);
  for (std::size_t i = 0; i < 4; ++i) {
    // At 1 ms and 2 kHz the simulation itself is off by a few hundredths of a sigma of 0.3 %.
    CHECK(fit.values[i] ==
          Approx(get_parameter(truth, fit.unknowns[i].name)).epsilon(tolerance(3e-4)));
  }
}

TEST_CASE("A clock offset longer than the bump is removed before the search", "[property]") {
  Case truth = test::make_bump_case();
  set_parameter(truth, "speed", 19.8);
  // Without other hit times the search ends in another local minimum.
  const double off = GENERATE(-0.0097, 0.09, -0.09);
  const std::vector<MeasuredRun> runs{
      test::measure(test::make_known_case(), truth, {off, 0.3, -0.02, 1.0, 2})};
  std::vector<Unknown> unknowns = test::make_suspension(runs);
  const double sigma = std::abs(off) < 0.025 ? 0.005 : 0.025;
  for (Unknown& u : make_nuisances(runs, {sigma, 0.2, {}}, unknowns)) unknowns.push_back(u);
  const FitResult fit = fit_simulation(runs, unknowns);
  CHECK(fit.converged);
  CHECK(fit.is_adequate());
  CHECK(fit.values[4] == Approx(off).margin(5.0 * fit.uncertainty.sigma[4]));
  CHECK(fit.values[0] == Approx(40000.0).margin(5.0 * fit.uncertainty.sigma[0]));
}

TEST_CASE("Clocks are aligned to the nearest trial step, for any bias", "[property]") {
  const Case base = test::make_bump_case();
  MeasuredRun run = test::measure(base, base, {0.0067, 1.0, -0.1, 1.0, 3});
  cut_window(run, 0.3, 0.5);  // ends on the first pulse, so that its mean is not that of rest
  NuisanceSigmas sigmas;
  sigmas.bias.assign(C::kCount, 0.0);
  sigmas.bias[at(C::kImuAccelerationZ)] = 1.0;
  sigmas.bias[at(C::kImuRateY)] = 0.1;
  const std::vector<Unknown> unknowns = make_nuisances({run}, sigmas);
  REQUIRE(unknowns[0].name == "hit_time");
  std::vector<double> start;
  start.reserve(unknowns.size());
  for (const Unknown& u : unknowns) start.push_back(u.start);
  const auto align = [&](const MeasuredRun& r) {
    return make_readings({r}, unknowns, {})->align(start)[0];
  };
  CHECK(align(run) == Approx(0.0067).margin(tolerance(0.51e-3)));
  // Readings without information leave the prior mean.
  for (MeasuredChannel& c : run.channels) c.sigma *= 1e6;
  CHECK(align(run) == 0.0);
}

TEST_CASE("Only readings taken during the maneuver are compared", "[unit]") {
  const Case base = test::make_bump_case();  // 1.3 s
  const MeasuredRun run = test::measure(base, base, {});
  MeasuredRun longer = run;
  for (int i = 1; i <= 1000; ++i) {
    longer.times.push_back(run.times.back() + i);
    for (MeasuredChannel& c : longer.channels) c.values.push_back(0.0);
  }
  const std::vector<Unknown> unknowns{make_parameter({run}, "front_damping")};
  const auto shorter = make_readings({run}, unknowns, {});
  const auto model = make_readings({longer}, unknowns, {});
  CHECK(model->reading_count() == shorter->reading_count());
  CHECK(model->outside_count() == shorter->outside_count() + 2000);
  // A known offset of the clock counts.
  for (double& t : longer.times) t += 100.0;
  const std::vector<Unknown> late{make_hit_time(0, {-100.0, 0.001})};
  CHECK(make_readings({longer}, late, {})->outside_count() < 2010);
  CHECK_THROWS_WITH(
      make_readings({longer}, unknowns, {}),
      Contains("truth: time runs from 100 to 1101.3 s, the maneuver from 0 to 1.3 s"));
}

TEST_CASE("An infeasible simulation is reported, not thrown, but refused as an initial guess",
          "[unit]") {
  const Case base = test::make_bump_case();
  const MeasuredRun run = test::measure(base, base, {});
  std::vector<Unknown> unknowns{make_parameter({run}, "front_stiffness")};
  const auto model = make_readings({run}, unknowns, {});
  CHECK_THAT(model->linearize({1000.0}).failure, Contains("spring"));
  unknowns[0].start = 1000.0;
  CHECK_THROWS_WITH(fit_simulation({run}, unknowns), Contains("the fit starts there"));
}

TEST_CASE("A fit has the same bits on any number of threads", "[property][threads]") {
  const Case base = test::make_known_case();
  MeasuredRun run = test::measure(base, test::make_bump_case(), {0.001, 0.0, 0.0, 1.0, 9});
  cut_window(run, 0.4, 1.0);
  FitOptions one, three;
  three.linearize.threads = 3;
  const std::vector<Unknown> unknowns = test::make_all_unknowns({run});
  const FitResult a = fit_simulation({run}, unknowns, one);
  const FitResult b = fit_simulation({run}, unknowns, three);
  CHECK(a.values == b.values);
  CHECK(a.uncertainty.sigma == b.uncertainty.sigma);
}

TEST_CASE("The neighbor correlation shows residuals that are not white", "[property]") {
  const Case base = test::make_bump_case();
  const MeasuredRun white = test::measure(base, base, {0.0, 0.0, 0.0, 1.0, 4});
  MeasuredRun wrong = white;
  set_parameter(wrong.setup.car(), "rear_damping", 1800.0);
  const std::vector<Unknown> unknowns{make_parameter({white}, "front_damping")};
  const FitResult good = fit_simulation({white}, unknowns), bad = fit_simulation({wrong}, unknowns);
  CHECK(good.is_adequate());
  CHECK_FALSE(good.is_quiet());
  MeasuredRun quiet = white;
  for (MeasuredChannel& c : quiet.channels) c.sigma *= 2.0;
  CHECK(fit_simulation({quiet}, unknowns).is_quiet());
  CHECK_FALSE(bad.is_adequate());
  const double limit = 4.0 / std::sqrt(static_cast<double>(good.channels[1].count));
  CHECK(std::abs(good.channels[1].neighbor_correlation) < limit);
  CHECK(bad.channels[1].neighbor_correlation > limit);
}

TEST_CASE("Unusable measurements and unknowns are errors", "[unit]") {
  const Case base = test::make_bump_case();
  const MeasuredRun run = test::measure(base, base, {});
  const std::vector<Unknown> unknowns = test::make_suspension({run});
  const auto fit = [&](const MeasuredRun& r) { return fit_simulation({r}, unknowns); };
  MeasuredRun bad = run;
  bad.times[7] = bad.times[6];
  CHECK_THROWS_WITH(fit(bad), Contains("must be finite and ascend"));
  bad = run;
  bad.channels[0].values[3] = std::nan("");
  CHECK_THROWS_WITH(fit(bad), Contains("imu_acceleration_z in sample 4"));
  bad = run;
  bad.channels[1].channel = bad.channels[0].channel;
  CHECK_THROWS_WITH(fit(bad), Contains("twice"));
  bad = run;
  bad.channels[0].sigma = 0.0;
  CHECK_THROWS_WITH(fit(bad), Contains("must be > 0"));
  bad = run;
  cut_window(bad, 0.5, 0.501);
  CHECK_THROWS_WITH(fit(bad), Contains("too few"));
  CHECK_THROWS_WITH(make_parameter({run}, "front_stifness"), Contains("front_stiffness"));
  CHECK_THROWS_WITH(make_parameter({run}, "duration"), Contains("cannot be fitted"));
  CHECK_THROWS_WITH(fit_simulation({run}, {unknowns[0], unknowns[0]}), Contains("twice"));
  CHECK_THROWS_WITH(fit_simulation({run}, {}), Contains("nothing is free"));
  CHECK_THROWS_AS(fit_simulation({}, unknowns), InputError);
}

}  // namespace
}  // namespace strut
