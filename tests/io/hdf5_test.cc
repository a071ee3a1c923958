#include "io/format/hdf5.h"

#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "io/file/file_bytes.h"
#include "io/format/hdf5_calls.h"
#include "tests/support/limited_file_size.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using test::TemporaryFolder;

const std::vector<double> kValues = {1.0, 1.0 / 3.0, -0.0, 1e-300, 5.0, 6.0};
const Hdf5Label kLabel = {"N/m", "rate of the springs", {"front", "rear \xC3\xA9"}};

void write_example(const std::filesystem::path& path) {
  Hdf5Writer file(path);
  file.write("/history/time", kValues, {"s", "time", {}});
  file.write("/parameters", kValues, 2, kLabel);
  file.write("/empty", std::vector<double>{}, {"", "", {}});
  file.write_attribute("/", "strut_version", "0.1.0");
  file.write_attribute("/history", "empty", "");
  file.commit();
}

TEST_CASE("HDF5 datasets read back bit for bit", "[io][property]") {
  const TemporaryFolder folder;
  write_example(folder / "run.h5");
  const Hdf5Reader file(folder / "run.h5");
  const Hdf5Dataset time = file.read("/history/time");
  CHECK(time.shape == std::vector<std::size_t>{6});
  CHECK(time.values == kValues);
  CHECK(time.label.unit == "s");
  CHECK(time.label.names.empty());
  const Hdf5Dataset parameters = file.read("/parameters");
  CHECK(parameters.shape == std::vector<std::size_t>{3, 2});
  CHECK(parameters.values == kValues);
  CHECK(parameters.label.unit == kLabel.unit);
  CHECK(parameters.label.description == kLabel.description);
  CHECK(parameters.label.names == kLabel.names);
  CHECK(file.read("/empty").values.empty());
  CHECK(file.read_attribute("/", "strut_version") == "0.1.0");
  CHECK(file.read_attribute("/history", "empty").empty());
  CHECK(file.list("/") == std::vector<std::string>{"empty", "history", "parameters"});
  CHECK(file.has("/history/time"));
  CHECK_FALSE(file.has("/history/place"));
  CHECK_FALSE(file.has("/no/place"));
  CHECK(folder.file_count() == 1);
}

TEST_CASE("Integers, texts and numbers of attributes read back", "[io][property]") {
  const TemporaryFolder folder;
  const std::vector<std::int64_t> large = {INT64_MIN, -1, 0, INT64_MAX};
  const std::vector<std::int32_t> small = {INT32_MIN, 7, INT32_MAX};
  const std::vector<std::string> texts = {"", "a", "rear \xC3\xA9", "longest of all of them"};
  Hdf5Writer writer(folder / "run.h5");
  writer.write("/large", large, {"1", "", {}});
  writer.write("/small", small, {"1", "", {}});
  writer.write("/texts", texts, {"1", "words", {}});
  writer.write_attribute("/", "count", INT64_MAX);
  writer.write_attribute("/texts", "third", 1.0 / 3.0);
  writer.write_attribute_list("/", "names", {"a", "b"});
  writer.commit();
  const Hdf5Reader file(folder / "run.h5");
  CHECK(file.read_integers("/large") == large);
  CHECK(file.read_integers("/small") == std::vector<std::int64_t>{INT32_MIN, 7, INT32_MAX});
  CHECK(file.read_texts("/texts") == texts);
  CHECK(file.read_label("/texts").description == "words");
  CHECK(file.read_integer_attribute("/", "count") == INT64_MAX);
  CHECK(file.read_number_attribute("/texts", "third") == 1.0 / 3.0);
  CHECK(file.read_attribute_list("/", "names") == std::vector<std::string>{"a", "b"});
  CHECK(file.list_attributes("/") == std::vector<std::string>{"count", "names"});
  CHECK_FALSE(file.has_attribute("/", "third"));
  CHECK_THROWS_WITH(file.read_integers("/texts"), Contains("/texts: must hold integers"));
  CHECK_THROWS_WITH(file.read("/texts"), Contains("/texts: must hold numbers"));
  CHECK_THROWS_WITH(file.read_texts("/large"), Contains("/large: must hold texts"));
  CHECK_THROWS_WITH(file.read_integer_attribute("/texts", "third"), Contains("an integer"));
  CHECK_THROWS_WITH(file.read_number_attribute("/", "third"), Contains("no such attribute"));
}

TEST_CASE("A file in memory equals that on disk, with and without a seal", "[io][property]") {
  const TemporaryFolder folder;
  const bool sealed = GENERATE(false, true);
  const auto fill = [](Hdf5Writer& writer) {
    writer.write("/a/b", kValues, 2, kLabel);
    writer.write_attribute("/", "key", "value");
  };
  const Hdf5WriterOptions options = {.seal = sealed ? std::optional(SealLabel{kModelSeal, {}})
                                                    : std::nullopt};
  Hdf5Writer first(folder / "run.h5", options), second(Hdf5InMemory{"here"}, options);
  fill(first);
  fill(second);
  first.commit();
  const std::vector<std::byte> image = second.image();
  CHECK(image == read_bytes(folder / "run.h5"));
  CHECK(image[0] == (sealed ? std::byte{'s'} : std::byte{0x89}));
  CHECK(is_sealed(folder / "run.h5") == sealed);
  CHECK(Hdf5Reader(folder / "run.h5").read("/a/b").values == kValues);
  const Hdf5Reader one("here", image), other("here", image);
  CHECK(one.read("/a/b").values == kValues);
  CHECK(other.read_attribute("/", "key") == "value");
  CHECK_THROWS_AS(second.commit(), std::logic_error);
  CHECK_THROWS_AS(fill(second), EnvironmentError);
  const std::span cut = std::span(image).first(image.size() / 2);
  CHECK_THROWS_WITH(Hdf5Reader("here", cut), Contains("here: damaged"));
}

TEST_CASE("A file that is not committed never appears", "[io]") {
  const TemporaryFolder folder;
  {
    Hdf5Writer file(folder / "run.h5");
    file.write("/time", kValues, {"s", "", {}});
  }
  CHECK(folder.file_count() == 0);
}

TEST_CASE("A dataset that does not match its columns is refused", "[io]") {
  const TemporaryFolder folder;
  Hdf5Writer file(folder / "run.h5");
  CHECK_THROWS_AS(file.write("/a", kValues, 4, {}), std::logic_error);
  CHECK_THROWS_AS(file.write("/a", kValues, 0, {}), std::logic_error);
  CHECK_THROWS_AS(file.write("/a", kValues, 3, kLabel), std::logic_error);
}

TEST_CASE("A failing HDF5 call names file and dataset", "[io]") {
  const TemporaryFolder folder;
  Hdf5Writer writer(folder / "run.h5");
  writer.write("/time", kValues, {});
  CHECK_THROWS_WITH(writer.write("/time", kValues, {}),
                    EndsWith("run.h5: /time: dataset cannot be written"));
  CHECK_THROWS_AS(writer.write_attribute("/no", "a", "b"), EnvironmentError);
  writer.commit();
  const Hdf5Reader reader(folder / "run.h5");
  CHECK_THROWS_WITH(reader.read("/no/time"), Contains("run.h5: /no/time: no such dataset"));
  CHECK_THROWS_WITH(reader.read("/"), Contains("run.h5: /"));
  CHECK_THROWS_WITH(reader.read_attribute("/time", "color"), Contains("/time@color"));
  CHECK_THROWS_AS(reader.list("/no"), InputError);
}

TEST_CASE("A file that is missing, foreign or damaged is an input error", "[io]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(Hdf5Reader(folder / "no.h5"), Contains("no.h5: file not found"));
  CHECK_THROWS_WITH(Hdf5Reader(folder.write("text.h5", "time,z\n0,1\n")),
                    Contains("text.h5: not an HDF5 file"));
  write_example(folder / "run.h5");
  const auto size = std::filesystem::file_size(folder / "run.h5");
  std::filesystem::resize_file(folder / "run.h5", size / 2);
  CHECK_THROWS_WITH(Hdf5Reader(folder / "run.h5"), Contains("run.h5: damaged"));
}

// Without a seal a reader has only the checksums of the format. Chunks that are not compressed have
// none: their numbers may change, but nothing else, and no damage may crash the program.
TEST_CASE("A flipped bit anywhere is an error or a number, never a crash", "[io][property]") {
  const TemporaryFolder folder;
  write_example(folder / "run.h5");
  const std::vector<std::byte> good = read_bytes(folder / "run.h5");
  int found = 0, silent = 0;
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::vector<std::byte> image = good;
    image[at] ^= std::byte{1} << (at % 8);
    try {
      const Hdf5Reader file("run.h5", image);
      const Hdf5Dataset parameters = file.read("/parameters");
      file.read("/history/time");
      CHECK(parameters.shape == std::vector<std::size_t>{3, 2});
      CHECK(parameters.label.unit == kLabel.unit);
      CHECK(parameters.label.description == kLabel.description);
      CHECK(parameters.label.names == kLabel.names);
      CHECK(file.read_attribute("/", "strut_version") == "0.1.0");
      CHECK(file.read_attribute("/history", "empty").empty());
      ++silent;
    } catch (const InputError&) {
      ++found;
    }
  }
  CHECK(found > 500);
  CHECK(silent > 0);
}

// h5py writes such attributes; the library crashes on damaged ones.
TEST_CASE("An attribute of variable length is refused", "[io]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.h5";
  write_example(path);
  {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    REQUIRE(H5Tset_size(type.id(), H5T_VARIABLE) >= 0);
    const Hdf5Handle attribute(
        H5Acreate2(file.id(), "note", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const char* const text = "a text of its own length";
    REQUIRE(H5Awrite(attribute.id(), type.id(), &text) >= 0);
  }
  const Hdf5Reader reader(path);
  CHECK(reader.read_attribute("/", "strut_version") == "0.1.0");
  CHECK_THROWS_WITH(reader.read_attribute("/", "note"), Contains("texts of fixed length"));
}

TEST_CASE("A target that cannot hold HDF5 is an environment error", "[io]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(Hdf5Writer(folder / "no_folder/run.h5"), EnvironmentError);
  CHECK_THROWS_AS(Hdf5Writer("/dev/null"), EnvironmentError);
  CHECK(folder.file_count() == 0);
}

TEST_CASE("A disk that fills up leaves the old HDF5 file and nothing else", "[io]") {
  const TemporaryFolder folder;
  write_example(folder / "run.h5");
  const std::vector<double> many(100000, 1.5);
  const auto write_many = [&] {
    Hdf5Writer file(folder / "run.h5");
    file.write("/many", many, {"m", "", {}});
    file.commit();
  };
  {
    const test::LimitedFileSize limit(20000);
    CHECK_THROWS_AS(write_many(), EnvironmentError);
  }
  CHECK(Hdf5Reader(folder / "run.h5").has("/parameters"));
  CHECK(folder.file_count() == 1);
  CHECK_NOTHROW(write_many());
  CHECK(Hdf5Reader(folder / "run.h5").read("/many").values == many);
}

}  // namespace
}  // namespace strut
