// Reads the rows of a shard from its file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

void require(bool good, const fs::path& path, const std::string& object, const std::string& what) {
  if (!good) throw InputError(fmt::format("{}: {}: {}", path.string(), object, what));
}

void check_schema_version(const fs::path& path, const Hdf5Reader& file) {
  // Models and checkpoints have version numbers of their own; only they have this attribute.
  constexpr char kKindKey[] = "kind";
  if (file.has_attribute("/", kKindKey)) {
    throw InputError(fmt::format("{}: a {}; must be a shard or a merged file of a sweep",
                                 path.string(), file.read_attribute("/", kKindKey)));
  }
  const std::int64_t version = file.read_integer_attribute("/", kSchemaVersionKey);
  require(version == kShardSchemaVersion, path, kSchemaVersionKey,
          fmt::format("is {}; this program reads {}{}", version, kShardSchemaVersion,
                      version > kShardSchemaVersion ? ": written by a newer strut" : ""));
}

std::vector<ColumnInfo> read_columns(const fs::path& path, const Hdf5Reader& file,
                                     const std::string& name) {
  const Hdf5Label label = file.read_label(name);
  const std::size_t count = label.names.size();
  require(label.units.size() == count && label.descriptions.size() == count, path, name,
          "damaged: the numbers of names, units and descriptions differ");
  std::vector<ColumnInfo> columns;
  columns.reserve(count);
  for (std::size_t c = 0; c < count; ++c) {
    columns.push_back({label.names[c], label.units[c], label.descriptions[c]});
  }
  return columns;
}

ShardRows read_rows(const fs::path& path, const Hdf5Reader& file, const ShardSchema& schema) {
  ShardRows rows;
  rows.history.resize(schema.history.size());
  const std::size_t count = file.read_shape(kCaseIdName).front();
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, auto& values) {
    require_shape(path, file, column, count);
    using Value = typename std::decay_t<decltype(values)>::value_type;
    if constexpr (std::is_same_v<Value, std::string>) {
      values = file.read_texts(column.name);
    } else if constexpr (std::is_same_v<Value, double>) {
      values = std::move(file.read(column.name).values);
    } else {
      const auto integers = file.read_integers(column.name);
      values.reserve(integers.size());
      for (const std::int64_t value : integers) values.push_back(static_cast<Value>(value));
    }
  });
  return rows;
}

ShardProvenance read_provenance(const Hdf5Reader& file) {
  constexpr std::array<const char*, 6> kOwn = {kSchemaVersionKey, kPlanHashKey,
                                               kShardKey,         kChecksumKey,
                                               kStatusMeaningKey, kHistoryIntervalKey};
  ShardProvenance provenance;
  provenance.plan_hash = file.read_attribute("/", kPlanHashKey);
  provenance.shard = file.read_integer_attribute("/", kShardKey);
  for (const std::string& key : file.list_attributes("/")) {
    const bool own = std::find(kOwn.begin(), kOwn.end(), key) != kOwn.end();
    if (!own) provenance.texts.emplace_back(key, file.read_attribute("/", key));
  }
  return provenance;
}

}  // namespace

void require_shape(const fs::path& path, const Hdf5Reader& file, const ShardColumn& column,
                   std::size_t rows) {
  std::vector<std::size_t> shape = {rows};
  if (column.columns > 0) shape.push_back(column.columns);
  require(file.read_shape(column.name) == shape, path, column.name,
          fmt::format("must have {} rows, one per case, and {} columns", rows,
                      std::max<std::size_t>(column.columns, 1)));
}

ShardSchema read_shard_schema(const fs::path& path, const Hdf5Reader& file) {
  check_schema_version(path, file);
  ShardSchema schema;
  schema.parameters = read_columns(path, file, kParametersName);
  if (file.has(kSnapshotName)) schema.snapshot = read_columns(path, file, kSnapshotName);
  if (file.has(kHistoryGroup)) {
    for (const std::string& channel : file.read_attribute_list(kHistoryGroup, "names")) {
      ColumnInfo& info = schema.history.emplace_back(ColumnInfo{channel, "", ""});
      const Hdf5Label label = file.read_label(get_history_name(info));
      info.unit = label.unit;
      info.description = label.description;
    }
  }
  if (!schema.history.empty()) {
    const std::string name = get_history_name(schema.history.front());
    const auto shape = file.read_shape(name);
    require(shape.size() == 2, path, name, "must have two dimensions");
    schema.history_samples = shape.back();
  }
  schema.history_interval = file.read_number_attribute("/", kHistoryIntervalKey);
  schema.status_meaning = file.read_attribute("/", kStatusMeaningKey);
  return schema;
}

Shard read_shard(const fs::path& path, ShardParts parts) {
  return read_shard(path, read_sealed(path, kShardSeal), parts);
}

Shard read_shard(const fs::path& path, const SealedBytes& sealed, ShardParts parts) {
  const ShardSeal seal = read_shard_seal(path, sealed.bytes);
  const Hdf5Reader file(path, sealed.bytes);
  Shard shard;
  shard.schema = read_shard_schema(path, file);
  ShardSchema wanted = shard.schema;
  if (parts == ShardParts::kTables) wanted.history.clear();
  shard.rows = read_rows(path, file, wanted);
  shard.provenance = read_provenance(file);
  require(shard.provenance.plan_hash == seal.plan_hash && shard.provenance.shard == seal.shard,
          path, "seal", "damaged: names another plan or shard than the file");
  if (parts == ShardParts::kTables) return shard;
  shard.digest = calc_rows_digest(shard.rows);
  require(shard.digest.text() == file.read_attribute("/", kChecksumKey), path, kChecksumKey,
          "damaged: does not match the rows");
  return shard;
}

}  // namespace strut
