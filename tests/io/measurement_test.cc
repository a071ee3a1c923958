#include "io/store/measurement.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "io/format/hdf5.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;

TEST_CASE("Measured columns come from CSV with their lines", "[io]") {
  const TemporaryFolder folder;
  const auto file = folder.write("m.csv", "a,b,c\n# units: m,,s\n1,2,3\n\n4,5,6\n");
  const Measurement m = read_measurement(file, {{"c", "a"}, {"d", "b"}});
  REQUIRE(m.columns.size() == 3);
  CHECK(m.columns[0].name == "c");
  CHECK(m.values("c") == std::vector<double>{3.0, 6.0});
  CHECK(m.find("a")->unit == "m");
  CHECK(m.find("d") == nullptr);
  CHECK(m.row_count() == 2);
  CHECK(m.locate(1) == file.string() + ":5");
  CHECK_THROWS_WITH(read_measurement(file, {{"bb"}}),
                    Contains("no column 'bb' among a, b, c; did you mean 'b'?"));
  CHECK_THROWS_WITH(read_measurement(folder.write("n.csv", "a,b\n1,nan\n"), {{"b"}}),
                    Contains("n.csv:2: b = 'nan'"));
  CHECK_THROWS_WITH(read_measurement(folder.write("e.csv", "a,b\n"), {{"a"}}),
                    Contains("e.csv: no rows"));
  CHECK_THROWS_WITH(read_measurement(folder / "none.csv", {{"a"}}), Contains("file not found"));
}

void write_columns(const std::filesystem::path& file, const std::string& prefix,
                   const std::vector<double>& a, const std::vector<double>& b) {
  Hdf5Writer writer(file);
  writer.write(prefix + "/a", a, {"m", "", {}});
  writer.write(prefix + "/b", b, {"s", "", {}});
  writer.commit();
}

TEST_CASE("Measured columns come from HDF5 in each of its layouts", "[io]") {
  const TemporaryFolder folder;
  const MeasurementRequest both = {{"b", "a"}};
  const std::vector<double> a = {1.0, 4.0}, b = {2.0, 5.0};
  SECTION("columns at the top") { write_columns(folder / "m.h5", "", a, b); }
  SECTION("a group") { write_columns(folder / "m.h5", "/snapshot", a, b); }
  SECTION("a table") {
    Hdf5Writer writer(folder / "m.h5");
    writer.write("/snapshot", std::vector<double>{1.0, 9.0, 2.0, 4.0, 9.0, 5.0}, 3,
                 {"mixed", "", {"a", "z", "b"}, {"m", "1", "s"}, {}});
    writer.commit();
  }
  const Measurement m = read_measurement(folder / "m.h5", both);
  CHECK(m.values("a") == a);
  CHECK(m.values("b") == b);
  CHECK(m.find("a")->unit == "m");
  CHECK(m.find("b")->unit == "s");
  CHECK(m.locate(1) == (folder / "m.h5").string() + ": row 1");
}

TEST_CASE("The requested part of an HDF5 file is read", "[io]") {
  const TemporaryFolder folder;
  write_columns(folder / "h.h5", "/history", {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0});
  const MeasurementRequest history = {{"a"}, {}, MeasuredPart::kHistory};
  CHECK(read_measurement(folder / "h.h5", history).row_count() == 3);
  CHECK_THROWS_WITH(read_measurement(folder / "h.h5", {{"a"}}),
                    Contains("h.h5: /snapshot: no such group; the file has only /history"));
  Hdf5Writer writer(folder / "cases.h5");
  writer.write("/history/a", std::vector<double>(6, 1.0), 3, {"m", "", {}});
  writer.commit();
  CHECK_THROWS_WITH(read_measurement(folder / "cases.h5", history),
                    Contains("/history/a: histories of 2 cases"));
}

TEST_CASE("Errors name measured columns that differ in length, are not finite or are missing",
          "[io]") {
  const TemporaryFolder folder;
  const MeasurementRequest both = {{"a", "b"}};
  write_columns(folder / "l.h5", "", {1.0, 2.0}, {1.0});
  CHECK_THROWS_WITH(read_measurement(folder / "l.h5", both),
                    Contains("l.h5: column 'b' has 1 values, 'a' 2"));
  write_columns(folder / "n.h5", "", {1.0, 2.0}, {1.0, std::nan("")});
  CHECK_THROWS_WITH(read_measurement(folder / "n.h5", both),
                    Contains("n.h5: row 1: b is not finite"));
  CHECK(read_measurement(folder / "n.h5", {{"a"}}).row_count() == 2);
  CHECK_THROWS_WITH(read_measurement(folder / "n.h5", {{"c"}}),
                    Contains("n.h5: no column 'c' among a, b"));
  CHECK_THROWS_WITH(read_measurement(folder.write("t.h5", "a,b\n1,2\n"), both),
                    Contains("not an HDF5 file"));
}

}  // namespace
}  // namespace strut
