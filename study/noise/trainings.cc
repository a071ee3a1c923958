#include "study/noise/trainings.h"

#include <fmt/format.h>

#include "base/text/format_number.h"
#include "sweep/plan.h"

namespace strut {
namespace {

std::string make_name(const std::string& kind, double scale) {
  return fmt::format("noise_{}_{}", kind, format_number(scale));
}

void set_noise(const NoiseModel& noise, const SweepRequest& sweep, TableTraining& training) {
  training.request.noise = noise;
  training.request.noise->seed = training.request.seed;
  training.cases = Plan(sweep).case_count() * noise.copies;
}

}  // namespace

std::string make_snapshot_name(const NoiseSnapshots& snapshots, double scale) {
  return make_name(snapshots.preload, scale);
}

std::string make_window_name(double scale) { return make_name("window", scale); }

TableTraining make_snapshot_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                     const NoiseSnapshots& snapshots, double scale) {
  TableTraining training;
  training.name = make_snapshot_name(snapshots, scale);
  training.data = snapshots.data;
  training.request = data.common;
  training.request.rows.inputs = data.inputs;
  training.request.rows.targets = list_axes(snapshots.sweep);
  set_noise(make_snapshot_noise(request, data.inputs, scale), snapshots.sweep, training);
  return training;
}

TableTraining make_window_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                   double scale) {
  TableTraining training;
  training.name = make_window_name(scale);
  training.data = data.window_data;
  training.request = data.common;
  training.request.rows.inputs = list_history_channels(data.window);
  training.request.rows.targets = list_axes(data.snapshots.front().sweep);
  training.request.window = request.window;
  set_noise(make_window_noise(request, training.request.rows.inputs, scale), data.window, training);
  return training;
}

std::vector<TableTraining> list_noise_trainings(const NoiseStudyRequest& request,
                                                const NoiseStudyData& data) {
  std::vector<TableTraining> trainings;
  trainings.reserve((data.snapshots.size() + 1) * request.scales.size());
  for (const double scale : request.scales) {
    for (const NoiseSnapshots& snapshots : data.snapshots) {
      trainings.push_back(make_snapshot_training(request, data, snapshots, scale));
    }
    trainings.push_back(make_window_training(request, data, scale));
  }
  return trainings;
}

}  // namespace strut
