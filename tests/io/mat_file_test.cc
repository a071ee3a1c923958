#include "io/table/mat_file.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

/// Bytes of MATLAB's level 5 format (MathWorks, "MAT-File Format"), written here by its description
/// alone: data elements of a tag (type, size) and a body padded to 8 bytes.
enum : std::uint32_t { kInt8 = 1, kInt32 = 5, kUint32 = 6, kDouble = 9, kMatrix = 14 };
enum : std::uint32_t { kStructClass = 2, kCharClass = 4, kDoubleClass = 6 };

template <class T>
std::string make_element(std::uint32_t type, const std::vector<T>& values) {
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(T));
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &type, 4);
  std::memcpy(bytes.data() + 4, &size, 4);
  bytes.append(reinterpret_cast<const char*>(values.data()), size);
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}

/// Of four bytes, which stand in the tag itself.
std::string make_small_element(std::uint32_t type, std::int32_t value) {
  const std::uint32_t tag = type | (4U << 16U);
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &tag, 4);
  std::memcpy(bytes.data() + 4, &value, 4);
  return bytes;
}

std::string wrap_matrix(const std::string& body) {
  return make_element<char>(kMatrix, {body.begin(), body.end()});
}

std::string make_array(const std::string& name, std::int32_t rows, std::int32_t columns,
                       const std::vector<double>& values) {
  return wrap_matrix(make_element<std::uint32_t>(kUint32, {kDoubleClass, 0}) +
                     make_element<std::int32_t>(kInt32, {rows, columns}) +
                     make_element<char>(kInt8, {name.begin(), name.end()}) +
                     make_element(kDouble, values));
}

std::string make_struct(const std::string& name, const std::string& field,
                        const std::string& value) {
  std::vector<char> names(field.begin(), field.end());
  names.resize(32, '\0');
  return wrap_matrix(make_element<std::uint32_t>(kUint32, {kStructClass, 0}) +
                     make_element<std::int32_t>(kInt32, {1, 1}) +
                     make_element<char>(kInt8, {name.begin(), name.end()}) +
                     make_small_element(kInt32, 32) + make_element(kInt8, names) + value);
}

std::string make_file(const std::string& elements) {
  std::string header = "MATLAB 5.0 MAT-file, made by a test";
  header.resize(124, ' ');
  header += std::string{'\0', '\1', 'I', 'M'};  // version 1, little endian
  return header + elements;
}

TEST_CASE("MATLAB files are read: vectors, matrices and structs", "[io]") {
  const test::TemporaryFolder folder;
  const auto path = folder.write(
      "m.mat", make_file(make_array("t", 3, 1, {0.0, 0.5, 1.0}) +
                         make_array("xy", 3, 2, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) +
                         make_struct("run", "force", make_array("", 1, 3, {7.0, 8.0, 9.0}))));
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
  const std::string whole = make_file(make_array("t", 3, 1, {0.0, 0.5, 1.0}));
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
  const std::string whole =
      make_file(make_array("t", 3, 1, {0.0, 0.5, 1.0}) + make_array("F", 3, 1, {1.0, 2.0, 3.0}));
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
