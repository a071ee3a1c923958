#include "study/trainings.h"

#include <iterator>

#include "sweep/folder.h"

namespace strut {
namespace {

/// Settings shared by the trainings of one seed.
TrainingRequest make_training_request(const StudyFolder& folder, const StudyRequest& request,
                                      int seed) {
  TrainingRequest made;
  made.split = request.split;
  made.seed = made.split.seed = static_cast<std::uint64_t>(seed);
  made.options = request.options;
  made.options.threads = 1;
  made.problem.threads = 1;
  made.store.scratch = folder.models();
  return made;
}

TableTraining make_training(const StudyFolder& folder, const StudyRequest& request,
                            const StudyCell& cell, int seed) {
  TableTraining training;
  training.name = make_model_name(request, cell, seed);
  training.data = folder.sweep(make_sweep_name(request, cell)).root;
  training.cases = request.samples[cell.samples];
  training.request = make_training_request(folder, request, seed);
  training.request.rows.inputs = request.inputs[cell.inputs].channels;
  training.request.hidden = request.networks[cell.network].hidden;
  return training;
}

NoiseSnapshots open_snapshots(const StudyFolder& folder, const StudyRequest& request,
                              std::size_t preload) {
  const StudyCell main{preload, request.main_samples, request.main_network, request.main_inputs};
  const SweepFolder sweep = folder.sweep(make_sweep_name(request, main));
  return {request.preloads[preload].name, open_sweep_folder(sweep).request(), sweep.root};
}

}  // namespace

NoiseStudyData open_noise_data(const StudyFolder& folder, const StudyRequest& request) {
  NoiseStudyData data;
  data.snapshots.reserve(request.preloads.size());
  for (std::size_t p = 0; p < request.preloads.size(); ++p) {
    data.snapshots.push_back(open_snapshots(folder, request, p));
  }
  data.inputs = request.inputs[request.main_inputs].channels;
  const SweepFolder windows = get_window_sweep(folder, request);
  data.window = open_sweep_folder(windows).request();
  data.window_data = windows.root;
  data.common = make_training_request(folder, request, 1);
  data.common.hidden = request.networks[request.noise->network].hidden;
  data.common.options.goal = 0.0;  // no goal is within reach of noisy data
  return data;
}

std::vector<TableTraining> list_study_trainings(const StudyFolder& folder,
                                                const StudyRequest& request) {
  std::vector<TableTraining> trainings;
  for (const StudyCell& cell : list_cells(request)) {
    for (int seed = 1; seed <= request.seeds; ++seed) {
      trainings.push_back(make_training(folder, request, cell, seed));
    }
  }
  if (!request.noise) return trainings;
  auto noisy = list_noise_trainings(*request.noise, open_noise_data(folder, request));
  trainings.insert(trainings.end(), std::make_move_iterator(noisy.begin()),
                   std::make_move_iterator(noisy.end()));
  return trainings;
}

}  // namespace strut
