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
