// A campaign with everything its files say: runs in SI that a model can be fitted to.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnose/campaign/campaign.h"
#include "diagnose/campaign/measured_table.h"
#include "diagnose/campaign/noise_model.h"
#include "estimate/measured_run.h"
#include "estimate/reading_model.h"

namespace strut {

struct CampaignData {
  Campaign campaign;
  std::vector<MeasuredTable> tables;  // one a run
  std::vector<MeasuredRun> runs;      // one a run
  std::vector<NoiseEstimate> noise;   // one a column of the campaign; inputs have none
  std::vector<std::string> notes;     // for the user

  const ModelInfo& model() const { return *campaign.info; }
  /// Whether recorded inputs drive the runs; if not, a road whose roughness nobody measured.
  bool has_inputs() const { return model().is_driven_by_inputs(); }
  std::size_t run_count() const { return campaign.runs.size(); }
  const std::vector<MeasuredChannel>& channels(std::size_t run) const { return runs[run].channels; }
  /// s on the clock of the readings.
  const std::vector<double>& times(std::size_t run) const { return runs[run].times; }
  const ChannelInfo& info(int channel) const {
    return model().channels[static_cast<std::size_t>(channel)];
  }
  const NoiseEstimate& find_noise(int channel) const;
  /// Numbers of the runs for this use.
  std::vector<std::size_t> list_runs(RunUse use) const;
};

/// The campaign of one of its runs.
CampaignData take_run(const CampaignData& data, std::size_t run);

/// Whether a run meets more than a road's roughness; what recorded inputs drive always does.
bool meets_bump(const CampaignData& data, std::size_t run);

/// Reads the campaign, its model with what `[fit] fix` sets, and every run. Throws InputError for
/// whatever campaign.h, measured_table.h and check_campaign_data.h refuse.
CampaignData read_campaign_data(const std::filesystem::path& path);

/// What `[fit] free` names, with its priors, and the gains of inputs that are not known exactly:
/// the same for all of `runs`.
std::vector<Unknown> make_free_unknowns(const CampaignData& data,
                                        const std::vector<std::size_t>& runs);

/// What an unknown that all runs share is in the model's file.
double get_nominal(const CampaignData& data, const Unknown& unknown);

/// The nuisances of `runs` (make_nuisances), with the priors that the campaign gives for single
/// runs. Unknown::run counts within `runs`. What is in `chosen` is left out.
std::vector<Unknown> make_run_unknowns(const CampaignData& data,
                                       const std::vector<std::size_t>& runs,
                                       const std::vector<Unknown>& chosen);

/// The readings of `runs` against their simulation.
std::unique_ptr<ReadingModel> make_reading_model(const CampaignData& data,
                                                 const std::vector<std::size_t>& runs,
                                                 std::vector<Unknown> unknowns, int threads = 1);

/// The samples of an input as a signal: a spline, or local cubics of `half_width` [s] > 0. Throws
/// ModelError as make_signal does.
InputSignal make_sampled_input(const std::string& channel, const std::vector<double>& times,
                               const std::vector<double>& values, double half_width);

}  // namespace strut
