#include "jobs/cli/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

/// NaN where the text is not a finite number.
double parse_finite(const std::string& text) {
  const auto value = parse_number<double>(text);
  return value && std::isfinite(*value) ? *value : std::numeric_limits<double>::quiet_NaN();
}

std::size_t find_index(const std::string& name, const std::vector<std::string>& names) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  throw InputError(fmt::format("'{}' is not an input{}; inputs: {}", name,
                               suggest_name(name, names), join_names(names)));
}

}  // namespace

std::pair<double, double> read_time_range(const Arguments& arguments, const std::string& option) {
  const std::string text = arguments.text(option);
  const auto colon = text.find(':');
  const double from = parse_finite(text.substr(0, colon));
  const double to =
      colon == std::string::npos ? std::nan("") : parse_finite(text.substr(colon + 1));
  if (std::isfinite(from) && std::isfinite(to)) return {from, to};
  throw InputError(fmt::format("--{} = {}: must be FROM:TO in s, as 0.3:2.5", option, text));
}

void apply_settings(const std::string& option, const std::vector<std::string>& settings,
                    const std::vector<std::string>& names, std::vector<double>& values) {
  name_option(option, [&] {
    for (const std::string& setting : settings) {
      const NamedValue given = parse_setting(setting);
      double& place = values[find_index(given.name, names)];
      const double value = given.to_si("");
      if (!std::isfinite(value)) {
        throw InputError(fmt::format("{}: not finite; must be a number", setting));
      }
      place = value;
    }
  });
}

}  // namespace strut
