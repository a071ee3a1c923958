#include "jobs/report/sensitivities.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error/input_error.h"
#include "jobs/case/design_report.h"

namespace strut {
namespace {

constexpr std::size_t kMaxPoints = 600;  // points of a curve

DesignReport calc_report(const SweepRequest& request) {
  DesignReport report;
  report.noise = make_default_noise();
  report.channels = request.snapshot.channels;
  SensitivityOptions options;
  options.integrate = make_accurate(request.integrate);
  report.sensitivity = calc_sensitivity(make_base_point(request.base, request.grid, {}, {}),
                                        request.grid.axes(), request.snapshot.offset, options);
  report.design = calc_design(report.sensitivity, report.channels, report.noise);
  return report;
}

int get_color(std::size_t series) { return 1 + static_cast<int>(series % std::size(kChartColors)); }

/// A curve over the distance traveled; get(i): value at instant i.
template <class Get>
ChartSeries make_distance_curve(const Sensitivity& s, std::size_t parameter, const Get& get) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < s.instants.size(); ++i) {
    x.push_back(s.instants[i].offset);
    y.push_back(get(i));
  }
  return make_curve(make_words(s.parameters[parameter].name), SeriesKind::kLine,
                    get_color(parameter), x, y, kMaxPoints);
}

const char kDistance[] = "rear wheels beyond the bump's center [m]";

Chart make_bound_chart(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  ChartPanel panel{{kDistance}, {"bound, 1 sigma [%]", true}, {}};
  double smallest = INFINITY;
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    panel.series.push_back(make_distance_curve(s, p, [&](std::size_t i) {
      const double bound = report.design.scan[i].bound[p];
      smallest = std::min(smallest, bound);
      return bound <= kIdentifiable ? bound : NAN;
    }));
  }
  const double best = s.instants[report.design.best[0].instants[0]].offset;
  for (const auto& [name, offset] :
       {std::pair{"the sweep's instant", s.snapshot.offset}, std::pair{"best instant", best}}) {
    panel.series.push_back({name,
                            SeriesKind::kDashedLine,
                            offset == best ? 5 : kInk,
                            {offset, offset},
                            {smallest, kIdentifiable}});
  }
  Chart chart{"bounds", {std::move(panel)}};
  chart.panel_height = 420;
  chart.caption = fmt::format(
      "Cramer-Rao bound of each parameter from one snapshot, in per cent of its value, over "
      "the location of the snapshot; bounds above {} % are left out.",
      format_short(kIdentifiable));
  return chart;
}

Chart make_sensitivity_chart(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  Chart chart{"sensitivities", {}, 2};
  chart.panel_height = 280;
  chart.caption = "Change of each channel of the snapshot when a parameter changes by one percent.";
  for (const int channel : report.channels) {
    const ChannelInfo& info = get_channel(channel);
    ChartPanel panel{{kDistance}, {make_label(info.name, info.unit + " per %")}, {}};
    for (std::size_t p = 0; p < s.parameters.size(); ++p) {
      panel.series.push_back(make_distance_curve(s, p, [&](std::size_t i) {
        return to_unit(s.parameters[p], s.get(s.instants[i], channel, p));
      }));
    }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

std::vector<std::string> make_row(const Sensitivity& s, const std::string& label,
                                  const std::string& offset, const Bounds& bounds) {
  std::vector<std::string> row = {label, offset};
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    row.push_back(bounds.bound[p] <= kIdentifiable ? format_cell("{:.3g}", bounds.bound[p])
                                                   : "free");
  }
  return row;
}

ReportTable make_bound_table(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  ReportTable table{"Cramer-Rao bounds, 1 sigma [%]", {"measured at", "offset [m]"}};
  for (const SensitivityParameter& p : s.parameters) table.header.push_back(p.name);
  const auto format_offset = [](const Instant& i) { return format_cell("{:.3f}", i.offset); };
  table.rows.push_back(
      make_row(s, "the sweep's instant", format_offset(s.snapshot), report.design.snapshot));
  for (const DesignChoice& choice : report.design.best) {
    std::string offsets;
    for (const std::size_t i : choice.instants) {
      offsets += (offsets.empty() ? "" : ", ") + format_offset(s.instants[i]);
    }
    const std::size_t count = choice.instants.size();
    table.rows.push_back(
        make_row(s, count == 1 ? "best instant" : fmt::format("best {} instants", count), offsets,
                 choice.bounds));
  }
  table.rows.push_back(make_row(s, "all instants", "", report.design.window));
  return table;
}

}  // namespace

ReportSection make_sensitivity_section(const SweepRequest& request, const FigureDrawer& drawer) {
  ReportSection section{"Sensitivities and the best instant"};
  try {
    const DesignReport report = calc_report(request);
    section.paragraphs = {
        "Accuracy with which the snapshot's channels identify the parameters, with the noise of "
        "typical sensors, at the middle of the grid. `strut design` offers other sensors and base "
        "points."};
    section.tables = {make_bound_table(report)};
    drawer.draw_all({make_bound_chart(report), make_sensitivity_chart(report)}, section);
  } catch (const InputError& e) {
    section.paragraphs = {fmt::format("Could not be calculated: {}", e.what())};
  }
  return section;
}

}  // namespace strut
