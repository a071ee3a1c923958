#include "jobs/simulate/run_report.h"

#include <algorithm>

#include "jobs/simulate/motion.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

ReportTable make_parameter_table(const RunRecord& run) {
  ReportTable table{"Parameters", {"name", "what", "value", "unit"}, {}, {}, 2};
  for (const RunParameter& p : run.parameters) {
    table.rows.push_back({p.name, p.description, format_short(p.value), p.unit});
  }
  return table;
}

ReportTable make_source_table(const RunRecord& run) {
  ReportTable table{"How it was made", {"what", "value"}, {}, {}, 2};
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
  constexpr double kHole = 5e-5;  // m; less is how a table's spline swings about its points
  if (high > 0.0 || low > -kHole) text = "a bump of " + format_short(1e3 * high) + " mm";
  if (low <= -kHole) {
    text += (text.empty() ? "" : " and ") + std::string("a hole of ") + format_short(-1e3 * low) +
            " mm";
  }
  if (road.side == BumpSide::kLeft) text += " under the left wheels";
  if (road.side == BumpSide::kRight) text += " under the right wheels";
  return text;
}

std::string describe(const Case& c) {
  const RoadSpec& road = c.maneuver.road;
  const std::string text = c.vehicle.name + " at " + format_short(c.maneuver.speed) + " m/s ";
  if (road.shape == BumpShape::kNone) return text + "on a flat road.";
  return text + "over " + describe_road(road) + ".";
}

}  // namespace

void write_run_report(const std::filesystem::path& folder, const CaseSource& source, const Case& c,
                      const RunRecord& run) {
  const PageFolder out{folder};
  clear_page_folder(out, out.page());
  const FigureDrawer drawer(out.make());
  ReportSection motion{"Motion"};
  motion.motions = {drawer.draw_motion(
      make_motion(c, run.results), "motion",
      "The car drives to the right; wheels of its right side solid, of its left side, beyond, "
      "dashed. Springs are as long as they were simulated; their mounts stand where they are at "
      "nominal trim.")};
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
