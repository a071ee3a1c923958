#include "jobs/cli/step_warning.h"

#include <fmt/format.h>

#include "base/text/format_number.h"
#include "jobs/cli/messages.h"

namespace strut {

bool warn_of_long_step(const std::string& name, double step, const std::string& model,
                       double longest) {
  constexpr double kBelow = 0.95;  // rounded to two digits, still short enough
  if (step <= longest * (1.0 + 1e-9)) return false;
  print_note(fmt::format(
      "warning: {} = {} s: too long to resolve the effects of {}, which need at most {:.2g} s",
      name, format_number(step), model, kBelow * longest));
  return true;
}

}  // namespace strut
