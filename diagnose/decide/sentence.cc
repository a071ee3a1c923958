#include "diagnose/decide/sentence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/decide/improvement.h"

namespace strut {
namespace {

std::string join(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

std::vector<std::string> list_names(const std::vector<Cause>& causes) {
  std::vector<std::string> names;
  names.reserve(causes.size());
  for (const Cause& cause : causes) {
    names.push_back(describe_effect(cause.effect, cause.place, cause.change));
  }
  return names;
}

/// "damper_asymmetry at rear", or "one of A, B, which these runs cannot distinguish"
std::string describe_position(const CausePosition& position) {
  const std::vector<std::string> names = list_names(position.list_close());
  if (names.size() == 1) return names.front();
  return fmt::format("one of {}, {}", join(names, ", "),
                     position.is_limited_by_form
                         ? "between which the remaining error of the model does not decide"
                         : "which these runs cannot distinguish");
}

/// "Cause: A." or "Causes, which act together: A; and one of B, C, which ..."
std::string describe_claim(const std::vector<CausePosition>& positions) {
  std::vector<std::string> parts;
  parts.reserve(positions.size());
  for (const CausePosition& p : positions) parts.push_back(describe_position(p));
  return fmt::format("{}: {}.", parts.size() > 1 ? "Causes, which act together" : "Cause",
                     join(parts, "; and "));
}

/// "97 %", "99.6 %": 100 only where nothing remains.
std::string format_percent_of(double fraction) {
  const double percent = 100.0 * fraction;
  return percent > 99.0 && percent < 100.0 ? fmt::format("{:.1f} %", std::min(percent, 99.9))
                                           : fmt::format("{:.0f} %", percent);
}

/// "Adding A and B", or "The extended model (without A)" where an effect of the file is another.
std::string describe_change(const Diagnosis& diagnosis) {
  const std::vector<Cause> causes = diagnosis.verdict.list_causes();
  const bool are_added = std::all_of(causes.begin(), causes.end(), [](const Cause& cause) {
    return cause.change == EffectChange::kAdded;
  });
  const std::string extension = describe_extension(diagnosis);
  return are_added ? "Adding " + extension : fmt::format("The extended model ({})", extension);
}

/// "Adding A removes 97 % of the excess error on the held-out runs."
std::string describe_improvement(const Diagnosis& diagnosis) {
  constexpr double kVisible = 0.005;
  const Improvement& improvement = diagnosis.improvement;
  const std::string change = describe_change(diagnosis);
  const double log_odds = 0.5 * improvement.hold_out.fall;
  // The readings of all channels together show what no channel shows alone.
  if (log_odds < 0.0) {
    return fmt::format(
        "{} lowers the log-likelihood of the held-out runs by {:.2g}, within three standard "
        "deviations of noise.",
        change, -log_odds);
  }
  if (!improvement.explained || *improvement.explained < kVisible) {
    return fmt::format("{} raises the log-likelihood of the held-out runs by {:.3g}.", change,
                       log_odds);
  }
  return fmt::format("{} removes {} of the excess error on the held-out runs.", change,
                     format_percent_of(*improvement.explained));
}

/// The dependence of the force map, or the place and band of the residual of the model with all
/// that is claimed.
std::string describe_residual(const Diagnosis& diagnosis) {
  if (diagnosis.force) {
    const std::string& place = diagnosis.force->place;
    return fmt::format("a force in the {} that depends on {}",
                       place.empty() ? "strut" : place + " struts", diagnosis.force->depends.words);
  }
  const Where& where = diagnosis.where;
  if (where.band.empty() || !is_significant(diagnosis.selection.left)) return "";
  return where.place.empty() ? "at " + where.band
                             : fmt::format("acting at {}, at {}", where.place, where.band);
}

/// "A fits the runs for fitting, but ..."; empty where nothing was refused.
std::string describe_refusal(const Selection& selection) {
  const std::string& name = selection.refused;
  switch (selection.refusal) {
    case Refusal::kContradicted:
      return name + " fits the runs for fitting, but the held-out runs contradict it";
    case Refusal::kUnstable:
      return name + " fits the runs for fitting, but less well than others without single runs";
    case Refusal::kImplausible:
      return "effects of the catalogue fit only with values that they cannot have";
    case Refusal::kSmall:
      return name + " fits what remains, but explains too little to be a cause of its own";
    case Refusal::kNone:
      break;
  }
  return "";
}

/// " Incomplete: ..." with the channel that remains furthest above its noise.
std::string describe_remainder(const CampaignData& data, const Diagnosis& diagnosis) {
  std::string text;
  const Misfit* worst = find_worst(diagnosis.verdict.misfits);
  const std::string residual = describe_residual(diagnosis);
  if (!residual.empty()) text += residual;
  if (worst != nullptr) text += (text.empty() ? "" : "; ") + describe_misfit(data, *worst);
  const std::string refused = describe_refusal(diagnosis.selection);
  if (!refused.empty()) text += (text.empty() ? "" : "; ") + refused;
  const std::vector<std::string> worsened = list_worsened(data, diagnosis.runs);
  if (!worsened.empty()) text += "; it worsens " + join(worsened, ", ");
  return text;
}

/// The sentence where no effect of the catalogue is claimed.
std::string describe_unknown(const CampaignData& data, const Diagnosis& diagnosis) {
  const Verdict& verdict = diagnosis.verdict;
  if (!diagnosis.selection.is_left && are_held_out(data, verdict.misfits)) {
    return fmt::format(
        "Cause: unknown. The calibrated model agrees with the runs for fitting, but not with the "
        "held-out runs: {}. The runs for fitting do not show the cause.",
        describe_misfit(data, *find_worst(verdict.misfits)));
  }
  const std::string remainder = describe_remainder(data, diagnosis);
  // Unstable fits do not exclude the catalogue.
  const bool is_open = diagnosis.selection.refusal == Refusal::kUnstable;
  const std::string unknown = (is_open ? "Cause: unknown" : "Cause: none of the catalogue") +
                              (remainder.empty() ? "" : "; " + remainder) + ".";
  return diagnosis.force ? unknown + " " + describe_improvement(diagnosis) : unknown;
}

}  // namespace

std::string name_strut(const std::string& place) { return place.empty() ? "strut" : place; }

std::string describe_extension(const Diagnosis& diagnosis) {
  std::vector<std::string> parts = list_names(diagnosis.verdict.list_causes());
  if (diagnosis.force) parts.emplace_back("the force map");
  return join(parts, " and ");
}

std::string write_sentence(const CampaignData& data, const Diagnosis& diagnosis) {
  const Verdict& verdict = diagnosis.verdict;
  switch (verdict.kind) {
    case VerdictKind::kAdequate:
      return "The calibrated model is adequate: every channel of every run agrees with it within "
             "its noise, and no effect of the catalogue exceeds the noise.";
    case VerdictKind::kNamed:
    case VerdictKind::kGroup:
      return describe_claim(verdict.positions) + " " + describe_improvement(diagnosis);
    case VerdictKind::kFormIncomplete:
      return fmt::format("{} Incomplete: {}. {}", describe_claim(verdict.positions),
                         describe_remainder(data, diagnosis), describe_improvement(diagnosis));
    case VerdictKind::kUnknown:
      break;
  }
  return describe_unknown(data, diagnosis);
}

}  // namespace strut
