#include "train/model/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/math/all_finite.h"
#include "io/format/hdf5.h"
#include "io/store/shard_layout.h"
#include "train/data/training_file.h"
#include "train/network/network.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

// Version 2 added /ci95.
constexpr TrainingFileKind kKind = {kModelSeal, 2};
constexpr char kSplitSeedKey[] = "split_seed";
constexpr char kIntervalName[] = "/ci95", kNoiseName[] = "/noise";

std::vector<std::int64_t> widen(const std::vector<int>& sizes) {
  return {sizes.begin(), sizes.end()};
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
  TwoRowTable table = read_two_rows(path, file, name);
  const bool finite = all_finite(table.first) && all_finite(table.second);
  columns = std::move(table.columns);
  map = Normalizer(std::move(table.first), std::move(table.second));
  if (!finite || map.find_constant() < columns.size()) {
    fail_file(path, name + ": bounds must be finite and differ");
  }
}

std::string calc_checksum(const TrainedModel& model) {
  Checksum sum;
  sum.add(widen(model.sizes));
  sum.add(model.weights);
  sum.add(model.inputs);
  sum.add(model.targets);
  for (const Normalizer* map : {&model.input_map, &model.target_map}) {
    sum.add(map->low());
    sum.add(map->high());
  }
  sum.add(model.ci95);
  sum.add(model.plan_hash);
  sum.add(std::vector<std::int64_t>{model.samples, model.usable, model.skipped,
                                    static_cast<std::int64_t>(model.split.seed), model.best_epoch,
                                    static_cast<std::int64_t>(model.stop)});
  sum.add(std::vector<double>{model.split.train, model.split.validate, model.best_validation,
                              model.seconds});
  sum.add(model.record);
  sum.add(model.options);
  if (model.noise) add_noise(sum, *model.noise);
  if (model.window) add_window(sum, *model.window);
  return sum.finish();
}

/// Reads the noise of `inputs`.
NoiseModel read_input_noise(const fs::path& path, const Hdf5Reader& file,
                            const std::vector<ColumnInfo>& inputs) {
  std::vector<ColumnInfo> columns;
  NoiseModel noise = read_noise(path, file, kNoiseName, columns);
  if (columns != inputs) {
    fail_file(path, fmt::format("{}: its columns must be those of the inputs", kNoiseName));
  }
  return noise;
}

void check_model(const fs::path& path, const TrainedModel& model) {
  const NetworkShape shape(model.sizes);
  if (model.weights.size() != shape.weight_count) {
    fail_file(path, fmt::format("/weights: {}; the layers have {}", model.weights.size(),
                                shape.weight_count));
  }
  if (model.inputs.size() != static_cast<std::size_t>(shape.inputs()) ||
      model.targets.size() != static_cast<std::size_t>(shape.outputs())) {
    fail_file(path,
              "/inputs, /targets: must have a column for each input and output of the network");
  }
  if (model.window && model.window->components() != model.inputs.size()) {
    fail_file(path, fmt::format("{}: must have a direction for each input", kWindowGroup));
  }
  const bool widths =
      std::all_of(model.ci95.begin(), model.ci95.end(), [](double width) { return width >= 0.0; });
  if (model.ci95.size() != model.targets.size() || !widths) {
    fail_file(path,
              fmt::format("{}: must have a width for each target, none below 0", kIntervalName));
  }
  if (!all_finite(model.weights)) fail_file(path, "/weights: must be finite");
}

}  // namespace

void write_trained_model(const fs::path& path, const TrainedModel& model) {
  Hdf5Writer file(path, {.seal = SealLabel{kKind.seal}});
  const std::vector<std::int64_t> sizes = widen(model.sizes);
  file.write("/layer_sizes", std::span<const std::int64_t>(sizes),
             {"1", "inputs, hidden layers (tanh), outputs (linear)", {}});
  file.write("/weights", model.weights,
             {"1", "per layer W (outputs x inputs, by rows), then b; of normalized values", {}});
  write_columns(file, "/inputs", model.inputs, model.input_map);
  write_columns(file, "/targets", model.targets, model.target_map);
  file.write(kIntervalName, model.ci95,
             {"as the target's",
              "half width of the 95 % interval of each target, from the validation part",
              {}});
  write_record(file, model.record);
  write_named_texts(file, "/options", model.options, {"name of an option", "its value"});
  if (model.noise) write_noise(file, kNoiseName, *model.noise, model.inputs);
  if (model.window) write_window(file, *model.window);
  write_kind(file, kKind);
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

TrainedModel read_trained_model(const fs::path& path) {
  const Hdf5Reader file(path, kKind.seal);
  check_kind(path, file, kKind);
  TrainedModel model;
  for (const std::int64_t size : file.read_integers("/layer_sizes")) {
    model.sizes.push_back(to_int(path, "/layer_sizes", static_cast<double>(size)));
  }
  model.weights = file.read("/weights").values;
  read_columns(path, file, "/inputs", model.inputs, model.input_map);
  read_columns(path, file, "/targets", model.targets, model.target_map);
  model.ci95 = file.read(kIntervalName).values;
  model.record = read_record(path, file);
  model.options = read_named_texts(path, file, "/options");
  model.plan_hash = file.read_attribute("/", kPlanHashKey);
  model.samples = file.read_integer_attribute("/", "samples");
  model.usable = file.read_integer_attribute("/", "usable_cases");
  model.skipped = file.read_integer_attribute("/", "skipped_cases");
  model.split.seed = static_cast<std::uint64_t>(file.read_integer_attribute("/", kSplitSeedKey));
  model.split.train = file.read_number_attribute("/", "split_train");
  model.split.validate = file.read_number_attribute("/", "split_validate");
  model.stop = read_stop(path, file);
  model.best_epoch = read_int(path, file, "best_epoch");
  model.best_validation = file.read_number_attribute("/", "best_validation");
  model.seconds = file.read_number_attribute("/", "seconds");
  if (file.has(kNoiseName)) model.noise = read_input_noise(path, file, model.inputs);
  if (file.has(kWindowGroup)) model.window = read_window(path, file);
  check_sum(path, file, calc_checksum(model));
  check_model(path, model);
  return model;
}

}  // namespace strut
