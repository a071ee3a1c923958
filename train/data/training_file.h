// Common parts of model and checkpoint files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/least_squares/levenberg_marquardt.h"
#include "io/file/sha256.h"
#include "io/format/hdf5.h"
#include "io/format/named_texts.h"
#include "io/store/shard.h"

namespace strut {

/// Kind of a file and version of its layout.
struct TrainingFileKind {
  SealKind seal;
  std::int64_t schema_version;

  std::string name() const { return std::string("strut ") + seal.name; }  // "strut model"
};

/// Hash over the content of a file, in the order of the calls of add.
class Checksum {
 public:
  template <class T>
  void add(const std::vector<T>& values) {
    hash_.update(std::as_bytes(std::span(values)));
  }
  void add(const std::string& text) { hash_.update(text + "\n"); }
  void add(const NamedTexts& facts) {
    for (const auto& [name, value] : facts) add(name + "=" + value);
  }
  void add(const std::vector<ColumnInfo>& columns) {
    for (const ColumnInfo& c : columns) add(c.name + "\t" + c.unit + "\t" + c.description);
  }
  void add(const std::vector<EpochRecord>& record);
  std::string finish() { return to_hex(hash_.finish()); }

 private:
  Sha256 hash_;
};

/// Throws InputError with the file's path.
[[noreturn]] void fail_file(const std::filesystem::path& path, const std::string& what);

void write_kind(Hdf5Writer& file, const TrainingFileKind& kind);
/// Throws InputError if the file is of another kind or version.
void check_kind(const std::filesystem::path& path, const Hdf5Reader& file,
                const TrainingFileKind& kind);
/// Throws InputError unless the file states this checksum, the only one in a file without a seal.
void check_sum(const std::filesystem::path& path, const Hdf5Reader& file,
               const std::string& checksum);

void write_record(Hdf5Writer& file, const std::vector<EpochRecord>& record);
std::vector<EpochRecord> read_record(const std::filesystem::path& path, const Hdf5Reader& file);

StopReason read_stop(const std::filesystem::path& path, const Hdf5Reader& file);
/// Reads an integer attribute of the file, at least 0. Throws InputError.
int read_int(const std::filesystem::path& path, const Hdf5Reader& file, const char* key);
/// Converts `value` to an integer. Throws InputError if it is not one, or below 0.
int to_int(const std::filesystem::path& path, const std::string& object, double value);

/// A dataset of two rows whose columns have a name, unit and description.
struct TwoRowTable {
  std::vector<ColumnInfo> columns;
  std::vector<double> first, second;
};

/// Throws InputError, which names file and dataset, if the dataset is not such a table.
TwoRowTable read_two_rows(const std::filesystem::path& path, const Hdf5Reader& file,
                          const std::string& name);

}  // namespace strut
