// Datasets and attributes of a shard's file, listed once for its writer, its reader and the merge.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "io/store/shard.h"

namespace strut {

/// A dataset of a shard: rows are cases.
struct ShardColumn {
  std::string name;         // "/snapshot"
  std::size_t columns = 0;  // 0: one dimension
  Hdf5Label label;
};

// Attributes of the file.
inline constexpr char kSchemaVersionKey[] = "schema_version";
inline constexpr char kPlanHashKey[] = "plan_hash";
inline constexpr char kShardKey[] = "shard";
inline constexpr char kChecksumKey[] = "checksum";
inline constexpr char kStatusMeaningKey[] = "status_meaning";
inline constexpr char kHistoryIntervalKey[] = "history_interval";
inline constexpr char kInstructionSetKey[] = "instruction_set";

inline constexpr char kCaseIdName[] = "/case_id";
inline constexpr char kParametersName[] = "/parameters";
inline constexpr char kSnapshotName[] = "/snapshot";
inline constexpr char kReasonName[] = "/reason";
inline constexpr char kHistoryGroup[] = "/history";

// Axes of a merged file.
inline constexpr char kParameterAxis[] = "/parameter";
inline constexpr char kChannelAxis[] = "/channel";
inline constexpr char kReasonLength[] = "/reason_length";
inline constexpr char kTimeAxis[] = "/history/time";

inline std::string get_history_name(const ColumnInfo& channel) {
  return kHistoryGroup + ("/" + channel.name);
}

inline ShardColumn make_table_column(const char* name, const std::vector<ColumnInfo>& columns,
                                     const char* description) {
  ShardColumn table{name, columns.size(), {"mixed", description, {}}};
  for (const ColumnInfo& column : columns) {
    table.label.names.push_back(column.name);
    table.label.units.push_back(column.unit);
    table.label.descriptions.push_back(column.description);
  }
  const auto& units = table.label.units;
  const auto differs = [&units](const std::string& unit) { return unit != units.front(); };
  if (!units.empty() && std::none_of(units.begin(), units.end(), differs)) {
    table.label.unit = units.front();
  }
  return table;
}

/// Calls visit(ShardColumn, vector of values) for every dataset of `schema`, in a fixed order.
template <class Rows, class Visit>
void visit_shard_columns(const ShardSchema& schema, Rows& rows, const Visit& visit) {
  const auto plain = [](const char* name, const char* unit, const std::string& description) {
    return ShardColumn{name, 0, {unit, description, {}}};
  };
  visit(plain(kCaseIdName, "1", "number of the case in the plan"), rows.case_id);
  visit(make_table_column(kParametersName, schema.parameters, "parameters of the case"),
        rows.parameters);
  if (!schema.snapshot.empty()) {
    visit(make_table_column(kSnapshotName, schema.snapshot,
                            "channels at event_time; NaN: the case has none"),
          rows.snapshot);
  }
  visit(plain("/layer", "1", "stratum that the case was drawn from"), rows.layer);
  visit(plain("/status", "1", "how the case ended: " + schema.status_meaning), rows.status);
  visit(plain("/attempt", "1", "0: first try; k: the k-th retry"), rows.attempt);
  visit(plain("/event_time", "s", "time of the snapshot; NaN: none"), rows.event_time);
  visit(plain("/failure_time", "s", "time at which the case failed; NaN: it did not"),
        rows.failure_time);
  visit(plain(kReasonName, "1", "why the case failed; empty: it did not"), rows.reason);
  for (std::size_t c = 0; c < schema.history.size(); ++c) {
    const ColumnInfo& channel = schema.history[c];
    visit(ShardColumn{get_history_name(channel),
                      schema.history_samples,
                      {channel.unit, channel.description, {}}},
          rows.history[c]);
  }
}

/// Writes the attributes that complete a schema; `File` is any writer of HDF5.
template <class File>
void write_shard_attributes(File& file, const std::vector<std::string>& history_names,
                            double history_interval, const std::string& status_meaning,
                            const std::string& plan_hash, const DataDigest& digest) {
  file.write_attribute("/", kSchemaVersionKey, std::int64_t{kShardSchemaVersion});
  file.write_attribute("/", kPlanHashKey, plan_hash);
  file.write_attribute("/", kChecksumKey, digest.text());
  file.write_attribute("/", kStatusMeaningKey, status_meaning);
  file.write_attribute("/", kHistoryIntervalKey, history_interval);
  if (!history_names.empty()) file.write_attribute_list(kHistoryGroup, "names", history_names);
}

/// Reads the schema of a shard or a merged file, which messages call `path`. Throws InputError if a
/// dataset is missing or has the wrong shape, or if the schema version is unknown.
ShardSchema read_shard_schema(const std::filesystem::path& path, const Hdf5Reader& file);

/// Throws InputError unless the dataset has `rows` rows, one per case, and the columns of `column`.
void require_shape(const std::filesystem::path& path, const Hdf5Reader& file,
                   const ShardColumn& column, std::size_t rows);

inline std::vector<std::string> list_names(const std::vector<ColumnInfo>& columns) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const ColumnInfo& column : columns) names.push_back(column.name);
  return names;
}

}  // namespace strut
