// Trainings side by side.
#include "train/training_table.h"

#include <atomic>
#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_sweep.h"

namespace strut {
namespace {

using test::TemporaryFolder;
namespace fs = std::filesystem;

std::vector<TableTraining> make_trainings(const fs::path& data) {
  std::vector<TableTraining> trainings;
  for (std::uint64_t i = 0; i < 6; ++i) {
    TableTraining t;
    t.name = "t" + std::to_string(i);
    t.data = data;
    t.cases = 27;
    t.request.rows.inputs = {"body_position_z", "pitch_rate"};
    t.request.hidden = {2 + static_cast<int>(i % 3)};
    t.request.seed = t.request.split.seed = 1 + i;
    t.request.options.epochs = 5;
    trainings.push_back(t);
  }
  return trainings;
}

TrainingTableSummary run_table(const std::vector<TableTraining>& trainings, const fs::path& folder,
                               int threads, bool halted = false) {
  fs::create_directories(folder);
  TrainingTableProgress progress;
  std::atomic<bool> halt{halted};
  return run_training_table(trainings, {folder, threads, {}}, progress, halt);
}

TEST_CASE("Trainings side by side give what each gives alone", "[io][property]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  const auto trainings = make_trainings(sweep.folder().root);
  CHECK(run_table(trainings, folder / "one", 1).trained == 6);
  CHECK(run_table(trainings, folder / "three", 3).trained == 6);
  for (const TableTraining& t : trainings) {
    const TrainedModel one = read_trained_model(folder / "one" / (t.name + ".h5"));
    Dataset dataset({t.data});
    Training alone(dataset, t.request);
    while (alone.step()) continue;
    CHECK(read_trained_model(folder / "three" / (t.name + ".h5")).weights == one.weights);
    CHECK(one.weights == alone.make_model().weights);
  }
}

TEST_CASE("A table of trainings keeps what is the same and nothing else", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  auto trainings = make_trainings(sweep.folder().root);
  const fs::path models = folder / "models";
  run_table(trainings, models, 2);
  CHECK(run_table(trainings, models, 2).kept == 6);
  trainings[0].request.options.epochs = 6;
  trainings[1].request.options.goal = 1e-3;
  trainings[2].request.rows.samples = 20;
  trainings[3].request.split.train = 0.6;
  trainings[4].request.rows.inputs = {"body_position_z", "body_acceleration_z"};
  const TrainingTableSummary summary = run_table(trainings, models, 2);
  CHECK(summary.trained == 5);
  CHECK(summary.kept == 1);
  CHECK(summary.notes.size() == 5);
  CHECK(run_table(trainings, models, 2).kept == 6);
}

TEST_CASE("A table names the training that cannot be", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  auto trainings = make_trainings(sweep.folder().root);
  trainings[4].request.hidden = {50};
  CHECK_THROWS_WITH(run_table(trainings, folder / "models", 1), Catch::StartsWith("t4: "));
}

TEST_CASE("A table of trainings that is halted writes nothing half", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  const TrainingTableSummary summary =
      run_table(make_trainings(sweep.folder().root), folder / "models", 2, true);
  CHECK(summary.stopped);
  CHECK(summary.trained == 0);
  CHECK(fs::is_empty(folder / "models"));
}

}  // namespace
}  // namespace strut
