// The outcome of a run.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace strut {

enum class RunStatus : std::int32_t {
  kDone = 0,
  kDiverged = 1,       // a state is not finite or exceeds kDivergenceSpeed
  kOutOfTravel = 2,    // a corner left the travel for which its loops close
  kStalled = 3,        // too many steps, shortened by successive contact events
  kNoEquilibrium = 4,  // loops that do not close, springs that cannot carry the car
  kNoEvent = 5,        // the car never reached the line of the snapshot
  kImpossible = 6,     // contradictory values, such as flanks longer than their bump
};

struct RunStatusInfo {
  RunStatus status;
  const char* name;    // in files, journals and messages
  const char* reason;  // "" where each case has a reason of its own
};

inline constexpr std::array<RunStatusInfo, 7> kRunStatuses = {{
    {RunStatus::kDone, "done", ""},
    {RunStatus::kDiverged, "diverged", "a state is not finite, or a speed exceeds 500 m/s"},
    {RunStatus::kOutOfTravel, "out_of_travel",
     "a corner left the travel for which its loops close"},
    {RunStatus::kStalled, "stalled",
     "successive contact events shorten the steps so much that the run makes no progress"},
    {RunStatus::kNoEquilibrium, "no_equilibrium", ""},
    {RunStatus::kNoEvent, "no_event", "the rear wheels never reached the line of the snapshot"},
    {RunStatus::kImpossible, "impossible", ""},
}};
static_assert(
    [] {
      for (std::size_t i = 0; i < kRunStatuses.size(); ++i) {
        if (static_cast<std::size_t>(kRunStatuses[i].status) != i) return false;
      }
      return true;
    }(),
    "run statuses are listed in the order of their numbers");

/// The name of a status by its number in files; "unknown" for any other number.
constexpr const char* get_run_status_name(std::int32_t status) {
  const bool known = status >= 0 && static_cast<std::size_t>(status) < kRunStatuses.size();
  return known ? kRunStatuses[static_cast<std::size_t>(status)].name : "unknown";
}
constexpr const char* get_name(RunStatus status) {
  return get_run_status_name(static_cast<std::int32_t>(status));
}

}  // namespace strut
