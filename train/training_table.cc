#include "train/training_table.h"

#include <algorithm>
#include <mutex>
#include <numeric>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

const std::string* find_text(const NamedTexts& texts, const std::string& name) {
  const auto found = std::find_if(texts.begin(), texts.end(),
                                  [&](const auto& fact) { return fact.first == name; });
  return found == texts.end() ? nullptr : &found->second;
}

std::string describe_difference(const std::string& name, const std::string& is,
                                const std::string& wanted) {
  return name + " = " + is + ", not " + wanted;
}

std::string compare_text(const NamedTexts& options, const std::string& name,
                         const std::string& wanted) {
  const std::string* is = find_text(options, name);
  if (is != nullptr && *is == wanted) return "";
  return describe_difference(name, is == nullptr ? "unknown" : *is, wanted);
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

/// What the threads of a table share. Files are read and written by one thread at a time, as the
/// HDF5 library asks.
class TrainingTable {
 public:
  TrainingTable(const std::vector<TableTraining>& trainings, const TrainingTableOptions& options,
                TrainingTableProgress& progress, std::atomic<bool>& halt)
      : trainings_(trainings), options_(options), progress_(progress), halt_(halt) {
    order_.resize(trainings.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::vector<double> work;
    work.reserve(trainings.size());
    for (const TableTraining& t : trainings) work.push_back(estimate_epoch_work(t));
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
    progress_.total = trainings.size();
    for (const double w : work) add(progress_.work, w);
  }

  TrainingTableSummary run() {
    run_team(options_.threads, halt_, [this] {
      for (std::size_t i = next_++; i < order_.size() && !halt_; i = next_++) {
        work_on(trainings_[order_[i]]);
      }
    });
    summary_.stopped = halt_;
    summary_.trained = progress_.trained;
    summary_.kept = progress_.kept;
    return summary_;
  }

 private:
  static void add(std::atomic<double>& sum, double value) {
    double was = sum;
    while (!sum.compare_exchange_weak(was, was + value)) continue;
  }

  fs::path find_file(const TableTraining& t) const { return options_.folder / (t.name + ".h5"); }

  void work_on(const TableTraining& t) {
    const double work = estimate_epoch_work(t);
    std::unique_ptr<Training> training = begin(t);
    if (training == nullptr) {
      add(progress_.work, -work);
      ++progress_.kept;
      return;
    }
    bool goes_on = true;
    while (goes_on && !halt_) goes_on = training->step();
    if (goes_on) return;
    TrainedModel model = training->make_model();
    model.provenance = options_.provenance;
    {
      const std::scoped_lock lock(files_);
      write_trained_model(find_file(t), model);
    }
    add(progress_.work_done, work);
    ++progress_.trained;
  }

  static std::unique_ptr<Training> make_training(const TableTraining& t) {
    try {
      Dataset dataset({t.data}, {.histories = t.request.window.has_value()});
      return std::make_unique<Training>(dataset, t.request);
    } catch (const InputError& e) {
      throw InputError(t.name + ": " + e.what());
    }
  }

  /// Null where the model is there already.
  std::unique_ptr<Training> begin(const TableTraining& t) {
    const std::scoped_lock lock(files_);
    std::unique_ptr<Training> training = make_training(t);
    const fs::path file = find_file(t);
    if (!fs::exists(file)) return training;
    std::string difference;
    try {
      difference = find_difference(read_trained_model(file), *training, t.request);
    } catch (const InputError& e) {
      difference = e.what();
    }
    if (difference.empty()) return nullptr;
    summary_.notes.push_back(file.string() + ": trained anew, it was another: " + difference);
    return training;
  }

  const std::vector<TableTraining>& trainings_;
  const TrainingTableOptions& options_;
  TrainingTableProgress& progress_;
  std::atomic<bool>& halt_;
  std::vector<std::size_t> order_;
  std::atomic<std::size_t> next_{0};
  std::mutex files_;
  TrainingTableSummary summary_;
};

}  // namespace

double estimate_epoch_work(const TableTraining& training) {
  const TrainingRequest& request = training.request;
  double weights = 0.0, inputs = static_cast<double>(request.rows.inputs.size());
  for (const int size : request.hidden) {
    weights += (inputs + 1.0) * size;
    inputs = size;
  }
  // Curvature of every row, then the factorization.
  return static_cast<double>(training.cases) * weights * weights +
         weights * weights * weights / 3.0;
}

std::string find_difference(const TrainedModel& model, const Training& training,
                            const TrainingRequest& request) {
  for (const auto& [name, wanted] : training.make_checkpoint().started_with) {
    std::string difference = compare_text(model.options, name, wanted);
    if (!difference.empty()) return difference;
  }
  // Limits decide where a training ends, and with it which weights are kept.
  const LevenbergMarquardtOptions& o = request.options;
  const std::pair<const char*, std::string> limits[] = {
      {"epochs", std::to_string(o.epochs)},
      {"max_failures", std::to_string(o.max_failures)},
      {"goal", format_number(o.goal)},
      {"min_gradient", format_number(o.min_gradient)},
      {"max_damping", format_number(o.max_damping)}};
  for (const auto& [name, wanted] : limits) {
    std::string difference = compare_text(model.options, name, wanted);
    if (!difference.empty()) return difference;
  }
  return compare_data(model, training, request);
}

TrainingTableSummary run_training_table(const std::vector<TableTraining>& trainings,
                                        const TrainingTableOptions& options,
                                        TrainingTableProgress& progress, std::atomic<bool>& halt) {
  return TrainingTable(trainings, options, progress, halt).run();
}

}  // namespace strut
