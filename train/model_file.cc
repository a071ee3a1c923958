#include "train/model_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "io/hdf5.h"
#include "io/sha256.h"
#include "io/shard_layout.h"
#include "train/network.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSchemaVersion = 1;
constexpr char kModelKind[] = "strut model", kCheckpointKind[] = "strut checkpoint";
constexpr char kKindKey[] = "kind", kSplitSeedKey[] = "split_seed";
constexpr std::size_t kRecordColumns = 5;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw InputError(path.string() + ": " + what);
}

/// Hash over the numbers of a file, in the order in which they are added.
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
  std::string finish() { return to_hex(hash_.finish()); }

 private:
  Sha256 hash_;
};

std::vector<std::int64_t> widen(const std::vector<int>& sizes) {
  return {sizes.begin(), sizes.end()};
}

std::vector<double> flatten(const std::vector<EpochRecord>& record) {
  std::vector<double> rows;
  rows.reserve(kRecordColumns * record.size());
  for (const EpochRecord& r : record) {
    rows.insert(rows.end(),
                {static_cast<double>(r.epoch), r.loss, r.validation, r.gradient, r.damping});
  }
  return rows;
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
    fail(path, "/record: must have " + std::to_string(kRecordColumns) + " columns");
  }
  std::vector<EpochRecord> record;
  record.reserve(data.shape[0]);
  for (std::size_t i = 0; i < data.shape[0]; ++i) {
    const double* r = data.values.data() + i * kRecordColumns;
    record.push_back({static_cast<int>(r[0]), r[1], r[2], r[3], r[4]});
  }
  return record;
}

void write_facts(Hdf5Writer& file, const std::string& group, const NamedTexts& facts) {
  std::vector<std::string> names, values;
  names.reserve(facts.size());
  values.reserve(facts.size());
  for (const auto& [name, value] : facts) {
    names.push_back(name);
    values.push_back(value);
  }
  file.write(group + "/name", names, {"1", "name of an option", {}});
  file.write(group + "/value", values, {"1", "its value", {}});
}

NamedTexts read_facts(const fs::path& path, const Hdf5Reader& file, const std::string& group) {
  const std::vector<std::string> names = file.read_texts(group + "/name");
  const std::vector<std::string> values = file.read_texts(group + "/value");
  if (names.size() != values.size()) fail(path, group + ": names and values do not fit each other");
  NamedTexts facts;
  facts.reserve(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) facts.emplace_back(names[i], values[i]);
  return facts;
}

void write_columns(Hdf5Writer& file, const char* name, const std::vector<ColumnInfo>& columns,
                   const Normalizer& map) {
  std::vector<double> bounds = map.low();
  bounds.insert(bounds.end(), map.high().begin(), map.high().end());
  const ShardColumn table = make_table_column(
      name, columns, "lowest and highest value, which the network sees as -1 and 1");
  file.write(name, bounds, columns.size(), table.label);
}

void read_columns(const fs::path& path, const Hdf5Reader& file, const std::string& name,
                  std::vector<ColumnInfo>& columns, Normalizer& map) {
  const Hdf5Dataset data = file.read(name);
  const Hdf5Label& label = data.label;
  const std::size_t count = label.names.size();
  if (data.shape != std::vector<std::size_t>{2, count} || label.units.size() != count ||
      label.descriptions.size() != count) {
    fail(path, name + ": must have two rows, and a name, unit and description for each column");
  }
  const auto cut = data.values.begin() + static_cast<std::ptrdiff_t>(count);
  map = Normalizer({data.values.begin(), cut}, {cut, data.values.end()});
  const bool finite = std::all_of(data.values.begin(), data.values.end(),
                                  [](double x) { return std::isfinite(x); });
  if (!finite || map.find_constant() < count)
    fail(path, name + ": bounds must be finite and differ");
  columns.clear();
  columns.reserve(count);
  for (std::size_t c = 0; c < count; ++c) {
    columns.push_back({label.names[c], label.units[c], label.descriptions[c]});
  }
}

void check_kind(const fs::path& path, const Hdf5Reader& file, const std::string& kind) {
  if (!file.has_attribute("/", kKindKey) || file.read_attribute("/", kKindKey) != kind) {
    fail(path, "no " + kind.substr(kind.find(' ') + 1) + " of strut");
  }
  const std::int64_t version = file.read_integer_attribute("/", kSchemaVersionKey);
  if (version != kSchemaVersion) {
    fail(path, "schema_version = " + std::to_string(version) + ": this program reads " +
                   std::to_string(kSchemaVersion));
  }
}

void check_sum(const fs::path& path, const Hdf5Reader& file, const std::string& checksum) {
  if (file.read_attribute("/", kChecksumKey) != checksum) {
    fail(path, "checksum: the content has another one; the file is damaged");
  }
}

std::string calc_checksum(const Model& model) {
  Checksum sum;
  sum.add(widen(model.sizes));
  sum.add(model.weights);
  sum.add(model.inputs);
  sum.add(model.targets);
  for (const Normalizer* map : {&model.input_map, &model.target_map}) {
    sum.add(map->low());
    sum.add(map->high());
  }
  sum.add(model.plan_hash);
  sum.add(std::vector<std::int64_t>{model.samples, model.usable, model.skipped,
                                    static_cast<std::int64_t>(model.split.seed), model.best_epoch,
                                    static_cast<std::int64_t>(model.stop)});
  sum.add(std::vector<double>{model.split.train, model.split.validate, model.best_validation,
                              model.seconds});
  sum.add(flatten(model.record));
  sum.add(model.options);
  return sum.finish();
}

std::string calc_checksum(const Checkpoint& checkpoint) {
  const LevenbergMarquardtState& state = checkpoint.state;
  Checksum sum;
  sum.add(state.weights);
  sum.add(state.best_weights);
  sum.add(state.scale);
  sum.add(std::vector<double>{state.damping, state.growth, state.validation, state.best_validation,
                              state.seconds});
  sum.add(std::vector<std::int64_t>{state.epoch, state.best_epoch, state.failures, state.trials,
                                    static_cast<std::int64_t>(state.stop)});
  sum.add(flatten(checkpoint.record));
  sum.add(checkpoint.started_with);
  return sum.finish();
}

void check_model(const fs::path& path, const Model& model) {
  const NetworkShape shape(model.sizes);
  if (model.weights.size() != shape.weight_count) {
    fail(path, "/weights: " + std::to_string(model.weights.size()) + "; the layers have " +
                   std::to_string(shape.weight_count));
  }
  if (model.inputs.size() != static_cast<std::size_t>(shape.inputs()) ||
      model.targets.size() != static_cast<std::size_t>(shape.outputs())) {
    fail(path, "/inputs, /targets: must have a column for each input and output of the network");
  }
  const bool finite = std::all_of(model.weights.begin(), model.weights.end(),
                                  [](double x) { return std::isfinite(x); });
  if (!finite) fail(path, "/weights: must be finite");
}

StopReason read_stop(const fs::path& path, const Hdf5Reader& file) {
  const std::int64_t number = file.read_integer_attribute("/", "stop");
  if (number < 0 || number > static_cast<std::int64_t>(StopReason::kNotFinite)) {
    fail(path, "stop: unknown");
  }
  return static_cast<StopReason>(number);
}

int read_int(const Hdf5Reader& file, const char* key) {
  return static_cast<int>(file.read_integer_attribute("/", key));
}

}  // namespace

void write_model(const fs::path& path, const Model& model) {
  Hdf5Writer file(path);
  const std::vector<std::int64_t> sizes = widen(model.sizes);
  file.write("/layer_sizes", std::span<const std::int64_t>(sizes),
             {"1", "inputs, hidden layers (tanh), outputs (linear)", {}});
  file.write("/weights", model.weights,
             {"1", "per layer W (outputs x inputs, by rows), then b; of normalized values", {}});
  write_columns(file, "/inputs", model.inputs, model.input_map);
  write_columns(file, "/targets", model.targets, model.target_map);
  write_record(file, model.record);
  write_facts(file, "/options", model.options);
  file.write_attribute("/", kKindKey, std::string(kModelKind));
  file.write_attribute("/", kSchemaVersionKey, kSchemaVersion);
  file.write_attribute("/", kPlanHashKey, model.plan_hash);
  file.write_attribute("/", "samples", model.samples);
  file.write_attribute("/", "usable_cases", model.usable);
  file.write_attribute("/", "skipped_cases", model.skipped);
  file.write_attribute("/", kSplitSeedKey, static_cast<std::int64_t>(model.split.seed));
  file.write_attribute("/", "split_train", model.split.train);
  file.write_attribute("/", "split_validate", model.split.validate);
  file.write_attribute("/", "stop", static_cast<std::int64_t>(model.stop));
  file.write_attribute("/", "stop_reason", std::string(get_name(model.stop)));
  file.write_attribute("/", "best_epoch", std::int64_t{model.best_epoch});
  file.write_attribute("/", "best_validation", model.best_validation);
  file.write_attribute("/", "seconds", model.seconds);
  file.write_attribute("/", kChecksumKey, calc_checksum(model));
  for (const auto& [name, text] : model.provenance) file.write_attribute("/", name, text);
  file.commit();
}

Model read_model(const fs::path& path) {
  const Hdf5Reader file(path);
  check_kind(path, file, kModelKind);
  Model model;
  for (const std::int64_t size : file.read_integers("/layer_sizes")) {
    model.sizes.push_back(static_cast<int>(size));
  }
  model.weights = file.read("/weights").values;
  read_columns(path, file, "/inputs", model.inputs, model.input_map);
  read_columns(path, file, "/targets", model.targets, model.target_map);
  model.record = read_record(path, file);
  model.options = read_facts(path, file, "/options");
  model.plan_hash = file.read_attribute("/", kPlanHashKey);
  model.samples = file.read_integer_attribute("/", "samples");
  model.usable = file.read_integer_attribute("/", "usable_cases");
  model.skipped = file.read_integer_attribute("/", "skipped_cases");
  model.split.seed = static_cast<std::uint64_t>(file.read_integer_attribute("/", kSplitSeedKey));
  model.split.train = file.read_number_attribute("/", "split_train");
  model.split.validate = file.read_number_attribute("/", "split_validate");
  model.stop = read_stop(path, file);
  model.best_epoch = read_int(file, "best_epoch");
  model.best_validation = file.read_number_attribute("/", "best_validation");
  model.seconds = file.read_number_attribute("/", "seconds");
  check_sum(path, file, calc_checksum(model));
  check_model(path, model);
  return model;
}

void write_checkpoint(const fs::path& path, const Checkpoint& checkpoint) {
  const LevenbergMarquardtState& state = checkpoint.state;
  Hdf5Writer file(path);
  file.write("/weights", state.weights, {"1", "at this epoch", {}});
  file.write("/best_weights", state.best_weights, {"1", "at the validation minimum", {}});
  file.write("/scale", state.scale, {"1", "what the damping multiplies", {}});
  write_record(file, checkpoint.record);
  write_facts(file, "/started_with", checkpoint.started_with);
  file.write_attribute("/", kKindKey, std::string(kCheckpointKind));
  file.write_attribute("/", kSchemaVersionKey, kSchemaVersion);
  file.write_attribute("/", "damping", state.damping);
  file.write_attribute("/", "growth", state.growth);
  file.write_attribute("/", "validation", state.validation);
  file.write_attribute("/", "best_validation", state.best_validation);
  file.write_attribute("/", "seconds", state.seconds);
  file.write_attribute("/", "epoch", std::int64_t{state.epoch});
  file.write_attribute("/", "best_epoch", std::int64_t{state.best_epoch});
  file.write_attribute("/", "failures", std::int64_t{state.failures});
  file.write_attribute("/", "trials", std::int64_t{state.trials});
  file.write_attribute("/", "stop", static_cast<std::int64_t>(state.stop));
  file.write_attribute("/", kChecksumKey, calc_checksum(checkpoint));
  file.commit();
}

Checkpoint read_checkpoint(const fs::path& path) {
  const Hdf5Reader file(path);
  check_kind(path, file, kCheckpointKind);
  Checkpoint checkpoint;
  LevenbergMarquardtState& state = checkpoint.state;
  state.weights = file.read("/weights").values;
  state.best_weights = file.read("/best_weights").values;
  state.scale = file.read("/scale").values;
  checkpoint.record = read_record(path, file);
  checkpoint.started_with = read_facts(path, file, "/started_with");
  state.damping = file.read_number_attribute("/", "damping");
  state.growth = file.read_number_attribute("/", "growth");
  state.validation = file.read_number_attribute("/", "validation");
  state.best_validation = file.read_number_attribute("/", "best_validation");
  state.seconds = file.read_number_attribute("/", "seconds");
  state.epoch = read_int(file, "epoch");
  state.best_epoch = read_int(file, "best_epoch");
  state.failures = read_int(file, "failures");
  state.trials = static_cast<long>(file.read_integer_attribute("/", "trials"));
  state.stop = read_stop(path, file);
  check_sum(path, file, calc_checksum(checkpoint));
  return checkpoint;
}

void require_same_start(const fs::path& path, const Checkpoint& checkpoint, const NamedTexts& now) {
  std::string differences;
  for (const auto& [name, value] : now) {
    const auto before =
        std::find_if(checkpoint.started_with.begin(), checkpoint.started_with.end(),
                     [&name = name](const auto& fact) { return fact.first == name; });
    const std::string was = before == checkpoint.started_with.end() ? "not there" : before->second;
    if (was != value) differences += "\n  " + name + ": was " + was + ", is " + value;
  }
  if (!differences.empty()) fail(path, "a checkpoint of another training:" + differences);
}

}  // namespace strut
