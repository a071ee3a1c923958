#include "jobs/compare/report.h"

#include <algorithm>

#include "jobs/compare/figures.h"
#include "jobs/compare/tables.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

ReportSection make_run_section(const CampaignData& data, const RunComparison& run,
                               const FigureDrawer& drawer) {
  const CampaignRun& entry = data.campaign.runs[run.run];
  ReportSection section;
  section.heading = entry.name + (entry.use == RunUse::kFit ? ", for fitting" : ", held out");
  if (!run.calibrated.evaluation.failure.empty()) {
    section.paragraphs.push_back(run.calibrated.evaluation.failure);
    return section;
  }
  drawer.draw_all(make_run_charts(data, run), section);
  section.tables = make_run_tables(data, run);
  return section;
}

}  // namespace

void write_compare_report(const CompareFolder& folder, const CampaignData& data,
                          const Comparison& comparison, const std::vector<std::string>& tables) {
  const FigureDrawer drawer(folder.make());
  ReportPage page;
  page.title = "Measured against simulated: " + data.campaign.path.filename().string();
  page.lead = {make_verdict_text(data, comparison)};
  std::vector<std::string> notes = data.notes;
  notes.insert(notes.end(), comparison.notes.begin(), comparison.notes.end());
  page.sections.push_back({"Overview", notes, make_compare_tables(data, comparison)});
  for (const RunComparison& run : comparison.runs) {
    page.sections.push_back(make_run_section(data, run, drawer));
  }
  page.footer = make_report_footer();
  page.of = kComparisonContent.name;
  page.tables = tables;
  write_page(folder, page);
}

}  // namespace strut
