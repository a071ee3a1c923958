#include "sweep/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "base/text/nearest_name.h"
#include "io/format/hdf5_stream.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// A shard in the merged file.
struct MergedShard {
  std::int64_t number = 0, first_row = 0, rows = 0, retries = 0;
};

/// The shards that exist, in order, and the size of the merged file.
struct MergeLayout {
  std::vector<MergedShard> shards;
  std::size_t rows = 0;
  std::size_t text_length = 1;  // length of the longest reason
};

struct FileSize {
  std::size_t rows = 0, text_length = 0;
};

FileSize read_size(const fs::path& path) {
  const Hdf5Reader file(path, read_sealed(path, kShardSeal).bytes);
  return {file.read_shape(kCaseIdName).front(), file.read_text_length(kReasonName)};
}

MergeLayout read_layout(const SweepFolder& folder) {
  MergeLayout layout;
  for (const std::int64_t shard : list_shards(folder)) {
    const FileSize size = read_size(folder.shard(shard));
    layout.shards.push_back({shard, static_cast<std::int64_t>(layout.rows),
                             static_cast<std::int64_t>(size.rows), count_retries(folder, shard)});
    layout.rows += size.rows;
    layout.text_length = std::max(layout.text_length, size.text_length);
    for (int round = 0; round < layout.shards.back().retries; ++round) {
      const FileSize retry = read_size(folder.retry(shard, round));
      layout.text_length = std::max(layout.text_length, retry.text_length);
    }
  }
  return layout;
}

void require_all(const SweepFolder& folder, const MergeInput& input, const MergeLayout& layout) {
  const std::int64_t planned = input.extent.shard_count();
  const auto present = static_cast<std::int64_t>(layout.shards.size());
  if (present >= planned) return;
  std::int64_t first = 0;
  while (first < present && layout.shards[static_cast<std::size_t>(first)].number == first) ++first;
  throw InputError(fmt::format(
      "{0}: {1} of {2} shards are missing, the first is {3}; `strut run {0}` makes them, --partial "
      "merges the others",
      folder.root.string(), planned - present, planned, SweepFolder::shard_name(first)));
}

void create_datasets(const ShardSchema& schema, const MergeLayout& layout, Hdf5StreamWriter& file) {
  ShardRows rows;
  rows.history.resize(schema.history.size());
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, const auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    // netCDF has no texts of fixed length, but characters.
    constexpr bool kIsText = std::is_same_v<Value, std::string>;
    const std::size_t columns = kIsText ? layout.text_length : column.columns;
    std::vector<std::size_t> shape = {layout.rows};
    if (columns > 0) shape.push_back(columns);
    file.create(column.name, hdf5_type<Value>, shape, column.label, 1);
  });
}

void append_rows(const ShardSchema& schema, const MergeLayout& layout, const ShardRows& rows,
                 Hdf5StreamWriter& file) {
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, const auto& values) {
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<std::string>>) {
      file.append(column.name, pack_texts(values, layout.text_length).bytes);
    } else {
      file.append(column.name, values);
    }
  });
}

/// Writes the group /shards.
void write_shard_list(const MergeLayout& layout, Hdf5StreamWriter& file) {
  const auto write = [&](const std::string& name, const std::string& description,
                         std::int64_t MergedShard::*field) {
    std::vector<std::int64_t> values;
    values.reserve(layout.shards.size());
    for (const MergedShard& shard : layout.shards) values.push_back(shard.*field);
    file.create("/shards/" + name, Hdf5Type::kInt64, {values.size()}, {"1", description, {}});
    file.append("/shards/" + name, values);
  };
  write("number", "number of the shard", &MergedShard::number);
  write("first_row", "its first row in this file", &MergedShard::first_row);
  write("rows", "its cases", &MergedShard::rows);
  write("retries", "overlays that mended rows of it", &MergedShard::retries);
}

void write_times(const ShardSchema& schema, Hdf5StreamWriter& file) {
  std::vector<double> times(schema.history_samples);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = static_cast<double>(i) * schema.history_interval;
  }
  file.create(kTimeAxis, Hdf5Type::kDouble, {times.size()}, {"s", "time of a sample", {}});
  file.append(kTimeAxis, times);
}

/// Writes what makes the file one of netCDF-4: an axis for each dimension, and the attributes
/// `units` and `long_name`.
void write_axes(const ShardSchema& schema, const MergeLayout& layout, Hdf5StreamWriter& file) {
  std::vector<std::string> rows, histories;
  const auto describe = [&](const std::string& name, const Hdf5Label& label) {
    if (label.units.empty()) file.write_attribute(name, "units", label.unit);
    file.write_attribute(name, "long_name", label.description);
    // One text: not all tools read lists.
    if (!label.names.empty()) file.write_attribute(name, "columns", join_names(label.names));
  };
  ShardRows none;
  none.history.resize(schema.history.size());
  visit_shard_columns(schema, none, [&](const ShardColumn& column, const auto&) {
    if (column.name != kCaseIdName) rows.push_back(column.name);
    if (column.name.starts_with(kHistoryGroup)) histories.push_back(column.name);
    describe(column.name, column.label);
  });
  file.attach_scale(kCaseIdName, 0, rows);
  file.write_attribute(kReasonName, "_Encoding", "utf-8");
  file.create_dimension(kReasonLength, layout.text_length);
  file.attach_scale(kReasonLength, 1, {kReasonName});
  file.write_names(kParameterAxis, list_names(schema.parameters), "names of the parameters");
  file.attach_scale(kParameterAxis, 1, {kParametersName});
  if (!schema.snapshot.empty()) {
    file.write_names(kChannelAxis, list_names(schema.snapshot), "names of the channels");
    file.attach_scale(kChannelAxis, 1, {kSnapshotName});
  }
  if (!schema.history.empty()) {
    write_times(schema, file);
    file.attach_scale(kTimeAxis, 1, histories);
    describe(kTimeAxis, {"s", "time of a sample", {}});
  }
  file.attach_scale("/shards/number", 0, {"/shards/first_row", "/shards/rows", "/shards/retries"});
}

Shard read_checked_shard(const SweepFolder& folder, const MergeInput& input, std::int64_t number) {
  Shard shard = read_shard_with_retries(folder, input.extent, number);
  if (shard.schema == input.schema) return shard;
  throw InputError(folder.shard(number).string() + ": its columns differ from those of its plan");
}

void require_unique(const SweepFolder& folder, std::vector<std::int64_t> case_ids) {
  const std::int64_t repeated = find_repeated(std::move(case_ids));
  if (repeated < 0) return;
  throw InputError(fmt::format("{0}: case {1} is in two shards; `strut verify {0}` names them",
                               folder.root.string(), repeated));
}

}  // namespace

MergeReport merge_sweep(const SweepFolder& folder, const MergeInput& input, const fs::path& output,
                        const MergeOptions& options,
                        const std::function<bool(std::int64_t)>& progress) {
  const MergeLayout layout = read_layout(folder);
  if (!options.partial) require_all(folder, input, layout);
  if (layout.rows == 0) throw InputError(folder.root.string() + ": contains no shard yet");
  Hdf5StreamWriter file(output, {kMergedSeal, {{"plan", input.extent.plan_hash}}});
  create_datasets(input.schema, layout, file);
  DataDigest digest;
  MergeReport report;
  std::vector<std::int64_t> case_ids;
  for (const MergedShard& merged : layout.shards) {
    const ShardRows rows = read_checked_shard(folder, input, merged.number).rows;
    case_ids.insert(case_ids.end(), rows.case_id.begin(), rows.case_id.end());
    append_rows(input.schema, layout, rows, file);
    digest.add(calc_rows_digest(rows));
    ++report.shards;
    report.cases += merged.rows;
    report.failed += std::count_if(rows.status.begin(), rows.status.end(),
                                   [](std::int32_t status) { return status != 0; });
    if (!progress(report.cases)) return report;
  }
  require_unique(folder, std::move(case_ids));
  report.missing = input.extent.shard_count() - report.shards;
  report.data_digest = digest.text();
  write_shard_list(layout, file);
  write_axes(input.schema, layout, file);
  write_shard_attributes(file, list_names(input.schema.history), input.schema.history_interval,
                         input.schema.status_meaning, input.extent.plan_hash, digest);
  for (const auto& [key, text] : options.provenance) file.write_attribute("/", key, text);
  file.commit();
  return report;
}

}  // namespace strut
