// The result of a check of the environment and its consequence for a sweep.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/names/name_table.h"

namespace strut {

enum class Health {
  kGood,
  kWarning,  // works with limitations
  kBad,      // a guarantee of the sweep does not hold here
};

inline constexpr std::array<Named<Health>, 3> kHealthNames = {
    {{Health::kGood, "good"}, {Health::kWarning, "warning"}, {Health::kBad, "bad"}}};
static_assert(names_all(kHealthNames, Health::kBad));

constexpr const char* get_name(Health health) { return find_name(kHealthNames, health); }

struct Finding {
  std::string check;  // e.g. "exclusive create"
  Health health = Health::kGood;
  std::string found;    // in words and numbers
  std::string meaning;  // the guarantee that depends on it, or what to do
};

using Findings = std::vector<Finding>;

}  // namespace strut
