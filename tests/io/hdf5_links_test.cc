// HDF5 files that refer to others: nothing outside the file is read.
#include <hdf5.h>

#include <array>
#include <catch2/catch.hpp>
#include <fstream>

#include "io/format/hdf5.h"
#include "io/store/hdf5_table.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using test::TemporaryFolder;
namespace fs = std::filesystem;

constexpr std::array<double, 3> kValues = {1.0, 2.0, 3.0};

// A file with a dataset, and an attribute at its root.
fs::path write_secret(const TemporaryFolder& folder) {
  fs::path path = folder / "secret.h5";
  Hdf5Writer writer(path);
  writer.write("/group/values", kValues, {"m", "", {}});
  writer.write_attribute("/", "key", "secret");
  writer.commit();
  return path;
}

// Made by the library itself, since the writer cannot.
template <class Make>
fs::path make_file(const TemporaryFolder& folder, const Make& make) {
  fs::path path = folder / "other.h5";
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  make(file);
  H5Fclose(file);
  return path;
}

TEST_CASE("A link to another HDF5 file is not followed", "[io]") {
  const TemporaryFolder folder;
  const fs::path secret = write_secret(folder);
  const fs::path path = make_file(folder, [&](hid_t file) {
    const char* target = secret.c_str();
    H5Lcreate_external(target, "/group/values", file, "dataset", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(target, "/group", file, "group", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(target, "/", file, "root", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/group/values", file, "soft", H5P_DEFAULT, H5P_DEFAULT);
  });
  const Hdf5Reader reader(path);
  for (const char* name : {"/dataset", "/group/values", "/root/group/values", "/soft"}) {
    INFO(name);
    CHECK_THROWS_AS(reader.read(name), InputError);
    CHECK_THROWS_AS(reader.read_shape(name), InputError);
    CHECK_THROWS_AS(reader.read_attribute(name, "unit"), InputError);
    CHECK_FALSE(reader.has_attribute(name, "unit"));
  }
  CHECK_FALSE(reader.has("/group/values"));
  CHECK_FALSE(reader.has_attribute("/root", "key"));
  CHECK_THROWS_AS(reader.read_attribute("/root", "key"), InputError);
  CHECK_THROWS_AS(reader.list("/group"), InputError);
  CHECK_THROWS_AS(reader.list_attributes("/root"), InputError);
  // The library follows it by default.
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  CHECK(H5Aexists_by_name(file, "/root", "key", H5P_DEFAULT) > 0);
  H5Fclose(file);
}

TEST_CASE("A dataset whose numbers lie in another file is not read", "[io]") {
  const TemporaryFolder folder;
  const fs::path raw = folder / "raw";
  std::ofstream(raw).write("0123456789abcdef", 16);
  const fs::path secret = write_secret(folder);
  const fs::path path = make_file(folder, [&](hid_t file) {
    const hsize_t two = 2, three = 3;
    const hid_t outside = H5Pcreate(H5P_DATASET_CREATE), view = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t pair = H5Screate_simple(1, &two, nullptr);
    const hid_t triple = H5Screate_simple(1, &three, nullptr);
    H5Pset_external(outside, raw.c_str(), 0, 16);
    H5Pset_virtual(view, triple, secret.c_str(), "/group/values", triple);
    H5Dclose(H5Dcreate2(file, "raw", H5T_NATIVE_DOUBLE, pair, H5P_DEFAULT, outside, H5P_DEFAULT));
    H5Dclose(H5Dcreate2(file, "view", H5T_NATIVE_DOUBLE, triple, H5P_DEFAULT, view, H5P_DEFAULT));
    H5Sclose(pair);
    H5Sclose(triple);
    H5Pclose(outside);
    H5Pclose(view);
  });
  const Hdf5Reader reader(path);
  for (const char* name : {"/raw", "/view"}) {
    INFO(name);
    REQUIRE(reader.has(name));
    CHECK_THROWS_WITH(reader.read(name), Catch::Contains("a view over shards cannot be verified"));
  }
}

TEST_CASE("Columns that lie in another file are left out and noted, the others read", "[io]") {
  const TemporaryFolder folder;
  const fs::path secret = write_secret(folder);
  const fs::path path = make_file(folder, [&](hid_t file) {
    H5Lcreate_external(secret.c_str(), "/group/values", file, "there", H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t size = kValues.size();
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t data =
        H5Dcreate2(file, "here", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, kValues.data());
    H5Dclose(data);
    H5Sclose(space);
  });
  const auto table = open_hdf5_table(path, MeasuredPart::kHistory);
  CHECK(table->names() == std::vector<std::string>{"here"});
  CHECK(table->read("here").values == std::vector<double>(kValues.begin(), kValues.end()));
}

TEST_CASE("An HDF5 file without numbers says what is missing", "[io]") {
  const TemporaryFolder folder;
  const fs::path path = make_file(folder, [](hid_t file) {
    const hid_t record = H5Tcreate(H5T_COMPOUND, sizeof(double));
    H5Tinsert(record, "force", 0, H5T_NATIVE_DOUBLE);
    const hsize_t size = kValues.size();
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    H5Dclose(H5Dcreate2(file, "runs", record, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
    H5Tclose(record);
  });
  CHECK_THROWS_WITH(open_hdf5_table(path, MeasuredPart::kHistory),
                    Catch::Contains("compound types"));
}

}  // namespace
}  // namespace strut
