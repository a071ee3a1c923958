// A campaign with the contents of its files: runs in SI that a model can be fitted to.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnose/campaign/campaign.h"
#include "diagnose/campaign/measured_table.h"
#include "diagnose/campaign/noise_model.h"
#include "estimate/linearize_options.h"
#include "estimate/measured_run.h"
#include "estimate/reading_model.h"

namespace strut {

struct CampaignData {
  Campaign campaign;
  std::vector<MeasuredTable> tables;  // by run
  std::vector<MeasuredRun> runs;      // by run
  std::vector<NoiseEstimate> noise;   // by column of the campaign; empty for inputs
  std::vector<std::string> notes;     // for the user

  const ModelInfo& model() const { return *campaign.info; }
  /// Whether recorded inputs drive the runs; if not, a road of unknown roughness does.
  bool has_inputs() const { return model().is_driven_by_inputs(); }
  std::size_t run_count() const { return campaign.runs.size(); }
  const std::vector<MeasuredChannel>& channels(std::size_t run) const { return runs[run].channels; }
  /// On the clock of the readings [s].
  const std::vector<double>& times(std::size_t run) const { return runs[run].times; }
  const ChannelInfo& info(int channel) const {
    return model().channels[static_cast<std::size_t>(channel)];
  }
  /// The input that a column records.
  const InputInfo& get_input(const CampaignColumn& column) const;
  const NoiseEstimate& find_noise(int channel) const;
  /// The runs with these indices.
  std::vector<MeasuredRun> select(const std::vector<std::size_t>& chosen) const;
  /// Indices of the runs for this use.
  std::vector<std::size_t> list_runs(RunUse use) const;
};

/// The recorded input of this name of a run that recorded inputs drive; null where it lacks it.
const InputSignal* find_input(const MeasuredRun& run, const std::string& name);

/// The campaign with a single one of its runs.
CampaignData take_run(const CampaignData& data, std::size_t run);

/// Whether a run crosses a bump, not only a rough road; always true for a run that recorded inputs
/// drive.
bool meets_bump(const CampaignData& data, std::size_t run);

/// Reads the campaign, its model with the values of `[fit] fix`, and every run. Throws InputError
/// as campaign.h, measured_table.h and check_campaign_data.h say.
CampaignData read_campaign_data(const std::filesystem::path& path);

/// The readings of `runs` against their simulation.
std::unique_ptr<ReadingModel> make_reading_model(const CampaignData& data,
                                                 const std::vector<std::size_t>& runs,
                                                 std::vector<Unknown> unknowns, int threads = 1);
/// The same for runs that were changed since they were read; derivatives by differences of this
/// relative step.
std::unique_ptr<ReadingModel> make_reading_model(
    std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns, int threads = 1,
    double relative_step = LinearizeOptions{}.relative_step);

/// The samples of an input as a signal: a spline, or smoothed. Throws ModelError as make_signal
/// does.
InputSignal make_sampled_input(const std::string& channel, const std::vector<double>& times,
                               const std::vector<double>& values, const LocalPolynomial& smoothing);

}  // namespace strut
