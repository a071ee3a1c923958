// A clean end on SIGINT and SIGTERM, and SIGUSR1 as a scheduler's warning of its time limit.
#pragma once

#include <atomic>
#include <csignal>
#include <string>
#include <thread>

namespace strut {

/// From now on SIGINT and SIGTERM end the program with code 128 + signal. One that was ignored
/// before stays so, here and below.
void end_on_interrupt();

/// What is then said to standard error, as far as 4000 bytes go.
void set_last_words(const std::string& text);

/// Holds those signals, and SIGUSR1, back while it lives, so that a file is finished or cleaned up
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

/// Turns the first of those signals into a flag, so that long work stops where it is whole. A
/// second signal more than 0.1 s later, or work that has not ended 1.5 s after the first, ends the
/// program at once, with the last words: for work that survives SIGKILL. To be made before other
/// threads are.
class InterruptWatcher {
 public:
  InterruptWatcher();
  ~InterruptWatcher();
  InterruptWatcher(const InterruptWatcher&) = delete;
  InterruptWatcher& operator=(const InterruptWatcher&) = delete;

  /// True once a signal came. Others may set it too, to stop the same work.
  std::atomic<bool>& halt() { return halt_; }
  /// True once SIGUSR1 came: work that lasts is to end where it is whole, in its own time. What
  /// does not look at this goes on.
  const std::atomic<bool>& warned() const { return warned_; }
  /// The signal that stops; 0: none came.
  int signal() const { return signal_; }

 private:
  void watch();

  InterruptGuard guard_;
  std::atomic<bool> halt_{false}, warned_{false}, over_{false};
  std::atomic<int> signal_{0};
  std::thread thread_;
};

}  // namespace strut
