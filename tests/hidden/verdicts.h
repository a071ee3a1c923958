// Truth files and verdicts as the scorer reads them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/parse_json.h"

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
  std::string where;  // all that is said of it
  std::map<std::string, Estimate> after;
  double explained = 0.0;
  bool has_gain = false;
};

struct TrueFault {
  std::string fault, effect, place, parameter;
  double magnitude = 0.0;
  char grade = 'D';
};

struct TrueTrial {
  std::string name, kit, category;
  char grade = '-';
  double roughness = 0.0;  // m^3
  std::vector<TrueFault> faults;
  std::map<std::string, double> parameters;
};

/// Throws std::runtime_error with the file's name for what is no such file.
test::JsonTree read_json(const std::filesystem::path& path);
TrueTrial read_truth(const std::filesystem::path& path);
Verdict read_verdict(const std::filesystem::path& path);

/// All truths of a folder; every one must be as the seal in SHA256SUMS says, and none be missing.
std::vector<TrueTrial> read_truths(const std::filesystem::path& folder);

}  // namespace strut::hidden
