#include "jobs/bench/instructions.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace strut {

std::optional<double> count_instructions(const std::function<void()>& run) {
  perf_event_attr attributes{};
  attributes.size = sizeof(attributes);
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
  attributes.disabled = 1;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  constexpr int kThisThread = 0, kAnyProcessor = -1, kNoGroup = -1;
  const int counter = static_cast<int>(
      ::syscall(SYS_perf_event_open, &attributes, kThisThread, kAnyProcessor, kNoGroup, 0UL));
  if (counter < 0) return std::nullopt;
  ::ioctl(counter, PERF_EVENT_IOC_ENABLE, 0);
  run();
  ::ioctl(counter, PERF_EVENT_IOC_DISABLE, 0);
  std::uint64_t count = 0;
  const bool is_read = ::read(counter, &count, sizeof(count)) == sizeof(count);
  ::close(counter);
  if (!is_read || count == 0) return std::nullopt;
  return static_cast<double>(count);
}

}  // namespace strut
