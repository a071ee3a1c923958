#include "jobs/report/coverage.h"

#include <algorithm>
#include <cmath>

namespace strut {
namespace {

constexpr std::int64_t kMaxLevels = 20, kBins = 10;

CaseCount make_strata(const Plan& plan) {
  CaseCount count{"stratum by " + make_words(plan.request().sample.by), {}, {}, {}};
  for (std::size_t stratum = 0; stratum < plan.strata().size(); ++stratum) {
    count.centers.push_back(static_cast<double>(stratum + 1));
  }
  return count;
}

/// Number of bins: one for each level of a grid with few levels; a fixed number otherwise.
std::int64_t count_bins(const SweepRequest& request, const Axis& axis) {
  const bool has_levels = request.sample.method == SampleMethod::kGrid && axis.count <= kMaxLevels;
  return has_levels ? axis.count : kBins;
}

double calc_bin_width(const SweepRequest& request, const Axis& axis) {
  const std::int64_t bins = count_bins(request, axis);
  return bins == axis.count ? axis.step : (axis.last() - axis.from) / static_cast<double>(bins);
}

/// Center of the first bin.
double calc_first(const SweepRequest& request, const Axis& axis) {
  if (count_bins(request, axis) == axis.count) return axis.from;
  return axis.from + 0.5 * calc_bin_width(request, axis);
}

CaseCount make_bins(const SweepRequest& request, const Axis& axis, const std::string& unit) {
  CaseCount count{make_label(axis.name, unit), {}, {}, {}};
  for (std::int64_t bin = 0; bin < count_bins(request, axis); ++bin) {
    count.centers.push_back(calc_first(request, axis) +
                            static_cast<double>(bin) * calc_bin_width(request, axis));
  }
  return count;
}

std::size_t find_bin(const SweepRequest& request, const Axis& axis, double value) {
  const double width = calc_bin_width(request, axis);
  const double position = width == 0.0 ? 0.0 : (value - calc_first(request, axis)) / width;
  const auto last = static_cast<double>(count_bins(request, axis) - 1);
  return static_cast<std::size_t>(std::clamp(std::round(position), 0.0, last));
}

void add_case(CaseCount& count, std::size_t bin, bool has_failed) {
  if (bin >= count.centers.size()) return;
  count.simulated[bin] += 1.0;
  if (has_failed) count.failed[bin] += 1.0;
}

}  // namespace

std::vector<CaseCount> count_cases(Dataset& dataset, const Plan& plan) {
  const SweepRequest& request = plan.request();
  const std::vector<Axis>& axes = request.grid.axes();
  const std::vector<ColumnInfo>& columns = dataset.schema().parameters;
  std::vector<CaseCount> counts = {make_strata(plan)};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    counts.push_back(make_bins(request, axes[a], columns[a].unit));
  }
  for (CaseCount& count : counts) {
    count.simulated.assign(count.centers.size(), 0.0);
    count.failed.assign(count.centers.size(), 0.0);
  }
  for (std::size_t piece = 0; piece < dataset.piece_count(); ++piece) {
    const ShardRows& rows = dataset.read_piece(piece);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool has_failed = rows.status[i] != 0;
      add_case(counts[0], static_cast<std::size_t>(rows.layer[i]), has_failed);
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const double value = rows.parameters[i * columns.size() + a];
        add_case(counts[a + 1], find_bin(request, axes[a], value), has_failed);
      }
    }
  }
  return counts;
}

Chart make_coverage_chart(const std::vector<CaseCount>& counts) {
  Chart chart{"coverage", {}, 2};
  chart.panel_height = 260;
  chart.caption =
      "Cases simulated so far by stratum and by each parameter of the grid, and how many of them "
      "failed.";
  const auto has_failed = [](const CaseCount& count) {
    return std::any_of(count.failed.begin(), count.failed.end(), [](double n) { return n > 0.0; });
  };
  const bool is_any = std::any_of(counts.begin(), counts.end(), has_failed);
  for (const CaseCount& count : counts) {
    // One bar of all cases: the table of the progress has their number.
    const bool is_only = chart.panels.empty() && &count == &counts.back();
    if (count.centers.size() < 2 && !is_only) continue;
    ChartPanel panel{{count.label}, {"cases"}, {}};
    panel.series.push_back({"simulated", SeriesKind::kBars, 6, count.centers, count.simulated});
    if (is_any) {
      panel.series.push_back({"failed", SeriesKind::kBars, 2, count.centers, count.failed});
    }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

}  // namespace strut
