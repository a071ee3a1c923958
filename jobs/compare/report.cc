#include "jobs/compare/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/math/normal.h"
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
  for (ReportTable& table : section.tables) table.is_folded = true;
  return section;
}

/// The number of adequate channels, the largest residual, and the first calibrated parameter.
std::vector<KeyNumber> make_key_numbers(const CampaignData& data, const Comparison& comparison) {
  std::size_t channels = 0, adequate = 0;
  double worst = 0.0;
  std::string name;
  for (const RunComparison& run : comparison.runs) {
    for (const ChannelComparison& c : run.calibrated.channels) {
      ++channels;
      adequate += c.is_adequate() ? 1 : 0;
      const double ratio = c.adequacy.calc_times_noise();
      if (ratio > worst) name = data.info(c.channel).name;
      worst = std::max(worst, ratio);
    }
  }
  std::vector<KeyNumber> numbers = {
      {fmt::format("{} of {}", adequate, channels), "channels of all runs within their noise"}};
  if (!name.empty()) {
    numbers.push_back({worst <= 1.0 ? "within the noise" : format_short(worst) + " x noise",
                       "largest residual: " + make_words(name)});
  }
  const Baseline& baseline = comparison.baseline;
  if (baseline.is_fitted && baseline.shared_count() > 0) {
    const Unknown& u = baseline.calibrated.unknowns[0];
    numbers.push_back({fmt::format("{} \u00b1 {} {}", format_short(baseline.calibrated.values[0]),
                                   format_short(kNormal95 * baseline.calc_sigma(0)), u.unit),
                       make_words(u.name)});
  }
  return numbers;
}

}  // namespace

void write_compare_report(const CompareFolder& folder, const CampaignData& data,
                          const Comparison& comparison, const std::vector<std::string>& tables) {
  const FigureDrawer drawer(folder.make());
  ReportPage page;
  page.title = "Measured against simulated: " + data.campaign.path.filename().string();
  page.lead = {make_verdict_text(data, comparison)};
  page.badge = comparison.is_adequate() ? ReportBadge{"adequate", Tone::kGood}
                                        : ReportBadge{"not adequate", Tone::kBad};
  page.key_numbers = make_key_numbers(data, comparison);
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
