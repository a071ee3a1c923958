// The result of a check, and its meaning for a sweep.
#pragma once

#include <string>
#include <vector>

namespace strut {

enum class Health {
  kGood,
  kWarning,  // works, but not as well as it might
  kBad,      // a promise of the sweep does not hold here
};

const char* get_name(Health health);

struct Finding {
  std::string check;  // "exclusive create"
  Health health = Health::kGood;
  std::string found;    // in words and numbers
  std::string meaning;  // which promise it carries, or what to do
};

using Findings = std::vector<Finding>;

}  // namespace strut
