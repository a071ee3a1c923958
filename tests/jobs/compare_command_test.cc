// strut compare as a user runs it.

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>

#include "io/table/csv.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::run_program;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";

std::string compare(const std::filesystem::path& campaign, const std::filesystem::path& folder,
                    const std::string& options = "") {
  return "compare " + campaign.string() + " -o " + folder.string() + " " + options;
}

/// A campaign of two runs with nothing free.
std::filesystem::path write_quick_campaign(const test::TemporaryFolder& folder) {
  test::write_two_runs(folder);
  test::CampaignText text;
  text.fit = "";
  return test::write_campaign(folder, text);
}

TEST_CASE("compare writes numbers, tables, figures and a report of every run", "[io][threads]") {
  const test::TemporaryFolder folder;
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  test::write_two_runs(folder, truth);
  const auto campaign = test::write_campaign(folder);
  const test::Outcome outcome = run_program(compare(campaign, folder / "out", "--json"));
  CHECK(outcome.code == 0);
  const auto json = test::parse_json(outcome.out);
  CHECK(test::read_text(folder / "out" / "compare.json") == outcome.out);
  CHECK(json.get<bool>("adequate"));
  CHECK(json.get<std::string>("noise.sprung_position.source") == "estimated");
  const double stiffness = json.get<double>("parameters.stiffness.value");
  CHECK(stiffness == Approx(950.0).epsilon(test::tolerance(0.01)));
  CHECK(json.get<double>("parameters.stiffness.nominal") == 900.0);
  int runs = 0;
  for (const auto& [key, run] : json.get_child("runs")) {
    const auto& before = run.get_child("nominal.channels.sprung_position");
    const auto& after = run.get_child("calibrated.channels.sprung_position");
    CHECK(after.get<double>("nrmse") < 0.5 * before.get<double>("nrmse"));
    CHECK(after.get_child("time").size() == 5);
    CHECK(after.get_child("band").size() == 5);
    CHECK(after.get_child("state").size() == 3);
    CHECK(run.get<double>("balance.nrmse") < 0.5);
    ++runs;
  }
  CHECK(runs == 2);
  const CsvTable table = read_csv(folder / "out" / "run_1_a.csv", MissingCells::kNan);
  CHECK(table.row_count() == 801);
  // The table and compare.json give the same residual.
  double squares = 0.0;
  const auto& measured = table.column("sprung_position").values;
  const auto& simulated = table.column("sprung_position_calibrated").values;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    squares += std::pow(measured[i] - simulated[i], 2.0) / static_cast<double>(measured.size());
  }
  const auto& first = json.get_child("runs").front().second;
  CHECK(std::sqrt(squares) ==
        Approx(first.get<double>("calibrated.channels.sprung_position.rms")).epsilon(1e-6));
  const std::string report = test::read_text(folder / "out" / "report.html");
  CHECK_THAT(report, Contains("Adequate") && Contains("b.csv, held out") && Contains("</html>"));
  CHECK(std::filesystem::exists(folder / "out" / "channels.csv"));
}

TEST_CASE("compare does not replace a comparison without --force", "[io]") {
  const test::TemporaryFolder folder;
  const auto campaign = write_quick_campaign(folder);
  const test::Outcome first = run_program(compare(campaign, folder / "out"));
  CHECK(first.code == 0);
  CHECK(test::check_hint(first.messages)[1] == "diagnose");
  const test::Outcome again = run_program(compare(campaign, folder / "out"));
  CHECK(again.code == 2);
  CHECK_THAT(again.messages, Contains("--force"));
  CHECK(run_program(compare(campaign, folder / "out", "--force")).code == 0);
}

TEST_CASE("compare replaces the files of an earlier comparison and no others", "[io]") {
  const test::TemporaryFolder folder;
  const auto campaign = write_quick_campaign(folder);
  const std::filesystem::path out = folder / "out";
  REQUIRE(run_program(compare(campaign, out)).code == 0);
  CHECK(std::filesystem::exists(out / "run_2_b.csv"));
  CHECK(std::filesystem::exists(out / "figures/run_2_b_time.json"));
  folder.write("out/mine.csv", "1,2\n");
  folder.write("out/figures/mine.svg", "<svg/>\n");

  std::filesystem::rename(folder / "b.csv", folder / "c.csv");
  std::string renamed = test::read_text(campaign);
  renamed.replace(renamed.find("b.csv"), 5, "c.csv");
  folder.write("campaign.toml", renamed);
  REQUIRE(run_program(compare(campaign, out, "--force")).code == 0);
  CHECK(test::read_text(out / "mine.csv") == "1,2\n");
  CHECK(test::read_text(out / "figures/mine.svg") == "<svg/>\n");
  CHECK(std::filesystem::exists(out / "run_2_c.csv"));
  CHECK_FALSE(std::filesystem::exists(out / "run_2_b.csv"));
  for (const auto& entry : std::filesystem::directory_iterator(out / "figures")) {
    CHECK_THAT(entry.path().filename().string(), !Contains("run_2_b"));
  }
}

TEST_CASE("compare into the campaign's own folder leaves its input files unchanged", "[io]") {
  const test::TemporaryFolder folder;
  const auto campaign = write_quick_campaign(folder);
  const std::string written = test::read_text(campaign),
                    measured = test::read_text(folder / "a.csv");
  CHECK(run_program(compare(campaign, folder / "")).code == 0);
  CHECK(run_program(compare(campaign, folder / "", "--force")).code == 0);
  CHECK(test::read_text(campaign) == written);
  CHECK(test::read_text(folder / "a.csv") == measured);
}

TEST_CASE("compare replaces only files of an earlier comparison", "[io]") {
  const test::TemporaryFolder folder;
  test::write_two_runs(folder);
  const auto campaign = test::write_campaign(folder);
  std::filesystem::create_directory(folder / "mine");
  folder.write("mine/channels.csv", "1,2\n");
  const test::Outcome mine = run_program(compare(campaign, folder / "mine", "--force"));
  CHECK(mine.code == 2);
  CHECK_THAT(mine.messages, Contains("holds channels.csv") && Contains("another folder"));
  CHECK(test::read_text(folder / "mine/channels.csv") == "1,2\n");

  std::filesystem::create_directory(folder / "diagnosis");
  folder.write("diagnosis/verdict.json", "{}\n");
  const test::Outcome other = run_program(compare(campaign, folder / "diagnosis", "--force"));
  CHECK(other.code == 2);
  CHECK_THAT(other.messages, Contains("holds a diagnosis (verdict.json)"));

  const std::string simulate =
      "simulate examples/vehicles/paper_sedan.toml examples/maneuvers/bump_20mps.toml -o " +
      std::string(folder / "run.csv") + " --report ";
  const test::Outcome run = run_program(simulate + std::string(folder / "diagnosis"));
  CHECK(run.code == 2);
  CHECK_THAT(run.messages, Contains("--report") && Contains("holds a diagnosis (verdict.json)"));
  REQUIRE(run_program(simulate + std::string(folder / "crossing")).code == 0);
  const test::Outcome crossing = run_program(compare(campaign, folder / "crossing", "--force"));
  CHECK(crossing.code == 2);
  CHECK_THAT(crossing.messages, Contains("holds the report of a simulated run"));
}

TEST_CASE("compare ends with code 2 and a plain message on bad data", "[io]") {
  const test::TemporaryFolder folder;
  test::write_two_runs(folder, {}, [](std::size_t row, std::array<std::string, 4>& cells) {
    if (row == 30) cells[0] = "0.1";
  });
  const test::Outcome outcome = run_program(compare(test::write_campaign(folder), folder / "out"));
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.messages, Contains("a.csv:32") && Contains("runs backwards"));
}

TEST_CASE("The example campaigns are complete except for their recordings", "[io]") {
  for (const char* name : {"quarter_car", "damper_dyno"}) {
    const test::TemporaryFolder folder;
    const test::Outcome outcome =
        run_program(compare(kExamples + "/campaigns/" + name + ".toml", folder / "out"));
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("run[1].file") && Contains("file not found"));
  }
}

TEST_CASE("A damper on a crank is compared by its force", "[io][threads]") {
  const test::TemporaryFolder folder;
  const auto record = [](std::uint64_t seed) {
    std::string text = "t_s,disp_mm,force_N,temp_C\n";
    for (int i = 0; i < 3000; ++i) {
      const double t = std::round(i / 300.0 * 1e4) / 1e4, w = 6.6;
      const double force = 1500.0 * 0.0187 * w * std::cos(w * i / 300.0) + 40.0 +
                           0.5 * test::calc_test_normal(seed, 0, static_cast<std::uint64_t>(i));
      text += test::print_number(t) + "," + test::print_number(18.7 * std::sin(w * i / 300.0)) +
              "," + test::print_number(force) + ",25\n";
    }
    return text;
  };
  folder.write("trial_1.csv", record(1));
  folder.write("trial_2.csv", record(2));
  std::string campaign = test::read_text(kExamples + "/campaigns/damper_dyno.toml");
  campaign.replace(campaign.find("../rigs"), 7, kExamples + "/rigs");
  const test::Outcome outcome = run_program(
      compare(folder.write("dyno.toml", campaign), folder / "out", "--json --threads 1"));
  CHECK(outcome.code == 0);
  const auto json = test::parse_json(outcome.out);
  // 0.5 N of noise on 2000 s N/m at 0.09 m/s rms, 3000 readings: 0.1 N s/m.
  CHECK(json.get<double>("parameters.damping.value") == Approx(1500.0).epsilon(1e-3));
  CHECK(json.get<bool>("adequate"));
}

TEST_CASE("A car's crossing is compared axle by axle", "[io]") {
  const test::TemporaryFolder folder;
  const std::string vehicle = kExamples + "/vehicles/paper_sedan.toml";
  const std::string maneuver = kExamples + "/maneuvers/bump_20mps.toml";
  const auto record = [&](const std::string& name, const std::string& more) {
    REQUIRE(run_program("simulate " + vehicle + " " + maneuver +
                        " --set rear_damping=1700 --step 0.0005 --rate 250 " + more + " -o " +
                        std::string(folder / name))
                .code == 0);
  };
  record("a.csv", "");
  record("b.h5", "--set speed=19.5");
  const auto run = [&](const std::string& file, const std::string& use, const std::string& more) {
    return "[[run]]\nfile = \"" + file + "\"\nuse = \"" + use + "\"\nmaneuver = \"" + maneuver +
           "\"\n" + more;
  };
  const auto campaign = folder.write(
      "car.toml", "model = \"" + vehicle +
                      "\"\n[columns]\ntime = {}\nimu_acceleration_z = { noise = 0.02 }\n"
                      "imu_rate_y = { noise = 1e-3 }\n[fit]\nfree = [\"rear_damping\"]\n" +
                      run("a.csv", "fit", "window = [0.1, 2.0]\n") +
                      run("b.h5", "hold_out", "speed = [19.6, 0.1]\nhit_time = [0, 0.002]\n"));
  const test::Outcome outcome = run_program(compare(campaign, folder / "out", "--json"));
  CHECK(outcome.code == 0);
  const auto json = test::parse_json(outcome.out);
  CHECK(json.get<double>("parameters.rear_damping.value") ==
        Approx(1700.0).epsilon(test::tolerance(2e-3)));
  const auto& held = json.get_child("runs").back().second;
  CHECK(held.get<double>("calibrated.run_values.speed") ==
        Approx(19.5).epsilon(test::tolerance(5e-4)));
  const auto& before = held.get_child("nominal.channels.imu_acceleration_z");
  const auto& after = held.get_child("calibrated.channels.imu_acceleration_z");
  CHECK(after.get<double>("nrmse") < 0.1 * before.get<double>("nrmse"));
  const auto& time = before.get_child("time");
  REQUIRE(time.size() == 5);
  CHECK(time.front().first == "approach");
  // A worn rear damper shows when the rear axle crosses, not before.
  CHECK(time.get<double>("ring-down.rms") > 5.0 * time.get<double>("approach.rms"));
  CHECK(json.get<bool>("adequate"));

  const std::string rough = kExamples + "/maneuvers/rough_road.toml";
  const auto on_rough_road = [&](const std::string& file, const std::string& use) {
    return "[[run]]\nfile = \"" + file + "\"\nuse = \"" + use + "\"\nmaneuver = \"" + rough +
           "\"\n";
  };
  const auto known = folder.write(
      "known.toml", "model = \"" + vehicle +
                        "\"\n[columns]\ntime = {}\nimu_rate_y = { noise = 1e-3 }\n[fit]\n"
                        "free = [\"rear_damping\"]\n" +
                        on_rough_road("a.csv", "fit") + on_rough_road("b.h5", "hold_out"));
  const test::Outcome refused = run_program(compare(known, folder / "road"));
  CHECK(refused.code == 2);
  CHECK_THAT(refused.messages, Contains("rough_road.toml: road: a campaign finds"));
}

}  // namespace
}  // namespace strut
