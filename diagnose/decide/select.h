// Selects the effects that explain the data: score test of all hypotheses, fits of the best ones,
// thresholds from the null distribution for this data set, confirmation by the held-out runs;
// causes are added, swapped and dropped.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/decide/undetected.h"
#include "diagnose/discrepancy/leftover.h"
#include "diagnose/hypothesis/test_bench.h"
#include "diagnose/noise/hold_out.h"
#include "diagnose/noise/whitened_fit.h"

namespace strut {

struct SelectOptions {
  int threads = 1;
  /// Maximum number of causes; and where the model's error dominates the noise (kDominated).
  int most_causes = 2, most_causes_dominated = 3;
  std::size_t fitted = 8;     // number of hypotheses fitted, the best by score
  double confidence = 0.999;  // of the threshold: quantile of the best delta chi2 under the null
  std::size_t nulls = 2000;   // number of draws from the null distribution
  /// Factor on thresholds for errors of the noise model; measured on hidden trials without a fault.
  double margin = 1.25;
  /// A cause that explains less than this fraction of the noise's power is not claimed, since no
  /// model is that exact; a car's is less exact than a rig's. The last: fraction of the road's
  /// power, since linear responses are not exact either.
  double negligible = 1e-3, negligible_car = 2.5e-3, negligible_road = 3e-5;
  /// A second cause explains at least this fraction of what the first does; less cannot be
  /// distinguished from a first cause whose form deviates from the catalogue's.
  double second_share = 0.1;
  /// First fits of a round, to rank its hypotheses; and fits of the best.
  SearchEffort screening{15, 1.0}, convergence{60, 0.1};
  /// For rigs: number of classes of the first and of later rounds whose best hypotheses are scored
  /// together with a second effect; number of them that are fitted; number of second effects fitted
  /// beside each.
  std::size_t paired = 6, paired_later = 3, paired_fits = 3, partners = 2;
  LeftoverOptions leftover;
  /// Minimum fraction of the runs without each of which a cause remains among the best.
  double stability = 0.5;
  /// A cause with `certain` times the threshold is exempt from that, since its first-order score
  /// may be lower than its fit's delta chi2. Beside a first cause it has to explain `certain_share`
  /// of what that one does, in place of second_share.
  double certain = 3.0, certain_share = 0.035;
  /// Where the model's error dominates the noise: minimum fraction of the residual that a cause
  /// removes; half as much of that of the held-out runs.
  double dominated_share = 0.15;
  std::function<void(const std::string&)> progress;  // called with the name of each stage
};

/// A hypothesis that was fitted in one round.
struct Candidate {
  Hypothesis hypothesis;
  double score = 0.0;                 // delta chi2 to first order
  double gain = 0.0;                  // delta chi2 of the fit
  std::vector<double> values, sigma;  // of its parameters
  std::vector<double> base_values;    // of the base's unknowns in the same fit
  SharedValues shared;                // shared unknowns, the hypothesis' parameters last
  double stability = 0.0;             // fraction of the runs without each of which it is among the
                                      // best
  /// The fit's distance to its minimum in standard deviations, and whether it has converged; only
  /// fits that come near the best are continued until they do.
  double distance = 0.0;
  bool converged = false;
  std::size_t alias = 0;  // number of its class: hypotheses to which the readings respond alike
  long simulations = 0;
};

/// Why something that exceeds the threshold is not a cause.
enum class Refusal {
  kNone,
  kContradicted,  // by the held-out runs
  kUnstable,      // not among the best without single runs
  kImplausible,   // fitted values that the effect cannot have
  kSmall,         // beside the first cause
};

/// One round of the selection.
struct SelectRound {
  std::vector<Candidate> candidates;  // best first
  double threshold = 0.0;             // of Candidate::gain
  bool accepted = false;              // the best candidate became a cause
  Refusal refusal = Refusal::kNone;   // of the best candidate
  double misfit = 1.0;                // chi2 over its expectation, by which gains are divided
  /// Delta chi2 of the first candidate and another effect together, where pairs were looked for.
  double pair_gain = 0.0;
  double best_score = 0.0;  // delta chi2 to first order of the best hypothesis
  double p_value = 1.0;     // probability that noise, as large as the misfit, has such a best score
  /// Largest delta chi2 of a fit whose values are not such as its effect has: something is there,
  /// but not what the name says.
  double refused_gain = 0.0;
  std::vector<Undetected> undetected;  // all effects tested, for the intervals if none is a cause
  long simulations = 0;
};

struct Selection {
  WhitenedFit base, extended;          // without and with the causes
  std::vector<Hypothesis> causes;      // in the order in which they were found
  std::vector<std::size_t> round_of;   // index of each cause's round
  std::vector<double> gains;           // delta chi2 of each cause in its round
  Leftover left;                       // residual of the extended model
  bool is_left = false;                // the residual exceeds noise
  Refusal refusal = Refusal::kNone;    // of what exceeds the threshold beside the causes
  std::string refused;                 // its name
  std::vector<Undetected> undetected;  // effects beside the causes
  std::vector<SelectRound> rounds;     // in the order in which they were made
  std::vector<HoldOutRun> hold_out_before, hold_out_after;
  std::shared_ptr<const HoldOutJudge> judge;
  long simulations = 0;
};

Selection select_causes(const CampaignData& data, const SelectOptions& options);

}  // namespace strut
