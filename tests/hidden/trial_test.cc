// Drawing, grading and writing of trials.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/hidden/ablation.h"
#include "tests/hidden/campaign_files.h"
#include "tests/hidden/fault_range.h"
#include "tests/hidden/sha256.h"
#include "tests/jobs/run_program.h"
#include "tests/support/tolerance.h"

namespace strut::hidden {
namespace {

using test::tolerance;

Truth with_fault(const Kit& kit, const FaultSetting& setting) {
  Truth truth = make_nominal_truth(kit);
  truth.faults = {setting};
  return truth;
}

std::map<std::string, std::string> read_folder(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[std::filesystem::relative(entry.path(), folder).string()] =
        test::read_text(entry.path().string());
  }
  return files;
}

/// Whether no magnitude could have had the ratio that was asked for: it is as near to the end that
/// its search may not pass as nine halvings come.
bool is_at_end(const Kit& kit, const HiddenFault& f) {
  const auto [low, high] = find_bracket(kit, f.setting.fault);
  const double size = std::fabs(f.setting.magnitude);
  return f.ratio < f.target ? size > 0.97 * high : size < 1.1 * low;
}

}  // namespace

TEST_CASE("Hidden data: 780 trials hide nothing 300 times and something unknown 100 times",
          "[unit]") {
  std::map<Category, int> count;
  for (std::uint64_t seed = 0; seed < 780; ++seed) ++count[draw_category(seed)];
  CHECK(count[Category::kNone] == 300);
  CHECK(count[Category::kOne] == 280);
  CHECK(count[Category::kTwo] == 100);
  CHECK(count[Category::kUnknown] == 100);
}

TEST_CASE("Hidden data: seeds of earlier measurements hide what they hid", "[regression]") {
  const Kit kit = make_kit("dyno");
  std::string hidden;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const FaultSetting& f : draw_faults(kit, seed)) {
      CHECK_FALSE(get_info(f.fault).newer);
      hidden += std::to_string(seed) + " " + get_info(f.fault).name + "; ";
    }
  }
  CHECK(hidden ==
        "0 sensor low-pass; 1 friction by stroke; 3 idle stroke; 3 LuGre friction; "
        "6 idle stroke; 11 lag; ");
  int newer = 0;
  for (std::uint64_t seed = kNewerFaults; seed < kNewerFaults + 39; ++seed) {
    for (const FaultSetting& f : draw_faults(kit, seed)) {
      newer += get_info(f.fault).newer ? 1 : 0;
    }
  }
  CHECK(newer > 0);
}

TEST_CASE("Hidden data: every name is listed at its place", "[unit]") {
  const auto& list = list_faults();
  REQUIRE(list.size() == static_cast<std::size_t>(Fault::kCount));
  for (std::size_t i = 0; i < list.size(); ++i) CHECK(list[i].fault == static_cast<Fault>(i));
}

TEST_CASE("Hidden data: a warming damper loses from run to run, the first keeps all", "[unit]") {
  const Kit kit = make_kit("dyno");
  const Truth warming = with_fault(kit, {Fault::kWarming, 0, 0.2, 0.0});
  // At most 1 of the crank's sine the damper's force is that of its rate: 20 % less in the last
  // run.
  for (const auto& [run, share] : {std::pair<std::size_t, double>{0, 1.0}, {2, 0.9}, {4, 0.8}}) {
    Truth weaker = make_nominal_truth(kit);
    weaker.factors[1] = share;
    const auto a = simulate_run(kit, warming, run, kit.rate, 0.0);
    const auto b = simulate_run(kit, weaker, run, kit.rate, 0.0);
    for (std::size_t i = 0; i < a[1].value.size(); i += 50) {
      REQUIRE(a[1].value[i] == Approx(b[1].value[i]).margin(tolerance(1e-6)));
    }
  }
}

TEST_CASE("Hidden data: a wrong speedometer is another speed in every run", "[unit]") {
  const Kit kit = make_kit("car");
  const FaultSetting wrong{Fault::kSpeedometer, 0, 0.02, 0.0};
  const std::size_t run = 3;
  REQUIRE(kit.runs[run].speed == Approx(30.0 / 3.6));
  Truth faster = make_nominal_truth(kit);
  faster.speed_error[run] = 0.03;
  const auto a = simulate_run(kit, with_fault(kit, wrong), run, 100.0, 0.0);
  const auto b = simulate_run(kit, faster, run, 100.0, 0.0);
  for (std::size_t c = 0; c < a.size(); ++c) {
    for (std::size_t i = 0; i < a[c].value.size(); ++i) {
      // Speeds that differ in their last digit, through adaptive steps.
      REQUIRE(a[c].value[i] ==
              Approx(b[c].value[i]).margin(tolerance(0.01 * kit.sensors[c].noise)));
    }
  }
}

TEST_CASE("Hidden data: ablations leave out what they say and keep the rest", "[unit]") {
  Kit kit = make_kit("car");
  Trial trial;
  trial.category = Category::kTwo;
  trial.truth = make_nominal_truth(kit);
  trial.truth.roughness = 16e-6;
  const auto lost = static_cast<int>(
      std::find_if(kit.sensors.begin(), kit.sensors.end(),
                   [](const Sensor& s) { return s.channel == "rear_left_suspension_deflection"; }) -
      kit.sensors.begin());
  trial.truth.faults = {{Fault::kSensorGain, lost, 0.03, 0.0}, {Fault::kPayload, 0, 40.0, 0.0}};
  for (const FaultSetting& s : trial.truth.faults) trial.faults.push_back({s, 20.0, 20.0, {}});
  const Trial whole = trial;
  const auto count_sensors = [&] {
    return std::count_if(kit.sensors.begin(), kit.sensors.end(),
                         [](const Sensor& s) { return s.recorded; });
  };
  SECTION("no roughness") {
    ablate(Ablation::kNoRoughness, kit, trial);
    CHECK(trial.truth.roughness == 0.0);
    CHECK(count_sensors() == 12);
    CHECK(trial.faults.size() == 2);
  }
  SECTION("no deflections, and the fault of one of them is nowhere") {
    ablate(Ablation::kNoDeflection, kit, trial);
    CHECK(count_sensors() == 8);
    CHECK(trial.category == Category::kOne);
    REQUIRE(trial.truth.faults.size() == 1);
    CHECK(trial.truth.faults[0].fault == Fault::kPayload);
    CHECK(trial.get_grade() == whole.get_grade());
  }
  SECTION("the body's sensors alone") {
    ablate(Ablation::kBodyOnly, kit, trial);
    CHECK(count_sensors() == 4);
  }
  SECTION("one crossing, the level road and what is held out") {
    ablate(Ablation::kOneCrossing, kit, trial);
    std::string left;
    for (const RunPlan& run : kit.runs) left += run.recorded ? run.name + " " : "";
    CHECK(left == "middle_20 flat_20 middle_22 low_14 high_24 ");
  }
  CHECK_THROWS_WITH(make_ablation("no_sensor"), Catch::Contains("body_only"));
}

TEST_CASE("Hidden data: what is left out is in no file", "[io]") {
  Kit kit = make_kit("quarter_car");
  Trial trial = draw_trial(kit, 0);
  ablate(Ablation::kBodyOnly, kit, trial);
  ablate(Ablation::kOneCrossing, kit, trial);
  const test::TemporaryFolder folder;
  write_trial(kit, trial, folder / "x");
  const auto files = read_folder(std::filesystem::path(folder / "x") / "trials" / "000000");
  CHECK(files.count("chirp_A.csv") == 0);
  CHECK(files.count("chirp_B.csv") == 1);
  CHECK(files.at("rough_A.csv").rfind("Time,z_plate,z_body\n", 0) == 0);
  CHECK(files.at("campaign.toml").find("unsprung_position") == std::string::npos);
  CHECK(files.at("campaign.toml").find("chirp_A") == std::string::npos);
}

TEST_CASE("Hidden data: a trial depends on its seed and on nothing else", "[property]") {
  const Kit kit = make_kit("dyno");
  const test::TemporaryFolder a, b;
  for (const std::uint64_t seed : {3U, 1U, 2U, 0U})
    write_trial(kit, draw_trial(kit, seed), a / "x");
  for (const std::uint64_t seed : {0U, 1U, 2U, 3U})
    write_trial(kit, draw_trial(kit, seed), b / "x");
  seal_truths(a / "x");
  seal_truths(b / "x");
  const auto files = read_folder(a / "x");
  CHECK(files == read_folder(b / "x"));
  CHECK(files.count("trials/000003/campaign.toml") == 1);
  CHECK(files.count("truths/000003.json") == 1);
  const std::string sealed = calc_sha256(files.at("truths/000002.json")) + "  000002.json";
  CHECK(files.at("truths/SHA256SUMS").find(sealed) != std::string::npos);
}

TEST_CASE("Hidden data: ratios are what was asked for, over all grades", "[statistical]") {
  const Kit kit = make_kit("dyno");
  std::map<char, int> grades;
  for (std::uint64_t seed = 0; seed < 39; ++seed) {
    for (const HiddenFault& f : draw_trial(kit, seed).faults) {
      INFO(seed << " " << get_info(f.setting.fault).name << ", " << f.setting.magnitude
                << ", ratio " << f.ratio << " for " << f.target);
      ++grades[find_grade(f.ratio)];
      const bool met = std::fabs(f.ratio / f.target - 1.0) < tolerance(0.05);
      CHECK((met || is_at_end(kit, f)));
    }
  }
  for (const char grade : {'A', 'B', 'C', 'D'}) CHECK(grades[grade] >= 2);
}

TEST_CASE("Hidden data: machines have larger effects, small misfits and errors of sensors",
          "[statistical]") {
  const Kit exact = make_kit("dyno"), machine = make_kit("dyno", Regime::kMachine);
  int larger = 0, hidden = 0;
  std::size_t misfits = 0;
  for (std::uint64_t seed = 9420; seed < 9440; ++seed) {
    const Trial small = draw_trial(exact, seed), large = draw_trial(machine, seed);
    INFO(seed);
    CHECK(small.misfits.empty());
    CHECK(small.truth.sensor_gain == std::vector<double>(2, 0.0));
    misfits += large.misfits.size();
    CHECK(large.truth.faults.size() == large.faults.size() + large.misfits.size());
    REQUIRE(large.faults.size() == small.faults.size());
    for (const HiddenFault& m : large.misfits) {
      CHECK(m.ratio < tolerance(3.0));
      for (const HiddenFault& f : large.faults) CHECK(m.setting.fault != f.setting.fault);
    }
    for (std::size_t i = 0; i < large.faults.size(); ++i) {
      CHECK(large.faults[i].setting.fault == small.faults[i].setting.fault);
      CHECK(large.faults[i].target > 10.0 * small.faults[i].target);
      CHECK(large.faults[i].target < 30.0 * small.faults[i].target);
      ++hidden;
      larger += large.faults[i].ratio > 8.0 * small.faults[i].ratio ? 1 : 0;
    }
    CHECK(std::fabs(large.truth.sensor_gain[1]) > 0.0);
    CHECK(std::fabs(large.truth.sensor_gain[1]) < tolerance(5e-3));
    CHECK(std::fabs(large.truth.sensor_skew[0]) < tolerance(1e-4));
  }
  CHECK(misfits > 20);
  // Some are at the largest size that they can have.
  CHECK(larger > hidden / 2);
  CHECK_THROWS_WITH(make_regime("real"), Catch::Contains("machine"));
}

TEST_CASE("Hidden data: nothing that the tested program gets tells of the truth", "[unit]") {
  const Kit kit = make_kit("quarter_car");
  const test::TemporaryFolder folder;
  std::map<std::string, std::string> first;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    write_trial(kit, draw_trial(kit, seed), folder / "x");
    auto files =
        read_folder(std::filesystem::path(folder / "x") / "trials" / make_trial_name(seed));
    std::erase_if(files, [](const auto& file) { return file.first.ends_with(".csv"); });
    if (seed == 0) first = files;
    CHECK(files == first);
  }
}

TEST_CASE("Hidden data: a truth that is not what was sealed is not sealed anew", "[io]") {
  const Kit kit = make_kit("dyno");
  const test::TemporaryFolder folder;
  const std::filesystem::path place = folder / "x";
  write_trial(kit, draw_trial(kit, 0), place);
  seal_truths(place);
  write_trial(kit, draw_trial(kit, 1), place);
  seal_truths(place);
  const std::string sums = test::read_text((place / "truths/SHA256SUMS").string());
  CHECK(std::count(sums.begin(), sums.end(), '\n') == 2);
  std::ofstream(find_truth(place, 0), std::ios::app) << " ";
  CHECK_THROWS_WITH(seal_truths(place), Catch::Contains("000000.json"));
  CHECK(test::read_text((place / "truths/SHA256SUMS").string()) == sums);
  // Nor is one that is gone forgotten.
  std::filesystem::remove(find_truth(place, 0));
  seal_truths(place);
  CHECK(test::read_text((place / "truths/SHA256SUMS").string()) == sums);
}

TEST_CASE("Hidden data: every fault has a place in the words of a verdict", "[unit]") {
  const auto find = [](const char* kit, Fault fault, int place) {
    return get_where(make_kit(kit), {fault, place, 0.1, 0.0});
  };
  CHECK(find("dyno", Fault::kSelectiveDamper, 0) == "strut");
  CHECK(find("quarter_car", Fault::kInerter, 0) == "strut");
  CHECK(find("quarter_car", Fault::kHum, 0) == "body");
  CHECK(find("quarter_car", Fault::kTirePower, 0) == "tire");
  CHECK(find("quarter_car", Fault::kRoadGain, 0) == "road");
  CHECK(find("quarter_car", Fault::kSaturation, 2) == "sprung_position");
  CHECK(find("car", Fault::kWarming, 1) == "rear");
  CHECK(find("car", Fault::kEngine, 0) == "body");
  CHECK(find("car", Fault::kParabola, 0) == "road");
}

TEST_CASE("Hidden data: SHA-256 of FIPS 180-4's examples", "[reference]") {
  CHECK(calc_sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(calc_sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

}  // namespace strut::hidden
