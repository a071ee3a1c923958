// Runs that the recorded ones show to be possible: a crank has one stroke, a plate its travel, a
// road the bumps that are on it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/campaign/campaign_data.h"

namespace strut {

/// A run that could be recorded: an existing one with another motion of the rig's inputs, another
/// speed of the car or another bump.
struct PossibleRun {
  std::string description;  // "repeat RUN at 2 times its amplitude"
  std::size_t of = 0;       // the existing run
  CampaignData data;        // with that run alone, changed
};

/// Variants of an existing run.
///
/// Rig: its moving inputs times one factor, where travel (peak to peak) and mean square rate of
/// each stay within those of the recorded runs. None where all have the same travel, as on a crank.
/// Car: its bump, and those of other runs, at speeds up to the fastest recorded one, in whole km/h;
/// the car reaches the bump at the same time.
std::vector<PossibleRun> list_possible_runs(const CampaignData& data, std::size_t run);

}  // namespace strut
