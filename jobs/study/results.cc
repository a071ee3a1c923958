#include "jobs/study/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>

#include "jobs/cli/unsealed.h"
#include "jobs/study/trainings.h"
#include "report/html.h"
#include "sweep/folder.h"
#include "train/model/evaluate.h"

namespace strut {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

SeedResult read_seed(const StudyFolder& folder, const std::string& name, Dataset& dataset,
                     CellResult& cell) {
  const std::filesystem::path file = folder.model(name);
  const TrainedModel model = load_model(file);
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

/// A number, and where it is.
struct Placed {
  double value = 0.0;
  std::string at;
};

struct Numbers {
  std::vector<Placed> ratios, gaps;  // ours / published; 1 - R2
};

void add_numbers(const StudyRequest& request, const CellResult& cell, Numbers& numbers) {
  for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
    const std::string at = cell.key + " " + cell.parameters[p].name;
    for (std::size_t m = 0; m < kR2; ++m) {
      const double published = find_published(request, cell, p, m);
      if (std::isnan(published)) continue;
      numbers.ratios.push_back({cell.spread[p][m].median / published, at + " " + kMetrics[m].name});
    }
    numbers.gaps.push_back({1.0 - cell.spread[p][kR2].median, at});
  }
}

Spread calc_spread_of(const std::vector<Placed>& numbers) {
  std::vector<double> values;
  values.reserve(numbers.size());
  for (const Placed& number : numbers) values.push_back(number.value);
  return calc_spread(std::move(values));
}

const std::string& find_largest(const std::vector<Placed>& numbers) {
  return std::max_element(numbers.begin(), numbers.end(),
                          [](const Placed& a, const Placed& b) { return a.value < b.value; })
      ->at;
}

std::size_t count_held(const std::vector<Placed>& numbers, double aim) {
  return static_cast<std::size_t>(std::count_if(
      numbers.begin(), numbers.end(), [aim](const Placed& number) { return number.value <= aim; }));
}

StudySummary summarize_preload(const StudyRequest& request, const StudyResults& results,
                               std::size_t preload) {
  Numbers numbers;
  for (const CellResult& cell : results.cells) {
    if (cell.cell.preload == preload && !cell.cell.best_instant) {
      add_numbers(request, cell, numbers);
    }
  }
  StudySummary summary;
  summary.preload = request.preloads[preload].name;
  summary.gaps = numbers.gaps.size();
  summary.gaps_held = count_held(numbers.gaps, kAimedR2Gap);
  const Spread gaps = calc_spread_of(numbers.gaps);
  summary.median_gap = gaps.median;
  summary.smallest_gap = gaps.low;
  summary.largest_gap = gaps.high;
  summary.largest_gap_at = find_largest(numbers.gaps);
  if (numbers.ratios.empty()) return summary;
  summary.errors = numbers.ratios.size();
  summary.errors_held = count_held(numbers.ratios, kAimedRatio);
  const Spread ratios = calc_spread_of(numbers.ratios);
  summary.median_ratio = ratios.median;
  summary.smallest_ratio = ratios.low;
  summary.largest_ratio = ratios.high;
  summary.largest_at = find_largest(numbers.ratios);
  return summary;
}

}  // namespace

Spread calc_spread(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("calc_spread: no values");
  // A sort needs an order, which NaN has not.
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

std::vector<StudySummary> summarize(const StudyRequest& request, const StudyResults& results) {
  std::vector<StudySummary> summaries;
  summaries.reserve(request.preloads.size());
  for (std::size_t p = 0; p < request.preloads.size(); ++p) {
    summaries.push_back(summarize_preload(request, results, p));
  }
  return summaries;
}

std::string make_line(const StudySummary& s) {
  const auto round = [](double value) { return print_number("%.2g", value); };
  std::string line = s.preload + ": ";
  if (s.errors > 0) {
    line += std::to_string(s.errors_held) + " of " + std::to_string(s.errors) +
            " errors at most a tenth of the published ones (ratio " + round(s.smallest_ratio) +
            " at best, " + round(s.median_ratio) + " in the median, " + round(s.largest_ratio) +
            " at worst: " + s.largest_at + "); ";
  }
  return line + std::to_string(s.gaps_held) + " of " + std::to_string(s.gaps) +
         " with 1 - R2 at most 1e-4 (worst " + round(s.largest_gap) + ": " + s.largest_gap_at + ")";
}

}  // namespace strut
