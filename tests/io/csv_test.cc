#include "io/format/csv.h"

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
  CHECK_THROWS_WITH(read("a,b\n1,x\n"), EndsWith("a.csv:2: b = 'x': must be a finite number"));
  CHECK_THROWS_WITH(read("a,b\n1,\n"), Contains("a.csv:2: b = ''"));
  CHECK_THROWS_WITH(read("a,b\n1,nan\n"), Contains("a.csv:2: b = 'nan'"));
  CHECK_THROWS_WITH(read("a,b\n1,1e999\n"), Contains("a.csv:2: b = '1e999'"));
  CHECK_THROWS_WITH(read("a,b\n1,2 m\n"), Contains("'2 m'"));
  CHECK_THROWS_WITH(read("a,a\n"), Contains("a.csv:1: column 'a' is given twice"));
  CHECK_THROWS_WITH(read("a,\n"), Contains("a.csv:1: a column has no name"));
  CHECK_THROWS_WITH(read("1,2\n3,4\n"), Contains("a.csv:1: column name expected"));
  CHECK_THROWS_AS(read(""), InputError);
  CHECK_THROWS_WITH(read_csv(folder / "no.csv"), EndsWith("no.csv: file not found"));
}

TEST_CASE("The error for a missing column lists the columns of the file", "[io]") {
  const TemporaryFolder folder;
  const CsvTable table = read_csv(folder.write("a.csv", "position,height\n0,1\n"));
  CHECK(table.has("height"));
  CHECK_FALSE(table.has("hight"));
  CHECK_THROWS_WITH(table.column("hight"),
                    EndsWith("no column 'hight' among position, height; did you mean 'height'?"));
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
