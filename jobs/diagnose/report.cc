#include "jobs/diagnose/report.h"

#include <fmt/format.h>

#include "jobs/diagnose/figures.h"
#include "jobs/diagnose/tables.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

std::vector<std::string> make_lead(const Diagnosis& diagnosis) {
  std::vector<std::string> lead = {
      fmt::format("[{}] {}", get_badge(diagnosis.verdict.kind), diagnosis.sentence)};
  for (const std::string& line : describe_effects(diagnosis.verdict)) lead.push_back(line);
  const std::string where = make_where_text(diagnosis.where);
  if (!where.empty()) lead.push_back(where);
  if (!diagnosis.next_measurement.empty()) {
    lead.push_back("Next measurement: " + diagnosis.next_measurement);
  }
  if (diagnosis.is_extended()) {
    lead.push_back(
        fmt::format("{} is the model with the causes switched on at their fitted values, and with "
                    "the force map if there is one. It can be used as any model file.",
                    kExtendedModelFile));
  }
  return lead;
}

ReportSection make_run_section(const CampaignData& data, const Diagnosis& diagnosis,
                               const DiagnosedRun& run, const FigureDrawer& drawer) {
  ReportSection section{data.campaign.runs[run.run].name + ", held out"};
  for (const ModelCurves& model : list_model_curves(diagnosis, run)) {
    const std::string& failure = model.evaluation->failure;
    if (!failure.empty()) section.paragraphs.push_back(model.name + ": " + failure);
  }
  drawer.draw_all(make_run_charts(data, diagnosis, run), section);
  return section;
}

void add_list(const std::string& heading, const std::vector<std::string>& texts,
              std::vector<ReportSection>& sections) {
  if (!texts.empty()) sections.push_back({heading, texts});
}

ReportPage make_page(const CampaignData& data, const Diagnosis& diagnosis,
                     const FigureDrawer& drawer) {
  ReportPage page{"Diagnosis: " + data.campaign.path.filename().string(),
                  make_lead(diagnosis),
                  {},
                  make_report_footer()};
  std::vector<ReportSection>& sections = page.sections;
  const std::vector<ReportTable> causes = make_cause_tables(diagnosis);
  if (!causes.empty()) {
    sections.push_back({"Causes", {}, causes});
    drawer.draw_all(make_cause_charts(diagnosis), sections.back());
  }
  ReportSection map{"Force map"};
  drawer.draw_all(make_map_charts(diagnosis), map);
  if (!map.figures.empty()) sections.push_back(std::move(map));
  sections.push_back(
      {"Improvement on held-out runs", {}, {make_improvement_table(data, diagnosis)}});
  drawer.draw_all(make_improvement_charts(diagnosis), sections.back());
  for (const DiagnosedRun& run : diagnosis.runs) {
    if (data.campaign.runs[run.run].use != RunUse::kHoldOut) continue;
    sections.push_back(make_run_section(data, diagnosis, run, drawer));
  }
  ReportSection motion{"Residuals by the motion"};
  drawer.draw_all(make_motion_charts(data, diagnosis), motion);
  if (!motion.figures.empty()) sections.push_back(std::move(motion));
  const std::vector<ReportTable> parameters = make_parameter_tables(diagnosis);
  if (!parameters.empty()) sections.push_back({"Parameters", {}, parameters});
  add_list("Not identifiable from these runs", diagnosis.not_identifiable, sections);
  std::vector<std::string> notes = data.notes;
  notes.insert(notes.end(), diagnosis.notes.begin(), diagnosis.notes.end());
  for (const PriorConflict& c : diagnosis.conflicts) notes.push_back(describe_conflict(data, c));
  add_list("Notes", notes, sections);
  return page;
}

}  // namespace

void write_diagnose_report(const DiagnoseFolder& folder, const CampaignData& data,
                           const Diagnosis& diagnosis, const std::vector<std::string>& tables) {
  const FigureDrawer drawer(folder.make());
  ReportPage page = make_page(data, diagnosis, drawer);
  page.of = kDiagnosisContent.name;
  page.tables = tables;
  write_page(folder, page);
}

}  // namespace strut
