#include "jobs/diagnose/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/diagnose/figures.h"
#include "jobs/diagnose/tables.h"
#include "report/figures.h"
#include "report/page_file.h"

namespace strut {
namespace {

std::vector<std::string> make_lead(const Diagnosis& diagnosis) {
  std::vector<std::string> lead = {diagnosis.sentence};
  for (const std::string& line : describe_effects(diagnosis.verdict)) lead.push_back(line);
  const std::string where = make_where_text(diagnosis.where);
  if (!where.empty()) lead.push_back(where);
  if (!diagnosis.next_measurement.empty()) {
    lead.push_back("Next measurement: " + diagnosis.next_measurement + ".");
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

/// The verdict in a few words; of one cause or group, with its probability.
ReportBadge make_badge(const Verdict& verdict) {
  const std::string probability =
      verdict.positions.size() == 1
          ? fmt::format(", probability {:.2f}", verdict.positions.front().calc_claimed())
          : "";
  switch (verdict.kind) {
    case VerdictKind::kAdequate:
      return {"model adequate", Tone::kGood};
    case VerdictKind::kNamed:
      return {"cause found" + probability, Tone::kGood};
    case VerdictKind::kGroup:
      return {"one of a group" + probability, Tone::kWarning};
    case VerdictKind::kFormIncomplete:
      return {"cause found, form incomplete", Tone::kWarning};
    case VerdictKind::kUnknown:
      break;
  }
  return {"cause unknown", Tone::kBad};
}

/// The first cause's size, the improvement, and the residual beside the noise.
std::vector<KeyNumber> make_key_numbers(const Diagnosis& diagnosis) {
  std::vector<KeyNumber> numbers;
  if (!diagnosis.verdict.positions.empty()) {
    const CausePosition& position = diagnosis.verdict.positions.front();
    const Cause& cause = position.get_cause();
    const std::string name =
        make_words(cause.effect + (cause.place.empty() ? "" : ", ") + cause.place);
    if (!cause.parameters.empty()) {
      const CauseParameter& p = cause.parameters.front();
      const std::string unit = p.unit.empty() || p.unit == "1" ? "" : " " + p.unit;
      numbers.push_back({describe_interval(p.value, p.low, p.high) + unit,
                         fmt::format("{}: {}", name, make_words(p.key))});
    }
  }
  if (const auto& explained = diagnosis.improvement.explained; explained) {
    numbers.push_back({fmt::format("{:.0f} %", 100.0 * *explained),
                       "of the excess error on held-out runs removed"});
  }
  double worst = 0.0;
  std::string channel;
  for (const ChannelImprovement& c : diagnosis.improvement.channels) {
    const double ratio = c.noise_floor > 0.0 ? c.rms_after / c.noise_floor : 0.0;
    if (ratio > worst) channel = c.channel;
    worst = std::max(worst, ratio);
  }
  if (!channel.empty()) {
    numbers.push_back({worst <= 1.0 ? "within the noise" : fmt::format("{:.2g} x noise", worst),
                       "residual on held-out runs, worst channel: " + make_words(channel)});
  }
  return numbers;
}

ReportPage make_page(const CampaignData& data, const Diagnosis& diagnosis,
                     const FigureDrawer& drawer) {
  ReportPage page{"Diagnosis: " + data.campaign.path.filename().string(),
                  make_lead(diagnosis),
                  {},
                  make_report_footer()};
  page.badge = make_badge(diagnosis.verdict);
  page.key_numbers = make_key_numbers(diagnosis);
  std::vector<ReportSection>& sections = page.sections;
  ReportSection proof{"Before and after"};
  drawer.draw_all(make_law_charts(data, diagnosis), proof);
  drawer.draw_all(make_improvement_charts(diagnosis), proof);
  ReportTable improvement = make_improvement_table(data, diagnosis);
  improvement.is_folded = !proof.figures.empty();
  proof.tables.push_back(std::move(improvement));
  sections.push_back(std::move(proof));
  const std::vector<ReportTable> causes = make_cause_tables(diagnosis);
  if (!causes.empty()) {
    sections.push_back({"Causes", {}, causes});
    drawer.draw_all(make_cause_charts(diagnosis), sections.back());
  }
  ReportSection map{"Force map"};
  drawer.draw_all(make_map_charts(diagnosis), map);
  if (!map.figures.empty()) sections.push_back(std::move(map));
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
