#include "train/train_network.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/store/shard_layout.h"
#include "train/model/interval.h"
#include "train/network/network.h"
#include "train/window/rows.h"

namespace strut {
namespace {

NetworkShape make_shape(const TrainingRows& data, const std::vector<int>& hidden) {
  std::vector<int> sizes = {static_cast<int>(data.inputs.size())};
  sizes.insert(sizes.end(), hidden.begin(), hidden.end());
  sizes.push_back(static_cast<int>(data.targets.size()));
  return NetworkShape(sizes);
}

void require_equations(const TrainingRows& data, const NetworkShape& shape) {
  const std::size_t rows = data.train.row_count(), outputs = data.targets.size();
  if (rows * outputs >= shape.weight_count) return;
  throw InputError(fmt::format(
      "{} training cases x {} parameters give {} equations for the network's {} weights: it would "
      "memorize the cases; use more cases or a smaller network, or insist with `strut train "
      "--allow-few`",
      rows, outputs, rows * outputs, shape.weight_count));
}

TrainingRows read_parts(Dataset& dataset, const TrainingRequest& request) {
  if (request.window) {
    return make_window_rows(dataset, request.rows, request.split, *request.window,
                            request.noise.value_or(NoiseModel{}), request.problem.threads,
                            request.store);
  }
  return split_rows(read_usable_rows(dataset, request.rows, request.store), request.split,
                    request.store, request.noise);
}

/// Lists the options of a window; the rest of its transform follows from the data.
NamedTexts describe_window(const WindowTransform& window) {
  const WindowGrid& grid = window.grid;
  return {{"window_channels", join_names(list_names(window.channels))},
          {"window_interval", format_number(grid.interval)},
          {"window_first_sample", std::to_string(grid.first)},
          {"window_samples", std::to_string(grid.samples)},
          {"window_lags", std::to_string(grid.lags)}};
}

/// Without a growing sample, the first sample holds all rows, which makes the training exact.
GrowingSampleOptions choose_sample(const TrainingRequest& request, const TrainingRows& data) {
  if (request.growing) return *request.growing;
  GrowingSampleOptions all;
  all.first_rows = data.train.row_count();
  return all;
}

std::string describe_sample(const std::optional<GrowingSampleOptions>& growing) {
  if (!growing) return "all rows";
  const std::string first =
      growing->first_rows > 0 ? std::to_string(growing->first_rows) : "2 a weight";
  return fmt::format("first {}, grows by {}", first, format_number(growing->growth));
}

void append(NamedTexts& texts, const NamedTexts& more) {
  texts.insert(texts.end(), more.begin(), more.end());
}

}  // namespace

NamedTexts describe_limits(const LevenbergMarquardtOptions& options) {
  return {{"epochs", std::to_string(options.epochs)},
          {"max_failures", std::to_string(options.max_failures)},
          {"goal", format_number(options.goal)},
          {"min_gradient", format_number(options.min_gradient)},
          {"max_damping", format_number(options.max_damping)}};
}

Training::Training(Dataset& dataset, const TrainingRequest& request)
    : request_(request),
      plan_hash_(dataset.plan_hash()),
      data_(read_parts(dataset, request)),
      shape_(make_shape(data_, request.hidden)) {
  if (!request.allow_few) require_equations(data_, shape_);
  train_source_ = std::make_unique<StoreSource>(data_.train, data_.input_map, data_.target_map);
  validate_source_ =
      std::make_unique<StoreSource>(data_.validate, data_.input_map, data_.target_map);
  problem_ = std::make_unique<NetworkProblem>(shape_, *train_source_, request.problem);
  validation_ = std::make_unique<NetworkProblem>(shape_, *validate_source_, request.problem);
  training_.emplace(*problem_, validation_.get(), request.options, choose_sample(request, data_));
  training_->start(make_nguyen_widrow_weights(shape_, {}, request.seed));
}

void Training::resume(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  require_same_start(path, checkpoint, describe_start());
  GrowingSampleState state = checkpoint.state;
  record_ = checkpoint.record;
  // The limit that stopped it may have changed.
  state.training.stop = StopReason::kNone;
  training_->restore(state);
}

bool Training::step() {
  const bool running = training_->step();
  const EpochRecord& last = training_->last_record();
  // An epoch at which the training stopped runs again after resuming and on a larger sample.
  if (!record_.empty() && record_.back().epoch == last.epoch) record_.pop_back();
  record_.push_back(last);
  return running;
}

TrainingSummary Training::summarize() const {
  const LevenbergMarquardtState& s = state();
  return {s.stop,       s.best_weights,    record_.empty() ? EpochRecord{} : record_.back(),
          s.best_epoch, s.best_validation, s.trials,
          s.seconds};
}

NamedTexts Training::describe_start() const {
  const LevenbergMarquardtOptions& options = request_.options;
  NamedTexts texts = {{"plan_hash", plan_hash_},
                      {"inputs", join_names(list_names(data_.inputs))},
                      {"parameters", join_names(list_names(data_.targets))},
                      {"usable_cases", std::to_string(data_.usable)},
                      {"layers", fmt::format("{}", fmt::join(shape_.sizes, ", "))},
                      {"seed", std::to_string(request_.seed)},
                      {"split_seed", std::to_string(request_.split.seed)},
                      {"split_train", format_number(request_.split.train)},
                      {"split_validate", format_number(request_.split.validate)},
                      {"rule", kDampingRules[static_cast<std::size_t>(options.rule)]},
                      {"accelerate", options.accelerate ? "yes" : "no"},
                      {"first_damping", format_number(options.first_damping)},
                      {"sample", describe_sample(request_.growing)},
                      {"gram_rows", std::to_string(request_.problem.gram_rows)},
                      {kInstructionSetKey, problem_->kernel().isa}};
  if (data_.noise) append(texts, describe_noise(*data_.noise, data_.inputs));
  if (data_.window) {
    append(texts, describe_window(*data_.window));
    append(texts, describe_noise(data_.window->noise, data_.window->channels));
  }
  return texts;
}

Checkpoint Training::make_checkpoint() const {
  return {describe_start(), training_->save(), record_};
}

TrainedModel Training::make_model() const {
  const LevenbergMarquardtState& s = state();
  TrainedModel model;
  model.sizes = shape_.sizes;
  model.weights = s.best_weights;
  model.inputs = data_.inputs;
  model.targets = data_.targets;
  model.input_map = data_.input_map;
  model.target_map = data_.target_map;
  model.noise = data_.noise;
  model.window = data_.window;
  model.ci95 = calc_ci95(model, data_.validate);
  model.plan_hash = plan_hash_;
  model.samples = request_.rows.samples;
  model.usable = data_.usable;
  model.skipped = data_.skipped;
  model.split = request_.split;
  model.options = describe_start();
  append(model.options, describe_limits(request_.options));
  model.record = record_;
  model.stop = s.stop;
  model.best_epoch = s.best_epoch;
  model.best_validation = s.best_validation;
  model.seconds = s.seconds;
  return model;
}

}  // namespace strut
