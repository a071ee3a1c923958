#include "diagnose/compare/deciding_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"

namespace strut {
namespace {

/// "displacement (3.5e-05 m)": the inputs of a run whose noise is estimated.
std::vector<std::string> list_estimated_inputs(const CampaignData& data, std::size_t run) {
  std::vector<std::string> inputs;
  std::size_t number = 0;  // of the run's recorded inputs
  for (const MeasuredColumn& column : data.tables[run].columns) {
    const CampaignColumn& c = data.campaign.columns[column.at];
    if (c.role != ColumnRole::kInput) continue;
    const double sigma = data.runs[run].input_noise[number++].sigma;
    if (c.noise || !(sigma > 0.0)) continue;
    inputs.push_back(fmt::format("{} ({} {})", c.channel, format_rounded(sigma), c.si));
  }
  return inputs;
}

/// Whether the residual is within the noise only because of what is not the sensor's own.
bool is_decided_by_inputs(const ChannelAdequacy& adequacy) {
  constexpr double kNotable = 0.05;  // of the variance
  ChannelAdequacy sensor = adequacy;
  sensor.floor.sigma *= std::sqrt(std::max(0.0, 1.0 - adequacy.floor.common_fraction));
  sensor.floor.common_fraction = 0.0;
  return adequacy.floor.common_fraction > kNotable && adequacy.is_adequate() &&
         !sensor.is_adequate();
}

}  // namespace

std::vector<std::string> describe_deciding_noise(
    const CampaignData& data, const std::vector<const ModelComparison*>& models) {
  std::vector<std::string> notes;
  if (!data.has_inputs()) return notes;
  std::set<int> noted;
  for (std::size_t run = 0; run < models.size(); ++run) {
    const std::vector<std::string> inputs = list_estimated_inputs(data, run);
    if (inputs.empty()) continue;
    for (const ChannelComparison& c : models[run]->channels) {
      if (!is_decided_by_inputs(c.adequacy) || !noted.insert(c.channel).second) continue;
      notes.push_back(fmt::format(
          "{} in {} agrees with the model only if {:.0f} % of its noise's variance comes from the "
          "inputs, whose noise is estimated: {}; if you know it, state it: noise = SIGMA",
          data.info(c.channel).name, name_run(data, run), 100.0 * c.adequacy.floor.common_fraction,
          join_names(inputs)));
    }
  }
  return notes;
}

}  // namespace strut
