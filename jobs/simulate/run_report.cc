#include "jobs/simulate/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/simulate/ride.h"
#include "model_files/parameters.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

/// The parameters that --set changed; without rows where it changed none.
ReportTable make_change_table(const CaseSource& source, const Case& c) {
  ReportTable table{"Changed by --set", {"name", "description", "file", "here", "unit"}, {}, {}, 2};
  if (source.settings.empty()) return table;
  const Case file = load_case({source.vehicle, source.maneuver, {}});
  for (const std::string& setting : source.settings) {
    const ParameterInfo& p = find_parameter(parse_setting(setting).name);
    table.rows.push_back(
        {p.name, p.description, format_short(p.get(file)), format_short(p.get(c)), p.unit});
  }
  return table;
}

/// The rows of make_ride_table(): quantity, value, unit.
struct RideFigure {
  std::string quantity;
  double value = 0.0;
  const char* unit = "";
  int decimals = 2;
};

std::vector<RideFigure> list_ride_figures(const Ride& ride) {
  constexpr const char* kAcceleration = "m/s\u00b2";
  std::vector<RideFigure> figures = {
      {"peak vertical acceleration of the body", ride.peak, kAcceleration},
      {"its root mean square", ride.rms, kAcceleration}};
  if (ride.weighted) {
    figures.push_back(
        {"weighted by ISO 2631-1, largest rms of a second", *ride.transient, kAcceleration});
    figures.push_back(
        {"weighted by ISO 2631-1, rms of the whole run", *ride.weighted, kAcceleration});
  }
  for (int axle = 0; axle < kAxles; ++axle) {
    const AxleRide& a = ride.axles[static_cast<std::size_t>(axle)];
    const std::string name = std::string(" ") + kAxleNames[static_cast<std::size_t>(axle)];
    figures.push_back(
        {"suspension travel," + name + " (of \u00b1100 mm)", 1e3 * a.travel, "mm", 1});
    figures.push_back(
        {"tire load variation," + name + " (rms over mean)", 100.0 * a.load_variation, "%", 1});
    figures.push_back({"a wheel off the road," + name, 1e3 * a.airborne, "ms", 0});
  }
  return figures;
}

/// The figures of another run; empty where its file lacks a channel or has uneven times.
std::vector<RideFigure> list_other_figures(const OtherRun& other) {
  const std::vector<int> channels = list_ride_channels();
  const bool has_all = std::all_of(channels.begin(), channels.end(),
                                   [&](int channel) { return other.find(channel) != nullptr; });
  const std::optional<double> rate = other.find_rate();
  if (!has_all || !rate) return {};
  return list_ride_figures(calc_ride([&](int channel) { return *other.find(channel); }, *rate));
}

/// `duration` [s]: of this run.
ReportTable make_ride_table(const Ride& ride, double duration,
                            const std::optional<OtherRun>& other) {
  ReportTable table{"Figures of merit", {"quantity", "value", "unit"}};
  const std::vector<RideFigure> figures = list_ride_figures(ride);
  const std::vector<RideFigure> others =
      other ? list_other_figures(*other) : std::vector<RideFigure>{};
  if (!others.empty()) table.header = {"quantity", "this run", other->name, "unit"};
  for (const RideFigure& f : figures) {
    const auto format = [&](double value) { return fmt::format("{:.{}f}", value, f.decimals); };
    std::vector<std::string> row = {f.quantity, format(f.value)};
    // A coarse record has no weighted acceleration.
    const auto found = std::find_if(others.begin(), others.end(),
                                    [&](const RideFigure& o) { return o.quantity == f.quantity; });
    if (!others.empty()) row.push_back(found == others.end() ? "" : format(found->value));
    row.emplace_back(f.unit);
    table.rows.push_back(std::move(row));
  }
  if (!others.empty()) {
    const double length = other->times.back() - other->times.front();
    if (std::fabs(length - duration) > 0.01 * duration) {
      table.notes.push_back(fmt::format("{} lasts {} s, this run {} s.", other->name,
                                        format_short(length), format_short(duration)));
    }
  }
  return table;
}

std::vector<KeyNumber> make_key_numbers(const Ride& ride) {
  std::vector<KeyNumber> numbers = {
      {fmt::format("{:.2f} m/s\u00b2", ride.peak), "peak vertical acceleration"}};
  if (ride.weighted) {
    numbers.push_back(
        {fmt::format("{:.2f} m/s\u00b2", *ride.transient), "weighted by ISO 2631-1, worst second"});
  }
  const double travel = std::max(ride.axles[kFront].travel, ride.axles[kRear].travel);
  numbers.push_back({fmt::format("{:.0f} mm", 1e3 * travel), "suspension travel used of 100 mm"});
  return numbers;
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
    const std::string bumps = road.count > 1 ? std::to_string(road.count) + " bumps" : "a bump";
    text = fmt::format("{} of {} mm", bumps, format_short(1e3 * high));
    if (road.count > 1) text += fmt::format(", {} m apart", format_short(road.spacing));
  }
  if (low <= -kMinHole) {
    text += fmt::format("{}a hole of {} mm", text.empty() ? "" : " and ", format_short(-1e3 * low));
  }
  if (road.side == BumpSide::kLeft) text += " under the left wheels";
  if (road.side == BumpSide::kRight) text += " under the right wheels";
  return text;
}

std::string describe(const CaseSource& source, const Case& c) {
  const RoadSpec& road = c.maneuver.road;
  const bool is_rough = c.maneuver.profile.data != nullptr;
  std::string where = is_rough ? "on the road of " + source.maneuver.filename().string()
                               : std::string("on a flat road");
  if (road.shape != BumpShape::kNone) {
    where = "over " + describe_road(road) + (is_rough ? " " + where : "");
  }
  return fmt::format("{} at {} m/s {}.", c.vehicle.name, format_short(c.maneuver.speed), where);
}

}  // namespace

std::string make_run_title(const CaseSource& source) {
  constexpr std::size_t kMaxSettings = 3;
  std::string title = source.vehicle.stem().string() + " over " + source.maneuver.stem().string();
  for (std::size_t i = 0; i < std::min(kMaxSettings, source.settings.size()); ++i) {
    const NamedValue setting = parse_setting(source.settings[i]);
    title += fmt::format(", {} = {}{}{}", setting.name, setting.value,
                         setting.unit.empty() ? "" : " ", setting.unit);
  }
  return title + (source.settings.size() > kMaxSettings ? ", ..." : "");
}

ReportTable make_parameter_table(const RunRecord& run) {
  ReportTable table{"All parameters", {"name", "description", "value", "unit"}, {}, {}, 2};
  for (const RunParameter& p : run.parameters) {
    table.rows.push_back({p.name, p.description, format_short(p.value), p.unit});
  }
  table.is_folded = true;
  return table;
}

ReportTable make_source_table(const RunRecord& run) {
  ReportTable table{"Provenance", {"name", "value"}, {}, {}, 2};
  for (const auto& [name, value] : run.provenance) table.rows.push_back({name, value});
  table.is_folded = true;
  return table;
}

void write_run_report(const std::filesystem::path& folder, const CaseSource& source, const Case& c,
                      const RunRecord& run, double rate, const std::optional<OtherRun>& other) {
  const PageFolder out{folder};
  clear_page_folder(out, out.page());
  const FigureDrawer drawer(out.make());
  ReportSection motion{"Motion"};
  std::string caption =
      "The car drives to the right; its right wheels are solid, its left ones, farther away, "
      "dashed. "
      "Springs have their simulated length; their mounts are drawn at their positions at nominal "
      "trim. Below, the front axle from the front and the rear axle from behind.";
  if (other) caption += fmt::format(" {} is drawn over it, dotted.", other->name);
  motion.motions = {drawer.draw_motion(make_motion(c, run.results, other), "motion", caption)};
  drawer.draw_all({make_motion_curves(run.results, other)}, motion);
  const Ride ride = calc_ride([&](int channel) { return run.results.get_history(channel); }, rate);
  ReportSection parameters{"Parameters"};
  if (ReportTable changes = make_change_table(source, c); !changes.rows.empty()) {
    parameters.tables.push_back(std::move(changes));
  }
  parameters.tables.push_back(make_parameter_table(run));
  parameters.tables.push_back(make_source_table(run));
  ReportPage page{make_run_title(source),
                  {describe(source, c)},
                  {std::move(motion),
                   {"Ride", {}, {make_ride_table(ride, c.maneuver.duration, other)}},
                   std::move(parameters)},
                  make_report_footer()};
  page.of = kRunContent.name;
  page.key_numbers = make_key_numbers(ride);
  write_page(out, page);
}

}  // namespace strut
