// A force in a strut that no effect of the catalogue explains, fitted as a map over deflection and
// velocity (model/effects/force_map.h) together with all adjustable parameters of the model.
//
// The visited states determine the shapes of the map (map_basis.h), the readings their sizes
// (map_prior.h), updated in every Gauss-Newton step. The held-out runs decide between locations,
// and whether a map is accepted.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline/visited_states.h"
#include "diagnose/decide/select.h"
#include "diagnose/discrepancy/map_basis.h"

namespace strut {

struct ForceMapOptions {
  int threads = 1;
  MapGridOptions grid;
  /// Minimum log odds: of the fitted readings with a map against those without; of the held-out
  /// runs, for a map to be kept, and for it to replace the causes instead of complementing them.
  double log_odds = 3.0;
  /// Minimum fraction of the held-out runs' excess over noise that a map removes.
  double least_share = 0.1;
  /// Causes that remove more than this fraction of what a map alone removes are kept: their form is
  /// incomplete, but they are named correctly.
  double causes_share = 0.5;
  std::function<void(const std::string&)> progress;  // called with the name of each stage
};

/// A map at one location.
struct ForceMapFit {
  VisitedStates states;            // of the strut, with its location
  bool replaces_causes = false;    // false: complements them
  WhitenedFit fit;                 // with the map
  std::vector<HoldOutRun> judged;  // held-out runs
  /// Fraction of the held-out runs' excess over noise that the map removes.
  double share = 0.0;
};

/// Fits a map at one location, in addition to the model of `base`, to the runs for fitting. Null
/// where the readings do not support a map, or the strut does not move.
std::optional<WhitenedFit> fit_force_map(const CampaignData& data, const WhitenedFit& base,
                                         const VisitedStates& states,
                                         const ForceMapOptions& options = {});

/// Returns the best map of all locations, in addition to the causes of a selection or instead of
/// them; null where no map improves the held-out runs.
std::optional<ForceMapFit> choose_force_map(const CampaignData& data, const Selection& selection,
                                            const ForceMapOptions& options = {});

/// Lists the force maps of the model's file with the shared unknowns set.
ForceMaps list_force_maps_on(const CampaignData& data, const SharedValues& shared);

/// Standard error of the map's force at a deflection [m] and velocity [m/s] [N], from the
/// uncertainty of its fitted shapes.
double calc_map_sigma(const WhitenedFit& fit, double deflection, double velocity);

}  // namespace strut
