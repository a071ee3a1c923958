// Force maps: splines written anew, maps that are a damper or a spring, places, lanes, energy,
// files.

#include "model/effects/force_map.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "base/math/xsimd_backend.h"
#include "io/format/toml_text.h"
#include "model/model.h"
#include "model/rig/rig_system.h"
#include "model_files/drop_tables.h"
#include "model_files/read_effects.h"
#include "model_files/read_force_maps.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_car.h"
#include "tests/support/test_rig.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::prepare;
using test::tolerance;
using C = CarChannel;
using I = StateIndex;
const ModelInfo& kCar = get_car_info();
const fs::path kSource = STRUT_SOURCE_DIR;
const fs::path kCarFile = kSource / "examples/vehicles/paper_sedan.toml";
const fs::path kRigFile = kSource / "examples/rigs/quarter_car.toml";

std::size_t at(int i) { return static_cast<std::size_t>(i); }

ForceMap make_map(const std::string& place, int deflections, int velocities) {
  ForceMap map;
  map.place = place;
  map.deflection_low = -0.12;
  map.deflection_high = 0.1;
  map.deflection_count = deflections;
  map.velocity_low = -3.0;
  map.velocity_high = 2.5;
  map.velocity_count = velocities;
  return map;
}

/// The map that is `rate` times the velocity within its range.
ForceMap make_damper_map(const std::string& place, double rate, int deflections = 1,
                         int velocities = 9) {
  ForceMap map = make_map(place, deflections, velocities);
  const auto v = calc_map_abscissas(map.velocity_low, map.velocity_high, velocities);
  for (int i = 0; i < deflections; ++i) {
    for (const double x : v) map.coefficients.push_back(rate * x);
  }
  return map;
}

/// A map of no simple shape, some hundred newtons high.
ForceMap make_bent_map(const std::string& place, unsigned seed, int deflections = 6,
                       int velocities = 8) {
  ForceMap map = make_map(place, deflections, velocities);
  test::Random random(seed);
  for (int i = 0; i < deflections * velocities; ++i) {
    map.coefficients.push_back(random.uniform(-200.0, 200.0));
  }
  return map;
}

/// Spline `i` of degree `p` over knots low + (k - 3) width, by the recurrence of Cox and de Boor.
double calc_spline(int i, int p, double x, double low, double width) {
  const auto knot = [&](int k) { return low + (k - 3) * width; };
  if (p == 0) return x >= knot(i) && x < knot(i + 1) ? 1.0 : 0.0;
  return (x - knot(i)) / (p * width) * calc_spline(i, p - 1, x, low, width) +
         (knot(i + p + 1) - x) / (p * width) * calc_spline(i + 1, p - 1, x, low, width);
}

double calc_spline_of(double x, int i, double low, double high, int count) {
  if (count == 1) return 1.0;
  const double inside = std::fmin(std::fmax(x, low), high - 1e-12 * (high - low));
  return calc_spline(i, 3, inside, low, (high - low) / (count - 3));
}

TEST_CASE("A force map is a tensor product of cubic splines, held at its ends",
          "[unit][reference]") {
  const auto [rows, columns] =
      GENERATE(std::pair{6, 8}, std::pair{4, 4}, std::pair{1, 7}, std::pair{5, 1}, std::pair{1, 1});
  const ForceMap map = make_bent_map("", 3, rows, columns);
  test::Random random(11);
  for (int n = 0; n < 300; ++n) {
    const double d = random.uniform(-0.2, 0.2), v = random.uniform(-5.0, 5.0);
    double force = 0.0;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        force += map.coefficients[at(i) * at(columns) + at(j)] *
                 calc_spline_of(d, i, map.deflection_low, map.deflection_high, rows) *
                 calc_spline_of(v, j, map.velocity_low, map.velocity_high, columns);
      }
    }
    // The reference ends 1e-12 of the range before its end.
    CHECK(calc_force(map, d, v) == Approx(force).margin(tolerance(1e-8)));
  }
  CHECK(std::isfinite(calc_force(map, std::nan(""), std::nan(""))));
  CHECK(calc_force(map, INFINITY, -INFINITY) == calc_force(map, 9.0, -9.0));
}

TEST_CASE("Coefficients that are the abscissas make the argument itself", "[unit][reference]") {
  const ForceMap map = make_damper_map("", 700.0, GENERATE(1, 5), GENERATE(4, 9, 20));
  for (const double v : {-3.0, -1.234, 0.0, 0.7, 2.5}) {
    CHECK(calc_force(map, 0.013, v) == Approx(700.0 * v).margin(tolerance(1e-10)));
  }
}

// --- rigs ------------------------------------------------------------------------------------

RigSpec make_rig(RigKind kind, const ForceMaps& maps = {}) {
  RigSpec spec = test::make_corner_rig(kind);
  spec.force_maps = maps;
  return spec;
}

std::vector<InputSignal> make_input(RigKind kind) {
  const double size = kind == RigKind::kSingleMass ? 500.0 : 0.02;
  return {make_chirp(get_rig_info(kind).inputs[0].name, size, 1.0, 10.0, 1.0)};
}

LaneResults run_rig(const RigSpec& spec) {
  return simulate_rig(spec, make_input(spec.kind), test::make_steps(1e-3),
                      {.duration = 1.0, .interval = 0.01});
}

TEST_CASE("A rig's map that is a damper or a spring equals them", "[unit][reference][rigs]") {
  const RigKind kind = GENERATE(RigKind::kQuarterCar, RigKind::kStrutRig, RigKind::kSingleMass,
                                RigKind::kGuidedMass);
  const bool spring = GENERATE(false, true);
  ForceMap map = make_damper_map("", 400.0);
  RigSpec changed = make_rig(kind);
  (spring ? changed.stiffness : changed.damping) += spring ? 3000.0 : 400.0;
  if (spring) {
    map = make_map("", 7, 1);
    for (const double d : calc_map_abscissas(map.deflection_low, map.deflection_high, 7)) {
      map.coefficients.push_back(3000.0 * d);
    }
  }
  const LaneResults a = run_rig(make_rig(kind, {map})), b = run_rig(changed);
  const auto& channels = get_rig_info(kind).channels;
  for (std::size_t i = 0; i < b.history.size(); ++i) {
    // The map's force counts as the damper's, not as the spring's.
    const std::string& name = channels[i % channels.size()].name;
    if (spring && (name == "spring_force" || name == "damper_force")) continue;
    INFO(name);
    CHECK(a.history[i] == Approx(b.history[i]).epsilon(tolerance(1e-9)).margin(tolerance(1e-9)));
  }
}

TEST_CASE("A rig with a map rests at its rest position", "[unit][rigs]") {
  ForceMap map = make_map("", 1, 1);
  map.coefficients = {250.0};
  const RigSpec spec = make_rig(RigKind::kQuarterCar, {map});
  const LaneResults run =
      simulate_rig(spec, {}, test::make_steps(1e-3), {.duration = 1.0, .interval = 0.1});
  using Q = QuarterCarChannel;
  for (int i = 0; i <= 10; ++i) {
    const auto get = [&](int c) { return run.history[at(i) * Q::kCount + at(c)]; };
    CHECK(std::fabs(get(Q::kSprungPosition)) < tolerance(1e-12));
    CHECK(get(Q::kDamperForce) == Approx(250.0).epsilon(tolerance(1e-12)));
    CHECK(get(Q::kSpringForce) == Approx(300.0 * 9.81 - 250.0).epsilon(tolerance(1e-12)));
  }
}

TEST_CASE("Lanes of rigs may differ in their maps and in having one", "[unit][property][rigs]") {
  constexpr int kWidth = NativeLanes::kWidth;
  const RigKind kind = GENERATE(RigKind::kQuarterCar, RigKind::kStrutRig, RigKind::kSingleMass,
                                RigKind::kGuidedMass);
  std::vector<RigSpec> rigs;
  for (int lane = 0; lane < kWidth; ++lane) {
    const auto seed = static_cast<unsigned>(lane);
    rigs.push_back(lane % 2 == 1 ? make_rig(kind)
                                 : make_rig(kind, {make_bent_map("", seed, lane == 0 ? 1 : 6, 5)}));
  }
  std::array<const RigSpec*, static_cast<std::size_t>(kWidth)> specs, plain;
  plain.fill(&rigs[1]);
  for (std::size_t lane = 0; lane < specs.size(); ++lane) specs[lane] = &rigs[lane];
  const SamplePlan plan{.duration = 1.0, .interval = 0.01};
  const auto run = [&](const auto& of) {
    return simulate_rigs<NativeLanes>(of.data(), make_input(kind), test::make_steps(1e-3), plan);
  };
  const LaneResults mixed = run(specs), absent = run(plain);
  for (std::size_t lane = 0; lane < specs.size(); ++lane) {
    const LaneResults alone = run_rig(rigs[lane]);
    bool same = true;
    for (std::size_t i = 0; i < alone.history.size(); ++i) {
      const double value = mixed.history[i * specs.size() + lane];
      same = same && value == absent.history[i * specs.size() + lane];
      CHECK(value == Approx(alone.history[i]).epsilon(tolerance(1e-9)).margin(tolerance(1e-9)));
    }
    CHECK(same == (lane % 2 == 1));
  }
}

// --- cars ------------------------------------------------------------------------------------

Case make_case(const ForceMaps& maps = {}) {
  Case c = test::make_paper_case();
  c.vehicle.force_maps = maps;
  c.maneuver.duration = 0.8;
  c.maneuver.bump_distance = 3.0;
  c.maneuver.road.side = BumpSide::kLeft;
  c.maneuver.road.shape = BumpShape::kCosine;
  c.maneuver.road.height = 0.06;
  c.maneuver.road.length = 1.2;
  return c;
}

IntegrateOptions make_options(double step = 1e-3) {
  IntegrateOptions options;
  options.step.step = step;
  options.step.stepper = Stepper::kRk4;
  options.closure = Closure::kTable;
  return options;
}

const Kernel& scalar() { return list_kernels().back(); }

TEST_CASE("A car's map that is a damper equals a changed rate", "[unit][reference][effects]") {
  const Case mapped = make_case({make_damper_map("rear", 300.0, GENERATE(1, 5))});
  Case changed = make_case();
  for (StrutSpec& strut : changed.vehicle.suspension[kRear].strut) strut.damping += 300.0;
  const SamplePlan plan = test::make_plan(0.02);
  const LaneResults a = scalar().run_scalar(prepare(mapped), make_options(), plan);
  const LaneResults b = scalar().run_scalar(prepare(changed), make_options(), plan);
  REQUIRE(a.status[0] == 0);
  for (int i = 0; i < b.sample_count; ++i) {
    for (int channel = 0; channel < C::kCount; ++channel) {
      INFO(channel);
      const double value = b.get_sample(i, channel);
      // Tire forces of thousands of newtons cancel in what is near zero.
      CHECK(std::fabs(a.get_sample(i, channel) - value) <
            tolerance(1e-9 * std::fmax(std::fabs(value), 100.0)));
    }
  }
}

std::array<StrutForce<double>, kCorners> calc_struts(const Case& c, const State<double>& x) {
  const PreparedCase p = prepare(c);
  Workspace<double> ws{};
  State<double> dx{};
  const NewtonClosure<double> closure{&p.vehicle.layout, &p.vehicle.numbers};
  calc_derivative(p.vehicle, closure, TireMode::kRolling, x.data(), dx.data(), ws);
  return ws.strut;
}

TEST_CASE("A map acts at its place alone, along the damper, and its power is force times speed",
          "[unit][reference][effects]") {
  const ForceMap rear = make_bent_map("rear", 1), own = make_bent_map("rear_left", 2);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    test::Random random(seed);
    const State<double> x = test::make_random_state(random, 0.5373, 20.0, 0.4673);
    const PreparedCase p = prepare(make_case());
    Workspace<double> ws{};
    State<double> dx{};
    const NewtonClosure<double> closure{&p.vehicle.layout, &p.vehicle.numbers};
    calc_derivative(p.vehicle, closure, TireMode::kRolling, x.data(), dx.data(), ws);
    const auto with = calc_struts(make_case({rear, own}), x);
    for (int c = 0; c < kCorners; ++c) {
      INFO("seed " << seed << " corner " << c);
      const double rate = ws.motion[c].length_q[kDamperLine] * x[I::kCornerRate + c];
      const double d = p.vehicle.numbers.nominal_length[c * kLines + kDamperLine] -
                       ws.motion[c].length[kDamperLine];
      const double force = c == kRearLeft    ? calc_force(own, d, -rate)
                           : c == kRearRight ? calc_force(rear, d, -rate)
                                             : 0.0;
      const StrutForce<double>& plain = ws.strut[c];
      CHECK(with[c].damper_force == Approx(plain.damper_force + force).epsilon(tolerance(1e-12)));
      CHECK(with[c].spring_force == plain.spring_force);
      CHECK(with[c].generalized ==
            Approx(plain.generalized + force * ws.motion[c].length_q[kDamperLine])
                .epsilon(tolerance(1e-12)));
      CHECK(with[c].power == Approx(plain.power + force * rate).epsilon(tolerance(1e-12)));
      CHECK(with[c].energy == plain.energy);
    }
  }
}

TEST_CASE("A car without maps has no element of one", "[unit][effects]") {
  CHECK(prepare(make_case()).vehicle.effects.count == 0);
  CHECK(prepare(make_case({make_bent_map("front", 1)})).vehicle.effects.count == 2);
  CHECK(prepare(make_case({make_bent_map("rear_left", 1)})).vehicle.effects.count == 1);
}

TEST_CASE("Lanes of cars may differ in their maps and in having one", "[unit][property][effects]") {
  const Kernel& kernel = list_kernels().front();
  std::vector<PreparedCase> lanes;
  for (int lane = 0; lane < kernel.lanes; ++lane) {
    const auto seed = static_cast<unsigned>(lane + 5);
    const ForceMaps maps[4] = {{make_bent_map("rear", seed)},
                               {},
                               {make_bent_map("front_left", seed, 1, 4)},
                               {make_bent_map("front", seed, 9, 1), make_bent_map("rear", seed)}};
    lanes.push_back(prepare(make_case(maps[lane % 4])));
  }
  std::vector<const PreparedCase*> mixed, plain(lanes.size(), &lanes[1]);
  for (const PreparedCase& lane : lanes) mixed.push_back(&lane);
  const SamplePlan plan = test::make_plan(0.05);
  const LaneResults all = kernel.run_lanes(mixed.data(), kernel.lanes, make_options(), plan);
  const LaneResults none = kernel.run_lanes(plain.data(), kernel.lanes, make_options(), plan);
  for (int lane = 0; lane < kernel.lanes; ++lane) {
    const LaneResults alone =
        kernel.run_scalar(lanes[static_cast<std::size_t>(lane)], make_options(), plan);
    bool same = true;
    double error = 0.0;
    for (int i = 0; i < all.sample_count; ++i) {
      for (int channel = 0; channel < C::kCount; ++channel) {
        const double value = all.get_sample(i, channel, lane);
        same = same && value == none.get_sample(i, channel, lane);
        error = std::fmax(
            error, std::fabs(value - alone.get_sample(i, channel)) / (100.0 + std::fabs(value)));
      }
    }
    CHECK(error < tolerance(1e-9));
    CHECK(same == (lane % 4 == 1));
  }
}

TEST_CASE("A car with maps follows CVODE", "[unit][reference][effects]") {
  const PreparedCase c =
      prepare(make_case({make_bent_map("front_left", 3), make_bent_map("rear", 4)}));
  ReferenceOptions reference;
  reference.closure = Closure::kTable;
  reference.relative_tolerance = reference.absolute_tolerance = 1e-11;
  const LaneResults truth = run_cvode(c, reference, test::make_plan(0.02));
  const LaneResults run = scalar().run_scalar(c, make_options(2.5e-4), test::make_plan(0.02));
  REQUIRE(run.status[0] == 0);
  REQUIRE(truth.status[0] == 0);
  for (int i = 0; i < run.sample_count; ++i) {
    // A micrometer: what kinks of road and contact within steps leave of the car without maps.
    for (const int channel : {int{C::kBodyPositionZ}, int{C::kPitchAngle}, int{C::kRollAngle}}) {
      CHECK(std::fabs(run.get_sample(i, channel) - truth.get_sample(i, channel)) < tolerance(1e-6));
    }
  }
}

TEST_CASE("Work of a map's force is energy", "[unit][property][effects]") {
  const PreparedCase c = prepare(make_case({make_bent_map("front", 5), make_bent_map("rear", 6)}));
  const auto calc_balance = [&](const double* x) {
    Workspace<double> ws{};
    State<double> dx{};
    const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
    calc_derivative(c.vehicle, closure, TireMode::kRolling, x, dx.data(), ws);
    return calc_energy(c.vehicle, x, ws) - x[I::kWork];
  };
  IntegrateOptions options = make_options(2e-4);
  options.closure = Closure::kNewton;
  const LaneResults run = scalar().run_scalar(c, options, {});
  const double start = calc_balance(c.start.data());
  State<double> end{};
  std::copy(run.final_state.begin(), run.final_state.end(), end.begin());
  CHECK(std::fabs(calc_balance(end.data()) - start) < tolerance(1e-6 * start));
}

// --- files -----------------------------------------------------------------------------------

TEST_CASE("Force maps of a car's file are written back exactly", "[io][property]") {
  const test::TemporaryFolder folder;
  fs::copy(kSource / "examples/tires", folder / "tires", fs::copy_options::recursive);
  fs::create_directory(folder / "vehicles");
  const std::string plain = test::read_text(kCarFile);
  const ForceMaps maps = {make_bent_map("rear", 7), make_bent_map("front_left", 8, 1, 5),
                          make_bent_map("front", 9, 4, 1), make_bent_map("rear_right", 10, 1, 1)};
  const EffectSettings effects = {{"damper_asymmetry", "rear", {0.2}}};
  const std::string text = replace_force_maps(plain, maps, kCar);
  const VehicleSpec read = read_vehicle(folder.write("vehicles/car.toml", text));
  CHECK(read.force_maps == maps);
  CHECK(replace_force_maps(text, maps, kCar) == text);
  CHECK(replace_force_maps(text, {}, kCar) == plain);
  // Effects and maps may stand in one file, in either order.
  const std::string both = replace_effects(text, effects, kCar);
  const VehicleSpec all = read_vehicle(folder.write("vehicles/both.toml", both));
  CHECK(all.force_maps == maps);
  CHECK(all.effects == effects);
  CHECK(replace_effects(both, {}, kCar) == text);
  CHECK(replace_force_maps(both, {}, kCar) == replace_effects(plain, effects, kCar));
  VehicleSpec without = read;
  without.force_maps.clear();
  CHECK(without == read_vehicle(kCarFile));
  // Every number counts where files are compared.
  const auto values = flatten_toml(folder / "vehicles/car.toml");
  const auto counted = std::count_if(values.begin(), values.end(), [](const auto& value) {
    return value.first.find("force_map[1].force") == 0;
  });
  CHECK(counted == 48);
}

TEST_CASE("A force map of a rig's file is written back exactly", "[io][property]") {
  const test::TemporaryFolder folder;
  const ForceMaps maps = {make_bent_map("", 7)};
  const ModelInfo& kind = get_rig_info(RigKind::kQuarterCar);
  const std::string text = replace_force_maps(test::read_text(kRigFile), maps, kind);
  const RigSpec read = read_rig(folder.write("rig.toml", text));
  CHECK(read.force_maps == maps);
  RigSpec without = read;
  without.force_maps.clear();
  CHECK(without == read_rig(kRigFile));
}

TEST_CASE("Rows of an array are no tables", "[io]") {
  const std::string text =
      "a = [\n  [1, \"]\"],  # ]\n[2, 3]]\n\n[[map]]\nb = [\n[1],\n]\n\n[c]\nd = 1\n";
  CHECK(drop_tables(text, "map") == "a = [\n  [1, \"]\"],  # ]\n[2, 3]]\n\n[c]\nd = 1\n");
}

std::string refuse_rig(const std::string& deflection, const std::string& velocity,
                       const std::string& force, const std::string& more = "") {
  const test::TemporaryFolder folder;
  const std::string table = "\n[[force_map]]\ndeflection = " + deflection +
                            "\nvelocity = " + velocity + "\nforce = " + force + "\n" + more;
  try {
    read_rig(folder.write("rig.toml", test::read_text(kRigFile) + table));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_CASE("A wrong force map in a file is refused with its place and what is allowed", "[io]") {
  const std::string d = "[-0.1, 0.1]", v = "[-1, 1]", f = "[[1, 2, 3, 4]]";
  const std::string line = "rig.toml:" + std::to_string([] {
                             const std::string text = test::read_text(kRigFile);
                             return std::count(text.begin(), text.end(), '\n') + 2;
                           }());
  CHECK(refuse_rig(d, v, f).empty());
  CHECK(refuse_rig(d, v, "[[1.0]]").empty());
  CHECK_THAT(refuse_rig("[0.1, -0.1]", v, f), Contains("lower first"));
  CHECK_THAT(refuse_rig("[0.1]", v, f), Contains("two numbers"));
  CHECK_THAT(refuse_rig("[-0.1, 11]", v, f), Contains("deflection[2] = 11: must lie in [-10, 10]"));
  CHECK_THAT(refuse_rig(d, "[-1, 1000]", f), Contains("must lie in [-100, 100] m/s"));
  CHECK_THAT(refuse_rig(d, v, "[[1, 2, 3]]"), Contains("has 3 columns; allowed: 1 or 4 to 64"));
  CHECK_THAT(refuse_rig(d, v, "[[1], [2]]"), Contains("has 2 rows; allowed: 1 or 4 to 64"));
  CHECK_THAT(refuse_rig(d, v, "[[1], [2], [3], [4, 5]]"),
             Contains("force[4] = [4, 5]: must be an array of 1 numbers"));
  CHECK_THAT(refuse_rig(d, v, "[1, 2]"), Contains("force[1] = 1: must be an array of numbers"));
  CHECK_THAT(refuse_rig(d, v, "[]"), Contains("must be an array of rows of numbers"));
  CHECK_THAT(refuse_rig(d, v, "[[]]"), Contains("must be an array of 1 numbers"));
  CHECK_THAT(refuse_rig(d, v, "[[2e6]]"), Contains("must lie in [-1e+06, 1e+06] N"));
  CHECK_THAT(refuse_rig(d, v, f, "forces = 3\n"), Contains("forces"));
  CHECK_THAT(refuse_rig(d, v, f, "place = \"rear\"\n"), Contains("place"));
  CHECK_THAT(refuse_rig(d, v, f,
                        "[[force_map]]\ndeflection = " + d + "\nvelocity = " + v +
                            "\nforce = " + f + "\n"),
             Contains("twice"));
  CHECK_THAT(refuse_rig("[0.1, -0.1]", v, f), Contains(line.substr(0, line.size() - 1)));
}

TEST_CASE("Maps that no model may have are refused", "[unit]") {
  const auto refuse = [](const ForceMaps& maps) {
    try {
      validate(maps, kCar);
    } catch (const ModelError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const ForceMap good = make_bent_map("rear", 1);
  const auto change = [&](auto field, auto value) {
    ForceMap map = good;
    map.*field = value;
    return refuse({map});
  };
  CHECK(refuse({good}).empty());
  CHECK_THAT(refuse({good, good}), Contains("twice"));
  CHECK_THAT(change(&ForceMap::place, "roof"), Contains("front_left"));
  CHECK_THAT(change(&ForceMap::deflection_low, 1.0), Contains("lower first"));
  CHECK_THAT(change(&ForceMap::velocity_high, std::nan("")), Contains("lower first"));
  CHECK_THAT(change(&ForceMap::velocity_count, 3), Contains("1 or 4 to 64"));
  CHECK_THAT(change(&ForceMap::deflection_count, 7), Contains("48 coefficients; allowed: 56"));
  ForceMap bad = good;
  bad.coefficients[5] = std::nan("");
  CHECK_THAT(refuse({bad}), Contains("must lie in"));
}

}  // namespace
}  // namespace strut
