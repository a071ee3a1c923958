// strut identify as a user meets it.
#include <catch2/catch.hpp>

#include "base/text/format_number.h"
#include "io/format/hdf5.h"
#include "io/table/csv.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/test_model.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
namespace fs = std::filesystem;

/// A model and measured tables in a folder of their own.
struct Desk {
  Desk() { write_trained_model(folder / "m.h5", model); }

  Outcome identify(const std::string& words) const {
    return run_program("identify " + (folder / "m.h5").string() + " " + words);
  }
  /// A table of measured rows, with a column that no one needs in front.
  fs::path write_rows(const std::string& name, const std::vector<double>& rows) const {
    std::vector<CsvColumn> columns = {{"note", "", {}}};
    for (const ColumnInfo& input : model.inputs) columns.push_back({input.name, input.unit, {}});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i % 4 == 0) columns[0].values.push_back(1.0);
      columns[1 + i % 4].values.push_back(rows[i]);
    }
    write_csv(folder / name, columns);
    return folder / name;
  }
  /// Options --set of one snapshot.
  std::string set(const std::vector<double>& row) const {
    std::string words;
    for (std::size_t i = 0; i < 4; ++i) {
      words += " --set " + model.inputs[i].name + "=" + format_number(row[i]);
    }
    return words;
  }

  TemporaryFolder folder;
  TrainedModel model = test::make_random_model();
};

std::vector<double> identify_directly(const TrainedModel& model, const double* inputs) {
  std::vector<double> values(2);
  Identifier(model).identify(inputs, values.data());
  return values;
}

TEST_CASE("identify gives the network's values and intervals from the command line", "[io]") {
  const Desk desk;
  const std::vector<double> x = test::draw_inputs(desk.model, 1);
  const Outcome outcome = desk.identify(desk.set(x) + " --json");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const test::JsonTree json = test::parse_json(outcome.out);
  const auto values = identify_directly(desk.model, x.data());
  CHECK(json.get<double>("parameters.front_stiffness.value") == values[0]);
  CHECK(json.get<double>("parameters.rear_damping.value") == values[1]);
  const test::JsonTree& ends = json.get_child("parameters.rear_damping.ci95");
  CHECK(ends.front().second.get_value<double>() == values[1] - 0.25);
  CHECK(ends.back().second.get_value<double>() == values[1] + 0.25);
  CHECK(json.get<std::string>("parameters.front_stiffness.unit") == "N/m");
  CHECK(json.get<bool>("in_range"));
  const Outcome table = desk.identify(desk.set(x));
  CHECK_THAT(table.out, Contains("front_stiffness") && Contains("0.25") && Contains("N s/m"));
}

TEST_CASE("identify gives one answer per row of several files", "[io]") {
  const Desk desk;
  const std::vector<double> x = test::draw_inputs(desk.model, 5);
  const auto first = desk.write_rows("a.csv", {x.begin(), x.begin() + 12});
  Hdf5Writer file(desk.folder / "b.h5");
  for (std::size_t i = 0; i < 4; ++i) {
    file.write("/" + desk.model.inputs[i].name, std::vector<double>{x[12 + i], x[16 + i]},
               {desk.model.inputs[i].unit, "", {}});
  }
  file.commit();
  const std::string files = first.string() + " " + (desk.folder / "b.h5").string();
  const Outcome outcome = desk.identify(files + " --json -o " + (desk.folder / "out.csv").string());
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const test::JsonTree json = test::parse_json(outcome.out);
  const CsvTable table = read_csv(desk.folder / "out.csv");
  REQUIRE(table.row_count() == 5);
  std::size_t row = 0;
  for (const auto& [key, tree] : json.get_child("rows")) {
    const auto values = identify_directly(desk.model, x.data() + 4 * row);
    CHECK(tree.get<double>("parameters.front_stiffness.value") == values[0]);
    CHECK(table.column("rear_damping").values[row] == values[1]);
    CHECK(table.column("rear_damping_high").values[row] == values[1] + 0.25);
    CHECK(table.column("in_range").values[row] == 1.0);
    ++row;
  }
  CHECK(row == 5);
  CHECK(json.get_child("rows").front().second.get<std::string>("place") == first.string() + ":3");
  CHECK(table.column("front_stiffness").unit == "N/m");
  const Outcome again = desk.identify(files + " -o " + (desk.folder / "out.csv").string());
  CHECK(again.code == 2);
  CHECK_THAT(again.messages, Contains("out.csv: exists; --force replaces it"));
}

TEST_CASE("Outside of the range trained on there is no value, unless it is asked for", "[io]") {
  const Desk desk;
  std::vector<double> x = test::draw_inputs(desk.model, 2);
  const double low = desk.model.input_map.low()[3], high = desk.model.input_map.high()[3];
  x[7] = high + 0.25 * (high - low);
  const std::string file = desk.write_rows("a.csv", x).string();
  const Outcome outcome = desk.identify(file + " --json");
  CHECK(outcome.code == 1);
  const test::JsonTree json = test::parse_json(outcome.out);
  CHECK(!json.get<bool>("in_range"));
  const test::JsonTree good = json.get_child("rows").front().second;
  const test::JsonTree bad = json.get_child("rows").back().second;
  CHECK(good.get<bool>("in_range"));
  CHECK(!bad.get<bool>("in_range"));
  CHECK(bad.get<std::string>("parameters.front_stiffness.value") == "null");
  const test::JsonTree outside = bad.get_child("outside").front().second;
  CHECK(outside.get<std::string>("channel") == "pitch_angle");
  CHECK(outside.get<double>("excess") == Approx(0.25).epsilon(1e-9));
  CHECK(outside.get<double>("high") == high);
  const Outcome text = desk.identify(file);
  CHECK(text.code == 1);
  CHECK_THAT(text.messages,
             Contains("a.csv:4: pitch_angle") && Contains("25 %") && Contains("1 of 2 rows"));
  // Asked for, the value is there, its interval is not, and it is still told.
  const Outcome extrapolated = desk.identify(file + " --json --extrapolate");
  CHECK(extrapolated.code == 1);
  const test::JsonTree values = test::parse_json(extrapolated.out).get_child("rows").back().second;
  CHECK(values.get<double>("parameters.front_stiffness.value") ==
        identify_directly(desk.model, x.data() + 4)[0]);
  CHECK(values.get_child("parameters.front_stiffness.ci95").front().second.data() == "null");
  // Within 1.96 sigma of the sensor's noise it is not outside.
  const std::string sigma = format_number(0.25 * (high - low) / 1.9);
  const Outcome noisy = desk.identify(file + " --noise pitch_angle=" + sigma);
  CHECK(noisy.code == 0);
}

TEST_CASE("A snapshot is taken out of a time history at the instant that is named", "[io]") {
  const Desk desk;
  const std::vector<double> x = test::draw_inputs(desk.model, 3);
  std::vector<CsvColumn> columns = {{"time", "s", {0.0, 0.1, 0.3}}};
  std::vector<double> between;
  for (std::size_t i = 0; i < 4; ++i) {
    columns.push_back({desk.model.inputs[i].name, "", {x[i], x[4 + i], x[8 + i]}});
    between.push_back(0.75 * x[4 + i] + 0.25 * x[8 + i]);
  }
  const std::string file = (desk.folder / "drive.csv").string();
  write_csv(file, columns);
  const Outcome refused = desk.identify(file);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.messages, Contains("a time history") && Contains("--event-time"));
  const auto get_value = [&](const std::string& time) {
    const Outcome outcome = desk.identify(file + " --json --event-time " + time);
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    return test::parse_json(outcome.out).get<double>("parameters.front_stiffness.value");
  };
  CHECK(get_value("0") == identify_directly(desk.model, x.data())[0]);
  CHECK(get_value("0.3") == identify_directly(desk.model, x.data() + 8)[0]);
  CHECK(get_value("0.15") ==
        Approx(identify_directly(desk.model, between.data())[0]).epsilon(1e-9));
  CHECK_THAT(desk.identify(file + " --event-time 0.31").messages,
             Contains("--event-time = 0.31: must be in [0, 0.3] s"));
  columns[0].values = {0.0, 0.1, 0.1};
  write_csv(file, columns);
  CHECK_THAT(desk.identify(file + " --event-time 0.05").messages,
             Contains("drive.csv:5: time must ascend"));
}

TEST_CASE("identify refuses what it cannot read, and says what is allowed", "[io]") {
  const Desk desk;
  const std::vector<double> x = test::draw_inputs(desk.model, 1);
  const auto check_refused = [&](const std::string& words, const std::vector<std::string>& texts) {
    const Outcome outcome = desk.identify(words);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    for (const std::string& text : texts) CHECK_THAT(outcome.messages, Contains(text));
  };
  check_refused("", {"MEASURED: missing"});
  check_refused("--set pitch_angel=1",
                {"'pitch_angel' is not an input", "did you mean 'pitch_angle'?"});
  check_refused("--set pitch_angle=1", {"missing body_position_z, body_velocity_z"});
  check_refused("--set pitch_angle=nan", {"not finite"});
  check_refused("--set pitch_angle=x", {"must be a number"});
  check_refused("--set pitch_angle=1 --set pitch_angle=2", {"'pitch_angle' given twice"});
  check_refused(desk.set(x) + " --noise pitch_angle=-1", {"--noise", "0 and above"});
  check_refused(desk.set(x) + " --noise roll_rate=1", {"--noise: 'roll_rate' is not an input"});
  check_refused("/nowhere.csv", {"/nowhere.csv: file not found"});
  const auto write = [&](const std::string& text) {
    return desk.folder.write("a.csv", text).string();
  };
  const std::string names = "body_position_z,body_velocity_z,body_acceleration_z,pitch_angle\n";
  check_refused(write("body_position_z,body_velocity_z,body_acceleration_z,pitch_angel\n1,2,3,4\n"),
                {"a.csv: no column 'pitch_angle'", "did you mean 'pitch_angel'?"});
  check_refused(write(names + "1,2,3,inf\n"), {"a.csv:2: pitch_angle = 'inf'"});
  check_refused(write(names + "# units: m,m/s,N,rad\n1,2,3,4\n"),
                {"column 'body_acceleration_z': unit \"N\"", "allowed: m/s^2"});
  check_refused(write(names + "1,2,3,4\n") + desk.set(x), {"--set", "no file beside it"});
  CHECK_THAT(run_program("identify").messages, Contains("MODEL: missing"));
  CHECK_THAT(run_program("identify " + write(names)).messages,
             Contains("a.csv: damaged, or not a model file"));
}

}  // namespace
}  // namespace strut
