#include "jobs/report/figures.h"

#include <system_error>

#include "io/config.h"
#include "jobs/build_info.h"

namespace strut {

FigureDrawer::FigureDrawer(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw EnvironmentError(folder_.string() + ": cannot be made: " + error.message());
  if (!has_gnuplot()) {
    note_ =
        "gnuplot cannot be started, so the figures are left out (Debian: apt install gnuplot-nox); "
        "`strut report` adds them later";
  }
}

ReportFigure FigureDrawer::draw(const Figure& figure, const std::string& caption) const {
  write_figure_script(folder_, figure);
  return draw_script(figure.name, caption);
}

ReportFigure FigureDrawer::draw_script(const std::string& name, const std::string& caption) const {
  if (!note_.empty()) return {name, "", caption};
  draw_figure(folder_, name);
  return {name, read_text_file(folder_ / (name + ".svg")), caption};
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
