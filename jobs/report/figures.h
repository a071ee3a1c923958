// Figures on their way into a report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/json.h"
#include "jobs/report/chart.h"
#include "jobs/report/html.h"

namespace strut {

/// Writes figures into a folder, which is made where it is missing: NAME.json for the page,
/// NAME.csv with the numbers, NAME.gp and the picture NAME.svg that gnuplot draws by it. Without
/// gnuplot there are no pictures, and list_notes() says so.
class FigureDrawer {
 public:
  explicit FigureDrawer(std::filesystem::path folder);

  ReportFigure draw(const Chart& chart) const;
  /// All of them, at the end of a section.
  void draw_all(const std::vector<Chart>& charts, ReportSection& section) const;
  /// The same of a chart that was drawn into the folder before. Throws EnvironmentError.
  ReportFigure draw_again(const std::string& name, const std::string& caption) const;
  /// A scene of make_motion() as NAME.json.
  ReportMotion draw_motion(const Json& scene, const std::string& name,
                           const std::string& caption) const;
  ReportMotion draw_motion_again(const std::string& name, const std::string& caption) const;
  /// For the user: none where pictures are drawn.
  std::vector<std::string> list_notes() const;

 private:
  std::filesystem::path folder_;
  std::string note_;
};

/// Program, version, commit, compiler: the last line of every report.
std::string make_report_footer();

}  // namespace strut
