// The one test of adequacy: a model is adequate if it agrees with every channel of every run,
// fitted or held out, within its noise. `strut compare` and `strut diagnose` apply it to the
// calibrated model, `strut diagnose` also to the extended one.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "diagnose/campaign/campaign_data.h"
#include "diagnose/noise/noise_floor.h"

namespace strut {

/// A residual against its noise.
struct ChannelAdequacy {
  NoiseFloor floor;
  std::size_t count = 0;  // readings
  double rms = 0.0;       // of the residual

  double calc_times_noise() const { return rms / floor.sigma; }
  /// Maximum of calc_times_noise() of an adequate channel.
  double calc_limit() const { return 1.0 + calc_floor_tolerance(floor, count); }
  /// False without readings, and for anything that is not finite.
  bool is_adequate() const { return count > 0 && calc_times_noise() <= calc_limit(); }
};

/// A fitted value far from its prior: in standard deviations of the prior.
struct PriorConflict {
  std::size_t run = 0;     // of the campaign; any for a value that all runs share
  bool is_shared = false;  // by all runs
  std::string name, unit;
  double value = 0.0, mean = 0.0, sigma = 0.0;

  double calc_distance() const { return std::abs(value - mean) / sigma; }
};

/// Distances from the prior that are reported, and that contradict the model.
inline constexpr double kReportedDistance = 3.0, kMaxDistance = 5.0;

/// The values further than kReportedDistance from a stated prior, by unknown. `run`: of the
/// campaign.
std::vector<PriorConflict> list_prior_conflicts(const std::vector<Unknown>& unknowns,
                                                const std::vector<double>& values, std::size_t run);

/// "bump_length in pull.csv is 0.498 m, 24.5 standard deviations from its prior 0.4 +/- 0.004 m"
std::string describe_conflict(const CampaignData& data, const PriorConflict& conflict);

/// Why a run contradicts a model.
struct Misfit {
  std::size_t run = 0;  // of the campaign
  std::string failure;  // the model cannot simulate the run, or a value contradicts its prior; else
                        // empty: the residual of a channel exceeds its noise
  int channel = -1;     // index in ModelInfo::channels
  double times_noise = 0.0, limit = 0.0, rms = 0.0, nrmse = 0.0;
};

/// "pull.csv (held out)"
std::string name_run(const CampaignData& data, std::size_t run);

/// "force in pull.csv (held out) is 22 times its noise"; for a run without simulation its failure.
std::string describe_misfit(const CampaignData& data, const Misfit& misfit);

/// The misfit that exceeds its limit most, failures first; null where there is none.
const Misfit* find_worst(const std::vector<Misfit>& misfits);

/// Whether every misfit is of a held-out run: the runs for fitting do not show what the model
/// lacks.
bool are_held_out(const CampaignData& data, const std::vector<Misfit>& misfits);

}  // namespace strut
