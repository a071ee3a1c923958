#include "diagnose/decide/sentence.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/format_number.h"

namespace strut {
namespace {

std::string join_causes(const std::vector<Cause>& causes, const std::string& between) {
  std::string text;
  for (const Cause& cause : causes) {
    text +=
        (text.empty() ? "" : between) + describe_effect(cause.effect, cause.place, cause.change);
  }
  return text;
}

std::string format_percent_of(double fraction) {
  return format_rounded(std::round(100.0 * fraction)) + " %";
}

/// "Adding it removes 97 % of the excess error on the held-out runs."
std::string describe_improvement(const Diagnosis& diagnosis, const std::string& added) {
  const std::optional<double>& explained = diagnosis.improvement.explained;
  // The readings of all channels together show what no channel shows alone.
  if (!explained) {
    return fmt::format("Adding {} makes the held-out runs exp({}) times as likely.", added,
                       format_rounded(std::round(diagnosis.improvement.log_odds)));
  }
  return fmt::format("Adding {} removes {} of the excess error on the held-out runs.", added,
                     format_percent_of(*explained));
}

std::string describe_map(const UnknownForce& force) {
  return fmt::format("Its force map removes {} of the remaining excess error on the held-out runs.",
                     format_percent_of(force.fraction));
}

/// The residual of the extended model: its dependence, or its place and band.
std::string describe_residual(const Diagnosis& diagnosis) {
  if (diagnosis.force) {
    const std::string& place = diagnosis.force->place;
    return fmt::format("a force in the {} that depends on {}",
                       place.empty() ? "strut" : place + " struts", diagnosis.force->depends.words);
  }
  const Where& where = diagnosis.where;
  return where.place.empty() ? "at " + where.band
                             : fmt::format("acting at {}, at {}", where.place, where.band);
}

}  // namespace

std::string name_strut(const std::string& place) { return place.empty() ? "strut" : place; }

std::string write_sentence(const Diagnosis& diagnosis) {
  const std::string causes = join_causes(diagnosis.causes, " and ");
  const bool are_several = diagnosis.causes.size() > 1;
  const char* head = are_several ? "Causes" : "Cause";
  const char* them = are_several ? "them" : "it";
  switch (diagnosis.kind) {
    case VerdictKind::kAdequate:
      return "The calibrated model is adequate: neither an effect of the catalogue nor anything "
             "else exceeds the noise.";
    case VerdictKind::kNamed:
      return fmt::format("{}: {}. {}", head, causes, describe_improvement(diagnosis, them));
    case VerdictKind::kGroup:
      return fmt::format("Cause: one of {}, which these runs cannot distinguish. {}",
                         join_causes(diagnosis.group, ", "),
                         describe_improvement(diagnosis, causes));
    case VerdictKind::kFormIncomplete:
      return fmt::format(
          "{}: {}, but the remaining residual exceeds noise: {}. {}", head, causes,
          describe_residual(diagnosis),
          diagnosis.force ? describe_map(*diagnosis.force) : describe_improvement(diagnosis, them));
    case VerdictKind::kUnknown:
      break;
  }
  const std::string unknown = "Cause: none of the catalogue; " + describe_residual(diagnosis);
  const std::string nearest = causes.empty() ? "" : "; nearest: " + causes;
  if (diagnosis.force) {
    return fmt::format("{}{}. {}", unknown, nearest, describe_map(*diagnosis.force));
  }
  return causes.empty()
             ? unknown + "."
             : fmt::format("{}{}. {}", unknown, nearest, describe_improvement(diagnosis, them));
}

}  // namespace strut
