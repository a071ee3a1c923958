#include "jobs/interrupt.h"

#include <unistd.h>

#include <chrono>
#include <ctime>
#include <initializer_list>

namespace strut {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// How long work may take to stop after the first signal.
constexpr std::chrono::milliseconds kPatience{1500};

/// Nothing is half done outside of an InterruptGuard, so there is nothing to clean up.
extern "C" void end_now(int signal) { _exit(128 + signal); }

sigset_t make_interrupts() {
  sigset_t both;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  return both;
}

}  // namespace

void end_on_interrupt() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, &end_now);
}

InterruptGuard::InterruptGuard() {
  const sigset_t both = make_interrupts();
  pthread_sigmask(SIG_BLOCK, &both, &before_);
}

InterruptGuard::~InterruptGuard() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

InterruptWatcher::InterruptWatcher() : thread_([this] { watch(); }) {}

InterruptWatcher::~InterruptWatcher() {
  over_ = true;
  thread_.join();
}

void InterruptWatcher::watch() {
  const sigset_t both = make_interrupts();
  constexpr timespec kPoll{0, 20'000'000};
  SteadyClock::time_point first;
  while (!over_) {
    const int signal = sigtimedwait(&both, nullptr, &kPoll);
    const bool again = signal > 0 && signal_ != 0;
    if (again || (signal_ != 0 && SteadyClock::now() - first > kPatience)) _exit(128 + signal_);
    if (signal > 0) {
      first = SteadyClock::now();
      signal_ = signal;
      halt_ = true;
    }
  }
}

}  // namespace strut
