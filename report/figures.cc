#include "report/figures.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/text/build_info.h"
#include "base/text/shorten.h"
#include "io/file/atomic_file.h"
#include "report/chart_csv.h"
#include "report/plotly.h"

namespace strut {

namespace {

constexpr std::size_t kMaxChartBytes = std::size_t{256} << 20;

void check_figure_name(const Folder& folder, const std::string& name) {
  if (is_figure_name(name)) return;
  // The name last: it may hold a NUL, which ends the message of an exception.
  throw InputError(
      fmt::format("{}: the name of a figure must consist of letters, digits, '_' and '-', as strut "
                  "writes it; it is '{}'",
                  folder.path().string(), shorten(name)));
}

}  // namespace

bool is_figure_name(const std::string& name) {
  constexpr std::size_t kMaxLength = 200;
  return !name.empty() && name.size() <= kMaxLength &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

FigureDrawer::FigureDrawer(const Folder& root) : folder_(root.make_folder("figures")) {}

ReportFigure FigureDrawer::draw(const Chart& chart) const {
  check_figure_name(folder_, chart.name);
  write_text_file(folder_, chart.name + ".json", format_json(make_plotly(chart)) + "\n");
  write_text_file(folder_, chart.name + ".csv", make_chart_csv(chart));
  return read_again(chart.name, chart.caption);
}

void FigureDrawer::draw_all(const std::vector<Chart>& charts, ReportSection& section) const {
  for (const Chart& chart : charts) section.figures.push_back(draw(chart));
}

std::string FigureDrawer::read_json_of(const std::string& name) const {
  check_figure_name(folder_, name);
  auto json = folder_.read_if_present(name + ".json", kMaxChartBytes);
  if (!json) throw InputError(folder_.path_of(name + ".json").string() + ": file not found");
  return *std::move(json);
}

ReportFigure FigureDrawer::read_again(const std::string& name, const std::string& caption) const {
  ReportFigure figure{name, caption, read_json_of(name), {}};
  const std::string table = name + ".csv";
  if (folder_.open_file(table, O_RDONLY).is_open()) {
    figure.files.push_back(folder_.path().filename().string() + "/" + table);
  }
  return figure;
}

ReportMotion FigureDrawer::draw_motion(const Json& scene, const std::string& name,
                                       const std::string& caption) const {
  write_text_file(folder_, name + ".json", format_json(scene) + "\n");
  return read_motion_again(name, caption);
}

ReportMotion FigureDrawer::read_motion_again(const std::string& name,
                                             const std::string& caption) const {
  return {name, caption, read_json_of(name)};
}

std::string make_report_footer() {
  const BuildInfo& build = get_build_info();
  return fmt::format("strut {} ({}), {}, {}", build.version, build.commit, build.compiler,
                     build.build_type);
}

}  // namespace strut
