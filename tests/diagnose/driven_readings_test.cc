// Rigs fitted to records by an integrator of the test's own.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "base/math/spread.h"
#include "diagnose/baseline/baseline.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "estimate/driven_batch.h"
#include "estimate/simulate_run.h"
#include "model/rig/rig_system.h"
#include "model_files/read_rig.h"
#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::TemporaryFolder;

CampaignData read_two_runs(const test::QuarterTruth& truth, const test::CampaignText& text = {},
                           const test::ChangeRow& change = {}) {
  const TemporaryFolder folder;
  test::write_two_runs(folder, truth, change);
  return read_campaign_data(test::write_campaign(folder, text));
}

/// Names and true values of the campaign's free parameters.
std::vector<std::pair<std::string, double>> list_truth(const test::QuarterTruth& t) {
  return {{"unsprung_mass", t.unsprung_mass},
          {"stiffness", t.stiffness},
          {"damping", t.damping},
          {"tire_stiffness", t.tire_stiffness},
          {"tire_damping", t.tire_damping}};
}

test::CampaignText with_noise(double sigma) {
  test::CampaignText text;
  const std::string noise = ", noise = " + test::print_number(sigma) + " }";
  text.unsprung = "{ column = \"unsprung\"" + noise;
  text.sprung = "{ column = \"sprung\"" + noise;
  return text;
}

TEST_CASE("Points of a rig in lanes have the bits of each by itself", "[property]") {
  const CampaignData data = read_two_runs({}, with_noise(1e-6));
  const MeasuredRun& run = data.runs[0];
  const std::vector<Unknown> unknowns = {make_parameter({run}, "damping"),
                                         make_parameter({run}, "tire_stiffness")};
  std::vector<std::vector<double>> points(10);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto part = static_cast<double>(i);
    points[i] = {5.0 + part, 1000.0 + 60.0 * part};
  }
  const std::vector<RunCurves> together = simulate_points(run, unknowns, points);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const RunCurves alone = simulate_run(run, unknowns, points[p]);
    for (const MeasuredChannel& c : run.channels) {
      const auto at = static_cast<std::size_t>(c.channel);
      CHECK(together[p].channel[at] == alone.channel[at]);
    }
  }
  CHECK(together[0].channel != together[1].channel);
}

TEST_CASE("A fit recovers a rig's parameters from records of another integrator", "[reference]") {
  test::QuarterTruth truth;
  truth.start = {1e-3, -5e-4, 0.02, -0.01};
  const CampaignData data = read_two_runs(truth, with_noise(1e-6));
  const Baseline baseline = calibrate_baseline(data);
  CHECK(baseline.fit.converged);
  for (std::size_t i = 0; i < list_truth(truth).size(); ++i) {
    const auto [name, value] = list_truth(truth)[i];
    INFO(name);
    CHECK(baseline.calibrated.unknowns[i].name == name);
    // The spline through a chirp of up to 8 Hz at 200 Hz errs by 1e-5 of it.
    CHECK(baseline.calibrated.values[i] == Approx(value).epsilon(test::tolerance(2e-4)));
  }
  for (std::size_t i = 0; i < baseline.fit.unknowns.size(); ++i) {
    const Unknown& u = baseline.fit.unknowns[i];
    if (u.name == "initial_sprung_velocity" && u.run == 0) {
      CHECK(baseline.fit.values[i] == Approx(-0.01).epsilon(test::tolerance(0.01)));
    }
  }
}

TEST_CASE("A clock with jitter loses no reading and moves no parameter", "[reference]") {
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  truth.jitter = GENERATE(1e-8, 1e-6, 2e-4);
  const CampaignData data = read_two_runs(truth, with_noise(2e-5));
  const Baseline baseline = calibrate_baseline(data);
  CHECK(baseline.fit.converged);
  const auto model =
      make_reading_model(data, {0}, {make_shared_unknown(data.runs, "stiffness")}, 1);
  CHECK(model->reading_count() == 2 * data.times(0).size());
  CHECK(baseline.fit.chi2_per_degree() == Approx(1.0).epsilon(test::tolerance(0.2)));
  for (std::size_t i = 0; i < list_truth(truth).size(); ++i) {
    INFO(baseline.calibrated.unknowns[i].name);
    const double error = baseline.calibrated.values[i] - list_truth(truth)[i].second;
    CHECK(std::abs(error) < test::tolerance(4.0) * baseline.calc_sigma(i));
  }
  const RunCurves curves = simulate_run(data.runs[1], {}, {});
  REQUIRE(curves.failure.empty());
  for (const std::vector<double>& channel : curves.channel) {
    CHECK(count_readings(channel) == channel.size());
  }
}

TEST_CASE("Intervals of a fitted rig have their nominal coverage", "[statistical][slow]") {
  int inside = 0, count = 0;
  double chi2 = 0.0;
  constexpr int kDraws = 6;
  for (int draw = 0; draw < kDraws; ++draw) {
    test::QuarterTruth truth;
    truth.noise = 2e-5;
    truth.seed = 50 + 10 * static_cast<std::uint64_t>(draw);
    const Baseline baseline = calibrate_baseline(read_two_runs(truth, with_noise(2e-5)));
    chi2 += baseline.fit.chi2_per_degree() / kDraws;
    for (std::size_t i = 0; i < list_truth(truth).size(); ++i) {
      const double error = baseline.calibrated.values[i] - list_truth(truth)[i].second;
      inside += std::abs(error) < 1.96 * baseline.calc_sigma(i) ? 1 : 0;
      ++count;
    }
  }
  // 30 intervals of 95 %, correlated within a draw: fewer than 24 is beyond 3 sigmas.
  CHECK(inside >= 24);
  CHECK(count == 30);
  // 1600 readings a draw: 1 sigma of the mean 1.4 %.
  CHECK(chi2 == Approx(1.0).epsilon(test::tolerance(0.06)));
}

TEST_CASE("The Jacobian of a rig agrees with differences of its residuals", "[unit]") {
  test::CampaignText text = with_noise(2e-5);
  text.fit += "[noise]\ngain = 1e-3\nskew = 2e-5\n";
  const CampaignData data = read_two_runs({}, text);
  const std::vector<std::size_t> runs = {0, 1};
  std::vector<Unknown> unknowns = {make_shared_unknown(data.runs, "stiffness"),
                                   make_shared_unknown(data.runs, "road_position_gain"),
                                   make_shared_unknown(data.runs, "sprung_position_bias")};
  for (const Unknown& u : make_free_unknowns(data, runs)) {
    if (is_sensor_error(u)) unknowns.push_back(u);
  }
  CHECK(unknowns.size() == 7);  // gain and skew of two sensors
  for (Unknown& u : make_run_unknowns(data, runs, unknowns)) unknowns.push_back(u);
  const auto model = make_reading_model(data, runs, unknowns, 2);
  std::vector<double> values = list_starts(unknowns);
  values[2] = 1e-4;
  const Linearization at = model->linearize(values);
  REQUIRE(at.failure.empty());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    INFO(unknowns[i].name);
    const double h = 1e-3 * unknowns[i].scale;
    std::vector<double> up = values, down = values;
    up[i] += h;
    down[i] -= h;
    const Eigen::VectorXd slope =
        (model->linearize(up).residual - model->linearize(down).residual) / 2e-3;
    const auto column = at.jacobian.col(static_cast<Eigen::Index>(i));
    // The curvature within a thousandth of the scale, at resonance.
    CHECK((slope - column).norm() <= test::tolerance(1e-4) * column.norm());
  }
}

/// Changes the unsprung position of every row by a gain and its rate.
test::ChangeRow make_sensor_change(const test::QuarterTruth& truth, double gain, double skew) {
  const test::QuarterRecord record = test::record_quarter_car(truth);
  return [=](std::size_t row, std::array<std::string, 4>& cells) {
    const std::size_t before = row > 0 ? row - 1 : 0;
    const std::size_t after = std::min(row + 1, record.time.size() - 1);
    const double rate = (record.unsprung[after] - record.unsprung[before]) /
                        (record.time[after] - record.time[before]);
    const double value = (1.0 + gain) * std::stod(cells[2]) - skew * rate;
    cells[2] = test::print_number(value);
  };
}

TEST_CASE("Small errors of a sensor's gain and clock are found, not blamed on the model",
          "[reference]") {
  constexpr double kGain = 1.5e-3, kSkew = 3e-5;
  test::QuarterTruth truth;
  const TemporaryFolder folder;
  // Both runs have the same motion, so that the change fits both.
  test::write_record(folder, "a.csv", test::record_quarter_car(truth),
                     make_sensor_change(truth, kGain, kSkew));
  test::write_record(folder, "b.csv", test::record_quarter_car(truth));
  const auto calibrate = [&](const std::string& noise) {
    test::CampaignText text = with_noise(1e-7);
    text.fit += noise;
    return calibrate_baseline(read_campaign_data(test::write_campaign(folder, text)));
  };
  const Baseline tolerant = calibrate("[noise]\ngain = 1e-3\nskew = 2e-5\n");
  const Baseline strict = calibrate("[noise]\ngain = 0\nskew = 0\n");
  CHECK(tolerant.fit.chi2 < 0.1 * strict.fit.chi2);
  for (std::size_t i = 0; i < tolerant.fit.unknowns.size(); ++i) {
    const std::string& name = tolerant.fit.unknowns[i].name;
    // A gain of both positions looks like one of the road.
    if (name == "unsprung_position_skew") {
      CHECK(tolerant.fit.values[i] == Approx(kSkew).epsilon(test::tolerance(0.2)));
    }
  }
}

TEST_CASE("Points of a rig simulated together are those simulated alone", "[property]") {
  const CampaignData data = read_two_runs({}, with_noise(2e-5));
  const std::vector<Unknown> unknowns = {make_shared_unknown(data.runs, "stiffness"),
                                         make_shared_unknown(data.runs, "damper_leak"),
                                         make_shared_unknown(data.runs, "road_position_gain")};
  const auto model = make_reading_model(data, {0, 1}, unknowns, 1);
  std::vector<std::vector<double>> points;
  // Others of the run's lanes, another step, another road; and one that cannot be simulated.
  for (const double stroke : {0.0, 1e-3, 0.0, 5e-5, 5e-5}) points.push_back({900.0, stroke, 1.0});
  for (std::size_t i = 0; i < points.size(); ++i) points[i][0] += 10.0 * static_cast<double>(i);
  points.push_back({900.0, 0.0, 1.1});
  points.push_back({-1.0, 0.0, 1.0});
  const std::vector<Evaluation> together = model->evaluate(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    INFO(i);
    const Evaluation alone = model->evaluate(points[i]);
    CHECK(together[i].failure == alone.failure);
    CHECK(alone.failure.empty() == (i + 1 < points.size()));
    if (!alone.failure.empty()) continue;
    CHECK((together[i].residual.array() == alone.residual.array()).all());
  }
}

TEST_CASE("A lost stroke can be read at uneven times", "[unit]") {
  const CampaignData data =
      read_two_runs({}, with_noise(2e-5), [](std::size_t row, std::array<std::string, 4>& cells) {
        if (row % 3 == 1) cells[0] = test::print_number(std::stod(cells[0]) + 1.2345e-4);
      });
  const auto model =
      make_reading_model(data, {0}, {make_shared_unknown(data.runs, "damper_leak")}, 1);
  for (const double stroke : {0.0, 1e-4, 3e-5, 1e-5}) {
    INFO(stroke);
    const Evaluation at = model->evaluate(std::vector<double>{stroke});
    REQUIRE(at.failure.empty());
    CHECK(at.residual.allFinite());
  }
}

TEST_CASE("The derivative by a stroke does not include changes of the step", "[reference]") {
  const CampaignData data = read_two_runs({}, with_noise(2e-5));
  const std::vector<Unknown> unknowns = {make_shared_unknown(data.runs, "damper_leak")};
  const auto find_step = [&](double stroke) {
    return DrivenTask(data.runs[0], 0, unknowns, {stroke}, {}).sampling.fine_step;
  };
  double fine = 3e-5, coarse = 1e-4;
  REQUIRE(find_step(fine) < find_step(coarse));
  const double finest = find_step(fine);
  while (coarse - fine > 1e-12) {
    const double middle = 0.5 * (fine + coarse);
    (find_step(middle) == finest ? fine : coarse) = middle;
  }
  // The sides of the difference there lie on either side of where the number of steps changes.
  const auto model = make_reading_model(data, {0}, unknowns, 1);
  const Eigen::VectorXd there = model->linearize({fine}).jacobian.col(0),
                        beside = model->linearize({fine - 2e-7}).jacobian.col(0);
  CHECK((there - beside).norm() < test::tolerance(0.2) * beside.norm());
}

TEST_CASE("A lost stroke shorter than a step is simulated", "[reference]") {
  const CampaignData data = read_two_runs({}, with_noise(2e-5));
  constexpr double kStroke = 6e-5;
  const auto model =
      make_reading_model(data, {0}, {make_shared_unknown(data.runs, "damper_leak")}, 1);
  const std::vector<Evaluation> points =
      model->evaluate(std::vector<std::vector<double>>{{kStroke}, {0.0}});
  const Eigen::VectorXd felt = points[0].residual - points[1].residual;

  const MeasuredRun& run = data.runs.front();
  StepOptions fine;
  fine.step = 1e-5;
  SamplePlan plan;
  plan.duration = run.times.back();
  plan.interval = run.times[1] - run.times[0];
  const RigCase& setup = run.setup.rig();
  RigSpec leaking = setup.rig;
  set_rig_parameter(leaking, "damper_leak", kStroke);
  const LaneResults without = simulate_rig(setup.rig, setup.inputs, fine, plan);
  const LaneResults with = simulate_rig(leaking, setup.inputs, fine, plan);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(felt.size());
  const std::size_t channels = run.setup.info().channels.size();
  for (std::size_t k = 0; k < model->reading_count(); ++k) {
    const ReadingPlace& place = model->readings()[k];
    const MeasuredChannel& c = run.channels[place.channel];
    const std::size_t at = place.time * channels + static_cast<std::size_t>(c.channel);
    expected(static_cast<Eigen::Index>(k)) = (with.history[at] - without.history[at]) / c.sigma;
  }
  CHECK(expected.norm() > 1.0);
  CHECK((felt - expected).norm() <= test::tolerance(0.1) * expected.norm());
}

TEST_CASE("A rig's fit is the same for any number of threads", "[property][threads]") {
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  const CampaignData data = read_two_runs(truth, with_noise(2e-5));
  CHECK(calibrate_baseline(data, 1).fit.values == calibrate_baseline(data, 3).fit.values);
}

TEST_CASE("Samples at uneven times are interpolated, not rounded", "[reference]") {
  test::QuarterTruth truth;
  const CampaignData data = read_two_runs(
      truth, with_noise(1e-6), [](std::size_t row, std::array<std::string, 4>& cells) {
        if (row % 4 == 1 || row % 11 == 3) cells[2] = cells[3] = "";
        if (row % 3 == 1) cells[0] = test::print_number(std::stod(cells[0]) + 1e-9);
      });
  const Baseline baseline = calibrate_baseline(data);
  CHECK(baseline.fit.converged);
  CHECK(baseline.calibrated.values[1] == Approx(950.0).epsilon(test::tolerance(2e-4)));
}

TEST_CASE("A held-out run is not used to fit, and determines only its initial state", "[unit]") {
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  const TemporaryFolder folder;
  test::write_two_runs(folder, truth);
  const Baseline before =
      calibrate_baseline(read_campaign_data(test::write_campaign(folder, with_noise(2e-5))));
  truth.seed = 2;
  truth.amplitude = 0.001;
  truth.start = {0.0, 2e-3, 0.0, 0.0};
  test::write_record(folder, "b.csv", test::record_quarter_car(truth));
  const CampaignData data = read_campaign_data(test::write_campaign(folder, with_noise(2e-5)));
  const Baseline after = calibrate_baseline(data);
  CHECK(after.calibrated.values == before.calibrated.values);
  const RunEvaluation evaluation = evaluate_run(data, 1, after.calibrated);
  REQUIRE(evaluation.failure.empty());
  CHECK(evaluation.unknowns.size() == 6);
  CHECK(evaluation.values[1] == Approx(2e-3).epsilon(test::tolerance(0.1)));
}

TEST_CASE("The noise of an input is scaled with it", "[unit]") {
  CampaignData data = read_two_runs({}, with_noise(1e-6));
  MeasuredRun run = data.runs[0];
  REQUIRE(run.input_noise.size() == 1);
  run.input_noise[0].sigma = 1e-5;
  Unknown gain;
  gain.kind = UnknownKind::kInputGain;
  gain.input = 0;
  const MeasuredRun scaled = set_unknowns(run, {gain}, {-4.6});
  CHECK(scaled.input_noise[0].sigma == Approx(4.6e-5).epsilon(test::tolerance(1e-12)));
}

}  // namespace
}  // namespace strut
