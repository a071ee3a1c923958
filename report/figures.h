// Writes figures into the folder of a report, and reads them back.
#pragma once

#include <string>
#include <vector>

#include "io/file/folder.h"
#include "io/format/json.h"
#include "report/chart.h"
#include "report/html.h"

namespace strut {

/// Whether a name is valid for a table or figure: at most 200 letters, digits, '_' and '-', so that
/// it cannot lead out of the report's folder.
bool is_figure_name(const std::string& name);

/// Writes figures into the subfolder figures/ of a report's folder: NAME.json for the page and
/// NAME.csv with the numbers.
class FigureDrawer {
 public:
  /// Throws InputError where figures/ is a link, EnvironmentError where it cannot be made.
  explicit FigureDrawer(const Folder& root);

  ReportFigure draw(const Chart& chart) const;
  /// Draws the charts and appends them to a section.
  void draw_all(const std::vector<Chart>& charts, ReportSection& section) const;
  /// Reads a chart that was drawn into the folder earlier. Throws InputError where the name is
  /// invalid, or its file is missing or a link.
  ReportFigure read_again(const std::string& name, const std::string& caption) const;
  /// Writes a scene of make_motion() as NAME.json.
  ReportMotion draw_motion(const Json& scene, const std::string& name,
                           const std::string& caption) const;
  ReportMotion read_motion_again(const std::string& name, const std::string& caption) const;

 private:
  std::string read_json_of(const std::string& name) const;

  Folder folder_;
};

/// Program, version, commit, compiler: the last line of every report.
std::string make_report_footer();

}  // namespace strut
