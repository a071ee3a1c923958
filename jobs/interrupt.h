// A clean end on SIGINT and SIGTERM.
#pragma once

#include <csignal>

namespace strut {

/// From now on SIGINT and SIGTERM end the program with code 128 + signal.
void end_on_interrupt();

/// Holds those signals back while it lives, so that a file is finished or cleaned up first.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  sigset_t before_;
};

}  // namespace strut
