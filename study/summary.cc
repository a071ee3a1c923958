#include "study/summary.h"

#include <algorithm>
#include <cmath>

namespace strut {
namespace {

/// A number and the cell, parameter and metric that it belongs to.
struct NamedNumber {
  double value = 0.0;
  std::string name;
};

struct Numbers {
  std::vector<NamedNumber> ratios;  // ours / published
  std::vector<NamedNumber> gaps;    // 1 - R2
};

void add_numbers(const StudyRequest& request, const CellResult& cell, Numbers& numbers) {
  for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
    const std::string name = cell.key + " " + cell.parameters[p].name;
    for (std::size_t m = 0; m < kR2; ++m) {
      const double published = find_published(request, cell, p, m);
      if (std::isnan(published)) continue;
      numbers.ratios.push_back(
          {cell.spread[p][m].median / published, name + " " + kMetrics[m].name});
    }
    numbers.gaps.push_back({1.0 - cell.spread[p][kR2].median, name});
  }
}

Spread calc_spread_of(const std::vector<NamedNumber>& numbers) {
  std::vector<double> values;
  values.reserve(numbers.size());
  for (const NamedNumber& number : numbers) values.push_back(number.value);
  return calc_spread(std::move(values));
}

const std::string& find_largest_name(const std::vector<NamedNumber>& numbers) {
  return std::max_element(
             numbers.begin(), numbers.end(),
             [](const NamedNumber& a, const NamedNumber& b) { return a.value < b.value; })
      ->name;
}

std::size_t count_within(const std::vector<NamedNumber>& numbers, double aim) {
  return static_cast<std::size_t>(
      std::count_if(numbers.begin(), numbers.end(),
                    [aim](const NamedNumber& number) { return number.value <= aim; }));
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
  summary.gaps_held = count_within(numbers.gaps, kAimedR2Gap);
  const Spread gaps = calc_spread_of(numbers.gaps);
  summary.median_gap = gaps.median;
  summary.smallest_gap = gaps.low;
  summary.largest_gap = gaps.high;
  summary.largest_gap_at = find_largest_name(numbers.gaps);
  if (numbers.ratios.empty()) return summary;
  summary.errors = numbers.ratios.size();
  summary.errors_held = count_within(numbers.ratios, kAimedRatio);
  const Spread ratios = calc_spread_of(numbers.ratios);
  summary.median_ratio = ratios.median;
  summary.smallest_ratio = ratios.low;
  summary.largest_ratio = ratios.high;
  summary.largest_at = find_largest_name(numbers.ratios);
  return summary;
}

}  // namespace

std::vector<StudySummary> summarize(const StudyRequest& request, const StudyResults& results) {
  std::vector<StudySummary> summaries;
  summaries.reserve(request.preloads.size());
  for (std::size_t p = 0; p < request.preloads.size(); ++p) {
    summaries.push_back(summarize_preload(request, results, p));
  }
  return summaries;
}

}  // namespace strut
