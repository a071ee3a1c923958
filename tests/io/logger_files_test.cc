// Text tables as data loggers write them, cut down to a few rows.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "io/table/csv.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
using Values = std::vector<double>;

CsvTable read(const std::string& text) {
  const TemporaryFolder folder;
  return read_csv(folder.write("a.csv", text), MissingCells::kNan);
}

TEST_CASE("Dates carry clock times over days, in either order of day and month", "[io]") {
  // From the third to the fourth of May or, the month first, from 5 March to 5 April.
  for (const char* separator : {".", "/", "-"}) {
    CAPTURE(separator);
    const auto date = [&](const char* day) {
      return day + std::string(separator) + "05" + separator + "2026 ";
    };
    const CsvTable table = read("t;F\n" + date("03") + "10:00:00;1\n" + date("04") +
                                "09:00:00;2\n" + date("04") + "09:00:01;3\n");
    CHECK(table.column("t").values == Values{0.0, 82800.0, 82801.0});
  }
  // The end of summer time: UTC runs on.
  CHECK(
      read("t,F\n2026-10-25T02:59:59+02:00,1\n2026-10-25T02:00:00+01:00,2\n").column("t").values ==
      Values{0.0, 1.0});
}

TEST_CASE("Minutes and seconds begin anew each hour", "[io]") {
  CHECK(read("t,F\n59:59.5,1\n00:00.0,2\n00:00.5,3\n").column("t").values == Values{0.0, 0.5, 1.0});
}

TEST_CASE("Times since 1970 in less than seconds become seconds since the first row", "[io]") {
  // Sensor Logger for telephones, nanoseconds; others, milliseconds.
  const CsvTable phone = read(
      "time,seconds_elapsed,z\n1700000000000000000,0.5,1\n1700000000010000000,0.51,2\n"
      "1700000000020000000,0.52,3\n");
  const CsvColumn& time = phone.column("time");
  CHECK(time.unit == "s");
  CHECK(time.values[2] == Approx(0.02).margin(1e-6));
  CHECK(phone.column("seconds_elapsed").values == Values{0.5, 0.51, 0.52});
  REQUIRE(phone.notes.size() == 1);
  CHECK_THAT(phone.notes.front(), Contains("nanoseconds since 1970"));
  CHECK(read("Timestamp,z\n1700000000000,1\n1700000000010,2\n").column("Timestamp").values ==
        Values{0.0, 0.01});
  CHECK(read("time,z\n1700000000,1\n1700000001,2\n").notes.empty());
}

TEST_CASE("A line that numbers the columns is no row", "[io]") {
  // pandas without names, and AiM, which numbers the columns below names and units.
  const CsvTable pandas = read("0,1,2\n0.0,1.5,2.5\n0.1,1.25,2.25\n");
  CHECK(pandas.column("0").values == Values{0.0, 0.1});
  CHECK(pandas.column("2").values == Values{2.5, 2.25});
  const CsvTable aim = read(
      "\"Format\",\"AiM CSV File\"\n\"Sample Rate\",\"100\"\n\"Time\",\"Damper\",\"Acc\"\n"
      "\"s\",\"mm\",\"g\"\n\n\"1\",\"2\",\"3\"\n\"0.000\",\"1.5\",\"0.9\"\n"
      "\"0.010\",\"1.6\",\"1.0\"\n\"0.020\",\"1.7\",\"1.1\"\n");
  CHECK(aim.column("Time").values == Values{0.0, 0.01, 0.02});
  CHECK(aim.column("Damper").unit == "mm");
  CHECK(aim.column("Acc").values == Values{0.9, 1.0, 1.1});
  // Rows of whole numbers are rows.
  CHECK(read("0,1,2\n1,2,3\n").column("column_1").values == Values{0.0, 1.0});
}

TEST_CASE("LabVIEW measurement files are read", "[io]") {
  std::string rows;
  for (int i = 5; i < 20; ++i) rows += std::to_string(1e-3 * i) + "\t2.5\t-7\n";
  const CsvTable table = read(
      "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\t\t\t\n"
      "Channels\t2\t\t\nSamples\t3\t3\t\nY_Unit_Label\tVolts\tVolts\t\n"
      "X0\t0.0000000000000000E+0\t0.0000000000000000E+0\t\nDelta_X\t0.001000\t0.001000\t\n"
      "***End_of_Header***\t\t\t\nX_Value\tUntitled\tUntitled 1\tComment\n"
      "0.000000\t1.5\t-2\t\n0.001000\t1.6\t-3\n0.002000\t1.7\t-4\n0.003000\t1.8\t-5\n"
      "0.004000\t1.9\t-6\n" +
      rows);
  CHECK(table.row_count() == 20);
  CHECK(table.column("X_Value").values[4] == 0.004);
  CHECK(table.column("Untitled 1").values[0] == -2.0);
  CHECK(table.column("Untitled 1").values[4] == -6.0);
}

TEST_CASE("VBOX files are read, their time as that of day", "[io]") {
  const CsvTable table = read(
      "File created on 03/05/2026 at 13:45\n\n[header]\nsatellites\ntime\nvelocity kmh\n\n"
      "[comments]\nFirmware 2.1\n\n[column names]\nsats time velocity\n\n[data]\n"
      "007 134559.90 050.00\n007 134600.00 050.10\n007 134600.10 050.20\n"
      "007 134600.20 050.30\n");
  CHECK(table.column("velocity").values == Values{50.0, 50.1, 50.2, 50.3});
  const Values& times = table.column("time").values;
  REQUIRE(times.size() == 4);
  CHECK(times[1] == Approx(0.1));
  CHECK(times[3] == Approx(0.3));
  CHECK(table.column("time").unit == "s");
}

TEST_CASE("Units may have a line of other text below them", "[io]") {
  const CsvTable table =
      read("Time,Force,Position\ns,N,mm\ndouble,double,double\n0,1.5,2\n0.1,2.5,3\n");
  CHECK(table.column("Position").unit == "mm");
  CHECK(table.column("Force").values == Values{1.5, 2.5});
}

TEST_CASE("Rows may hold more text than numbers", "[io]") {
  const CsvTable table = read(
      "time,state,gear,driver,mode,F\n0.0,on,second,A. B.,wet,1.5\n0.1,on,second,A. B.,wet,2.5\n"
      "0.2,off,third,A. B.,wet,3.5\n");
  CHECK(table.column("time").values == Values{0.0, 0.1, 0.2});
  CHECK(table.column("F").values == Values{1.5, 2.5, 3.5});
  CHECK_THROWS_WITH(table.column("gear"), Contains("'second': must be a finite number"));
}

TEST_CASE("Hundreds of lines may stand above the table", "[io]") {
  std::string text;
  for (int i = 0; i < 300; ++i) text += "Setting " + std::to_string(i) + "\n";
  text += "time,F\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(i) + ".5,1.5\n";
  CHECK(read(text).column("F").values.size() == 20);
}

TEST_CASE("A line of too many names is refused", "[io]") {
  std::string names = "time,F";
  for (int i = 0; i < 70000; ++i) names += ",x";
  CHECK_THROWS_WITH(read(names + "\n0.0,1.5\n0.1,2.5\n"), Contains("70002 columns; at most 16384"));
}

TEST_CASE("Lines may end with carriage returns alone", "[io]") {
  CHECK(read("time,F\r0,1.5\r0.1,2.5\r").column("F").values == Values{1.5, 2.5});
}

TEST_CASE("A last number that was cut off is not read", "[io]") {
  std::string text = "t,F\n";
  for (int i = 10; i < 40; ++i) text += std::to_string(i) + ",1.2345\n";
  const CsvTable cut = read(text + "40,1.2");
  CHECK(cut.row_count() == 30);
  REQUIRE(cut.notes.size() == 1);
  CHECK_THAT(cut.notes.front(), Contains("the last line is cut off"));
  CHECK(read(text + "40,1.2345").row_count() == 31);
  CHECK(read("t,F\n0,1.25\n1,1.5").row_count() == 2);  // a short table written by hand
}

}  // namespace
}  // namespace strut
