// Truth files and verdicts as the scorer reads them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/jobs/parse_json.h"

namespace strut::hidden {

struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// An effect at a place with what is said of it.
struct Claim {
  std::string effect, place;
  double probability = 0.0;
  std::map<std::string, Estimate> parameters;
};

struct Verdict {
  std::string verdict;  // adequate | named | group | form_incomplete | unknown; "": none was given
  std::vector<Claim> causes, group, runners_up;
  std::string place;  // where.place
  std::map<std::string, Estimate> after;
  std::optional<double> explained;  // gain.explained; none: nothing stood out before
  std::optional<double> map_share;  // force_map.hold_out_share; none: no force map
};

struct TrueFault {
  std::string fault, effect, place, parameter;
  double magnitude = 0.0;
  char grade = 'D';
  std::string where;  // the place in the words of a verdict's where.place
};

struct TrueTrial {
  std::string name, kit, category;
  char grade = '-';
  double roughness = 0.0;  // m^3
  std::vector<TrueFault> faults;
  std::map<std::string, double> parameters;
  std::map<std::string, double> bounds;  // 1 sigma of the parameters that no fit can beat
};

/// Throws std::runtime_error with the file's name for what is no such file.
test::JsonTree read_json(const std::filesystem::path& path);
TrueTrial read_truth(const std::filesystem::path& path);
Verdict read_verdict(const std::filesystem::path& path);

/// All truths of a folder; every one must be as the seal in SHA256SUMS says, and none be missing.
std::vector<TrueTrial> read_truths(const std::filesystem::path& folder);

}  // namespace strut::hidden
