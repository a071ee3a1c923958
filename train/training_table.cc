#include "train/training_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

std::string describe_difference(const std::string& name, const std::string& is,
                                const std::string& wanted) {
  return fmt::format("{} = {}, not {}", name, is, wanted);
}

/// The first of the `wanted` texts that differs in `options`; empty if none does.
std::string compare_texts(const NamedTexts& options, const NamedTexts& wanted) {
  for (const auto& [name, text] : wanted) {
    const std::string is = find_text(options, name).value_or("unknown");
    if (is != text) return describe_difference(name, is, text);
  }
  return "";
}

std::string compare_data(const TrainedModel& model, const Training& training,
                         const TrainingRequest& request) {
  if (model.sizes != training.shape().sizes) return "another network";
  if (model.samples != request.rows.samples) {
    return describe_difference("samples", std::to_string(model.samples),
                               std::to_string(request.rows.samples));
  }
  if (model.inputs != training.data().inputs || model.targets != training.data().targets) {
    return "other inputs or parameters";
  }
  return "";
}

/// The data that the threads of a table share.
struct TableState {
  const TrainingTableOptions& options;
  TrainingTableProgress& progress;
  std::atomic<bool>& halt;
  std::mutex files;                // held while reading or writing: HDF5 is not thread-safe
  std::vector<std::string> notes;  // guarded by `files`

  fs::path find_file(const TableTraining& t) const { return options.folder / (t.name + ".h5"); }
};

void add(std::atomic<double>& sum, double value) {
  double was = sum;
  while (!sum.compare_exchange_weak(was, was + value)) continue;
}

/// The trainings, longest first.
std::vector<const TableTraining*> sort_by_work(const std::vector<TableTraining>& trainings) {
  std::vector<std::pair<double, const TableTraining*>> work;
  work.reserve(trainings.size());
  for (const TableTraining& t : trainings) work.emplace_back(estimate_epoch_work(t), &t);
  std::stable_sort(work.begin(), work.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const TableTraining*> sorted;
  sorted.reserve(work.size());
  for (const auto& [estimate, training] : work) sorted.push_back(training);
  return sorted;
}

std::unique_ptr<Training> make_training(const TableTraining& t) {
  try {
    Dataset dataset({t.data}, {.histories = t.request.window.has_value()});
    return std::make_unique<Training>(dataset, t.request);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", t.name, e.what()));
  }
}

/// Returns null if the folder already has the model.
std::unique_ptr<Training> start_training(const TableTraining& t, TableState& state) {
  const std::scoped_lock lock(state.files);
  std::unique_ptr<Training> training = make_training(t);
  const fs::path file = state.find_file(t);
  if (!fs::exists(file)) return training;
  std::string difference;
  try {
    difference = find_difference(read_trained_model(file), *training, t.request);
  } catch (const InputError& e) {
    difference = e.what();
  }
  if (difference.empty()) return nullptr;
  state.notes.push_back(
      fmt::format("{}: trained anew, the model was different: {}", file.string(), difference));
  return training;
}

/// Makes the model of one training, unless it exists or the table is halted.
void run_training(const TableTraining& t, TableState& state) {
  const double work = estimate_epoch_work(t);
  const std::unique_ptr<Training> training = start_training(t, state);
  if (training == nullptr) {
    add(state.progress.work, -work);
    ++state.progress.kept;
    return;
  }
  bool running = true;
  while (running && !state.halt) running = training->step();
  if (running) return;
  TrainedModel model = training->make_model();
  model.provenance = state.options.provenance;
  {
    const std::scoped_lock lock(state.files);
    write_trained_model(state.find_file(t), model);
  }
  add(state.progress.work_done, work);
  ++state.progress.trained;
}

}  // namespace

double estimate_epoch_work(const TableTraining& training) {
  const TrainingRequest& request = training.request;
  double weights = 0.0, inputs = static_cast<double>(request.rows.inputs.size());
  for (const int size : request.hidden) {
    weights += (inputs + 1.0) * size;
    inputs = size;
  }
  // H of every row, then its factorization.
  return static_cast<double>(training.cases) * weights * weights +
         weights * weights * weights / 3.0;
}

std::string find_difference(const TrainedModel& model, const Training& training,
                            const TrainingRequest& request) {
  // The limits decide at which epoch a training ends, and with it the weights.
  for (const NamedTexts& wanted :
       {training.make_checkpoint().started_with, describe_limits(request.options)}) {
    std::string difference = compare_texts(model.options, wanted);
    if (!difference.empty()) return difference;
  }
  return compare_data(model, training, request);
}

TrainingTableSummary run_training_table(const std::vector<TableTraining>& trainings,
                                        const TrainingTableOptions& options,
                                        TrainingTableProgress& progress, std::atomic<bool>& halt) {
  progress.total = trainings.size();
  for (const TableTraining& t : trainings) add(progress.work, estimate_epoch_work(t));
  const std::vector<const TableTraining*> sorted = sort_by_work(trainings);
  TableState state{options, progress, halt, {}, {}};
  std::atomic<std::size_t> next{0};
  run_team(options.threads, halt, [&] {
    for (std::size_t i = next++; i < sorted.size() && !halt; i = next++) {
      run_training(*sorted[i], state);
    }
  });
  return {halt, progress.trained, progress.kept, std::move(state.notes)};
}

}  // namespace strut
