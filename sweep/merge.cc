#include "sweep/merge.h"

#include <algorithm>
#include <type_traits>

#include "io/hdf5_stream.h"
#include "io/shard_layout.h"
#include "sweep/shard_store.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

struct ShardPlace {
  std::int64_t number = 0, first_row = -1, rows = 0, retries = 0;
};

struct Places {
  std::vector<ShardPlace> shards;  // of the plan, in order
  std::size_t rows = 0;
  std::size_t text_length = 1;  // of the longest reason
};

struct FileSize {
  std::size_t rows = 0, text_length = 0;
};

FileSize read_size(const fs::path& path) {
  const std::vector<std::byte> bytes = read_shard_bytes(path);
  check_shard_bytes(path, bytes);
  const Hdf5Reader file(path, bytes);
  return {file.read_shape("/case_id").front(), file.read_text_length(kReasonName)};
}

Places find_places(const SweepFolder& folder, const MergeInput& input) {
  Places places;
  places.shards.reserve(static_cast<std::size_t>(input.shard_count));
  for (std::int64_t shard = 0; shard < input.shard_count; ++shard) {
    ShardPlace place{.number = shard};
    if (fs::exists(folder.shard(shard))) {
      const FileSize size = read_size(folder.shard(shard));
      place.first_row = static_cast<std::int64_t>(places.rows);
      place.rows = static_cast<std::int64_t>(size.rows);
      place.retries = count_retries(folder, shard);
      places.rows += size.rows;
      places.text_length = std::max(places.text_length, size.text_length);
    }
    for (int round = 0; round < place.retries; ++round) {
      const FileSize size = read_size(folder.retry(shard, round));
      places.text_length = std::max(places.text_length, size.text_length);
    }
    places.shards.push_back(place);
  }
  return places;
}

void require_all(const SweepFolder& folder, const Places& places) {
  const auto is_missing = [](const ShardPlace& place) { return place.first_row < 0; };
  const auto first = std::find_if(places.shards.begin(), places.shards.end(), is_missing);
  if (first == places.shards.end()) return;
  const auto count = std::count_if(first, places.shards.end(), is_missing);
  throw InputError(folder.root.string() + ": " + std::to_string(count) + " of " +
                   std::to_string(places.shards.size()) + " shards are missing, the first is " +
                   SweepFolder::shard_name(first->number) + "; `strut run " + folder.root.string() +
                   "` makes them, --partial leaves them out");
}

/// Writes the datasets, by copies or as views; fed shard by shard.
class Merger {
 public:
  Merger(const SweepFolder& folder, const MergeInput& input, const fs::path& output,
         const Places& places, bool is_view)
      : folder_(folder),
        schema_(input.schema),
        output_(output),
        places_(places),
        is_view_(is_view),
        file_(output) {
    if (!is_view_) visit([this](const auto&... arguments) { create(arguments...); });
  }

  void add(const ShardPlace& place, const ShardRows& rows, const std::vector<RowOrigin>& origins) {
    if (is_view_) return add_parts(place, origins);
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
    if (is_view_) visit([this](const auto&... arguments) { create_view(arguments...); });
    write_shard_table();
    return file_;
  }

 private:
  /// visit_one(column, type, shape) for every dataset.
  template <class Visit>
  void visit(const Visit& visit_one) {
    ShardRows rows;
    rows.history.resize(schema_.history.size());
    visit_shard_columns(schema_, rows, [&](const ShardColumn& column, const auto& values) {
      using Value = typename std::decay_t<decltype(values)>::value_type;
      std::vector<std::size_t> shape = {places_.rows};
      if (column.columns > 0) shape.push_back(column.columns);
      visit_one(column, hdf5_type<Value>, shape);
    });
  }

  void create(const ShardColumn& column, Hdf5Type type, const std::vector<std::size_t>& shape) {
    file_.create(column.name, type, shape, column.label, places_.text_length);
  }

  void create_view(const ShardColumn& column, Hdf5Type type,
                   const std::vector<std::size_t>& shape) {
    for (Hdf5ViewPart& part : parts_) part.dataset = column.name;
    file_.write_virtual(column.name, type, shape, parts_, column.label, places_.text_length);
  }

  std::string relative_name(const fs::path& file) const {
    const fs::path folder = fs::weakly_canonical(fs::absolute(output_)).parent_path();
    return fs::weakly_canonical(file).lexically_relative(folder).generic_string();
  }

  /// Runs of rows that follow each other in one file.
  void add_parts(const ShardPlace& place, const std::vector<RowOrigin>& origins) {
    for (std::size_t row = 0; row < origins.size(); ++row) {
      const RowOrigin& origin = origins[row];
      const bool follows = row > 0 && origins[row - 1].round == origin.round &&
                           origins[row - 1].row + 1 == origin.row;
      if (follows) {
        ++parts_.back().rows;
        continue;
      }
      const fs::path file = origin.round < 0 ? folder_.shard(place.number)
                                             : folder_.retry(place.number, origin.round);
      parts_.push_back({.file = relative_name(file),
                        .dataset = "",
                        .source_rows = origin.file_rows,
                        .source_first = origin.row,
                        .target_first = static_cast<std::size_t>(place.first_row) + row,
                        .rows = 1});
    }
  }

  void write_shard_table() {
    const auto write = [this](const std::string& name, const std::string& description,
                              std::int64_t ShardPlace::*field) {
      std::vector<std::int64_t> values;
      values.reserve(places_.shards.size());
      for (const ShardPlace& place : places_.shards) values.push_back(place.*field);
      file_.create("/shards/" + name, Hdf5Type::kInt64, {values.size()}, {"1", description, {}});
      file_.append("/shards/" + name, values);
    };
    write("number", "number of the shard", &ShardPlace::number);
    write("first_row", "its first row in this file; -1: the shard was missing",
          &ShardPlace::first_row);
    write("rows", "its cases", &ShardPlace::rows);
    write("retries", "overlays that mended rows of it", &ShardPlace::retries);
  }

  const SweepFolder& folder_;
  const ShardSchema& schema_;
  const fs::path output_;
  const Places& places_;
  const bool is_view_;
  Hdf5StreamWriter file_;
  std::vector<Hdf5ViewPart> parts_;
};

void check_shard(const SweepFolder& folder, const MergeInput& input, const ShardPlace& place,
                 const Shard& shard) {
  const std::string file = folder.shard(place.number).string();
  const std::string misfit = check_place(shard.provenance.plan_hash, shard.provenance.shard,
                                         input.plan_hash, place.number);
  if (!misfit.empty()) throw InputError(file + ": " + misfit);
  if (shard.schema != input.schema) throw InputError(file + ": has other columns than its plan");
}

}  // namespace

MergeReport merge_sweep(const SweepFolder& folder, const MergeInput& input, const fs::path& output,
                        const MergeOptions& options,
                        const std::function<bool(std::int64_t)>& progress) {
  const Places places = find_places(folder, input);
  if (!options.partial) require_all(folder, places);
  if (places.rows == 0) throw InputError(folder.root.string() + ": holds no shard yet");
  Merger merger(folder, input, output, places, options.is_view);
  DataDigest digest;
  MergeReport report;
  for (const ShardPlace& place : places.shards) {
    if (place.first_row < 0) {
      ++report.missing;
      continue;
    }
    std::vector<RowOrigin> origins;
    const Shard shard = read_mended_shard(folder, place.number, &origins);
    check_shard(folder, input, place, shard);
    merger.add(place, shard.rows, origins);
    digest.add(calc_rows_digest(shard.rows));
    ++report.shards;
    report.cases += place.rows;
    report.failed += std::count_if(shard.rows.status.begin(), shard.rows.status.end(),
                                   [](std::int32_t status) { return status != 0; });
    if (!progress(report.cases)) return report;
  }
  report.data_digest = digest.text();
  Hdf5StreamWriter& file = merger.finish();
  write_shard_attributes(file, list_names(input.schema.history), input.schema.history_interval,
                         input.schema.status_meaning, input.plan_hash, digest);
  for (const auto& [key, text] : options.provenance) file.write_attribute("/", key, text);
  file.commit();
  return report;
}

}  // namespace strut
