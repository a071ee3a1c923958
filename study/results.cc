#include "study/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include "study/trainings.h"
#include "sweep/folder.h"
#include "train/model/evaluate.h"

namespace strut {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

SeedResult read_seed(const StudyFolder& folder, const std::string& name, Dataset& dataset,
                     CellResult& cell) {
  const std::filesystem::path file = folder.model(name);
  const TrainedModel model = read_trained_model(file);
  const ModelEvaluation test = evaluate_model(model, dataset, EvaluatedPart::kTest);
  cell.parameters = model.targets;
  SeedResult seed;
  seed.model = file.lexically_relative(folder.root).generic_string();
  seed.metrics = test.metrics;
  seed.tested = test.samples;
  seed.epochs = model.record.empty() ? 0 : model.record.back().epoch;
  seed.stop = model.stop;
  seed.best_validation = model.best_validation;
  seed.seconds = model.seconds;
  return seed;
}

CellResult read_cell(const StudyFolder& folder, const StudyRequest& request, const StudyCell& cell,
                     Dataset& dataset) {
  CellResult result;
  result.cell = cell;
  result.key = make_key(request, cell);
  result.sweep = make_sweep_name(request, cell);
  for (int seed = 1; seed <= request.seeds; ++seed) {
    result.seeds.push_back(
        read_seed(folder, make_model_name(request, cell, seed), dataset, result));
    result.seeds.back().seed = seed;
  }
  for (std::size_t p = 0; p < result.parameters.size(); ++p) {
    std::array<Spread, kMetrics.size()> spreads;
    for (std::size_t m = 0; m < kMetrics.size(); ++m) {
      std::vector<double> values;
      values.reserve(result.seeds.size());
      for (const SeedResult& seed : result.seeds) {
        values.push_back(seed.metrics[p].*kMetrics[m].value);
      }
      spreads[m] = calc_spread(std::move(values));
    }
    result.spread.push_back(spreads);
  }
  return result;
}

std::int64_t count_failed(Dataset& dataset) {
  std::int64_t failed = 0;
  for (std::size_t piece = 0; piece < dataset.piece_count(); ++piece) {
    const auto& status = dataset.read_piece(piece).status;
    failed += std::count_if(status.begin(), status.end(), [](int s) { return s != 0; });
  }
  return failed;
}

SweepFacts read_sweep_facts(const SweepFolder& folder, Dataset& dataset) {
  const Plan plan = open_sweep_folder(folder);
  return {folder.root.filename().string(), plan.hash(), plan.case_count(), count_failed(dataset),
          plan.request().snapshot.offset};
}

}  // namespace

Spread calc_spread(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("calc_spread: no values");
  // NaN has no place in a sorted order.
  if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) {
    return {kNaN, kNaN, kNaN};
  }
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

StudyResults read_results(const StudyFolder& folder, const StudyRequest& request) {
  StudyResults results;
  std::map<std::string, std::unique_ptr<Dataset>> datasets;
  std::map<std::string, double> offsets;
  for (const auto& [name, cell] : list_study_sweeps(request)) {
    const SweepFolder sweep = folder.sweep(name);
    auto dataset = std::make_unique<Dataset>(std::vector<std::filesystem::path>{sweep.root});
    results.sweeps.push_back(read_sweep_facts(sweep, *dataset));
    offsets[name] = results.sweeps.back().offset;
    datasets[name] = std::move(dataset);
  }
  const std::vector<StudyCell> cells = list_cells(request);
  results.cells.reserve(cells.size());
  for (const StudyCell& cell : cells) {
    const std::string sweep = make_sweep_name(request, cell);
    results.cells.push_back(read_cell(folder, request, cell, *datasets.at(sweep)));
    results.cells.back().offset = offsets.at(sweep);
  }
  if (request.noise) {
    const SweepFolder windows = get_window_sweep(folder, request);
    Dataset dataset({windows.root});
    results.sweeps.push_back(read_sweep_facts(windows, dataset));
    results.noise = read_noise_study(*request.noise, open_noise_data(folder, request),
                                     folder.models(), folder.noise());
  }
  return results;
}

const CellResult& find_main_cell(const StudyRequest& request, const StudyResults& results,
                                 std::size_t preload) {
  return *std::find_if(results.cells.begin(), results.cells.end(), [&](const CellResult& cell) {
    return cell.cell.preload == preload && is_main(request, cell.cell);
  });
}

double find_published(const StudyRequest& request, const CellResult& cell, std::size_t parameter,
                      std::size_t metric) {
  if (cell.cell.best_instant) return kNaN;
  const auto found = request.published.cells.find(cell.key);
  if (found == request.published.cells.end()) return kNaN;
  const auto& parameters = found->second.parameters;
  const auto values = parameters.find(cell.parameters[parameter].name);
  if (values == parameters.end()) return kNaN;
  const auto value = values->second.find(kMetrics[metric].name);
  return value == values->second.end() ? kNaN : value->second;
}

std::string get_unit(const ColumnInfo& parameter, std::size_t metric) {
  if (metric == kR2) return "1";
  return metric == kMape ? "%" : parameter.unit;
}

}  // namespace strut
