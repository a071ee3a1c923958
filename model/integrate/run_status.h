// How a run ended.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace strut {

enum class RunStatus : std::int32_t {
  kDone = 0,
  kDiverged = 1,       // a state is no longer finite, or faster than any car
  kOutOfTravel = 2,    // a corner left the travel its loops were closed over
  kStalled = 3,        // steps cut short by contact events, one upon the other, get nowhere
  kNoEquilibrium = 4,  // loops that cannot be closed, springs that cannot carry the car
  kNoEvent = 5,        // the car never met the snapshot's line
  kImpossible = 6,     // values that exclude each other, as flanks longer than their bump
};

struct RunStatusInfo {
  RunStatus status;
  const char* name;    // in files, journals and messages
  const char* reason;  // "" where the case says it
};

inline constexpr std::array<RunStatusInfo, 7> kRunStatuses = {{
    {RunStatus::kDone, "done", ""},
    {RunStatus::kDiverged, "diverged", "a state is no longer finite, or faster than any car"},
    {RunStatus::kOutOfTravel, "out_of_travel",
     "a corner left the travel its loops were closed over"},
    {RunStatus::kStalled, "stalled",
     "steps cut short by contact events, one upon the other, get nowhere"},
    {RunStatus::kNoEquilibrium, "no_equilibrium", ""},
    {RunStatus::kNoEvent, "no_event", "the rear wheels never met the snapshot's line"},
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

/// The name of a status by its number, as files hold it; "unknown" for no status.
constexpr const char* get_run_status_name(std::int32_t status) {
  const bool known = status >= 0 && static_cast<std::size_t>(status) < kRunStatuses.size();
  return known ? kRunStatuses[static_cast<std::size_t>(status)].name : "unknown";
}
constexpr const char* get_name(RunStatus status) {
  return get_run_status_name(static_cast<std::int32_t>(status));
}

}  // namespace strut
