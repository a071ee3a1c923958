#include "jobs/report/histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math/spread.h"
#include "io/store/dataset.h"
#include "jobs/cli/progress.h"
#include "report/chart.h"

namespace strut {
namespace {

constexpr std::size_t kMaxCases = 1000;
/// Points of all curves together, for a page that can be mailed.
constexpr std::size_t kMaxPoints = 30000;

/// Values of the cases at some samples of the histories.
struct Histories {
  std::vector<std::size_t> samples;
  std::vector<std::vector<std::vector<double>>> values;  // by channel, sample and case
  std::size_t cases = 0;
};

void add_row(const ShardSchema& schema, const ShardRows& rows, std::size_t row, Histories& h) {
  ++h.cases;
  for (std::size_t c = 0; c < schema.history.size(); ++c) {
    const double* history = rows.history[c].data() + row * schema.history_samples;
    for (std::size_t i = 0; i < h.samples.size(); ++i) {
      const double value = history[h.samples[i]];
      if (std::isfinite(value)) h.values[c][i].push_back(value);
    }
  }
}

Histories read_histories(Dataset& dataset) {
  const ShardSchema& schema = dataset.schema();
  Histories h;
  const std::size_t max_samples =
      std::max<std::size_t>(200, kMaxPoints / (3 * schema.history.size()));
  const std::size_t stride = (schema.history_samples + max_samples - 1) / max_samples;
  for (std::size_t i = 0; i < schema.history_samples; i += stride) h.samples.push_back(i);
  h.values.assign(schema.history.size(), std::vector<std::vector<double>>(h.samples.size()));
  // From shards all over the sweep: where an axis needs a new mechanism, neighbors are alike.
  const std::size_t pieces = dataset.piece_count();
  const std::size_t per_piece = std::max<std::size_t>(1, dataset.row_count() / pieces);
  const std::size_t wanted = std::min(pieces, (kMaxCases + per_piece - 1) / per_piece);
  for (std::size_t k = 0; k < wanted; ++k) {
    const ShardRows& rows = dataset.read_piece(k * pieces / wanted);
    for (std::size_t row = 0; row < rows.size() && h.cases < kMaxCases; ++row) {
      if (rows.status[row] == 0) add_row(schema, rows, row, h);
    }
  }
  return h;
}

ChartPanel make_panel(const ShardSchema& schema, Histories& h, std::size_t channel) {
  ChartSeries band{"5 to 95 %", SeriesKind::kBand, 6}, median{"median", SeriesKind::kLine, 1};
  for (std::size_t i = 0; i < h.samples.size(); ++i) {
    std::vector<double>& values = h.values[channel][i];
    if (values.empty()) continue;
    median.x.push_back(static_cast<double>(h.samples[i]) * schema.history_interval);
    median.y.push_back(calc_quantile(values, 0.5));
    band.low.push_back(calc_quantile(values, 0.05));
    band.high.push_back(calc_quantile(values, 0.95));
  }
  band.x = median.x;
  const ColumnInfo& c = schema.history[channel];
  return {{"time [s]"}, {make_label(c.name, c.unit)}, {band, median}};
}

}  // namespace

ReportSection make_history_section(const SweepFolder& folder, const FigureDrawer& drawer) {
  Dataset dataset({folder.root}, {.partial = true, .histories = true});
  const ShardSchema& schema = dataset.schema();
  Histories h = read_histories(dataset);
  ReportSection section{"Histories", {}};
  section.paragraphs = {fmt::format("{} channels, {} samples each, one every {:.6g} s.",
                                    schema.history.size(), schema.history_samples,
                                    schema.history_interval)};
  if (h.cases == 0) {
    section.paragraphs.emplace_back("No finished case has one.");
    return section;
  }
  Chart chart{"histories", {}, 2};
  chart.caption =
      fmt::format("The channels over time, of {}: median, and the band of 5 to 95 % of them{}.",
                  format_count(static_cast<std::int64_t>(h.cases), "finished case"),
                  h.samples.size() < schema.history_samples
                      ? fmt::format("; {} of {} instants, so peaks may be cut", h.samples.size(),
                                    schema.history_samples)
                      : "");
  for (std::size_t c = 0; c < schema.history.size(); ++c) {
    chart.panels.push_back(make_panel(schema, h, c));
  }
  section.figures.push_back(drawer.draw(chart));
  return section;
}

}  // namespace strut
