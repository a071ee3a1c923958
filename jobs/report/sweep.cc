#include "jobs/report/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math/random.h"
#include "io/file/atomic_file.h"
#include "io/file/folder.h"
#include "io/store/dataset.h"
#include "jobs/cli/failures.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/unsealed.h"
#include "jobs/report/coverage.h"
#include "jobs/report/histories.h"
#include "jobs/report/sensitivities.h"
#include "report/figures.h"
#include "report/html.h"
#include "sweep/folder.h"
#include "sweep/status.h"

namespace strut {
namespace {

constexpr std::size_t kBins = 10;
/// Maximum number of cases in a figure; larger sweeps are sampled.
constexpr std::size_t kMaxCases = 200000;

/// Finished cases with a snapshot, by rows: parameters, then snapshot.
struct Cases {
  std::vector<ColumnInfo> parameters, channels;
  std::vector<std::vector<double>> rows;
  std::size_t step = 1;  // about one case of `step` is included
};

/// Picks about one number of `step`, at random but reproducibly: every n-th point of a Sobol
/// sequence or of a grid would leave out parts of the space.
bool is_picked(std::size_t number, std::size_t step) {
  return calc_uniform(0, 0, number) * static_cast<double>(step) < 1.0;
}

Cases read_cases(Dataset& dataset) {
  const ShardSchema& schema = dataset.schema();
  Cases cases{schema.parameters, schema.snapshot, {}, 1};
  cases.step = (dataset.row_count() + kMaxCases - 1) / kMaxCases;
  const std::size_t p = schema.parameters.size(), s = schema.snapshot.size();
  std::size_t number = 0;
  for (std::size_t piece = 0; piece < dataset.piece_count(); ++piece) {
    const ShardRows& rows = dataset.read_piece(piece);
    for (std::size_t i = 0; i < rows.size(); ++i, ++number) {
      if (rows.status[i] != 0 || !is_picked(number, cases.step)) continue;
      const double* parameters = rows.parameters.data() + i * p;
      const double* snapshot = rows.snapshot.data() + i * s;
      std::vector<double> row(parameters, parameters + p);
      row.insert(row.end(), snapshot, snapshot + s);
      if (std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); })) {
        cases.rows.push_back(std::move(row));
      }
    }
  }
  return cases;
}

std::string round(double value) { return format_cell("{:.6g}", value); }

std::vector<double> sort_column(const Cases& cases, std::size_t column) {
  std::vector<double> values;
  values.reserve(cases.rows.size());
  for (const auto& row : cases.rows) values.push_back(row[column]);
  std::sort(values.begin(), values.end());
  return values;
}

double find_quantile(const std::vector<double>& sorted, double probability) {
  const double position = probability * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::llround(position))];
}

ReportTable make_channel_table(const Cases& cases) {
  ReportTable table{"Snapshot, finished cases",
                    {"channel", "unit", "smallest", "5 %", "median", "95 %", "largest"},
                    {},
                    {},
                    2};
  for (std::size_t c = 0; c < cases.channels.size(); ++c) {
    const auto values = sort_column(cases, cases.parameters.size() + c);
    table.rows.push_back({cases.channels[c].name, cases.channels[c].unit, round(values.front()),
                          round(find_quantile(values, 0.05)), round(find_quantile(values, 0.5)),
                          round(find_quantile(values, 0.95)), round(values.back())});
  }
  return table;
}

/// A channel over one parameter: median and 5 to 95 % band for each bin of the parameter. A bin is
/// drawn at its median value, which is the level if the bin holds a single one.
ChartPanel make_band_panel(const Cases& cases, std::size_t parameter, std::size_t channel) {
  const std::size_t column = cases.parameters.size() + channel;
  const auto range = sort_column(cases, parameter);
  const double low = range.front(), width = (range.back() - low) / static_cast<double>(kBins);
  std::vector<std::vector<double>> parameters(kBins), bins(kBins);
  for (const auto& row : cases.rows) {
    const double position = width > 0.0 ? (row[parameter] - low) / width : 0.0;
    const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(position));
    parameters[bin].push_back(row[parameter]);
    bins[bin].push_back(row[column]);
  }
  ChartSeries band{"5 to 95 %", SeriesKind::kBand, 6}, median{"median", SeriesKind::kLinePoints, 1};
  for (std::size_t b = 0; b < kBins; ++b) {
    if (bins[b].empty()) continue;
    std::sort(parameters[b].begin(), parameters[b].end());
    std::sort(bins[b].begin(), bins[b].end());
    median.x.push_back(find_quantile(parameters[b], 0.5));
    median.y.push_back(find_quantile(bins[b], 0.5));
    band.low.push_back(find_quantile(bins[b], 0.05));
    band.high.push_back(find_quantile(bins[b], 0.95));
  }
  band.x = median.x;
  const ColumnInfo &p = cases.parameters[parameter], &c = cases.channels[channel];
  return {{make_label(p.name, p.unit)}, {make_label(c.name, c.unit)}, {band, median}};
}

Chart make_channel_chart(const Cases& cases, std::size_t channel) {
  Chart chart{"channel_" + cases.channels[channel].name, {}, 2};
  chart.caption = fmt::format(
      "{} ({}) over each parameter, at all values of the others: median, and the band of 5 to 95 % "
      "of the cases.",
      cases.channels[channel].name, cases.channels[channel].description);
  for (std::size_t p = 0; p < cases.parameters.size(); ++p) {
    chart.panels.push_back(make_band_panel(cases, p, channel));
  }
  return chart;
}

ReportSection make_progress(const SweepFolder& folder, const Plan& plan, const SweepStatus& s) {
  ReportTable table{"Progress", {"quantity", "value"}, {}, {}, 2};
  table.rows = {
      {"cases", format_count(s.cases)},
      {"done", format_count(s.done)},
      {"failed", format_count(s.failed)},
      {"left", format_count(s.left)},
      {"shards", format_count(s.shards_present) + " of " + format_count(s.shards) + " of up to " +
                     std::to_string(plan.request().shard_cases) + " cases"},
      {"size", format_bytes(static_cast<double>(s.bytes))}};
  const auto simulated = static_cast<double>(s.done + s.failed);
  if (simulated > 0.0 && s.simulation_seconds > 0.0) {
    table.rows.push_back(
        {"simulation", format_duration(s.simulation_seconds) + " of one thread, " +
                           format_cell("{:.3g}", 1e3 * s.simulation_seconds / simulated) +
                           " ms a case"});
  }
  table.rows.push_back({"plan", plan.hash()});
  table.rows.push_back({"data digest", s.digest.text()});
  ReportSection section{"Cases", {}, {table}};
  if (!s.complete()) {
    section.paragraphs.push_back(
        fmt::format("Not complete: `strut run {}` continues.", folder.root.string()));
  }
  for (const std::string& fault : s.faults) section.paragraphs.push_back(fault);
  return section;
}

ReportTable make_stratum_table(const Plan& plan) {
  ReportTable table{"Strata by " + plan.request().sample.by,
                    {"stratum", "from", "to", "cases", "drawn"},
                    {},
                    {},
                    0};
  for (const Stratum& stratum : plan.strata()) {
    table.rows.push_back({std::to_string(table.rows.size() + 1), round(stratum.lower),
                          round(stratum.upper), format_count(stratum.population),
                          format_count(stratum.drawn)});
  }
  return table;
}

ReportTable make_fact_table(const Plan& plan) {
  ReportTable table{"Everything that changes a result", {"key", "value"}, {}, {}, 2};
  for (const auto& [name, value] : plan.facts()) table.rows.push_back({name, value});
  table.is_folded = true;
  return table;
}

ReportSection make_strata(const Plan& plan) { return {"Coverage", {}, {make_stratum_table(plan)}}; }

Chart make_failure_chart(const SweepStatus& status) {
  ChartSeries bars{"", SeriesKind::kBars, 2};
  ChartPanel panel{{""}, {"cases"}, {}};
  for (const auto& [reason, count] : status.failures) {
    panel.x.categories.push_back(reason);
    bars.x.push_back(static_cast<double>(panel.x.categories.size()));
    bars.y.push_back(static_cast<double>(count.cases));
  }
  panel.series.push_back(std::move(bars));
  Chart chart{"failures", {std::move(panel)}};
  chart.caption = "Reasons of failures; the coverage shows their locations.";
  return chart;
}

ReportSection make_failures(const Plan& plan, const SweepStatus& status,
                            const FigureDrawer& drawer) {
  ReportSection section{"Failures", {}};
  if (status.failures.empty()) {
    section.paragraphs = {"No case failed."};
    return section;
  }
  drawer.draw_all({make_failure_chart(status)}, section);
  ReportTable table{"Failed cases", {"reason", "cases", "first case", "why it failed"}, {}, {}, 4};
  for (const auto& [reason, count] : status.failures) {
    std::string first;
    if (count.first_case >= 0) {
      first = std::to_string(count.first_case);
      for (const auto& [name, value] : list_values(plan, count.first_case)) {
        first += fmt::format("\n{} = {}", name, round(value));
      }
    }
    table.rows.push_back({reason, format_count(count.cases), first, count.first_reason});
  }
  section.tables.push_back(table);
  return section;
}

ReportSection make_snapshots(const Cases& cases, const FigureDrawer& drawer) {
  ReportSection section{"Snapshots", {}};
  if (cases.rows.empty() || cases.channels.empty()) {
    section.paragraphs = {"No finished case has one."};
    return section;
  }
  if (cases.step > 1) {
    section.paragraphs = {fmt::format("From about one case of {}.", cases.step)};
  }
  section.tables.push_back(make_channel_table(cases));
  for (std::size_t c = 0; c < cases.channels.size(); ++c) {
    section.figures.push_back(drawer.draw(make_channel_chart(cases, c)));
  }
  return section;
}

ReportBadge make_badge(const SweepStatus& s) {
  if (!s.faults.empty()) return {"damaged", Tone::kBad};
  if (!s.complete()) return {"not complete", Tone::kWarning};
  if (s.failed > 0) return {"complete, " + format_count(s.failed) + " failed", Tone::kWarning};
  return {"complete", Tone::kGood};
}

std::vector<KeyNumber> make_key_numbers(const SweepStatus& s) {
  std::vector<KeyNumber> numbers = {
      {format_count(s.done) + " of " + format_count(s.cases), "cars simulated"},
      {format_count(s.failed), "failed"}};
  const auto simulated = static_cast<double>(s.done + s.failed);
  if (simulated > 0.0 && s.simulation_seconds > 0.0) {
    numbers.push_back(
        {format_cell("{:.3g} ms", 1e3 * s.simulation_seconds / simulated), "of one thread a car"});
  }
  return numbers;
}

}  // namespace

void write_sweep_report(const SweepFolder& folder) {
  const Plan plan = open_sweep_folder(folder);
  note_unsealed(folder.plan(), kPlanSeal);
  const SweepStatus status = read_status(folder, plan);
  const FigureDrawer drawer(Folder(folder.root));
  ReportPage page;
  page.title = "Sweep " + folder.name();
  page.lead = {format_count(status.done) + " of " + format_count(status.cases) + " cases of " +
               plan.request().base.vehicle.name + " are simulated, " + format_count(status.failed) +
               " failed."};
  page.badge = make_badge(status);
  page.key_numbers = make_key_numbers(status);
  page.sections = {make_progress(folder, plan, status), make_strata(plan),
                   make_failures(plan, status, drawer)};
  if (status.shards_present > 0) {
    Dataset dataset({folder.root}, {.partial = true});
    drawer.draw_all({make_coverage_chart(count_cases(dataset, plan))}, page.sections[1]);
    if (plan.request().snapshot.on) {
      page.sections.push_back(make_snapshots(read_cases(dataset), drawer));
    }
    if (!dataset.schema().history.empty()) {
      page.sections.push_back(make_history_section(folder, drawer));
    }
  }
  if (plan.request().snapshot.on) {
    page.sections.push_back(make_sensitivity_section(plan.request(), drawer));
  }
  ReportSection request{"Plan", {}, {make_fact_table(plan)}};
  // As a person wrote it. The folder may come from elsewhere: a link is not followed.
  constexpr std::size_t kMaxShown = 20'000;  // bytes
  auto text = Folder(folder.root).read_if_present(folder.request().filename().string());
  if (text && text->size() > kMaxShown) *text = text->substr(0, kMaxShown) + "\n... and more";
  if (text) request.files = {std::move(*text)};
  page.sections.push_back(std::move(request));
  page.footer = make_report_footer();
  write_text_file_inside(folder.root, folder.root / "report.html", make_html(page));
}

}  // namespace strut
