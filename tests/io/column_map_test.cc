#include "io/store/column_map.h"

#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;

const std::vector<ColumnInfo> kHistory = {
    {"time", "s", ""}, {"imu_acceleration_z", "m/s^2", ""}, {"pitch_rate", "rad/s", ""}};

const std::vector<std::string> kKnown = {"time", "imu_acceleration_z", "pitch_rate", "other"};

TEST_CASE("A campaign's columns map any file to channels in SI", "[io]") {
  const TemporaryFolder folder;
  const auto file =
      folder.write("drive.csv", "t;AccZ [g];Nick [°/s]\n0,0;1,0;10\n0,5;-2,0;20\n1,0;3,0;30\n");
  const auto campaign = folder.write(
      "campaign.toml",
      "model = \"not_read.toml\"\n[columns]\ntime = { column = \"t\", offset = -0.5 }\n"
      "imu_acceleration_z = { column = \"AccZ\", sign = -1 }\n"
      "pitch_rate = { column = \"Nick\" }\nother = { column = \"x\", unit = \"?\" }\n"
      "[[run]]\nfile = \"drive.csv\"\nuse = \"fit\"\nwindow = [-0.1, 0.6]\n");
  const ColumnMap map = read_column_map(campaign, kHistory, kKnown);
  const Measurement m = read_channels(file, MeasuredPart::kHistory, kHistory, {}, map);
  CHECK(m.values("time") == std::vector<double>{0.0, 0.5});  // the window, after the offset
  CHECK(m.values("imu_acceleration_z")[0] == Approx(2.0 * 9.80665));
  CHECK(m.values("pitch_rate")[1] == Approx(30.0 * 3.14159265358979 / 180.0));
  CHECK(m.find("pitch_rate")->unit == "rad/s");
  CHECK(m.locate(0) == file.string() + ":3");
}

TEST_CASE("Without a map, channels stand in columns of their own name and unit", "[io]") {
  const TemporaryFolder folder;
  const std::vector<ColumnInfo> channels = {{"pitch_angle", "rad", ""}};
  const auto read = [&](const char* text) {
    return read_channels(folder.write("a.csv", text), MeasuredPart::kSnapshot, channels,
                         {{"time", "s", ""}}, {});
  };
  CHECK(read("pitch_angle\n0.5\n").values("pitch_angle")[0] == 0.5);
  CHECK(read("pitch_angle [mrad]\n0.5\n").values("pitch_angle")[0] == Approx(5e-4));
  CHECK(read("pitch_angle [mrad],time [ms]\n0.5,2\n").values("time")[0] == Approx(2e-3));
  CHECK_THROWS_WITH(read("pitch_angle [mm]\n0.5\n"),
                    Contains("column 'pitch_angle': unit \"mm\"") && Contains("allowed: rad"));
}

TEST_CASE("What a file says of a unit may be overruled, with a note", "[io]") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "time,pitch_rate [deg/s]\n0,1\n");
  const auto read = [&](const std::string& keys) {
    const auto campaign = folder.write(
        "c.toml", "[columns]\npitch_rate = { column = \"pitch_rate\", " + keys + " }\n");
    return read_channels(file, MeasuredPart::kHistory, {kHistory[0], kHistory[2]}, {},
                         read_column_map(campaign, kHistory, kKnown));
  };
  const Measurement overruled = read("unit = \"rad/s\"");
  CHECK(overruled.values("pitch_rate")[0] == 1.0);
  REQUIRE(overruled.notes.size() == 1);
  CHECK_THAT(overruled.notes[0], Contains("the file says that column 'pitch_rate' is in deg/s"));
  CHECK(read("scale = 0.02").values("pitch_rate")[0] == Approx(0.02));  // the user's conversion
  CHECK(read("scale = 0.02").notes.empty());
  CHECK_THROWS_WITH(read("sign = 2"), Contains("sign = 2: must be 1 or -1"));
}

TEST_CASE("Columns may swap their names, or pass them on", "[io]") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "time,imu_acceleration_z,pitch_rate\n0,1,2\n1,3,4\n");
  const auto read = [&](const std::string& columns) {
    const auto campaign = folder.write("c.toml", "[columns]\n" + columns);
    return read_channels(file, MeasuredPart::kHistory, kHistory, {},
                         read_column_map(campaign, kHistory, kKnown));
  };
  const Measurement swapped = read(
      "imu_acceleration_z = { column = \"pitch_rate\" }\n"
      "pitch_rate = { column = \"imu_acceleration_z\" }\n");
  CHECK(swapped.values("imu_acceleration_z") == std::vector<double>{2.0, 4.0});
  CHECK(swapped.values("pitch_rate") == std::vector<double>{1.0, 3.0});
  const Measurement chain = read(
      "time = { column = \"imu_acceleration_z\" }\n"
      "imu_acceleration_z = { column = \"pitch_rate\" }\npitch_rate = { column = \"time\" }\n");
  CHECK(chain.values("time") == std::vector<double>{1.0, 3.0});
  CHECK(chain.values("imu_acceleration_z") == std::vector<double>{2.0, 4.0});
  CHECK(chain.values("pitch_rate") == std::vector<double>{0.0, 1.0});
}

TEST_CASE("Of a file with several windows all is read, and a note says so", "[io]") {
  const TemporaryFolder folder;
  const auto file = folder.write("a.csv", "time,pitch_rate\n0,1\n1,2\n2,3\n");
  const std::vector<ColumnInfo> channels = {kHistory[0], kHistory[2]};
  const auto read = [&](const std::string& windows) {
    const auto campaign =
        folder.write("c.toml", "[columns]\ntime = { column = \"time\" }\n" + windows);
    return read_channels(file, MeasuredPart::kHistory, channels, {},
                         read_column_map(campaign, channels, kKnown));
  };
  const std::string first = "[[run]]\nfile = \"a.csv\"\nwindow = [0, 1]\n";
  CHECK(read(first).row_count() == 2);
  CHECK_THAT(read(first).notes.front(), Contains("only 0 to 1 s"));
  const Measurement both = read(first + "[[run]]\nfile = \"a.csv\"\nwindow = [1, 2]\n");
  CHECK(both.row_count() == 3);
  CHECK_THAT(both.notes.front(), Contains("2 windows"));
}

TEST_CASE("A map for one clock refuses other clocks and unknown channels", "[io]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& columns) {
    read_column_map(folder.write("c.toml", "[columns]\n" + columns), kHistory, kKnown);
  };
  CHECK_THROWS_WITH(read("pitch_rate = { column = \"p\", delay = 0.05 }\n"),
                    Contains("c.toml:2") && Contains("delay"));
  CHECK_THROWS_WITH(read("pitch_rate = { column = \"p\", clock = \"t2\" }\n"), Contains("clock"));
  CHECK_THROWS_WITH(read("pitch_rat = { column = \"p\" }\n"),
                    Contains("did you mean 'pitch_rate'"));
}

}  // namespace
}  // namespace strut
