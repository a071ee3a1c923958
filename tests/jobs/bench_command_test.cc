// `strut bench`: errors, counts, output, baselines.
#include <catch2/catch.hpp>
#include <iterator>

#include "jobs/bench/cases.h"
#include "model/kernel/count_flops.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/check_page.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";
const std::string kSedan = kExamples + "/vehicles/paper_sedan.toml";
const std::string kBump = kExamples + "/maneuvers/bump_20mps.toml";

TEST_CASE("The benchmark's error is that of the worst lane", "[io]") {
  BenchCases bench = make_bench_cases({kSedan, kBump, {}}, 2);
  REQUIRE(bench.acceleration.size() == 2);
  const Kernel& kernel = list_kernels().front();
  BenchSetting lanes, scalar;
  scalar.in_lanes = false;
  CHECK(measure_error(bench, kernel, lanes) < 1e-3);  // the benchmark's limit of an exact run
  for (double& value : bench.acceleration[1]) value *= 2.0;
  // Against twice the truth: |1 - 2| / 2, to the error that both runs have.
  CHECK(measure_error(bench, kernel, lanes) == Approx(0.5).epsilon(1e-3));
  CHECK(measure_error(bench, kernel, scalar) < 1e-3);
}

TEST_CASE("The paper's run costs no more operations than on record", "[io][regression]") {
  struct Recorded {
    const char* label;
    double right_hand_sides;  // of the nominal case alone, RK4 1 ms
    long operations;          // of one of them
  };
  // Counts, not times. After a change that is meant to cost more, write the new ones down here and
  // in docs/performance.md.
  constexpr Recorded kRecorded[] = {{"double", 12057, 25498},
                                    {"lanes", 12057, 25498},
                                    {"lanes_tabulated", 12057, 12076},
                                    {"lanes_one_side", 12057, 12771}};
  const BenchCases bench = make_bench_cases({kSedan, kBump, {}}, 1);
  const std::vector<BenchSetting> settings = list_standard_settings();
  REQUIRE(settings.size() == std::size(kRecorded));
  for (std::size_t i = 0; i < settings.size(); ++i) {
    BenchSetting setting = settings[i];
    INFO(setting.label);
    CHECK(setting.label == kRecorded[i].label);
    setting.in_lanes = false;
    const double count = count_right_hand_sides(bench, list_kernels().back(), setting);
    CHECK(count <= kRecorded[i].right_hand_sides);
    CHECK(count > 12000);
    const long operations = count_flops(bench.cases[0], setting.options).arithmetic;
    CHECK(operations <= kRecorded[i].operations);
    CHECK(operations > kRecorded[i].operations / 2);
  }
}

TEST_CASE("The benchmark prints the agreed keys and compares with itself", "[io][slow]") {
  const TemporaryFolder folder;
  const std::string file = folder / "old.json";
  const Outcome first = run_program("bench --quick --json");
  REQUIRE(first.code == 0);
  CHECK(test::check_hint(first.messages)[1] == "bench");
  folder.write("old.json", first.out);
  const test::JsonTree json = test::parse_json(first.out);
  for (const char* name :
       {"double", "lanes", "lanes_tabulated", "lanes_one_side", "fastest_both_sides", "fastest"}) {
    const std::string figure = std::string("single_core.") + name;
    const double runs = json.get<double>(figure + ".runs_per_s");
    CHECK(runs > 0.0);
    CHECK(json.get<double>(figure + ".real_time_factor") == Approx(3.0 * runs));
    CHECK(json.get<double>(figure + ".flops_per_run") >
          1e3 * json.get<double>(figure + ".rhs_per_run"));
  }
  CHECK(json.get<double>("single_core.lanes.speedup_over_double") ==
        Approx(json.get<double>("single_core.lanes.runs_per_s") /
               json.get<double>("single_core.double.runs_per_s")));
  CHECK(!json.get<std::string>("single_core.fastest.setting").empty());
  CHECK(json.get_child("threads").front().second.get<int>("threads") == 1);
  CHECK(json.get<double>("accuracy.body_acceleration_rms_relative") <= 1e-3);
  CHECK(json.get<long>("flops_per_rhs") > json.get<long>("flops_per_rhs_tabulated"));
  const double share = json.get<double>("share_of_peak");
  CHECK((share > 0.0 && share < 1.0));
  CHECK(json.get<int>("bytes_per_case") > 0);
  for (const char* name : {"cpu", "cores", "isa", "compiler", "commit"}) {
    CHECK(json.get_optional<std::string>(std::string("machine.") + name));
  }
  const std::string report = folder / "speed";
  const Outcome second = run_program("bench --quick --baseline " + file + " --report " + report);
  CHECK(second.code == 0);
  test::check_page(report + "/report.html", 1);
  CHECK_THAT(test::read_text(report + "/report.html"),
             Contains("Chrono::Vehicle") && Contains(json.get<std::string>("machine.cpu")));
  CHECK(run_program("report " + report).code == 0);
  const test::JsonTree written = test::parse_json(test::read_text(report + "/bench.json"));
  CHECK(written.get<double>("flops_per_rhs") == json.get<double>("flops_per_rhs"));
  CHECK_THAT(second.out, Contains("new / old") && Contains("corrected by spin"));
  CHECK_THAT(second.out, Catch::Matchers::Matches("(.|\n)*flops_per_rhs +1.000 +a count\n(.|\n)*"));
}

TEST_CASE("A baseline that is no benchmark is refused", "[io]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("old.json", "{\"a\": 1}");
  const Outcome outcome = run_program("bench --quick --baseline " + file);
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains(file) && Contains("strut bench --json"));
  CHECK(run_program("bench --baseline /nowhere.json").code == 2);
}

TEST_CASE("A benchmark's page replaces no other file", "[io]") {
  for (const char* name : {"bench.json", "verdict.json", "report.html"}) {
    const TemporaryFolder foreign;
    foreign.write(name, "{}");
    const Outcome outcome = run_program("bench --quick --report " + (foreign / "").string());
    INFO(outcome.messages);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("--report") && Contains(name));
    CHECK(test::read_text(foreign / name) == "{}");
  }
}

}  // namespace
}  // namespace strut
