#include "jobs/report/figures.h"

#include "io/atomic_file.h"
#include "io/config.h"
#include "jobs/build_info.h"
#include "jobs/report/chart_csv.h"
#include "jobs/report/gnuplot.h"
#include "jobs/report/plotly.h"

namespace strut {

FigureDrawer::FigureDrawer(std::filesystem::path folder) : folder_(std::move(folder)) {
  make_folder(folder_);
  if (!has_gnuplot()) {
    note_ =
        "gnuplot cannot be started, so there are no pictures of the charts as files (Debian: apt "
        "install gnuplot-nox); `strut report` adds them later";
  }
}

ReportFigure FigureDrawer::draw(const Chart& chart) const {
  write_text_file(folder_ / (chart.name + ".json"), make_plotly(chart).dump() + "\n");
  write_text_file(folder_ / (chart.name + ".csv"), make_chart_csv(chart));
  write_text_file(folder_ / (chart.name + ".gp"), make_gnuplot(chart));
  remove_file(folder_ / (chart.name + ".svg"));  // of other numbers, where gnuplot is not there now
  return draw_again(chart.name, chart.caption);
}

void FigureDrawer::draw_all(const std::vector<Chart>& charts, ReportSection& section) const {
  for (const Chart& chart : charts) section.figures.push_back(draw(chart));
}

ReportFigure FigureDrawer::draw_again(const std::string& name, const std::string& caption) const {
  const std::string link = (folder_.filename() / name).generic_string();
  ReportFigure figure{name, caption, read_text_file(folder_ / (name + ".json")), {}};
  if (note_.empty()) {
    draw_picture(folder_, name);
    figure.files.push_back(link + ".svg");
  }
  figure.files.push_back(link + ".csv");
  return figure;
}

ReportMotion FigureDrawer::draw_motion(const Json& scene, const std::string& name,
                                       const std::string& caption) const {
  write_text_file(folder_ / (name + ".json"), scene.dump() + "\n");
  return draw_motion_again(name, caption);
}

ReportMotion FigureDrawer::draw_motion_again(const std::string& name,
                                             const std::string& caption) const {
  return {name, caption, read_text_file(folder_ / (name + ".json"))};
}

std::vector<std::string> FigureDrawer::list_notes() const {
  return note_.empty() ? std::vector<std::string>{} : std::vector<std::string>{note_};
}

std::string make_report_footer() {
  const BuildInfo& build = get_build_info();
  return std::string("strut ") + build.version + " (" + build.commit + "), " + build.compiler +
         ", " + build.build_type;
}

}  // namespace strut
