#include "train/model/checkpoint.h"

#include <fmt/format.h>

#include "io/format/hdf5.h"
#include "io/store/shard_layout.h"
#include "train/data/training_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr TrainingFileKind kKind = {kCheckpointSeal, 2};

std::string calc_checksum(const Checkpoint& checkpoint) {
  const LevenbergMarquardtState& state = checkpoint.state.training;
  Checksum sum;
  sum.add(state.weights);
  sum.add(state.best_weights);
  sum.add(state.scale);
  sum.add(std::vector<double>{state.damping, state.growth, state.validation, state.best_validation,
                              state.seconds});
  sum.add(std::vector<std::int64_t>{state.epoch, state.best_epoch, state.failures, state.trials,
                                    static_cast<std::int64_t>(state.stop),
                                    static_cast<std::int64_t>(checkpoint.state.rows)});
  sum.add(checkpoint.record);
  sum.add(checkpoint.started_with);
  return sum.finish();
}

}  // namespace

void write_checkpoint(const fs::path& path, const Checkpoint& checkpoint) {
  const LevenbergMarquardtState& state = checkpoint.state.training;
  Hdf5Writer file(path, {.seal = SealLabel{kKind.seal}});
  file.write("/weights", state.weights, {"1", "at this epoch", {}});
  file.write("/best_weights", state.best_weights, {"1", "at the validation minimum", {}});
  file.write("/scale", state.scale, {"1", "what the damping multiplies", {}});
  write_record(file, checkpoint.record);
  write_named_texts(file, "/started_with", checkpoint.started_with,
                    {"name of an option", "its value"});
  write_kind(file, kKind);
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
  file.write_attribute("/", "rows", static_cast<std::int64_t>(checkpoint.state.rows));
  file.write_attribute("/", kChecksumKey, calc_checksum(checkpoint));
  file.commit();
}

Checkpoint read_checkpoint(const fs::path& path) {
  const Hdf5Reader file(path, kKind.seal);
  check_kind(path, file, kKind);
  Checkpoint checkpoint;
  LevenbergMarquardtState& state = checkpoint.state.training;
  state.weights = file.read("/weights").values;
  state.best_weights = file.read("/best_weights").values;
  state.scale = file.read("/scale").values;
  checkpoint.record = read_record(path, file);
  checkpoint.started_with = read_named_texts(path, file, "/started_with");
  state.damping = file.read_number_attribute("/", "damping");
  state.growth = file.read_number_attribute("/", "growth");
  state.validation = file.read_number_attribute("/", "validation");
  state.best_validation = file.read_number_attribute("/", "best_validation");
  state.seconds = file.read_number_attribute("/", "seconds");
  state.epoch = read_int(path, file, "epoch");
  state.best_epoch = read_int(path, file, "best_epoch");
  state.failures = read_int(path, file, "failures");
  state.trials = static_cast<long>(file.read_integer_attribute("/", "trials"));
  state.stop = read_stop(path, file);
  checkpoint.state.rows = static_cast<std::size_t>(file.read_integer_attribute("/", "rows"));
  check_sum(path, file, calc_checksum(checkpoint));
  return checkpoint;
}

void require_same_start(const fs::path& path, const Checkpoint& checkpoint, const NamedTexts& now) {
  std::string differences;
  for (const auto& [name, value] : now) {
    const std::string was = find_text(checkpoint.started_with, name).value_or("absent");
    if (was != value) differences += fmt::format("\n  {}: was {}, is {}", name, was, value);
  }
  if (!differences.empty()) fail_file(path, "a checkpoint of a different training:" + differences);
}

}  // namespace strut
