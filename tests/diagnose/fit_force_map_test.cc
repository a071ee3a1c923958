// Force maps fitted to readings: shapes, their sizes, descriptions, known maps, and no map.
#include "diagnose/decide/fit_force_map.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "diagnose/discrepancy/map_axis.h"
#include "diagnose/discrepancy/map_prior.h"
#include "diagnose/discrepancy/map_shape.h"
#include "io/file/read_text_file.h"
#include "io/format/toml_document.h"
#include "model_files/read_force_maps.h"
#include "model_files/read_rig.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"
#include "tests/support/whitened_baseline.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using Index = Eigen::Index;
using test::tolerance;

/// A strut that swings through half a meter per second and 20 mm, out of step and in no rhythm.
VisitedStates make_states(std::size_t count = 2000) {
  VisitedStates states;
  states.force = 100.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i);
    states.velocity.push_back(0.5 * std::sin(0.37 * t) * std::cos(0.011 * t));
    states.deflection.push_back(0.02 * std::cos(0.37 * t) * std::cos(0.023 * t));
  }
  return states;
}

/// The force of shapes at every visited state: one column per shape.
Eigen::MatrixXd calc_columns(const MapBasis& basis, const VisitedStates& states) {
  const auto rows = static_cast<Index>(states.velocity.size());
  Eigen::MatrixXd columns(rows, static_cast<Index>(basis.shapes.size()));
  for (Index c = 0; c < columns.cols(); ++c) {
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(columns.cols(), c);
    const ForceMap map = add_shapes(basis, one);
    const Eigen::MatrixXd grid = Eigen::Map<const Eigen::MatrixXd>(
        map.coefficients.data(), map.velocity_count, map.deflection_count);
    for (Index i = 0; i < rows; ++i) {
      const auto k = static_cast<std::size_t>(i);
      columns(i, c) = get_velocity_axis(map)
                          .calc_splines(states.velocity[k])
                          .dot(grid * get_deflection_axis(map).calc_splines(states.deflection[k]));
    }
  }
  return columns;
}

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
}

Eigen::VectorXd draw(Index count, std::uint64_t seed) {
  Eigen::VectorXd noise(count);
  for (Index i = 0; i < count; ++i) {
    noise(i) = test::calc_test_normal(seed, 0, static_cast<std::uint64_t>(i));
  }
  return noise;
}

TEST_CASE("Shapes of a map leave preload, stiffness and damping to the model", "[unit]") {
  const VisitedStates states = make_states();
  const MapBasis basis = make_map_basis(states);
  const Eigen::MatrixXd columns = calc_columns(basis, states);
  const auto n = static_cast<double>(columns.rows());
  const Eigen::VectorXd v = as_vector(states.velocity), d = as_vector(states.deflection);
  int own = 0;
  for (Index i = 0; i < columns.cols(); ++i) {
    const MapShape& shape = basis.shapes[static_cast<std::size_t>(i)];
    INFO(i);
    if (shape.share == MapShare::kJoint) continue;
    ++own;
    // Unvisited parts count 1e-4 of the rest, and take part of the roughest shapes.
    const double power = columns.col(i).squaredNorm() / n;
    CHECK(power <= 1.0 + tolerance(1e-9));
    if (shape.roughness < 1e4) CHECK(power == Approx(1.0).margin(tolerance(0.05)));
    CHECK(std::abs(columns.col(i).mean()) < tolerance(0.01));
    const Eigen::VectorXd& line = shape.share == MapShare::kVelocity ? v : d;
    CHECK(std::abs(columns.col(i).dot(line)) < tolerance(0.01) * std::sqrt(n) * line.norm());
  }
  CHECK(own == 22 + 8);
  // The smooth ones first.
  CHECK(basis.shapes[0].roughness < basis.shapes[1].roughness);
  CHECK(basis.shapes[0].roughness == Approx(16.0));
}

TEST_CASE("A strut that does not move gets no shapes", "[unit]") {
  VisitedStates states;
  CHECK(make_map_basis(states).shapes.empty());
  states.velocity = {0.0, 0.0};
  states.deflection = {0.01, 0.01};
  CHECK(make_map_basis(states).shapes.empty());
}

TEST_CASE("Free parameters of the model are eliminated from a map's evidence", "[unit]") {
  const Eigen::MatrixXd jacobian = draw(180, 1).reshaped(60, 3),
                        columns = draw(120, 2).reshaped(60, 2);
  const Eigen::VectorXd residual = draw(60, 3);
  const MapEvidence e = eliminate_base(columns, jacobian, residual);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(jacobian);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(60, 3);
  const Eigen::MatrixXd rest = columns - basis * (basis.transpose() * columns);
  const Eigen::VectorXd left = residual - basis * (basis.transpose() * residual);
  // The regularization's 1e-12, of numbers around 60.
  CHECK((e.information - rest.transpose() * rest).norm() < tolerance(1e-8));
  CHECK((e.gradient - rest.transpose() * left).norm() < tolerance(1e-8));
  CHECK(e.chi2 == Approx(left.squaredNorm()).epsilon(tolerance(1e-10)));
  CHECK(e.count == 57.0);
}

/// Constant, velocity and deflection: the free parameters of the model.
Eigen::MatrixXd make_lines(const VisitedStates& states) {
  Eigen::MatrixXd lines(static_cast<Index>(states.velocity.size()), 3);
  lines << Eigen::VectorXd::Ones(lines.rows()), as_vector(states.velocity),
      as_vector(states.deflection);
  return lines;
}

TEST_CASE("The readings determine the variables and the roughness of a map", "[unit]") {
  const VisitedStates states = make_states();
  const MapBasis basis = make_map_basis(states);
  const Eigen::VectorXd v = as_vector(states.velocity), d = as_vector(states.deflection);
  const Eigen::VectorXd noise = draw(v.size(), 5);  // N
  const Eigen::MatrixXd columns = calc_columns(basis, states), lines = make_lines(states);

  SECTION("nothing") {
    // Three sizes at their best beat none by 3 in less than 2 % of nulls.
    int above = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const MapEvidence e = eliminate_base(columns, lines, draw(v.size(), 100 + seed));
      above += choose_map_prior(e, basis.shapes).log_likelihood > 3.0 ? 1 : 0;
    }
    CHECK(above <= 1);
  }

  SECTION("velocity") {
    const Eigen::VectorXd truth = (v.array() / 0.05).tanh() * 10.0;
    const MapEvidence e = eliminate_base(columns, lines, noise - truth);
    const MapPrior prior = choose_map_prior(e, basis.shapes);
    CHECK(prior.log_likelihood > 100.0);
    CHECK(prior.size[0] > 10.0 * prior.size[1]);
    const Eigen::MatrixXd factors = combine_shapes(e, prior);
    Eigen::MatrixXd seen = factors.transpose() * e.information * factors;
    // Combinations do not meet in the readings.
    CHECK((seen - Eigen::MatrixXd(seen.diagonal().asDiagonal())).norm() <
          tolerance(1e-8) * seen.norm());
    const Eigen::VectorXd mean = calc_map_mean(e, prior);
    // The readings hardly determine the rest.
    seen.diagonal().array() += 1.0;
    const Eigen::VectorXd of_combinations =
        -factors * seen.ldlt().solve(factors.transpose() * e.gradient);
    CHECK((of_combinations - mean).norm() < tolerance(0.05) * mean.norm());
    const Eigen::VectorXd found = columns * mean;
    // Up to the line and constant that the model has anyway.
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(lines);
    const Eigen::VectorXd off = truth - found;
    const Eigen::VectorXd rest = off - lines * qr.solve(off);
    const Eigen::VectorXd curved = truth - lines * qr.solve(truth);
    // Noise of 1 N, and some 20 shapes on 2000 readings leave 0.1 N; splines 0.02 m/s apart more.
    CHECK(rest.norm() < tolerance(0.05) * curved.norm());
  }

  SECTION("deflection") {
    const Eigen::VectorXd truth = (d.array() / 0.02).cube() * 10.0;
    const MapPrior prior =
        choose_map_prior(eliminate_base(columns, lines, noise - truth), basis.shapes);
    CHECK(prior.log_likelihood > 100.0);
    CHECK(prior.size[1] > 0.0);
    CHECK(prior.size[0] < 0.1 * prior.size[1]);
  }

  SECTION("both together") {
    const Eigen::VectorXd truth = d.array() * v.array() * 1000.0;
    const MapPrior prior =
        choose_map_prior(eliminate_base(columns, lines, noise - truth), basis.shapes);
    CHECK(prior.log_likelihood > 100.0);
    CHECK(prior.size[2] > prior.size[0]);
    CHECK(prior.size[2] > prior.size[1]);
  }
}

MapCurve make_curve(double (*force)(double), double low = -1.0, double high = 1.0) {
  MapCurve curve;
  for (int i = 0; i <= 80; ++i) {
    curve.x.push_back(low + (high - low) * i / 80.0);
    curve.force.push_back(force(curve.x.back()));
  }
  return curve;
}

std::string say(double (*force)(double), MapVariable variable = MapVariable::kVelocity,
                double low = -1.0, double high = 1.0) {
  return describe_curve(make_curve(force, low, high), variable);
}

TEST_CASE("Words describe the shape of a curve", "[unit]") {
  using V = MapVariable;
  CHECK(say([](double) { return 3.0; }).empty());
  CHECK(say([](double x) { return 2.0 - 5.0 * x; }).empty());
  CHECK_THAT(say([](double x) { return 9.0 * std::tanh(x / 0.2) - 7.0 * x; }),
             Contains("saturates above 0.") && Contains("alike in both"));
  CHECK_THAT(say([](double x) { return x * x * x + 2.0 * x; }),
             Contains("grows more steeply above 0.") && Contains("alike in both"));
  CHECK_THAT(say([](double x) { return 1e4 * x * x * x; }, V::kDeflection, -0.1, 0.1),
             Contains("hardens beyond") && Contains(" mm"));
  CHECK_THAT(say([](double x) { return std::max(0.0, x - 0.05); }, V::kDeflection, -0.1, 0.1),
             Contains("hardens beyond 5") && Contains("in compression only"));
  CHECK_THAT(say([](double x) { return std::min(0.0, x + 0.5); }),
             Contains("grows more steeply above 0.") && Contains("in rebound only"));
  CHECK_THAT(say([](double x) { return std::abs(x); }),
             Contains("kink at standstill") && Contains("stiffer in compression"));
  CHECK_THAT(say([](double x) { return -std::abs(x); }), Contains("stiffer in rebound"));
  CHECK_THAT(say([](double x) { return x > 0.0 ? 1.0 : -1.0; }), Contains("step at standstill"));
  CHECK_THAT(say([](double x) { return x * x; }), Contains("same way in both"));
  // Only one side was visited.
  CHECK_THAT(say([](double x) { return std::tanh(5.0 * x); }, V::kVelocity, -0.01, 1.0),
             Contains("saturates above"));
  // The strut never was near its rest: what it would do there is not known, and bends nothing.
  CHECK(say([](double x) { return 4e3 * x; }, V::kDeflection, 0.02, 0.05).empty());
  CHECK(say([](double x) { return 4e3 * x; }, V::kDeflection, -0.05, -0.02).empty());
}

TEST_CASE("Fractions tell the dependence of a map over visited states", "[unit]") {
  const VisitedStates states = make_states();
  ForceMap map = make_map_basis(states).grid;
  const auto v = calc_map_abscissas(map.velocity_low, map.velocity_high, map.velocity_count);
  const auto d = calc_map_abscissas(map.deflection_low, map.deflection_high, map.deflection_count);
  const auto fill = [&](double (*force)(double, double)) {
    map.coefficients.clear();
    for (const double x : d) {
      for (const double y : v) map.coefficients.push_back(force(x, y));
    }
    return measure_dependence(map, states);
  };
  const MapDependence of_v = fill([](double, double y) { return std::tanh(y / 0.1); });
  // The regression's ridge of 1e-6.
  CHECK(of_v.of_velocity == Approx(1.0).margin(tolerance(0.01)));
  CHECK_THAT(of_v.words, Catch::StartsWith("velocity (100 %), saturates above"));
  const MapDependence of_d = fill([](double x, double) { return 1e6 * x * x * x; });
  CHECK(of_d.of_deflection == Approx(1.0).margin(tolerance(0.01)));
  CHECK_THAT(of_d.words, Catch::StartsWith("deflection (100 %), hardens beyond"));
  const MapDependence both = fill([](double x, double y) { return x * y; });
  CHECK(both.of_both > 0.9);
  CHECK_THAT(both.words, Catch::StartsWith("deflection and velocity together"));
  const MapDependence mixed =
      fill([](double x, double y) { return y * y * y / 0.125 + x * x * x / 8e-6; });
  CHECK(mixed.of_velocity + mixed.of_deflection + mixed.of_both ==
        Approx(1.0).margin(tolerance(1e-9)));
  CHECK(mixed.of_velocity > 0.3);
  CHECK(mixed.of_deflection > 0.3);
  CHECK(mixed.of_both < 0.1);
}

// --- maps in readings ------------------------------------------------------------------------

const std::filesystem::path kRigFile = STRUT_SOURCE_DIR "/examples/rigs/quarter_car.toml";

/// A damper that saturates: 1 N at 0.05 m/s and beyond.
ForceMap make_known_map() {
  ForceMap map;
  map.deflection_low = -0.02;
  map.deflection_high = 0.02;
  map.velocity_low = -0.4;
  map.velocity_high = 0.4;
  map.velocity_count = 40;
  for (const double v : calc_map_abscissas(-0.4, 0.4, map.velocity_count)) {
    map.coefficients.push_back(std::tanh(v / 0.05));
  }
  return map;
}

/// Two runs of the program's own quarter car with these maps, and noise.
CampaignData simulate_campaign(const test::TemporaryFolder& folder, const ForceMaps& maps,
                               std::uint64_t seed = 1) {
  const Document document(kRigFile);
  RigSpec spec = read_rig(kRigFile);
  spec.force_maps = maps;
  constexpr double kNoise = 2e-5, kInterval = 5e-3, kDuration = 5.0;  // m, s
  const test::QuarterTruth road;
  for (const auto& [name, amplitude] : {std::pair{"a.csv", 4e-3}, std::pair{"b.csv", 3e-3}}) {
    test::QuarterTruth truth = road;
    truth.amplitude = amplitude;
    test::QuarterRecord record;
    for (int i = 0; i * kInterval <= kDuration; ++i) {
      record.time.push_back(i * kInterval);
      record.road.push_back(test::calc_test_road(truth, record.time.back(), kDuration));
    }
    const MeasuredRun run{
        name,
        RigCase{spec, {make_sampled_input("road_position", record.time, record.road, {})}},
        record.time,
        {}};
    const RunCurves curves = simulate_run(run, {}, {});
    REQUIRE(curves.failure.empty());
    record.unsprung = curves.channel[QuarterCarChannel::kUnsprungPosition];
    record.sprung = curves.channel[QuarterCarChannel::kSprungPosition];
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      record.unsprung[i] += kNoise * test::calc_test_normal(seed, 0, i);
      record.sprung[i] += kNoise * test::calc_test_normal(seed, 1, i);
    }
    test::write_record(folder, name, record);
    ++seed;
  }
  test::CampaignText text;
  text.fit = "free = [\"stiffness\", \"damping\", \"tire_stiffness\"]\n";
  return read_campaign_data(test::write_campaign(folder, text));
}

TEST_CASE("A map hidden in the program's own readings is found", "[regression][slow]") {
  const test::TemporaryFolder folder;
  const ForceMap truth = make_known_map();
  const CampaignData data = simulate_campaign(folder, {truth});
  const WhitenedFit base = test::fit_whitened_baseline(data);
  const VisitedStates states = list_visited_states(data, base.runs, base.shared()).front();
  const auto fit = fit_force_map(data, base, states);
  REQUIRE(fit);
  const ForceMap found = list_force_maps_on(data, fit->shared()).front();
  // The law of the whole strut, as a line of the map is the damper's: off by its mean square where
  // the strut was, over that of the map's own.
  const RigSpec nominal = read_rig(kRigFile);
  double damping = 0.0, stiffness = 0.0;
  for (std::size_t i = 0; i < fit->shared_count; ++i) {
    if (fit->fit.unknowns[i].name == "damping") damping = fit->fit.values[i];
    if (fit->fit.unknowns[i].name == "stiffness") stiffness = fit->fit.values[i];
  }
  double off = 0.0, all = 0.0, within = 0.0;
  for (std::size_t i = 0; i < states.velocity.size(); ++i) {
    const double d = states.deflection[i], v = states.velocity[i];
    const double error = calc_force(found, d, v) - calc_force(truth, d, v) +
                         (damping - nominal.damping) * v + (stiffness - nominal.stiffness) * d;
    off += error * error;
    all += std::pow(calc_force(truth, d, v), 2.0);
    if (std::abs(error) < 0.05) ++within;
  }
  // Splines 0.03 m/s apart bend over 0.05 m/s.
  CHECK(std::sqrt(off / all) < tolerance(0.03));
  CHECK(within > 0.95 * static_cast<double>(states.velocity.size()));
  const MapDependence depends = measure_dependence(found, states);
  CHECK(depends.of_velocity > 0.9);
  CHECK_THAT(depends.words, Contains("saturates above 0.0"));

  SECTION("and stands in the model's file") {
    const ForceMaps maps = list_force_maps_on(data, fit->shared());
    const auto file = folder.write(
        "extended.toml",
        replace_force_maps(read_text_file(kRigFile), maps, get_rig_info(RigKind::kQuarterCar)));
    CHECK(read_rig(file).force_maps == maps);
  }
}

TEST_CASE("Readings without a map get none", "[regression][slow]") {
  for (const std::uint64_t seed : {21U, 31U, 41U}) {
    const test::TemporaryFolder folder;
    const CampaignData data = simulate_campaign(folder, {}, seed);
    const WhitenedFit base = test::fit_whitened_baseline(data);
    for (const VisitedStates& states : list_visited_states(data, base.runs, base.shared())) {
      CHECK_FALSE(fit_force_map(data, base, states));
    }
  }
}

}  // namespace
}  // namespace strut
