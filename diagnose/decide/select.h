// Which effects the data ask for: the score test of all, fits of the best, thresholds from nulls of
// this data set, runs that are held out, adding, swapping and dropping.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/discrepancy/leftover.h"
#include "diagnose/hypothesis/test_bench.h"
#include "diagnose/noise/hold_out.h"
#include "diagnose/noise/whitened_fit.h"

namespace strut {

struct SelectOptions {
  int threads = 1;
  /// Where noise is what is left; and where the model lacks far more than noise.
  int most_causes = 2, most_causes_dominated = 3;
  std::size_t fitted = 8;     // of the best by score, that are fitted
  double confidence = 0.999;  // of the threshold: share of nulls whose best effect stays below
  std::size_t nulls = 2000;
  /// Thresholds are raised by this factor for what the noise model does not know; measured on
  /// hidden trials that hide nothing.
  double margin = 1.25;
  /// Fractions of the noise's power: a cause that explains less is not claimed, as no model is that
  /// exact, that of a car less than that of a rig. The last of the road's power, as linear
  /// responses are not exact either.
  double negligible = 1e-3, negligible_car = 2.5e-3, negligible_road = 3e-5;
  /// A second cause explains at least this share of what the first does; less is told from a first
  /// cause of another form than the catalogue's.
  double second_share = 0.1;
  LeftoverOptions leftover;
  /// A cause gains per reading of the runs held out at least this share of what it gains per
  /// reading of those it was fitted to, and it stays among the best without each of at least this
  /// share of the runs.
  double hold_out_share = 0.3, stability = 0.5;
  /// A cause that gains so many times its threshold must do neither: its score, to first order, may
  /// tell less than its fit, and held-out runs may have smaller amplitudes. Any gain there will do.
  double certain = 3.0;
  /// Where the model lacks far more than noise, a cause takes at least this share of all that is
  /// left, and half as much of what is left of the runs held out.
  double dominated_share = 0.15;
  std::function<void(const std::string&)> progress;  // what is being done
};

/// A hypothesis that was fitted in one round.
struct Candidate {
  Hypothesis hypothesis;
  double score = 0.0;                 // chi2's fall to first order
  double gain = 0.0;                  // of the fit
  std::vector<double> values, sigma;  // of its parameters
  std::vector<double> base_values;    // of the base's unknowns in the same fit
  SharedValues shared;                // all that runs share, the hypothesis' parameters behind
  double stability = 0.0;             // share of the runs without which it stays among the best
  long simulations = 0;
};

/// One round: what was tried upon the model of that round.
struct SelectRound {
  std::vector<Candidate> candidates;  // best first
  double threshold = 0.0;             // of a gain
  bool accepted = false;              // its best became a cause
  double misfit = 1.0;                // gains are divided by it: what is left over its expectation
};

struct Selection {
  WhitenedFit base, extended;         // without and with the causes
  std::vector<Hypothesis> causes;     // in the order in which they were found
  std::vector<std::size_t> round_of;  // of each cause
  std::vector<double> gains;          // of each, in its round
  Leftover left;                      // of the extended model
  bool is_left = false;               // more than noise is
  std::vector<SelectRound> rounds;    // one a cause, and the last that found none
  std::vector<HoldOutRun> hold_out_before, hold_out_after;
  std::shared_ptr<const HoldOutJudge> judge;
  long simulations = 0;
};

Selection select_causes(const CampaignData& data, const SelectOptions& options);

/// The gain that `confidence` of all nulls stay below: the best of all trials, each allowed only
/// its own sign where `one_sided`.
double calc_null_threshold(const Evidence& evidence, const Score& score,
                           const std::vector<bool>& one_sided, std::size_t nulls,
                           double confidence);

}  // namespace strut
