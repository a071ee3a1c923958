#include "jobs/cli/failures.h"

#include <fmt/format.h>

#include "base/text/format_number.h"
#include "jobs/cli/progress.h"

namespace strut {

std::vector<std::pair<std::string, double>> list_values(const Plan& plan, std::int64_t case_id) {
  const std::vector<Axis>& axes = plan.request().grid.axes();
  std::vector<double> values(axes.size());
  plan.calc_parameters(case_id, values);
  std::vector<std::pair<std::string, double>> named;
  for (std::size_t i = 0; i < axes.size(); ++i) named.emplace_back(axes[i].name, values[i]);
  return named;
}

std::string describe_case(const Plan& plan, std::int64_t case_id, const std::string& why) {
  std::string text = fmt::format("case {} with", case_id);
  for (const auto& [name, value] : list_values(plan, case_id)) {
    text += fmt::format(" {}={}", name, format_rounded(value));
  }
  return text + ": " + why;
}

std::string describe_failures(const Plan& plan, const std::string& reason,
                              const FailureCount& count) {
  std::string text = fmt::format("  {}: {}", reason, format_count(count.cases));
  if (count.first_case < 0) return text;
  return text + ", first " + describe_case(plan, count.first_case, count.first_reason);
}

}  // namespace strut
