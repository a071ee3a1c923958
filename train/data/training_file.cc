#include "train/data/training_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kKindKey[] = "kind";
constexpr std::size_t kRecordColumns = 5;

std::vector<double> flatten(const std::vector<EpochRecord>& record) {
  std::vector<double> rows;
  rows.reserve(kRecordColumns * record.size());
  for (const EpochRecord& r : record) {
    rows.insert(rows.end(),
                {static_cast<double>(r.epoch), r.loss, r.validation, r.gradient, r.damping});
  }
  return rows;
}

}  // namespace

void Checksum::add(const std::vector<EpochRecord>& record) { add(flatten(record)); }

void fail_file(const fs::path& path, const std::string& what) {
  throw InputError(path.string() + ": " + what);
}

void write_kind(Hdf5Writer& file, const TrainingFileKind& kind) {
  file.write_attribute("/", kKindKey, kind.name());
  file.write_attribute("/", kSchemaVersionKey, kind.schema_version);
}

void check_kind(const fs::path& path, const Hdf5Reader& file, const TrainingFileKind& kind) {
  if (!file.has_attribute("/", kKindKey) || file.read_attribute("/", kKindKey) != kind.name()) {
    fail_file(path, fmt::format("not a {} file of strut", kind.seal.name));
  }
  const std::int64_t version = file.read_integer_attribute("/", kSchemaVersionKey);
  if (version != kind.schema_version) {
    fail_file(path, fmt::format("schema_version = {}: this program reads {}", version,
                                kind.schema_version));
  }
}

void check_sum(const fs::path& path, const Hdf5Reader& file, const std::string& checksum) {
  if (file.read_attribute("/", kChecksumKey) != checksum) {
    fail_file(path, "checksum: does not match the content; the file is damaged");
  }
}

void write_record(Hdf5Writer& file, const std::vector<EpochRecord>& record) {
  file.write("/record", flatten(record), kRecordColumns,
             {"1",
              "each epoch before its step; loss: mean square error of normalized targets",
              {"epoch", "loss", "validation", "gradient", "damping"}});
}

std::vector<EpochRecord> read_record(const fs::path& path, const Hdf5Reader& file) {
  const Hdf5Dataset data = file.read("/record");
  if (data.shape.size() != 2 || data.shape[1] != kRecordColumns) {
    fail_file(path, fmt::format("/record: must have {} columns", kRecordColumns));
  }
  std::vector<EpochRecord> record;
  record.reserve(data.shape[0]);
  for (std::size_t i = 0; i < data.shape[0]; ++i) {
    const double* r = data.values.data() + i * kRecordColumns;
    record.push_back({to_int(path, "/record", r[0]), r[1], r[2], r[3], r[4]});
  }
  return record;
}

StopReason read_stop(const fs::path& path, const Hdf5Reader& file) {
  const std::int64_t number = file.read_integer_attribute("/", "stop");
  if (number < 0 || number > static_cast<std::int64_t>(StopReason::kNotFinite)) {
    fail_file(path, "stop: unknown");
  }
  return static_cast<StopReason>(number);
}

int read_int(const fs::path& path, const Hdf5Reader& file, const char* key) {
  return to_int(path, key, static_cast<double>(file.read_integer_attribute("/", key)));
}

int to_int(const fs::path& path, const std::string& object, double value) {
  if (!(value >= 0.0 && value <= std::numeric_limits<int>::max()) || value != std::floor(value)) {
    fail_file(path, object + ": damaged: must be a whole number of at least 0");
  }
  return static_cast<int>(value);
}

TwoRowTable read_two_rows(const fs::path& path, const Hdf5Reader& file, const std::string& name) {
  const Hdf5Dataset data = file.read(name);
  const Hdf5Label& label = data.label;
  const std::size_t count = label.names.size();
  if (count == 0 || data.shape != std::vector<std::size_t>{2, count} ||
      label.units.size() != count || label.descriptions.size() != count) {
    fail_file(path,
              name + ": must have two rows, and a name, unit and description for each column");
  }
  TwoRowTable table;
  table.columns.reserve(count);
  for (std::size_t c = 0; c < count; ++c) {
    table.columns.push_back({label.names[c], label.units[c], label.descriptions[c]});
  }
  const auto cut = data.values.begin() + static_cast<std::ptrdiff_t>(count);
  table.first.assign(data.values.begin(), cut);
  table.second.assign(cut, data.values.end());
  return table;
}

}  // namespace strut
