// Instructions that the processor executes, where the system lets a program count them.
#pragma once

#include <functional>
#include <optional>

namespace strut {

/// Number of instructions that `run` executes on this thread in user mode; nothing where the system
/// has no such counter, or does not allow it (kernel.perf_event_paranoid above 2, many containers).
std::optional<double> count_instructions(const std::function<void()>& run);

}  // namespace strut
