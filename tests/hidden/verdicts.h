// Reads truth files and verdicts for the scorer.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/hidden/imitation.h"
#include "tests/jobs/parse_json.h"

namespace strut::hidden {

struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// An effect at a place, with its probability and parameters.
struct Claim {
  std::string effect, place;
  double probability = 0.0;
  std::map<std::string, Estimate> parameters;
};

struct Verdict {
  std::string verdict;  // adequate | named | group | form_incomplete | unknown; "": none was given
  std::vector<Claim> causes, group, runners_up;
  /// The first cause with what is not distinguished from it; empty: as far as the group tells.
  std::vector<Claim> first;
  double unknown_share = 0.0;  // stated probability that the cause is none of the catalogue
  std::string place;           // where.place
  std::map<std::string, Estimate> after;
  std::optional<double> explained;  // gain.explained; null: no excess before
  std::optional<double> map_share;  // force_map.hold_out_share; null: no force map
};

struct TrueFault {
  std::string fault, effect, place, parameter;
  double magnitude = 0.0;
  char grade = 'D';
  std::string where;             // the place as in a verdict's where.place
  std::vector<CauseName> twins;  // other causes that the trial's runs cannot tell from it
};

struct TrueTrial {
  std::string name, kit, category;
  char grade = '-';
  double roughness = 0.0;  // m^3
  std::vector<TrueFault> faults;
  std::map<std::string, double> parameters;
  std::map<std::string, double> bounds;  // Cramer-Rao bounds of the parameters, 1 sigma
  /// Ratio beyond the best imitation by one known cause, and by two that are not the hidden pair.
  double beyond_one = 0.0, beyond_two = 0.0;
};

/// Throws std::runtime_error with the file's name for another format.
test::JsonTree read_json(const std::filesystem::path& path);
TrueTrial read_truth(const std::filesystem::path& path);
Verdict read_verdict(const std::filesystem::path& path);

/// All truths of a folder. Throws unless each agrees with its seal in SHA256SUMS and none is
/// missing.
std::vector<TrueTrial> read_truths(const std::filesystem::path& folder);

}  // namespace strut::hidden
