#include "jobs/simulate/run_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/simulate/motion.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

ReportTable make_parameter_table(const RunRecord& run) {
  ReportTable table{"Parameters", {"name", "description", "value", "unit"}, {}, {}, 2};
  for (const RunParameter& p : run.parameters) {
    table.rows.push_back({p.name, p.description, format_short(p.value), p.unit});
  }
  return table;
}

ReportTable make_source_table(const RunRecord& run) {
  ReportTable table{"Provenance", {"name", "value"}, {}, {}, 2};
  for (const auto& [name, value] : run.provenance) table.rows.push_back({name, value});
  return table;
}

/// "a bump of 50 mm under the left wheels"
std::string describe_road(const RoadSpec& road) {
  double low = 0.0, high = 0.0;
  for (const auto& [x, z] : list_profile(road)) {
    low = std::min(low, z);
    high = std::max(high, z);
  }
  std::string text;
  constexpr double kMinHole = 5e-5;  // m; the spline of a table overshoots its points by less
  if (high > 0.0 || low > -kMinHole) {
    text = fmt::format("a bump of {} mm", format_short(1e3 * high));
  }
  if (low <= -kMinHole) {
    text += fmt::format("{}a hole of {} mm", text.empty() ? "" : " and ", format_short(-1e3 * low));
  }
  if (road.side == BumpSide::kLeft) text += " under the left wheels";
  if (road.side == BumpSide::kRight) text += " under the right wheels";
  return text;
}

std::string describe(const Case& c) {
  const RoadSpec& road = c.maneuver.road;
  const std::string where =
      road.shape == BumpShape::kNone ? "on a flat road" : "over " + describe_road(road);
  return fmt::format("{} at {} m/s {}.", c.vehicle.name, format_short(c.maneuver.speed), where);
}

}  // namespace

void write_run_report(const std::filesystem::path& folder, const CaseSource& source, const Case& c,
                      const RunRecord& run) {
  const PageFolder out{folder};
  clear_page_folder(out, out.page());
  const FigureDrawer drawer(out.make());
  ReportSection motion{"Motion"};
  motion.motions = {drawer.draw_motion(make_motion(c, run.results), "motion",
                                       "The car drives to the right; the wheels of its right side "
                                       "are solid, those of its left side, "
                                       "which is farther away, dashed. Springs have their "
                                       "simulated length; their mounts are drawn at "
                                       "their positions at nominal trim.")};
  drawer.draw_all({make_motion_curves(run.results)}, motion);
  ReportPage page{
      "Run of " + source.vehicle.filename().string(),
      {describe(c)},
      {std::move(motion), {"Parameters", {}, {make_parameter_table(run), make_source_table(run)}}},
      make_report_footer()};
  page.of = kRunContent.name;
  write_page(out, page);
}

}  // namespace strut
