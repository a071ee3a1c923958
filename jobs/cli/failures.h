// Failed cases of a sweep as text, the same in every command.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sweep/status.h"

namespace strut {

/// The parameters of a case by name.
std::vector<std::pair<std::string, double>> list_values(const Plan& plan, std::int64_t case_id);

/// "case 123 with mass=900: a state is not finite"
std::string describe_case(const Plan& plan, std::int64_t case_id, const std::string& why);

/// A line: "  diverged: 12, first case 123 with mass=900: a state is not finite"
std::string describe_failures(const Plan& plan, const std::string& reason,
                              const FailureCount& count);

}  // namespace strut
