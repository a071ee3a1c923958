// Clean termination on SIGINT and SIGTERM; SIGUSR1 is a scheduler's warning of its time limit.
#pragma once

#include <atomic>
#include <csignal>
#include <string>
#include <thread>

namespace strut {

/// From now on SIGINT and SIGTERM end the program with code 128 + signal. A signal that the program
/// was started to ignore stays ignored, here and below.
void end_on_interrupt();

/// Sets the message that is then printed to standard error; at most 4000 bytes of it.
void set_interrupt_message(const std::string& text);

/// Blocks those signals, and SIGUSR1, during its lifetime, so that a file is finished or removed
/// first.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  sigset_t before_;
};

/// Turns the first of those signals into a flag, so that long work stops at a consistent point. A
/// second signal more than 0.1 s later, or work still going on 1.5 s after the first, ends the
/// program at once, with the interrupt message: only for work that survives SIGKILL. Must be
/// created before any other thread.
class InterruptWatcher {
 public:
  InterruptWatcher();
  ~InterruptWatcher();
  InterruptWatcher(const InterruptWatcher&) = delete;
  InterruptWatcher& operator=(const InterruptWatcher&) = delete;

  /// True once a signal has arrived. Other code may set it too, to stop the same work.
  std::atomic<bool>& halt() { return halt_; }
  /// True once SIGUSR1 has arrived: long work should end at the next consistent point. Work that
  /// does not check this flag continues.
  const std::atomic<bool>& warned() const { return warned_; }
  /// The signal that arrived first; 0: none.
  int signal() const { return signal_; }

 private:
  void watch();

  InterruptGuard guard_;
  std::atomic<bool> halt_{false}, warned_{false}, over_{false};
  std::atomic<int> signal_{0};
  std::thread thread_;
};

}  // namespace strut
