// Figures on their way into a report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/report/figure.h"
#include "jobs/report/html.h"

namespace strut {

/// Draws figures into a folder, which is made where it is missing. Without gnuplot none is drawn,
/// and `note` says so once.
class FigureDrawer {
 public:
  explicit FigureDrawer(std::filesystem::path folder);

  /// The drawn figure; without gnuplot one without a picture, whose script waits in the folder.
  ReportFigure draw(const Figure& figure, const std::string& caption) const;
  /// The same of a script that is in the folder already.
  ReportFigure draw_script(const std::string& name, const std::string& caption) const;
  /// For the user: none where figures are drawn.
  std::vector<std::string> list_notes() const;

 private:
  std::filesystem::path folder_;
  std::string note_;
};

/// Program, version, commit, compiler: the last line of every report.
std::string make_report_footer();

}  // namespace strut
