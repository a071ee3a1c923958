#include "jobs/simulate/rig_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "jobs/simulate/run_report.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

/// The kept channels over time, those of one unit in one panel.
Chart make_curves(const RunRecord& run) {
  Chart chart{"curves", {}};
  chart.panel_height = 220;
  chart.shares_x = true;
  chart.caption = "The run's channels over time.";
  const std::vector<double> time = run.results.get_history(run.kept.front());
  for (const int number : run.kept) {
    const ChannelInfo& info = (*run.channels)[static_cast<std::size_t>(number)];
    if (number == run.kept.front()) continue;  // the time
    const std::string label = "[" + info.unit + "]";
    auto panel = std::find_if(chart.panels.begin(), chart.panels.end(),
                              [&](const ChartPanel& p) { return p.y.label == label; });
    if (panel == chart.panels.end()) {
      panel = chart.panels.insert(panel, ChartPanel{{"time [s]"}, {label}, {}});
      panel->about = label + " over time [s]";
    }
    const int color = 1 + static_cast<int>(panel->series.size() % std::size(kChartColors));
    panel->series.push_back(make_curve(make_words(info.name), SeriesKind::kLine, color, time,
                                       run.results.get_history(number)));
  }
  return chart;
}

}  // namespace

void write_rig_report(const SimulateOptions& options, const RunRecord& run) {
  const PageFolder out{options.report};
  clear_page_folder(out, out.page());
  const FigureDrawer drawer(out.make());
  ReportSection curves{"Curves"};
  const Chart chart = make_curves(run);
  if (chart.panels.empty()) {
    curves.paragraphs = {"The run has no channel but the time."};
  } else {
    drawer.draw_all({chart}, curves);
  }
  ReportPage page{
      make_run_title(options.source),
      {},
      {std::move(curves), {"Parameters", {}, {make_parameter_table(run), make_source_table(run)}}},
      make_report_footer()};
  page.of = kRunContent.name;
  write_page(out, page);
}

}  // namespace strut
