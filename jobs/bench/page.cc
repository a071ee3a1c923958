#include "jobs/bench/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "io/file/atomic_file.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

/// Another simulator of whole cars, at its own step of 1 ms on one core.
struct Peer {
  const char* name;
  const char* about;
  double published;  // x real time
  double measured;   // on the machine of docs/performance.md
};

/// Source: the paper of uwsbel/low-fidelity-dynamic-models, which also ran Chrono::Vehicle; an
/// Intel Core i7-13700K. It gives no error.
constexpr std::array<Peer, 2> kPeers = {{
    {"24-degree-of-freedom model",
     "uwsbel/low-fidelity-dynamic-models; without the linkage's kinematics", 2720.0, 1700.0},
    {"Chrono::Vehicle", "with the linkage's kinematics; implicit", 2.0, 2.7},
}};

std::filesystem::path get_numbers_file(const PageFolder& folder) {
  return folder.root / kBenchContent.file;
}

struct SettingGroup {
  const char* name;
  int color;
  bool (*holds)(const BenchSetting&);
};

constexpr std::array<SettingGroup, 3> kGroups = {{
    {"one simulation or both sides, Newton closure", 1,
     [](const BenchSetting& s) {
       return s.options.closure == Closure::kNewton && !(s.in_lanes && s.options.symmetry);
     }},
    {"one side, Newton closure", 2,
     [](const BenchSetting& s) {
       return s.options.closure == Closure::kNewton && s.in_lanes && s.options.symmetry;
     }},
    {"tabulated corners", 3,
     [](const BenchSetting& s) { return s.options.closure == Closure::kTable; }},
}};

std::vector<Figure> list_figures(const BenchResult& result) {
  std::vector<Figure> all = result.single_core;
  all.insert(all.end(), result.candidates.begin(), result.candidates.end());
  return all;
}

Chart make_chart(const std::vector<Figure>& figures) {
  ChartPanel panel{
      {"error of the body acceleration [1]", true}, {"speed on one core [x real time]", true}, {}};
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Figure& f : figures) {
    if (!std::isfinite(f.error) || !(f.error > 0.0)) continue;
    least = std::min(least, f.error);
    most = std::max(most, f.error);
  }
  for (const SettingGroup& group : kGroups) {
    ChartSeries points{group.name, SeriesKind::kPoints, group.color};
    for (const Figure& f : figures) {
      if (!group.holds(f.setting)) continue;
      points.x.push_back(f.error);
      points.y.push_back(f.real_time_factor);
    }
    if (!points.x.empty()) panel.series.push_back(std::move(points));
  }
  int color = 4;
  for (const Peer& peer : kPeers) {
    if (!(most > 0.0)) break;
    ChartSeries line{std::string(peer.name) + ", error unknown", SeriesKind::kDashedLine, color++};
    line.x = {least, most};
    line.y = {peer.measured, peer.measured};
    panel.series.push_back(std::move(line));
  }
  Chart chart{"work_precision", {std::move(panel)}};
  chart.panel_height = 480;
  chart.caption =
      "Up is faster, left is more accurate. Each point is a setting of the integrator; the error "
      "is that of the worst lane against CVODE at 1e-12, relative to the rms of the acceleration.";
  return chart;
}

ReportTable make_setting_table(const std::vector<Figure>& figures) {
  ReportTable table{"",
                    {"name", "setting", "x real time", "runs/s", "error [1]",
                     "right-hand sides a run", "Mflop a run", "spin control"},
                    {},
                    {},
                    2};
  for (const Figure& f : figures) {
    table.rows.push_back({f.setting.label, f.setting.text, format_short(f.real_time_factor),
                          format_short(f.runs_per_s), fmt::format("{:.1e}", f.error),
                          format_short(f.rhs_per_run), format_short(1e-6 * f.flops_per_run),
                          fmt::format("{:.2f}", f.spin_control)});
  }
  table.notes = {
      "Spin control: speed of a fixed loop timed at the same time; 1: nobody else uses this "
      "machine."};
  return table;
}

ReportTable make_peer_table() {
  ReportTable table{
      "Times real time", {"simulator", "about", "published", "measured by us"}, {}, {}, 2};
  for (const Peer& peer : kPeers) {
    table.rows.push_back(
        {peer.name, peer.about, format_short(peer.published), format_short(peer.measured)});
  }
  table.notes = {
      "Published: on an Intel Core i7-13700K, by the paper of the first. "
      "Measured by us, and drawn: on the machine of docs/performance.md, not on this one."};
  return table;
}

/// The fastest setting that is accurate enough, and how quiet the machine was.
std::vector<KeyNumber> make_key_numbers(const std::vector<Figure>& figures) {
  constexpr double kAccurate = 1e-3;
  const Figure* fastest = nullptr;
  double quietest = 0.0;
  for (const Figure& f : figures) {
    quietest = std::max(quietest, f.spin_control);
    if (f.error > kAccurate) continue;
    if (fastest == nullptr || f.runs_per_s > fastest->runs_per_s) fastest = &f;
  }
  std::vector<KeyNumber> numbers;
  if (fastest != nullptr) {
    numbers.push_back({fmt::format("{:.0f} runs/s", fastest->runs_per_s),
                       fmt::format("on one core, error {:.1e}", fastest->error)});
    numbers.push_back({fmt::format("{:.0f} x", fastest->real_time_factor), "real time"});
  }
  numbers.push_back({fmt::format("{:.2f}", quietest), "spin control, 1: a quiet machine"});
  return numbers;
}

}  // namespace

void check_bench_page(const std::filesystem::path& folder) {
  const PageFolder page{folder.lexically_normal()};
  check_output_folder("report", page.root);
  check_page_folder("report", page, kBenchContent, {get_numbers_file(page)});
}

void write_bench_page(const std::filesystem::path& folder, const BenchResult& result,
                      const std::vector<FigureRatio>& ratios) {
  const PageFolder out{folder.lexically_normal()};
  clear_page_folder(out, get_numbers_file(out));
  const FigureDrawer drawer(out.make());
  std::vector<Figure> figures = list_figures(result);
  std::stable_sort(figures.begin(), figures.end(), [](const Figure& a, const Figure& b) {
    const auto rank = [](double error) { return std::isnan(error) ? INFINITY : error; };
    return rank(a.error) < rank(b.error);
  });
  const Machine& machine = result.machine;
  ReportSection speed{"Speed over error"};
  drawer.draw_all({make_chart(figures)}, speed);
  ReportSection settings{"Settings", {}, {make_setting_table(figures)}};
  ReportSection others{"Other simulators", {}, {make_peer_table()}};
  ReportPage page{"Throughput of strut",
                  {fmt::format("{}, {}, {}, {}.", machine.cpu, format_count(machine.cores, "core"),
                               machine.isa, machine.compiler)},
                  {std::move(speed), std::move(settings), std::move(others)},
                  make_report_footer()};
  page.of = kBenchContent.name;
  page.key_numbers = make_key_numbers(figures);
  write_page(out, page);
  std::ostringstream numbers;
  print_json(numbers, result, ratios);
  write_text_file_inside(out.root, get_numbers_file(out), numbers.str());
}

}  // namespace strut
