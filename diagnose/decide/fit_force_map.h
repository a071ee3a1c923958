// A force in a strut that no effect of the catalogue explains, fitted as a map over deflection and
// velocity (model/effects/force_map.h) together with all that the model may adjust.
//
// Shapes of the map are chosen where the strut was (map_basis.h), their sizes by the readings
// (map_prior.h), anew in every step of Gauss-Newton. Runs held out decide between places, and
// whether there is a map.
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
  /// ln of the odds: of the readings with a map over those without one; of the runs held out, by
  /// which a map is kept, and by which it stands for the causes instead of beside them.
  double log_odds = 3.0;
  /// A map takes at least this share of what the held-out runs have beyond noise.
  double least_share = 0.1;
  /// Causes that take more than this share of what a map alone takes stay: their form is
  /// incomplete, not their name.
  double causes_share = 0.5;
  std::function<void(const std::string&)> progress;  // what is being done
};

/// A map at one place.
struct ForceMapFit {
  VisitedStates states;            // where the strut was, and the place
  bool replaces_causes = false;    // or stands beside them
  WhitenedFit fit;                 // with the map
  std::vector<HoldOutRun> judged;  // runs held out
  /// Share of what the runs held out have beyond noise that the map takes.
  double share = 0.0;
};

/// The map at one place beside what `base` has, from runs for fitting alone; null where the
/// readings do not ask for one, or the strut does not move.
std::optional<WhitenedFit> fit_force_map(const CampaignData& data, const WhitenedFit& base,
                                         const VisitedStates& states,
                                         const ForceMapOptions& options = {});

/// The best map of all places, beside the causes of a selection or instead of them; null where the
/// runs held out say that none is better.
std::optional<ForceMapFit> choose_force_map(const CampaignData& data, const Selection& selection,
                                            const ForceMapOptions& options = {});

/// Force maps of the model's file and of unknowns.
ForceMaps list_force_maps_on(const CampaignData& data, const SharedValues& shared);

/// 1 sigma of the map's force [N] at a deflection and velocity: of what the fit tells of its
/// shapes.
double calc_map_sigma(const WhitenedFit& fit, double deflection, double velocity);

}  // namespace strut
