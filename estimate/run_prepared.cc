#include "estimate/run_prepared.h"

#include <algorithm>

#include "base/error/check.h"
#include "base/parallel/team.h"
#include "model/longest_step.h"

namespace strut {
namespace {

using Group = std::vector<std::size_t>;

/// The steps that the effects of a case need.
StepOptions choose_steps(StepOptions step, const PreparedCase& c) {
  step.step = shorten_step(step.step, c.longest_step);
  if (step.coarse_step > 0.0) {
    step.coarse_step = std::max(step.step, shorten_step(step.coarse_step, c.longest_step));
  }
  return step;
}

/// Groups cases that may share lanes, at most `width` a group, in order.
std::vector<Group> group_cases(const std::vector<PreparedCase>& cases,
                               const IntegrateOptions& options, std::size_t width) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto fits = [&](const Group& group) {
      const PreparedCase& first = cases[group.front()];
      return group.size() < width && first.duration == cases[i].duration &&
             may_share_lanes(first, cases[i], options) &&
             choose_steps(options.step, first) == choose_steps(options.step, cases[i]);
    };
    const auto found = std::find_if(groups.begin(), groups.end(), fits);
    if (found == groups.end()) {
      groups.push_back({i});
    } else {
      found->push_back(i);
    }
  }
  return groups;
}

LaneResults run_group(const std::vector<PreparedCase>& cases, const Group& group,
                      const SolverOptions& integrate, const SamplePlan& plan) {
  if (integrate.solver == Solver::kCvode) {
    return run_cvode(cases[group.front()], integrate.reference, plan);
  }
  std::vector<const PreparedCase*> pointers;
  pointers.reserve(group.size());
  for (const std::size_t i : group) pointers.push_back(&cases[i]);
  IntegrateOptions options = integrate.options;
  options.step = choose_steps(options.step, cases[group.front()]);
  return list_kernels().front().run_lanes(pointers.data(), static_cast<int>(pointers.size()),
                                          options, plan);
}

}  // namespace

std::vector<double> LaneRun::get_series(int channel) const {
  const std::vector<int>& recorded = results->recorded;
  if (recorded.empty()) return results->get_history(channel, lane);
  const auto column = std::find(recorded.begin(), recorded.end(), channel);
  STRUT_CHECK(column != recorded.end(), "history: the channel was not recorded");
  return results->get_history(static_cast<int>(column - recorded.begin()), lane);
}

std::vector<LaneRun> run_prepared(const std::vector<PreparedCase>& cases,
                                  const SolverOptions& integrate, const SamplePlan& plan,
                                  int threads) {
  const bool in_lanes = integrate.solver == Solver::kLanes;
  const auto width = static_cast<std::size_t>(in_lanes ? list_kernels().front().lanes : 1);
  const std::vector<Group> groups = group_cases(cases, integrate.options, width);
  std::vector<LaneRun> runs(cases.size());
  share_items(threads, groups.size(), [&](std::size_t g, int /*thread*/) {
    const auto results =
        std::make_shared<const LaneResults>(run_group(cases, groups[g], integrate, plan));
    for (std::size_t lane = 0; lane < groups[g].size(); ++lane) {
      runs[groups[g][lane]] = {results, static_cast<int>(lane)};
    }
  });
  return runs;
}

}  // namespace strut
