#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

#include "io/file/atomic_file.h"
#include "io/store/heartbeat.h"
#include "io/store/journal.h"
#include "sweep/folder.h"
#include "sweep/merge.h"
#include "sweep/shard_store.h"
#include "tests/fuzz/format.h"
#include "tests/support/mat_bytes.h"
#include "train/model/checkpoint.h"
#include "train/model/model_file.h"
#include "train/network/network.h"

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr char kSweep[] = R"(
vehicle = "../vehicles/paper_sedan.toml"
maneuver = "../maneuvers/bump_20mps.toml"
[grid]
front_stiffness = { from = 40000, to = 35500, count = 4 }
rear_damping = { from = 1980, to = 1800, count = 3 }
[sample]
strata = 2
count = 10
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["pitch_angle", "pitch_rate"] }
history = { rate = 10, channels = ["pitch_rate"] }
[shards]
cases = 5
)";

/// Makes rows like those of a run; readers do not depend on the numbers.
ShardRows make_rows(const Plan& plan, const ShardSchema& schema, std::int64_t shard) {
  const auto [first, last] = plan.shard_range(shard);
  ShardRows rows = ShardRows::make(schema, static_cast<std::size_t>(last - first));
  const std::size_t axes = schema.parameters.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.case_id[i] = plan.calc_case_id(first + static_cast<std::int64_t>(i));
    rows.layer[i] = plan.calc_stratum(rows.case_id[i]);
    plan.calc_parameters(rows.case_id[i], std::span(rows.parameters).subspan(i * axes, axes));
    rows.event_time[i] = 0.5;
  }
  const auto fill = [](std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i));
  };
  fill(rows.snapshot);
  for (std::vector<double>& channel : rows.history) fill(channel);
  rows.status.back() = 1;
  rows.failure_time.back() = 0.25;
  rows.reason.back() = "diverged";
  return rows;
}

SweepFolder make_sweep(const fs::path& work) {
  const fs::path request = work / "sweeps/small.toml";
  write_text_file(request, kSweep);
  const Plan plan(read_request(request));
  SweepFolder folder = make_sweep_folder(work / "sweep", plan);
  const ShardSchema schema = plan.make_schema();
  for (std::int64_t shard = 0; shard < plan.shard_count(); ++shard) {
    const ShardRows rows = make_rows(plan, schema, shard);
    const fs::path file = folder.shard(shard);
    const auto image = make_shard_image(compress_shard(schema, rows), {plan.hash(), shard, {}});
    write_text_file(file, {reinterpret_cast<const char*>(image.data()), image.size()});
    append_journal(Folder(folder.root), "journal", make_journal_entry(folder, file, rows));
  }
  merge_sweep(folder, {plan.make_extent(), schema}, work / "merged.h5", {},
              [](std::int64_t) { return true; });
  return folder;
}

TrainedModel make_model() {
  TrainedModel model;
  model.sizes = {2, 3, 1};
  model.weights = make_nguyen_widrow_weights(NetworkShape(model.sizes), {}, 1);
  model.inputs = {{"pitch_angle", "rad", "angle"}, {"pitch_rate", "rad/s", "rate"}};
  model.targets = {{"front_stiffness", "N/m", "rate"}};
  model.input_map = Normalizer({0.1, 0.5}, {0.2, 0.75});
  model.target_map = Normalizer({35500.0}, {40000.0});
  model.ci95 = {12.5};
  model.plan_hash = std::string(64, 'a');
  model.samples = 2000;
  model.usable = 1990;
  model.split = {0.6, 0.2, 77};
  model.options = {{"rule", "trainlm"}, {"epochs", "12"}};
  model.record = {{0, 1.0, 2.0, 3.0, 4.0}, {1, 0.1, 0.2, 0.3, 0.4}};
  model.stop = StopReason::kValidation;
  model.best_epoch = 1;
  return model;
}

void write_networks(const fs::path& work) {
  TrainedModel model = make_model();
  write_trained_model(work / "model.h5", model);

  model.noise = NoiseModel{.sigma = {1e-3, 2e-3}, .bias = {0.0, 1e-2}, .copies = 2, .seed = 5};
  write_trained_model(work / "noisy.h5", model);

  model.noise.reset();
  model.inputs = {{"component_1", "1", "direction"}, {"component_2", "1", "direction"}};
  WindowTransform window;
  window.channels = {{"pitch_rate", "rad/s", "rate"}};
  window.noise = NoiseModel{.sigma = {1e-3}, .bias = {1e-2}, .hit_time = 5e-3, .copies = 2};
  window.grid = {.interval = 0.1, .first = 3, .samples = 4, .lags = 1};
  window.mean = {0.1, 0.2, 0.3, 0.4};
  window.reference = window.mean;
  window.basis = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  model.window = window;
  write_trained_model(work / "window.h5", model);

  Checkpoint checkpoint;
  checkpoint.started_with = {{"seed", "1"}, {"layers", "4, 27, 4"}};
  checkpoint.state.rows = 5;
  LevenbergMarquardtState& state = checkpoint.state.training;
  state.weights = state.best_weights = model.weights;
  state.scale.assign(model.weights.size(), 1.0);
  state.epoch = 7;
  checkpoint.record = model.record;
  write_checkpoint(work / "checkpoint.h5", checkpoint);
}

/// Files as the programs of data loggers write them.
void write_recordings(const fs::path& work) {
  const fs::path folder = work / "recordings";
  fs::create_directory(folder);
  write_text_file(
      folder / "labview.seed",
      "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\nChannels\t2\t\t\n"
      "Samples\t3\t3\nY_Unit_Label\tVolts\tVolts\nX0\t0.0\t0.0\nDelta_X\t0.001\t0.001\n"
      "***End_of_Header***\t\t\nX_Value\tUntitled\tUntitled 1\tComment\n0.000\t1.5\t-2\t\n"
      "0.001\t1.6\t-3\n0.002\t1.7\t-4\n");
  write_text_file(
      folder / "vbox.seed",
      "File created on 03/05/2026 at 13:45\n\n[header]\nsatellites\ntime\nvelocity kmh\n\n"
      "[column names]\nsats time velocity\n\n[data]\n007 134559.90 050.00\n"
      "007 134600.00 050.10\n007 134600.10 050.20\n");
  write_text_file(folder / "aim.seed",
                  "\"Format\",\"AiM CSV File\"\n\"Time\",\"Damper\",\"Acc\"\n\"s\",\"mm\",\"g\"\n\n"
                  "\"1\",\"2\",\"3\"\n\"0.000\",\"1.5\",\"0.9\"\n\"0.010\",\"1.6\",\"1.0\"\n");
  write_text_file(folder / "european.seed",
                  "Datum;Uhrzeit;Weg [mm];Kraft (kN)\n01.02.2026;23:59:59,98;1,5;-0,25\n"
                  "01.02.2026;23:59:59,99;1,6;-0,26\n02.02.2026;00:00:00,00;;n/a\n");
  const std::vector<double> values = {0.0, 0.5, 1.0, 1.5};
  write_text_file(
      folder / "mat.seed",
      test::make_mat_file(
          test::make_mat_array("t", 4, 1, values) + test::make_mat_array("xy", 2, 2, values) +
          test::make_mat_struct("run", "force", test::make_mat_array("", 1, 4, values)) +
          test::make_mat_struct_array("runs", 1, 8,
                                      std::string("a\0\0\0\0\0\0\0b\0\0\0\0\0\0\0", 16)) +
          test::pack_mat_element(test::make_mat_array("packed", 2, 2, values))));
}

/// Copies a file that will be overwritten, as a seed.
void keep(const fs::path& file) { fs::copy_file(file, file.string() + ".seed"); }

}  // namespace

void make_work_folder(const fs::path& work) {
  fs::copy(STRUT_SOURCE_DIR "/examples", work, fs::copy_options::recursive);
  const SweepFolder sweep = make_sweep(work);
  keep(sweep.plan());
  keep(sweep.journal());
  write_networks(work);
  write_recordings(work);

  const std::string runner = "host.1.ab";
  write_text_file(sweep.root / "claim.seed", runner + "\n");
  write_text_file(sweep.root / "runner.seed",
                  write_runner_text({"host", "boot", "pid:[1]", "1", "2"}, 7, 3));
  fs::copy_file(sweep.root / "claim.seed", sweep.claims() / "000001");
  fs::copy_file(sweep.root / "runner.seed", sweep.claims() / ("runner." + runner));

  const fs::path earlier = STRUT_SOURCE_DIR "/tests/data/d0caeb7";
  fs::copy(earlier / "half_done/jobs", sweep.root / "jobs", fs::copy_options::recursive);
  keep(sweep.root / "jobs/001/submission.toml");
  keep(sweep.root / "jobs/001/array-0/0");
  keep(sweep.root / "jobs/001/array-0.job");
  write_text_file(sweep.root / "jobs/001/over", "0 0 TIMEOUT\n0 1 CANCELLED\n");
  keep(sweep.root / "jobs/001/over");
  fs::copy(earlier / "comparison", work / "report", fs::copy_options::recursive);
  keep(work / "report/report.json");
}

std::vector<Format> list_formats() {
  std::vector<Format> all;
  for (const auto& formats :
       {list_text_formats(), list_hdf5_formats(), list_sweep_formats(), list_command_formats()}) {
    all.insert(all.end(), formats.begin(), formats.end());
  }
  return all;
}

}  // namespace strut::fuzz
