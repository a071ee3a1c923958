#include "jobs/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iostream>
#include <limits>
#include <mutex>

#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "base/text/range.h"
#include "io/file/file_seal.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/provenance.h"
#include "jobs/cli/unsealed.h"
#include "jobs/evaluate.h"
#include "jobs/train/train_noise.h"
#include "train/train_network.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxInt = std::numeric_limits<int>::max();
constexpr std::int64_t kMaxInt64 = std::numeric_limits<std::int64_t>::max();
constexpr int kCheckpointEpochs = 25;  // between two checkpoints

std::vector<int> read_hidden(const Arguments& arguments) {
  const std::string text = arguments.text("hidden");
  std::vector<int> sizes;
  for (const std::string& part : split_list(text)) {
    const auto size = parse_number<int>(part);
    if (!size || *size < 1 || *size > NetworkShape::kLargestSize) {
      throw InputError(fmt::format("--hidden = {}: must be whole numbers in [1, {}], as 27,19,11",
                                   text, int{NetworkShape::kLargestSize}));
    }
    sizes.push_back(*size);
  }
  return sizes;
}

void read_limits(const Arguments& arguments, LevenbergMarquardtOptions& options) {
  options.rule = static_cast<DampingRule>(arguments.choice_or("rule", 0));
  options.epochs = static_cast<int>(arguments.integer_or("epochs", options.epochs, 0, kMaxInt));
  options.max_failures =
      static_cast<int>(arguments.integer_or("max-failures", options.max_failures, 1, kMaxInt));
  options.goal = arguments.number_or("goal", options.goal, at_least(0.0));
  options.min_gradient = arguments.number_or("min-gradient", options.min_gradient, at_least(0.0));
  options.first_damping = arguments.number_or("damping", options.first_damping, above(0.0));
  options.max_damping = arguments.number_or("max-damping", options.max_damping, above(0.0));
  options.seconds = arguments.number_or("max-time", options.seconds, above(0.0, "s"));
  options.threads = find_threads(arguments);
}

/// Throws InputError with what to give instead if the data lack one of the inputs by default.
void check_inputs(const Arguments& arguments, const ShardSchema& schema,
                  const TrainingRequest& request) {
  if (arguments.has("inputs") || arguments.has("window")) return;
  std::vector<std::string> names;
  for (const ColumnInfo& channel : schema.snapshot) names.push_back(channel.name);
  for (const std::string& input : request.rows.inputs) {
    if (std::find(names.begin(), names.end(), input) != names.end()) continue;
    const std::string advice = names.empty()
                                   ? "there are no snapshots: --window FROM:TO trains on histories"
                                   : "choose with --inputs among " + join_names(names);
    throw InputError(
        fmt::format("the snapshots lack '{}', an input by default; {}", input, advice));
  }
}

TrainingRequest read_request(const Arguments& arguments, const fs::path& output) {
  TrainingRequest request;
  request.rows.inputs = {"body_position_z", "body_velocity_z", "body_acceleration_z",
                         "pitch_angle"};
  if (arguments.has("inputs")) request.rows.inputs = split_list(arguments.text("inputs"));
  if (arguments.has("targets")) request.rows.targets = split_list(arguments.text("targets"));
  if (arguments.has("hidden")) request.hidden = read_hidden(arguments);
  request.rows.samples = arguments.integer_or("samples", 0, 1, kMaxInt64);
  request.seed = static_cast<std::uint64_t>(arguments.integer_or("seed", 1, 0, kMaxInt64));
  request.split.seed = request.seed;
  request.allow_few = arguments.is_on("allow-few");
  read_limits(arguments, request.options);
  if (arguments.is_on("growing")) request.growing = GrowingSampleOptions{};
  request.problem.threads = request.options.threads;
  request.problem.batch_rows =
      static_cast<std::size_t>(arguments.integer_or("batch", 4096, 1, 10'000'000));
  request.problem.gram_rows =
      static_cast<std::size_t>(arguments.integer_or("gram-rows", 0, 1, kMaxInt64));
  // The folder of the model is on a disk; the system's folder for temporary files may be in memory.
  request.store.scratch = fs::absolute(output).parent_path();
  return request;
}

/// The file of the training's state; empty without --checkpoint. An existing file is replaced only
/// with --resume, which continues from it, or with --force. Throws InputError where it is one of
/// `data`, or the model.
fs::path find_checkpoint(const Arguments& arguments, const std::vector<fs::path>& data,
                         const fs::path& output) {
  if (!arguments.has("checkpoint")) {
    if (arguments.is_on("resume")) throw arguments.usage_error("--resume needs --checkpoint FILE");
    return {};
  }
  fs::path checkpoint = arguments.text("checkpoint");
  if (fs::weakly_canonical(checkpoint) == fs::weakly_canonical(output)) {
    throw InputError(fmt::format(
        "--checkpoint = {}: is the model of --output; must be another file", checkpoint.string()));
  }
  check_output_file("checkpoint", checkpoint, data,
                    arguments.is_on("resume") || arguments.is_on("force"),
                    "--resume continues from it, --force replaces it", kCheckpointSeal.name);
  return checkpoint;
}

/// The progress of a training, shared with the thread that prints it.
class Progress {
 public:
  explicit Progress(const LevenbergMarquardtOptions& options) : options_(options) {}
  void set(const EpochRecord& record, std::size_t rows) {
    const std::scoped_lock lock(mutex_);
    if (rows_ == 0) first_ = record.epoch;
    record_ = record;
    rows_ = rows;
  }
  std::string line() const {
    const std::scoped_lock lock(mutex_);
    if (rows_ == 0) return fmt::format("first epoch, {}", format_duration(now() - start_));
    return fmt::format(
        "epoch {} of at most {}, loss {:.3g}, validation {:.3g}, lambda {:.1g}, {} rows, at most "
        "{} "
        "to go",
        record_.epoch, options_.epochs, record_.loss, record_.validation, record_.damping,
        format_count(static_cast<std::int64_t>(rows_)), format_duration(calc_seconds_left()));
  }

 private:
  /// Time to the last epoch or to the time limit, whichever comes first.
  double calc_seconds_left() const {
    const double spent = now() - start_;
    const double done = record_.epoch - first_ + 1, left = options_.epochs - record_.epoch;
    return std::max(0.0, std::min(left * spent / done, options_.seconds - spent));
  }

  const LevenbergMarquardtOptions options_;
  const double start_ = now();
  mutable std::mutex mutex_;
  int first_ = 0;  // first epoch of this run: not 1 after a resume
  EpochRecord record_;
  std::size_t rows_ = 0;
};

/// Trains until the training stops; false where a signal came first.
bool train(Training& training, const LevenbergMarquardtOptions& options, const fs::path& checkpoint,
           const std::atomic<bool>& halt) {
  const auto keep = [&] {
    if (!checkpoint.empty()) write_checkpoint(checkpoint, training.make_checkpoint());
  };
  keep();  // reports a file that cannot be written before the work, not after it
  Progress progress(options);
  bool running = true;
  {
    const ProgressLine line([&] { return progress.line(); });
    while (running && !halt) {
      running = training.step();
      progress.set(training.record().back(), training.rows());
      if (training.state().epoch % kCheckpointEpochs == 0) keep();
    }
  }
  keep();
  return !running;
}

/// Noisy copies of each case; 1 where there is no noise.
int count_copies(const TrainingRows& data) {
  if (data.window) return data.window->noise.copies;
  return data.noise ? data.noise->copies : 1;
}

void print(const Training& training, const TrainedModel& model, const fs::path& output,
           bool as_json) {
  const ModelEvaluation test = evaluate_rows(model, training.data().test);
  const TrainingRows& data = training.data();
  const TrainingSummary summary = training.summarize();
  const int copies = count_copies(data);
  const auto count_cases = [copies](const RowStore& rows) {
    return static_cast<std::int64_t>(rows.row_count()) / copies;
  };
  if (as_json) {
    Json json = make_json(model, test);
    json["file"] = output.string();
    json["stopped_by"] = get_name(summary.reason);
    json["epochs"] = summary.last.epoch;
    json["best_epoch"] = summary.best_epoch;
    json["best_validation"] = summary.best_validation;
    json["training_cases"] = count_cases(data.train);
    json["copies"] = copies;
    json["skipped_cases"] = data.skipped;
    json["weights"] = model.weights.size();
    json["seconds"] = summary.seconds;
    std::cout << format_json(json) << "\n";
    return;
  }
  std::cout << fmt::format(
      "{} cases trained, {} validated, {} tested{}; {} failed ones left out; {} weights\n{}\n\n"
      "errors of the test cases\n",
      format_count(count_cases(data.train)), format_count(count_cases(data.validate)),
      format_count(count_cases(data.test)),
      copies > 1 ? fmt::format(", each with {} draws of noise", copies) : "",
      format_count(data.skipped), model.weights.size(), summary.make_line());
  print_table(model, test);
  std::cout << "\n" << output.string() << "\n";
}

std::string describe(const TrainingRequest& request) {
  return fmt::format("layers {}, inputs {}, seed {}, {} threads", fmt::join(request.hidden, " "),
                     fmt::join(request.rows.inputs, " "), request.seed, request.options.threads);
}

void report_interruption(const Arguments& arguments, const fs::path& checkpoint) {
  if (checkpoint.empty()) {
    print_error("interrupted; no model is written");
    suggest_again(arguments, "keeps the state of the training",
                  {"--checkpoint", "training.checkpoint"});
    return;
  }
  print_error("interrupted; no model is written, --resume continues from the checkpoint");
  const bool resumes = arguments.is_on("resume");
  suggest_again(arguments, "continues",
                resumes ? std::vector<std::string>() : std::vector<std::string>{"--resume"});
}

}  // namespace

Arguments describe_train() {
  Arguments arguments(
      "strut train DATA... -o model.h5 [OPTIONS]",
      "Trains a network that identifies the parameters of a case from its snapshot, or from a\n"
      "window of its histories, by Levenberg-Marquardt, and tests it on held-out cases.\n"
      "DATA is a sweep folder, shards of one sweep, or a merged file. 70 % of the cases train,\n"
      "15 % validate, 15 % test. The result does not depend on --threads or --batch, nor on how\n"
      "the cases are stored.",
      "  strut run cars\n  strut train cars -o model.h5\n"
      "  strut train cars -o noisy.h5 --noise default --noise pitch_angle=2e-4\n"
      "  strut train cars -o window.h5 --window 0.3:2.5 --targets front_stiffness,rear_stiffness\n"
      "  strut train cars -o small.h5 --samples 1000 --hidden 12,8 --seed 3");
  arguments.add_operands(ArgumentValue::path("DATA", {"h5", "hdf5"}));
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"h5"}), "model to write");
  arguments.add_option("hidden", "N,N,...", "neurons of the hidden layers; default 27,19,11");
  arguments.add_option("inputs", "NAME,...",
                       "channels of the snapshot; default body_position_z,body_velocity_z,\n"
                       "body_acceleration_z,pitch_angle");
  arguments.add_option("targets", "NAME,...", "parameters to identify; default all of the grid's");
  add_noise_options(arguments);
  arguments.add_option("samples", "N", "use the first N cases; the run order is random");
  arguments.add_option("batch", "N", "rows in memory at a time; default 4096");
  arguments.add_switch("growing",
                       "start on few cases and add more, finally all, whenever the decrease of the "
                       "loss is within chance: for more than about 10,000 cases");
  arguments.add_option("gram-rows", "N",
                       "curvature from N rows, different ones in each epoch, gradient from all:\n"
                       "for more than 100,000 cases");
  arguments.add_option("seed", "S", "seed of the split and of the start weights; default 1");
  arguments.add_option("rule", ArgumentValue::one_of(kDampingRules),
                       "damping rule: gain-ratio (default), or MATLAB's trainlm");
  arguments.add_option("epochs", "N", "max epochs; default 1000");
  arguments.add_option("max-failures", "N",
                       "stop N epochs after the validation minimum; default 6");
  arguments.add_option("goal", "MSE", "stop at this loss of normalized values; default 0");
  arguments.add_option("min-gradient", "G", "stop at this length of its gradient; default 1e-7");
  arguments.add_option("damping", "MU", "first damping; default: the rule's, docs/training.md");
  arguments.add_option("max-damping", "MU", "stop beyond this damping; default 1e10");
  arguments.add_option("max-time", "S", "stop after S seconds; default: never");
  arguments.add_option("threads", "N", "number of threads; default: all processors");
  arguments.add_option("checkpoint", ArgumentValue::file("FILE"),
                       "file that keeps the state of the training");
  arguments.add_switch("resume", "continue from that file; the result is the same bit for bit");
  arguments.add_switch("allow-few", "train with fewer equations than weights");
  arguments.add_switch("partial", "accept a sweep folder with missing shards");
  arguments.add_switch("force", "replace FILE where it exists");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_train(const Arguments& arguments) {
  const auto& names = arguments.positional();
  if (names.empty())
    throw arguments.usage_error("DATA: missing; name a sweep folder, shards or a merged file");
  const fs::path output = find_output_file(arguments, names, kModelSeal.name);
  refuse_source("output", output);
  const fs::path checkpoint = find_checkpoint(arguments, {names.begin(), names.end()}, output);
  TrainingRequest request = read_request(arguments, output);
  DatasetOptions options;
  options.partial = arguments.is_on("partial");
  options.histories = arguments.has("window");
  InterruptWatcher watcher;
  Dataset dataset({names.begin(), names.end()}, options);
  note_unsealed_data(names);
  read_noise_options(arguments, dataset.schema(), request);
  check_inputs(arguments, dataset.schema(), request);
  Training training = [&] {
    const Stage reading("reading");
    const ProgressLine line("reading cases");
    return Training(dataset, request);
  }();
  if (arguments.is_on("resume")) {
    training.resume(checkpoint, read_checkpoint(checkpoint));
    note_unsealed(checkpoint, kCheckpointSeal);
  }
  print_detail(describe(request));
  if (!train(training, request.options, checkpoint, watcher.halt())) {
    report_interruption(arguments, checkpoint);
    return 128 + watcher.signal();
  }
  TrainedModel model = training.make_model();
  model.provenance = make_provenance();
  write_trained_model(output, model);
  print(training, model, output, arguments.is_on("json"));
  suggest_next_identify(output.string(), model);
  return kExitDone;
}

}  // namespace strut
