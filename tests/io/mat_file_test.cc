#include "io/table/mat_file.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/mat_bytes.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

using test::make_mat_array;
using test::make_mat_file;
using test::make_mat_struct;
using test::make_mat_struct_array;
using test::pack_mat_element;

TEST_CASE("MATLAB files are read: vectors, matrices and structs", "[io]") {
  const test::TemporaryFolder folder;
  const auto path = folder.write(
      "m.mat",
      make_mat_file(make_mat_array("t", 3, 1, {0.0, 0.5, 1.0}) +
                    make_mat_array("xy", 3, 2, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) +
                    make_mat_struct("run", "force", make_mat_array("", 1, 3, {7.0, 8.0, 9.0}))));
  CHECK(find_table_format(path) == TableFormat::kMatlab5);
  const auto file = open_mat_file(path);
  CHECK(file->names() == std::vector<std::string>{"t", "xy:1", "xy:2", "run.force"});
  CHECK(file->read("t").values == std::vector<double>{0.0, 0.5, 1.0});
  CHECK(file->read("xy:2").values == std::vector<double>{4.0, 5.0, 6.0});
  CHECK(file->read("run.force").values == std::vector<double>{7.0, 8.0, 9.0});
  CHECK_THROWS_WITH(file->read("forc"), Contains("no column 'forc' among t, xy:1"));
}

TEST_CASE("A damaged MATLAB file is an input error", "[io]") {
  const test::TemporaryFolder folder;
  const std::string whole = make_mat_file(make_mat_array("t", 3, 1, {0.0, 0.5, 1.0}));
  for (std::size_t size : {std::size_t{20}, std::size_t{128}, std::size_t{150}}) {
    CAPTURE(size);
    CHECK_THROWS_AS(open_mat_file(folder.write("m.mat", whole.substr(0, size))), InputError);
  }
  // A number of rows that no file of this size holds
  std::string huge = whole;
  const std::size_t rows = whole.find(std::string{'\3', '\0', '\0', '\0', '\1'});
  huge.replace(rows, 4, std::string{'\0', '\0', '\0', '\x20'});
  CHECK_THROWS_AS(open_mat_file(folder.write("m.mat", huge)), InputError);
}

TEST_CASE("A MATLAB file whose sizes lie is refused before it is read", "[io]") {
  const test::TemporaryFolder folder;
  const std::string run = make_mat_file(
      make_mat_struct("run", "force", make_mat_array("", 1, 4, {0.0, 0.5, 1.0, 1.5})));
  const auto read = [&](std::size_t at, const std::string& bytes) {
    std::string changed = run;
    changed.replace(at, bytes.size(), bytes);
    return open_mat_file(folder.write("m.mat", changed));
  };
  CHECK(read(0, "M")->names() == std::vector<std::string>{"run.force"});
  const std::size_t name = run.find("run") - 4, rows = 160;
  REQUIRE(run.substr(rows, 4) == std::string{'\1', '\0', '\0', '\0'});
  // 4 GB of name, 10^9 structs, -1 structs, a small element of 7 bytes, other types
  CHECK_THROWS_WITH(read(name, "\x03" + std::string{'\0'} + "\xff\xff"), Contains("an element of"));
  CHECK_THROWS_WITH(read(rows, std::string{'\1', '\0', '\0', 'Q'}), Contains("bytes within"));
  CHECK_THROWS_WITH(read(rows, "\xff\xff\xff\xff"), Contains("negative dimension"));
  const std::size_t length = run.find(std::string{'\5', '\0', '\4', '\0'});
  CHECK_THROWS_WITH(read(length + 2, "\7"), Contains("more than four bytes"));
  CHECK_THROWS_WITH(read(128, "\x07"), Contains("type 7 is no variable"));
  // matio reads flags, dimensions and name at fixed places, whatever the size of the whole.
  CHECK_THROWS_WITH(read(132, std::string(4, '\0')), Contains("an element is cut off"));
  CHECK_THROWS_WITH(read(136, "\x05"), Contains("without flags"));
  CHECK_THROWS_WITH(read(140, "\x10"), Contains("without flags"));
  CHECK_THROWS_WITH(read(152, "\x06"), Contains("without dimensions"));
  CHECK_THROWS_WITH(read(name - 4, "\x02"), Contains("without a name"));
  // 1000 structs of as many fields, in 10 kB, and names of no length
  const std::string names(8000, 'x');
  CHECK_THROWS_WITH(open_mat_file(folder.write(
                        "m.mat", make_mat_file(make_mat_struct_array("s", 1000, 8, names)))),
                    Contains("bytes within"));
  CHECK_THROWS_WITH(
      open_mat_file(folder.write("m.mat", make_mat_file(make_mat_struct_array("s", 1, 0, names)))),
      Contains("without a length of their names"));
  CHECK_THROWS_WITH(read(128, "\x0f"), Contains("compressed element cannot be read"));
  std::string nested = make_mat_array("", 1, 1, {1.0});
  for (int i = 0; i < 40; ++i) nested = make_mat_struct("", "a", nested);
  CHECK_THROWS_WITH(open_mat_file(folder.write("m.mat", make_mat_file(nested))),
                    Contains("nested too deeply"));
}

TEST_CASE("A compressed MATLAB file is read, and refused where its sizes lie", "[io]") {
  const test::TemporaryFolder folder;
  const auto open_packed = [&](const std::string& element) {
    return open_mat_file(folder.write("m.mat", make_mat_file(pack_mat_element(element))));
  };
  const std::string array = make_mat_array("t", 3, 1, {0.0, 0.5, 1.0});
  CHECK(open_packed(array)->read("t").values == std::vector<double>{0.0, 0.5, 1.0});
  std::string tall = array;
  tall.replace(32, 4, std::string{'\0', '\0', '\0', '\x20'});
  CHECK_THROWS_WITH(open_packed(tall), Contains("bytes within"));
  std::string long_one = array;
  long_one.replace(4, 4, "\xff\xff\xff\x7f");
  CHECK_THROWS_WITH(open_packed(long_one), Contains("packed into"));
  long_one.replace(4, 4, std::string{'\0', '\4', '\0', '\0'});
  CHECK_THROWS_WITH(open_packed(long_one), Contains("cannot be read"));
}

TEST_CASE("A MATLAB file that is cut off says what may be missing", "[io]") {
  const test::TemporaryFolder folder;
  const std::string whole = make_mat_file(make_mat_array("t", 3, 1, {0.0, 0.5, 1.0}) +
                                          make_mat_array("F", 3, 1, {1.0, 2.0, 3.0}));
  CHECK(open_mat_file(folder.write("m.mat", whole))->notes().empty());
  const auto cut = open_mat_file(folder.write("m.mat", whole.substr(0, whole.size() - 40)));
  CHECK(cut->names() == std::vector<std::string>{"t"});
  REQUIRE(cut->notes().size() == 1);
  CHECK_THAT(cut->notes().front(), Contains("is cut off; what follows t is missing"));
}

TEST_CASE("Formats that are not read are named, with the way to convert them", "[io]") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(find_table_format(folder.write("a.mf4", "MDF     4.10    ")),
                    Contains("an MDF measurement") && Contains("asammdf"));
  CHECK_THROWS_WITH(find_table_format(folder.write("a.xlsx", "PK\x03\x04 xl/workbook.xml")),
                    Contains("a spreadsheet") && Contains("CSV"));
  CHECK(find_table_format(folder.write("a.txt", "t F\n0 1\n")) == TableFormat::kText);
}

}  // namespace
}  // namespace strut
