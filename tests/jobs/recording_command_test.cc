// strut inspect, compare --check and identify --columns: a recording with names, units and mistakes
// of its own.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <string>

#include "io/table/csv.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/campaign_files.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::run_program;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";

TEST_CASE("inspect says what a file holds and what is odd", "[io]") {
  const test::TemporaryFolder folder;
  std::string text = "Time (s);Weg [mm];state;Kraft in kN\n";
  for (int i = 0; i < 50; ++i) {
    const std::string time = "0," + std::to_string(100 + 2 * i + (i > 30 ? 10 : 0));
    text += time + ";" + std::to_string(i % 7) + ";on;3\n";
  }
  const std::string file = folder.write("run.csv", text);
  const test::Outcome table = run_program("inspect " + file);
  CHECK(table.code == 0);
  CHECK_THAT(table.out, Contains("separated by semicolons, decimal comma") && Contains("500 Hz") &&
                            Contains("1 gaps (5 samples dropped)"));
  CHECK_THAT(table.out, Contains("state: not numbers (") && Contains("run.csv:2: state = 'on'"));
  const test::Outcome outcome = run_program("inspect " + file + " --json");
  const auto columns = test::parse_json(outcome.out).front().second.get_child("columns");
  REQUIRE(columns.size() == 4);
  auto column = columns.begin();
  CHECK(column->second.get<bool>("is_clock"));
  ++column;
  CHECK(column->second.get<std::string>("name") == "Weg");
  CHECK(column->second.get<std::string>("unit") == "mm");
  ++column;
  CHECK_THAT(column->second.get<std::string>("fault"), Contains("must be a finite number"));
  ++column;
  CHECK(column->second.get<std::string>("unit") == "kN");
  CHECK(run_program("inspect " + (folder / "absent.csv").string()).code == 2);
  CHECK_THAT(run_program("inspect " + file + " -o campaign.toml").messages,
             Contains("--model and -o belong together"));
}

/// Two records of a quarter car in millimeters, one column negated, with names of their own.
std::string write_records(const test::TemporaryFolder& folder) {
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  const auto change = [](std::size_t, std::array<std::string, 4>& cells) {
    for (const std::size_t i : {1U, 2U}) {
      cells[i] = test::print_number(1e3 * std::stod(cells[i]));
    }
    cells[3] = test::print_number(-1e3 * std::stod(cells[3]));
  };
  std::string files;
  for (const char* name : {"a.csv", "b.csv"}) {
    test::write_record(folder, name, test::record_quarter_car(truth), change);
    std::string text = test::read_text(folder / name);
    text.replace(0, text.find('\n'),
                 "t,road_position [mm],unsprung_position [mm],sprung_position [mm]");
    files += " " + folder.write(name, text).string();
    truth.amplitude *= 1.5;
    truth.seed = 2;
  }
  return files;
}

TEST_CASE("A campaign drafted by inspect shows its mistake in the check, and is right without it",
          "[io]") {
  const test::TemporaryFolder folder;
  const std::string files = write_records(folder);
  const std::string campaign = (folder / "campaign.toml").string();
  REQUIRE(run_program("inspect" + files + " --model " + kExamples + "/rigs/quarter_car.toml -o " +
                      campaign)
              .code == 0);
  const std::string check = "compare " + campaign + " --check";
  const test::Outcome wrong = run_program(check);
  CHECK(wrong.code == 1);
  CHECK_THAT(wrong.out, Contains("sprung_position looks negated: sign = -1"));
  const test::Outcome compared =
      run_program("compare " + campaign + " -o " + (folder / "wrong").string());
  CHECK_THAT(compared.messages, Contains("found a mistake (above)") &&
                                    Contains("next: strut compare " + campaign + " --check"));
  CHECK_THAT(test::read_text(folder / "wrong/compare.json"),
             Contains("check of the recordings: sprung_position looks negated"));
  const auto json = test::parse_json(run_program(check + " --json").out);
  REQUIRE(json.get_child("findings").size() == 1);
  CHECK(json.get_child("findings").front().second.get<std::string>("kind") == "sign");

  std::string text = test::read_text(campaign);
  // All masses and rates are free, with a mass for the scale of forces; no feedback, which is off.
  CHECK_THAT(text, Contains("free = [\"sprung_mass\", \"unsprung_mass\", \"stiffness\", "
                            "\"damping\", \"tire_stiffness\", \"tire_damping\"]\n"
                            "prior = { sprung_mass = [2.45, 0.25] }"));
  const std::string column = "column = \"sprung_position\"";
  REQUIRE(text.find(column) != std::string::npos);
  text.insert(text.find(column) + column.size(), ", sign = -1");
  folder.write("campaign.toml", text);
  const test::Outcome right = run_program(check);
  CHECK(right.code == 0);
  CHECK_THAT(right.out, Contains("2 runs: nothing looks wrong"));
  CHECK(run_program(check + " -o " + (folder / "out").string()).code == 2);
}

TEST_CASE(
    "A drafted campaign lets the derivative of an input drive where the input was not recorded",
    "[io]") {
  const test::TemporaryFolder folder;
  std::string rows;
  for (int i = 0; i < 10; ++i) rows += fmt::format("{},{},{},2\n", 0.1 * i, 0.3 * i, 9 - i);
  const auto draft = [&](const std::string& header) {
    const std::string file = folder.write("a.csv", header + "\n" + rows).string();
    const std::string campaign = (folder / "campaign.toml").string();
    REQUIRE(run_program("inspect " + file + " --model " + kExamples +
                        "/rigs/quarter_car.toml --force -o " + campaign)
                .code == 0);
    return test::read_text(campaign);
  };
  const std::string rate = draft("t,road_velocity,body acc [g],note");
  CHECK_THAT(rate, Contains("{ column = \"road_velocity\", role = \"input\" }"));
  CHECK_THAT(rate, Contains("sprung_acceleration = { column = \"body acc\" }"));
  const std::string both = draft("t,road_velocity,road_position,note");
  CHECK_THAT(both, Contains("{ column = \"road_position\", role = \"input\" }"));
  CHECK_THAT(both, Contains("{ column = \"road_velocity\" }"));
}

TEST_CASE("A drafted campaign holds out what is asked for and says what is left to assign",
          "[io]") {
  const test::TemporaryFolder folder;
  std::string rows = "t,road_position,Aufbau,quality\n";
  for (int i = 0; i < 10; ++i) rows += fmt::format("{},{},{},2\n", 0.1 * i, 0.3 * i, 9 - i);
  const std::string first = folder.write("a.csv", rows).string(),
                    second = folder.write("b.csv", rows).string();
  const std::string campaign = (folder / "campaign.toml").string();
  const std::string draft = "inspect " + first + " " + second + " --model " + kExamples +
                            "/rigs/quarter_car.toml --force -o " + campaign + " --hold-out ";
  const test::Outcome outcome = run_program(draft + first);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(outcome.messages, Contains("no channel was found for quality"));
  const std::string text = test::read_text(campaign);
  CHECK_THAT(text,
             Contains("file = \"a.csv\"\nuse  = \"hold_out\"") &&
                 Contains("file = \"b.csv\"\nuse  = \"fit\"") &&
                 Contains("sprung_position = { column = \"Aufbau\" }   # no unit in the file: "
                          "read in m   # a guess") &&
                 Contains("# CHANNEL = { column = \"quality\" }"));
  CHECK(run_program(draft + "c.csv").code == 2);
  CHECK_THAT(run_program(draft + first + "," + second).messages, Contains("no file is left"));
  CHECK(run_program(draft + first + "," + (folder / "." / "a.csv").string()).code == 0);
  CHECK(run_program(draft + "\"\"").code == 2);
  CHECK(run_program("inspect " + first + " --hold-out " + first).code == 2);
}

TEST_CASE("A drafted campaign knows German words, letters and compounds", "[io]") {
  const test::TemporaryFolder folder;
  std::string rows = "Zeit [s];Straßenhöhe [mm];HÖHE RAD [mm];Aufbaubeschleunigung;speed_rads;" +
                     std::string(100000, 'r') + "\n";
  for (int i = 0; i < 10; ++i) {
    rows += fmt::format("0,{};{},5;{};{};{};1\n", i, 3 * i, 9 - i, i % 3, 5 * i);
  }
  const std::string file = folder.write("fahrt.csv", rows).string();
  const std::string campaign = (folder / "campaign.toml").string();
  const test::Outcome outcome = run_program("inspect " + file + " --model " + kExamples +
                                            "/rigs/quarter_car.toml -o " + campaign);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(test::read_text(campaign),
             Contains("road_position       = { column = \"Straßenhöhe\", role = \"input\" }") &&
                 Contains("unsprung_position   = { column = \"HÖHE RAD\" }") &&
                 Contains("sprung_acceleration = { column = \"Aufbaubeschleunigung\" }"));
  // A unit in the plural is no wheel.
  CHECK_THAT(test::read_text(campaign), Contains("# CHANNEL = { column = \"speed_rads\" }"));
}

TEST_CASE("identify reads a recording by the columns of a campaign", "[io]") {
  const test::TemporaryFolder folder;
  const std::string vehicle = kExamples + "/vehicles/paper_sedan.toml";
  const std::string maneuver = kExamples + "/maneuvers/bump_20mps.toml";
  const std::string file = (folder / "drive.csv").string();
  REQUIRE(run_program("simulate " + vehicle + " " + maneuver +
                      " --set rear_damping=1850 --step 0.0005 --rate 200 -o " + file)
              .code == 0);
  const CsvTable table = read_csv(file);
  CsvColumn time = table.column("time"), acceleration = table.column("imu_acceleration_z"),
            rate = table.column("imu_rate_y");
  time.name = "Clock";
  acceleration.name = "AccZ";
  acceleration.unit = "g";
  for (double& a : acceleration.values) a /= -9.80665;
  rate.name = "Pitch";
  rate.unit = "deg/s";
  for (double& r : rate.values) r *= 57.29577951308232;
  write_csv(folder / "logger.csv", {time, acceleration, rate});
  const auto identify = [&](const std::string& unit) {
    const std::string campaign =
        folder.write("columns.toml", "model = \"" + vehicle +
                                         "\"\n[columns]\ntime = { column = \"Clock\" }\n"
                                         "imu_acceleration_z = { column = \"AccZ\", sign = -1" +
                                         unit + " }\nimu_rate_y = { column = \"Pitch\" }\n");
    return run_program("identify " + vehicle + " " + (folder / "logger.csv").string() +
                       " --maneuver " + maneuver + " --window 0.3:2 --json --columns " + campaign);
  };
  const test::Outcome outcome = identify("");
  REQUIRE(outcome.code == 0);
  CHECK(test::parse_json(outcome.out).get<double>("parameters.rear_damping.value") ==
        Approx(1850.0).epsilon(1e-3));
  // The advice counts from the unit in which the column was read.
  CHECK_THAT(identify(", unit = \"ft/s^2\"").messages, Contains("unit = \"g\"?"));
}

}  // namespace
}  // namespace strut
