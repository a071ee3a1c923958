// The verdict: which causes are claimed, with which alternatives and probabilities. Sentence,
// tables, verdict.json and extended.toml derive from this one result; check_verdict has its
// invariants.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/compare/adequacy.h"
#include "diagnose/decide/select.h"

namespace strut {

enum class VerdictKind { kAdequate, kNamed, kGroup, kFormIncomplete, kUnknown };
/// "adequate", "named", "group", "form_incomplete", "unknown"
const char* get_name(VerdictKind kind);
/// One word for a person: "adequate", "cause", "group", "incomplete", "unknown"
const char* get_badge(VerdictKind kind);

struct CauseParameter {
  std::string key, unit;                      // as in a model file: "asymmetry"
  double value = 0.0, low = 0.0, high = 0.0;  // with 95 % interval
  bool at_bound = false;                      // the value is a limit of the plausible range
};

struct Cause {
  std::string effect, place;
  double probability = 0.0;
  double delta_chi2 = 0.0;  // fall of chi2 with the effect
  std::vector<CauseParameter> parameters;
  EffectChange change = EffectChange::kAdded;
  bool converged = true;  // the fit from which probability and delta chi2 follow
};

bool is_same(const Cause& a, const Cause& b);
bool is_in(const std::vector<Cause>& causes, const Cause& cause);

/// One position of the extended model: the candidates of which one acts there. Causes of different
/// positions act together.
struct CausePosition {
  std::vector<Cause> candidates;  // most probable first
  std::size_t close = 1;          // the first so many are not distinguished
  std::size_t chosen = 0;         // the one in the extended model; below `close`
  double unknown = 0.0;           // 1 less the sum of the candidates' probabilities
  /// Whether the remaining error of the model, not the noise, is why they are not distinguished.
  bool is_limited_by_form = false;

  const Cause& get_cause() const { return candidates[chosen]; }
  std::vector<Cause> list_close() const;
  double calc_claimed() const;  // probability that one of the close candidates acts
};

struct Verdict {
  VerdictKind kind = VerdictKind::kAdequate;
  /// The claim; empty where no cause is claimed.
  std::vector<CausePosition> positions;
  std::vector<Cause> rejected;  // fitted candidates where no cause is claimed
  double unknown_share = 0.0;   // probability that the cause is none of the catalogue
  std::vector<Misfit> misfits;  // of the model with all that is claimed

  std::vector<Cause> list_causes() const;      // those of the extended model
  std::vector<Cause> list_group() const;       // all that are not distinguished, causes included
  std::vector<Cause> list_runners_up() const;  // all other candidates, each once

  /// Claims nothing: all candidates become rejected ones.
  void reject(double unknown);
  /// Sets the kind. `is_residual_significant`: of the model with the claim, in the runs for
  /// fitting.
  void conclude(bool is_residual_significant, bool has_map);
};

/// What the kind of a verdict depends on.
struct VerdictFacts {
  bool has_causes = false, has_group = false, has_map = false;
  bool is_residual_significant = false;  // in the runs for fitting, of the model with the claim
  bool is_adequate = false;              // by the one test (adequacy.h), of the same model
};
VerdictKind judge(const VerdictFacts& facts);

/// Probability that the cause is none of the catalogue. A cause of another form leaves a fraction
/// of itself as residual; a larger residual has another cause. `map_fraction`: fraction of the
/// residual that a force map explains.
double calc_unknown(const Selection& selection, double map_fraction = 0.0);

/// The claim of a selection, without its kind: its causes where at every position some candidate is
/// more probable than none of the catalogue; otherwise nothing.
Verdict make_claim(const ModelInfo& model, const Selection& selection, double map_fraction = 0.0);

/// Ends the program with a report (STRUT_CHECK) where the verdict contradicts itself: probabilities
/// outside of [0, 1] or, at a position, of a sum other than 1; a claim less probable than none; a
/// kind that does not follow from the claim.
void check_verdict(const Verdict& verdict, bool has_map);

}  // namespace strut
