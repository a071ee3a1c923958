#include "jobs/compare/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"

namespace strut {

std::vector<RecordingFinding> check_campaign(const CampaignData& data, int threads) {
  const Stage stage("check of the recordings");
  const ProgressLine line(fmt::format("checking {} recordings", data.run_count()));
  return check_recordings(data.runs, make_free_unknowns(data, data.list_runs(RunUse::kFit)),
                          threads);
}

namespace {

/// Whether a held-out run is a copy of one for fitting. Two copies of one use only count twice.
bool is_copied_hold_out(const CampaignData& data, const RecordingFinding& finding) {
  if (finding.kind != FindingKind::kCopy) return false;
  const auto& [first, second] = finding.copies;
  return data.campaign.runs[first].use != data.campaign.runs[second].use;
}

}  // namespace

void report_findings(const std::vector<RecordingFinding>& findings) {
  for (const RecordingFinding& finding : findings) print_note(finding.describe());
}

std::size_t check_before_fit(CampaignData& data, int threads) {
  const std::vector<RecordingFinding> findings = check_campaign(data, threads);
  for (const RecordingFinding& finding : findings) {
    if (is_copied_hold_out(data, finding)) throw InputError(finding.describe());
    data.notes.push_back("check of the recordings: " + finding.describe());
  }
  report_findings(findings);
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [](const RecordingFinding& finding) { return finding.is_mistake(); }));
}

void suggest_correction(std::size_t mistakes, const std::string& campaign) {
  print_note(mistakes == 1
                 ? std::string("the check of the recordings found a mistake (above), which "
                               "affects everything else: correct it first")
                 : fmt::format("the check of the recordings found {} mistakes (above), "
                               "which affect everything else: correct them first",
                               mistakes));
  suggest_next({"strut", "compare", campaign, "--check"}, "until nothing looks wrong");
}

Json make_check_json(const CampaignData& data, const std::vector<RecordingFinding>& findings) {
  Json list = Json::array();
  for (const RecordingFinding& f : findings) {
    list.push_back({{"kind", find_name(kFindingKinds, f.kind)},
                    {"run", f.run},
                    {"channel", f.channel},
                    {"size", f.size},
                    {"what", f.what},
                    {"advice", f.advice}});
  }
  return {{"runs", data.run_count()}, {"findings", std::move(list)}};
}

}  // namespace strut
