#include "io/table/csv.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/limited_file_size.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using test::read_text;
using test::TemporaryFolder;

std::vector<CsvColumn> make_columns() {
  return {{"time", "s", {0.0, 0.001, 1.0 / 3.0}}, {"pitch_angle", "rad", {-1e-300, 0.1, 1e22}}};
}

TEST_CASE("The first line holds the names, a comment below it the units", "[io]") {
  const TemporaryFolder folder;
  write_csv(folder / "run.csv", {{"time", "s", {0.0, 0.5}}, {"z", "m", {1.0, -2.0}}});
  CHECK(read_text(folder / "run.csv") == "time,z\n# units: s,m\n0,1\n0.5,-2\n");
}

TEST_CASE("Columns without units have no line of units", "[io]") {
  const TemporaryFolder folder;
  write_csv(folder / "curves.csv", {{"camber_rad", "", {0.5}}});
  CHECK(read_text(folder / "curves.csv") == "camber_rad\n0.5\n");
}

TEST_CASE("A CSV file reads back bit for bit", "[io][property]") {
  const TemporaryFolder folder;
  const auto columns = make_columns();
  write_csv(folder / "run.csv", columns);
  const CsvTable table = read_csv(folder / "run.csv");
  REQUIRE(table.columns.size() == columns.size());
  CHECK(table.row_count() == 3);
  for (const CsvColumn& column : columns) {
    CHECK(table.column(column.name).values == column.values);
    CHECK(table.column(column.name).unit == column.unit);
  }
  CHECK(folder.file_count() == 1);
}

TEST_CASE("Line ends, comments, quotes and blanks do not change a table", "[io]") {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "a.csv",
      "\xEF\xBB\xBF# survey of May\r\n\"position\" , height\r\n\r\n -1, +2e-3\r\n# x\r\n1,0");
  const CsvTable table = read_csv(path);
  CHECK(table.column("position").values == std::vector<double>{-1.0, 1.0});
  CHECK(table.column("height").values == std::vector<double>{0.002, 0.0});
  CHECK(table.lines == std::vector<int>{4, 6});
}

TEST_CASE("The error for an invalid table names file and line", "[io]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) { return read_csv(folder.write("a.csv", text)); };
  CHECK_THROWS_WITH(read("a,b\n1,2\n1\n"), EndsWith("a.csv:3: 1 cells; must be 2, one per column"));
  CHECK_THROWS_WITH(read("a,b\n1,2,3\n4,5,6\n"),
                    EndsWith("a.csv:2: 3 cells; must be 2, one per column"));
  CHECK_THROWS_WITH(read("a,b\n1\n1,2\n3,4\n"),
                    EndsWith("a.csv:2: 1 cells; must be 2, one per column"));
  CHECK_THROWS_WITH(read(std::string("a,b\n1,2\n\0", 9)),
                    EndsWith("binary data; not a table of numbers"));
  CHECK_THROWS_AS(read(""), InputError);
  CHECK_THROWS_WITH(read_csv(folder / "no.csv"), EndsWith("no.csv: file not found"));
}

TEST_CASE("A cell that is not a number is a fault of its column alone", "[io]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    const CsvTable table = read_csv(folder.write("a.csv", text));
    CHECK(table.column("a").values.front() == 1.0);
    return table.column("b");
  };
  CHECK_THROWS_WITH(read("a,b\n1,x\n"), EndsWith("a.csv:2: b = 'x': must be a finite number"));
  CHECK_THROWS_WITH(read("a,b\n1,\n"), Contains("a.csv:2: b = ''"));
  CHECK_THROWS_WITH(read("a,b\n1,nan\n"), Contains("a.csv:2: b = 'nan'"));
  CHECK_THROWS_WITH(read("a,b\n1,1e999\n"), Contains("a.csv:2: b = '1e999'"));
  CHECK_THROWS_WITH(read("a,b\n1,2 m\n"), Contains("'2 m'"));
  CHECK_THROWS_WITH(read("a,b\n1,2\n1,x\n2,3\n"), Contains("a.csv:3: b = 'x'"));
  // A damaged first row is not a line of names.
  CHECK_THROWS_WITH(read("a,b\n1,x\n2,3\n4,5\n"), Contains("a.csv:2: b = 'x'"));
}

TEST_CASE("The error for a missing column lists the columns of the file", "[io]") {
  const TemporaryFolder folder;
  const CsvTable table = read_csv(folder.write("a.csv", "position,height\n0,1\n"));
  CHECK(table.has("height"));
  CHECK_FALSE(table.has("hight"));
  CHECK_THROWS_WITH(table.column("hight"),
                    EndsWith("no column 'hight' among position, height; did you mean 'height'?"));
}

/// The same small table as different programs write it.
TEST_CASE("Tables of other programs are read", "[io]") {
  struct Dialect {
    std::string text, format;
  };
  const std::vector<Dialect> dialects = {
      {"time,F\n0,1.5\n0.1,-2\n", "separated by commas"},
      {"time;F\n0;1.5\n0.1;-2\n", "separated by semicolons"},
      {"time;F\n0;1,5\n0,1;-2\n", "separated by semicolons, decimal comma"},
      {"time\tF\n0\t1,5\n0,1\t-2\n", "separated by tabs, decimal comma"},
      {"time\tF\r\n0\t1.5\r\n0.1\t-2\r\n", "separated by tabs"},
      {"\"time\",\"F\"\n\"0\",\"1,5\"\n\"0,1\",\"-2\"\n", "separated by commas, decimal comma"},
      {"time|F\n0|1.5\n0.1|-2\n", "separated by bars"},
      {"  time   F\n  0.0  1.5\n  0.1 -2.0\n", "separated by blanks"},
      {"# time F\n0 1.5\n0.1 -2\n", "separated by blanks"},
      {";F\n0;1,5\n0,1;-2\n", "separated by semicolons, decimal comma"},
      {"time,F,\n0,1.5,\n0.1,-2,\n,,\n", "separated by commas"},
      {"time,F\n0,1.5,\n0.1,-2,\n", "separated by commas"},
      {"Stand 7\nOperator: N. N.\n\nRate;10;Hz;;\ntime;F\n0;1,5\n0,1;-2\n",
       "separated by semicolons, decimal comma"},
  };
  const TemporaryFolder folder;
  for (const Dialect& dialect : dialects) {
    CAPTURE(dialect.text);
    const CsvTable table = read_csv(folder.write("a.csv", dialect.text));
    CHECK(table.format == dialect.format);
    REQUIRE(table.columns.size() == 2);
    CHECK(table.column("time").values == std::vector<double>{0.0, 0.1});
    CHECK(table.column("F").values == std::vector<double>{1.5, -2.0});
  }
}

TEST_CASE("Units stand beside the names, below them or in a comment", "[io]") {
  const TemporaryFolder folder;
  for (const char* head :
       {"Time (s),\"Plate, Road (mm)\",AccZ [g]\n", "Time / s,\"Plate, Road / mm\",AccZ in g\n",
        "Time,\"Plate, Road\",AccZ\ns,mm,g\n", "Time,\"Plate, Road\",AccZ\n[s],[mm],[g]\n",
        "Time,\"Plate, Road\",AccZ\n# units: s,mm,g\n"}) {
    CAPTURE(head);
    const CsvTable table = read_csv(folder.write("a.csv", std::string(head) + "0,1,2\n1,3,4\n"));
    CHECK(table.column("Time").unit == "s");
    CHECK(table.column("Plate, Road").unit == "mm");
    CHECK(table.column("AccZ").unit == "g");
    CHECK(table.column("AccZ").values == std::vector<double>{2.0, 4.0});
  }
  CHECK(read_csv(folder.write("a.csv", "t,AccZ [g]\n0,1\n")).column("AccZ [g]").unit == "g");
  // The degree and micro signs and the square in Latin-1
  const CsvTable old =
      read_csv(folder.write("a.csv", "t;Winkel [\xb0];Weg [\xb5m];a [m/s\xb2]\n0;1;2;3\n"));
  CHECK(old.column("Winkel").unit == "deg");
  CHECK(old.column("Weg").unit == "um");
  CHECK(old.column("a").unit == "m/s^2");
}

TEST_CASE("Columns of one name are told apart", "[io]") {
  const TemporaryFolder folder;
  const CsvTable table = read_csv(folder.write("a.csv", "t,acc [g],acc [m/s^2],F,F\n0,1,2,3,4\n"));
  CHECK(table.column("acc [g]").values == std::vector<double>{1.0});
  CHECK(table.column("acc [m/s^2]").values == std::vector<double>{2.0});
  CHECK(table.column("F (2)").values == std::vector<double>{4.0});
  CHECK_THROWS_WITH(table.column("F"), Contains("no column 'F' among"));
}

TEST_CASE("Tables without names have numbered columns", "[io]") {
  const TemporaryFolder folder;
  const CsvTable table = read_csv(folder.write("a.csv", "0 1.5\n0.1 -2\n"));
  CHECK(table.column("column_1").values == std::vector<double>{0.0, 0.1});
  CHECK(table.column("column_2").values == std::vector<double>{1.5, -2.0});
}

TEST_CASE("Clock times become seconds since the first row, over midnight", "[io]") {
  const TemporaryFolder folder;
  const std::vector<double> expected = {0.0, 0.5, 1.25};
  for (const char* rows :
       {"23:59:59.500,1\n00:00:00.000,2\n00:00:00.750,3\n",
        "2026-05-03T23:59:59.500Z,1\n2026-05-04T00:00:00.000Z,2\n2026-05-04T00:00:00.750Z,3\n",
        "2026-05-03 23:59:59.500+02:00,1\n2026-05-04 00:00:00+02:00,2\n"
        "2026-05-04 00:00:00.75+02:00,3\n",
        "59:58.750,1\n59:59.250,2\n60:00.000,3\n"}) {
    CAPTURE(rows);
    const CsvTable table = read_csv(folder.write("a.csv", std::string("Clock,F\n") + rows));
    if (std::string(rows).starts_with("59:58")) {
      CHECK_THROWS_WITH(table.column("Clock"), Contains("'60:00.000': must be a finite number"));
      continue;
    }
    CHECK(table.column("Clock").values == expected);
    CHECK(table.column("Clock").unit == "s");
  }
  const CsvTable german = read_csv(
      folder.write("a.csv", "Zeit;F\n03.05.2026 12:00:00,250;1,5\n03.05.2026 12:00:01,500;2\n"));
  CHECK(german.column("Zeit").values == std::vector<double>{0.0, 1.25});
}

TEST_CASE("Spreadsheets' UTF-16 text is read", "[io]") {
  const TemporaryFolder folder;
  const std::string text = "t\tWinkel [\xb0]\r\n0\t1,5\r\n0,1\t-2\r\n";  // Latin-1
  for (const bool big : {false, true}) {
    std::string bytes = big ? "\xfe\xff" : "\xff\xfe";
    for (const char c : text) bytes += big ? std::string{'\0', c} : std::string{c, '\0'};
    const CsvTable table = read_csv(folder.write("a.csv", bytes));
    CHECK(table.column("Winkel").unit == "deg");
    CHECK(table.column("Winkel").values == std::vector<double>{1.5, -2.0});
    CHECK_THROWS_WITH(read_csv(folder.write("b.csv", bytes + "x")), Contains("damaged UTF-16"));
  }
}

TEST_CASE("A last line that a logger cut off is left out and noted", "[io]") {
  const TemporaryFolder folder;
  const CsvTable table = read_csv(folder.write("a.csv", "t,F\n0,1\n1,2\n2"));
  CHECK(table.row_count() == 2);
  REQUIRE(table.notes.size() == 1);
  CHECK_THAT(table.notes.front(), Contains("a.csv:4: the last line is cut off"));
  CHECK(read_csv(folder.write("a.csv", "t,F\n0,1\n1,2\n2,3")).row_count() == 3);
}

TEST_CASE("A target that cannot be written is an environment error", "[io]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "run.csv");
  CHECK_THROWS_AS(write_csv(folder / "run.csv", make_columns()), EnvironmentError);
  CHECK_THROWS_AS(write_csv(folder / "no_folder/run.csv", make_columns()), EnvironmentError);
  CHECK_THROWS_AS(write_csv("/dev/null", make_columns()), EnvironmentError);
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK(folder.file_count() == 1);
}

TEST_CASE("A full disk leaves the old file and nothing else", "[io]") {
  const TemporaryFolder folder;
  const auto path = folder.write("run.csv", "old");
  const std::vector<CsvColumn> columns = {{"a", "m", std::vector<double>(10000, 0.1)}};
  {
    const test::LimitedFileSize limit(1000);
    CHECK_THROWS_AS(write_csv(path, columns), EnvironmentError);
  }
  CHECK(read_text(path) == "old");
  CHECK(folder.file_count() == 1);
  CHECK_NOTHROW(write_csv(path, columns));
  CHECK(read_csv(path).row_count() == 10000);
}

TEST_CASE("Writing through a link keeps the link", "[io]") {
  const TemporaryFolder folder;
  folder.write("file.csv", "old");
  std::filesystem::create_symlink(folder / "file.csv", folder / "link.csv");
  write_csv(folder / "link.csv", make_columns());
  CHECK(std::filesystem::is_symlink(folder / "link.csv"));
  CHECK(read_csv(folder / "file.csv").row_count() == 3);
}

}  // namespace
}  // namespace strut
