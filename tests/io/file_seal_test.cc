#include "io/file/file_seal.h"

#include <catch2/catch.hpp>

#include "io/file/sha256.h"
#include "io/format/hdf5.h"
#include "io/format/hdf5_stream.h"
#include "tests/support/flip_bits.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const SealLabel kLabel = {kMergedSeal, {{"plan", std::string(64, 'a')}}};

fs::path write_streamed(const TemporaryFolder& folder) {
  Hdf5StreamWriter file(folder / "streamed.h5", kLabel);
  file.create("/x", Hdf5Type::kDouble, {3}, {"m", "", {}});
  file.append("/x", std::vector<double>{1.0, 2.0, 3.0});
  file.commit();
  return folder / "streamed.h5";
}

TEST_CASE("A seal has the documented text", "[io][reference]") {
  const TemporaryFolder folder;
  const std::string text = test::read_text(write_streamed(folder));
  const std::string lines = "strut merged seal 1\nplan " + std::string(64, 'a') + "\nsize " +
                            std::to_string(text.size()) + "\nsha256 " +
                            to_hex(calc_sha256(text.substr(0, text.size() - kSealBytes))) + "\n";
  std::string seal = lines + "seal " + to_hex(calc_sha256(lines)) + "\n";
  seal.resize(kSealBytes, '\0');
  CHECK(text.substr(text.size() - kSealBytes) == seal);
  CHECK(text.starts_with("\x89HDF"));  // by which other tools recognize it
}

TEST_CASE("A merged file that begins with its seal, as they once did, is read", "[io]") {
  const TemporaryFolder folder;
  const SealKind first = {"merged", "", "", false};
  const fs::path path = folder / "first.h5";
  Hdf5Writer writer(path, {.seal = SealLabel{first, kLabel.lines}});
  writer.write("/x", std::vector<double>{1.0, 2.0, 3.0}, {"m", "", {}});
  writer.commit();
  CHECK(test::read_text(path).starts_with("strut merged seal"));
  CHECK(find_seal_kind(path) == "merged");
  CHECK(check_sealed_file(path, kMergedSeal).fault.empty());
  CHECK(Hdf5Reader(path, kMergedSeal).read("/x").values.size() == 3);
  const auto check = [&] { require_intact(path, check_sealed_file(path, kMergedSeal)); };
  CHECK(test::count_missed_flips(path, check, "makes it anew") == 0);
}

TEST_CASE("A file sealed in memory reads like one sealed on disk", "[io]") {
  const TemporaryFolder folder;
  Hdf5Writer writer(folder / "written.h5", {.seal = kLabel});
  writer.write("/x", std::vector<double>{1.0, 2.0, 3.0}, {"m", "", {}});
  writer.commit();
  for (const fs::path& path : {folder / "written.h5", write_streamed(folder)}) {
    INFO(path);
    CHECK(is_sealed(path));
    CHECK(find_seal_kind(path) == "merged");
    const SealedBytes sealed = read_sealed(path, kMergedSeal);
    CHECK(sealed.seal.get("plan") == std::string(64, 'a'));
    CHECK(sealed.seal.get("shard").empty());
    CHECK(sealed.bytes.size() == fs::file_size(path));
    CHECK(check_sealed_file(path, kMergedSeal).fault.empty());
    CHECK(Hdf5Reader(path, kMergedSeal).read("/x").values == std::vector<double>{1.0, 2.0, 3.0});
    CHECK(Hdf5Reader(path).read("/x").values.size() == 3);  // as other tools read it
  }
}

TEST_CASE("Every flipped bit of a sealed file is found with reason and remedy", "[io][property]") {
  const TemporaryFolder folder;
  const fs::path path = write_streamed(folder);
  const std::string remedy = "`strut merge DIR -o FILE --force` makes it anew";
  CHECK(test::count_missed_flips(
            path, [&] { Hdf5Reader(path, kMergedSeal); }, remedy) == 0);
  const auto check = [&] { require_intact(path, check_sealed_file(path, kMergedSeal)); };
  CHECK(test::count_missed_flips(path, check, remedy) == 0);
}

TEST_CASE("A sealed file of another kind, truncated or extended, is refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path path = write_streamed(folder);
  CHECK_THROWS_WITH(
      Hdf5Reader(path, kModelSeal),
      Contains("streamed.h5: not a model file of strut: its seal is that of a merged file"));
  const std::uintmax_t size = fs::file_size(path);
  for (const std::uintmax_t other :
       {std::uintmax_t{0}, std::uintmax_t{511}, std::uintmax_t{512}, size - 1, size + 1}) {
    INFO(other);
    write_streamed(folder);
    fs::resize_file(path, other);
    CHECK_THROWS_WITH(Hdf5Reader(path, kMergedSeal), Contains("streamed.h5: damaged"));
  }
  // With axes, a file that lost its seal is no file of an earlier version.
  for (const std::uintmax_t change : {std::uintmax_t{0}, kSealBytes + 600}) {
    Hdf5StreamWriter axes(folder / "axes.h5", kLabel);
    for (const char* name : {"/x", "/y"}) {
      axes.create(name, Hdf5Type::kDouble, {3}, {"m", "", {}});
      axes.append(name, std::vector<double>{1.0, 2.0, 3.0});
    }
    axes.attach_scale("/x", 0, {"/y"});
    axes.commit();
    fs::resize_file(folder / "axes.h5", fs::file_size(folder / "axes.h5") - kSealBytes + change);
    CHECK_THROWS_WITH(Hdf5Reader(folder / "axes.h5", kMergedSeal),
                      Contains("damaged: a merged file without the seal at its end"));
  }
  const fs::path model = folder / "model.h5";
  Hdf5Writer writer(model, {.seal = SealLabel{kModelSeal, {}}});
  writer.write("/x", std::vector<double>{1.0, 2.0, 3.0}, {"m", "", {}});
  writer.commit();
  const std::uintmax_t whole = fs::file_size(model);
  for (const std::uintmax_t other : {whole - 1, whole + 1}) {
    fs::resize_file(model, other);
    CHECK_THROWS_WITH(
        Hdf5Reader(model, kModelSeal),
        Contains("has " + std::to_string(other) + " bytes, was " + std::to_string(whole)));
  }
}

TEST_CASE("What resembles a seal of too many lines is no seal", "[io]") {
  const TemporaryFolder folder;
  const fs::path path =
      folder.write("lines.h5", "strut merged seal 1\n" + std::string(kSealBytes - 20, '\n'));
  CHECK(find_seal_kind(path).empty());
  CHECK_THROWS_WITH(read_sealed(path, kMergedSeal), Contains("no valid seal"));
}

TEST_CASE("A seal with lines that do not fit is a check error", "[unit]") {
  std::vector<std::byte> image(1024);
  CHECK_THROWS_AS(seal_image({kPlanSeal, {{"plan", std::string(400, 'a')}}}, image),
                  std::logic_error);
}

}  // namespace
}  // namespace strut
