#include "sweep/merge.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "io/format/hdf5_stream.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

struct ShardPlace {
  std::int64_t number = 0, first_row = 0, rows = 0, retries = 0;
};

struct Places {
  std::vector<ShardPlace> shards;  // that are there, in order
  std::size_t rows = 0;
  std::size_t text_length = 1;  // of the longest reason
};

struct FileSize {
  std::size_t rows = 0, text_length = 0;
};

FileSize read_size(const fs::path& path) {
  const Hdf5Reader file(path, read_sealed(path, kShardSeal).bytes);
  return {file.read_shape(kCaseIdName).front(), file.read_text_length(kReasonName)};
}

Places find_places(const SweepFolder& folder) {
  Places places;
  for (const std::int64_t shard : list_shards(folder)) {
    const FileSize size = read_size(folder.shard(shard));
    places.shards.push_back({shard, static_cast<std::int64_t>(places.rows),
                             static_cast<std::int64_t>(size.rows), count_retries(folder, shard)});
    places.rows += size.rows;
    places.text_length = std::max(places.text_length, size.text_length);
    for (int round = 0; round < places.shards.back().retries; ++round) {
      const FileSize retry = read_size(folder.retry(shard, round));
      places.text_length = std::max(places.text_length, retry.text_length);
    }
  }
  return places;
}

void require_all(const SweepFolder& folder, const MergeInput& input, const Places& places) {
  const std::int64_t planned = input.extent.shard_count();
  const auto present = static_cast<std::int64_t>(places.shards.size());
  if (present >= planned) return;
  std::int64_t first = 0;
  while (first < present && places.shards[static_cast<std::size_t>(first)].number == first) ++first;
  throw InputError(folder.root.string() + ": " + std::to_string(planned - present) + " of " +
                   std::to_string(planned) + " shards are missing, the first is " +
                   SweepFolder::shard_name(first) + "; `strut run " + folder.root.string() +
                   "` makes them, --partial leaves them out");
}

/// Writes the datasets; fed shard by shard.
class Merger {
 public:
  Merger(const MergeInput& input, const fs::path& output, const Places& places)
      : schema_(input.schema),
        places_(places),
        file_(output, {kMergedSeal, {{"plan", input.extent.plan_hash}}}) {
    ShardRows rows;
    rows.history.resize(schema_.history.size());
    visit_shard_columns(schema_, rows, [&](const ShardColumn& column, const auto& values) {
      using Value = typename std::decay_t<decltype(values)>::value_type;
      std::vector<std::size_t> shape = {places_.rows};
      if (column.columns > 0) shape.push_back(column.columns);
      file_.create(column.name, hdf5_type<Value>, shape, column.label, places_.text_length);
    });
  }

  void add(const ShardRows& rows) {
    visit_shard_columns(schema_, rows, [this](const ShardColumn& column, const auto& values) {
      if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<std::string>>) {
        file_.append(column.name, pack_texts(values, places_.text_length).bytes);
      } else {
        file_.append(column.name, values);
      }
    });
  }

  /// The file, for attributes and its commit; after the last shard.
  Hdf5StreamWriter& finish() {
    const auto write = [this](const std::string& name, const std::string& description,
                              std::int64_t ShardPlace::*field) {
      std::vector<std::int64_t> values;
      values.reserve(places_.shards.size());
      for (const ShardPlace& place : places_.shards) values.push_back(place.*field);
      file_.create("/shards/" + name, Hdf5Type::kInt64, {values.size()}, {"1", description, {}});
      file_.append("/shards/" + name, values);
    };
    write("number", "number of the shard", &ShardPlace::number);
    write("first_row", "its first row in this file", &ShardPlace::first_row);
    write("rows", "its cases", &ShardPlace::rows);
    write("retries", "overlays that mended rows of it", &ShardPlace::retries);
    return file_;
  }

 private:
  const ShardSchema& schema_;
  const Places& places_;
  Hdf5StreamWriter file_;
};

}  // namespace

MergeReport merge_sweep(const SweepFolder& folder, const MergeInput& input, const fs::path& output,
                        const MergeOptions& options,
                        const std::function<bool(std::int64_t)>& progress) {
  const Places places = find_places(folder);
  if (!options.partial) require_all(folder, input, places);
  if (places.rows == 0) throw InputError(folder.root.string() + ": holds no shard yet");
  Merger merger(input, output, places);
  DataDigest digest;
  MergeReport report;
  std::vector<std::int64_t> case_ids;
  for (const ShardPlace& place : places.shards) {
    const Shard shard = read_shard_with_retries(folder, input.extent, place.number);
    if (shard.schema != input.schema) {
      throw InputError(folder.shard(place.number).string() + ": has other columns than its plan");
    }
    case_ids.insert(case_ids.end(), shard.rows.case_id.begin(), shard.rows.case_id.end());
    merger.add(shard.rows);
    digest.add(calc_rows_digest(shard.rows));
    ++report.shards;
    report.cases += place.rows;
    report.failed += std::count_if(shard.rows.status.begin(), shard.rows.status.end(),
                                   [](std::int32_t status) { return status != 0; });
    if (!progress(report.cases)) return report;
  }
  if (const std::int64_t twice = find_repeated(std::move(case_ids)); twice >= 0) {
    throw InputError(folder.root.string() + ": case " + std::to_string(twice) +
                     " is in two shards; `strut verify " + folder.root.string() + "` tells which");
  }
  report.missing = input.extent.shard_count() - report.shards;
  report.data_digest = digest.text();
  Hdf5StreamWriter& file = merger.finish();
  write_shard_attributes(file, list_names(input.schema.history), input.schema.history_interval,
                         input.schema.status_meaning, input.extent.plan_hash, digest);
  for (const auto& [key, text] : options.provenance) file.write_attribute("/", key, text);
  file.commit();
  return report;
}

}  // namespace strut
