#include "diagnose/compare/adequacy.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace strut {
namespace {

bool is_worse(const Misfit& a, const Misfit& b) {
  if (a.failure.empty() != b.failure.empty()) return !a.failure.empty();
  return a.failure.empty() && a.times_noise / a.limit > b.times_noise / b.limit;
}

/// What the campaign or the sensors say of a value: parameters and hit times. The priors of biases
/// and initial states are as wide as the motion.
bool is_stated(const Unknown& u) {
  return u.prior.informs() && u.prior.sigma > 0.0 &&
         (u.kind == UnknownKind::kParameter || u.kind == UnknownKind::kHitTime ||
          u.kind == UnknownKind::kInputGain);
}

}  // namespace

std::vector<PriorConflict> list_prior_conflicts(const std::vector<Unknown>& unknowns,
                                                const std::vector<double>& values,
                                                std::size_t run) {
  std::vector<PriorConflict> conflicts;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (!is_stated(u)) continue;
    PriorConflict c{run,       u.run == kEveryRun, u.name,       u.unit,
                    values[i], u.prior.mean,       u.prior.sigma};
    if (c.calc_distance() > kReportedDistance) conflicts.push_back(std::move(c));
  }
  return conflicts;
}

std::string describe_conflict(const CampaignData& data, const PriorConflict& c) {
  const std::string unit = c.unit.empty() || c.unit == "1" ? "" : " " + c.unit;
  return fmt::format(
      "{}{} is {:.3g}{}, {:.3g} standard deviations from its prior {:.3g} +/- {:.2g}{}", c.name,
      c.is_shared ? "" : " in " + name_run(data, c.run), c.value, unit, c.calc_distance(), c.mean,
      c.sigma, unit);
}

std::string name_run(const CampaignData& data, std::size_t run) {
  const CampaignRun& entry = data.campaign.runs[run];
  return entry.name + (entry.use == RunUse::kHoldOut ? " (held out)" : "");
}

std::string describe_misfit(const CampaignData& data, const Misfit& misfit) {
  if (!misfit.failure.empty()) return misfit.failure;
  return fmt::format("{} in {} is {:.3g} times its noise", data.info(misfit.channel).name,
                     name_run(data, misfit.run), misfit.times_noise);
}

const Misfit* find_worst(const std::vector<Misfit>& misfits) {
  const auto worst = std::min_element(misfits.begin(), misfits.end(), is_worse);
  return worst == misfits.end() ? nullptr : &*worst;
}

bool are_held_out(const CampaignData& data, const std::vector<Misfit>& misfits) {
  return std::all_of(misfits.begin(), misfits.end(), [&](const Misfit& m) {
    return data.campaign.runs[m.run].use == RunUse::kHoldOut;
  });
}

}  // namespace strut
