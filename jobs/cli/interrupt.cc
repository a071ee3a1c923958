#include "jobs/cli/interrupt.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <initializer_list>

namespace strut {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Maximum time that work may take to stop after the first signal.
constexpr std::chrono::milliseconds kPatience{1500};
/// Signals closer together count as one: timeout(1) signals a process and then its group.
constexpr std::chrono::milliseconds kEcho{100};

/// Filled beforehand, since a signal handler must neither allocate nor lock.
std::array<char, 4000> message;
std::atomic<std::size_t> message_size{0};

/// Needs no cleanup: outside of an InterruptGuard no file is incomplete.
extern "C" [[noreturn]] void end_now(int signal) {
  if (write(STDERR_FILENO, message.data(), message_size) < 0) _exit(128 + signal);
  _exit(128 + signal);
}

/// Whether the program was started to ignore the signal, as by nohup or `trap '' INT`; sigtimedwait
/// would receive it all the same.
bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

sigset_t make_interrupts() {
  sigset_t all;
  sigemptyset(&all);
  for (const int signal : {SIGINT, SIGTERM}) {
    if (!is_ignored(signal)) sigaddset(&all, signal);
  }
  sigaddset(&all, SIGUSR1);
  return all;
}

}  // namespace

void end_on_interrupt() {
  for (const int signal : {SIGINT, SIGTERM}) {
    if (!is_ignored(signal)) std::signal(signal, &end_now);
  }
}

void set_interrupt_message(const std::string& text) {
  message_size = 0;
  const std::size_t size = std::min(text.size(), message.size());
  std::copy_n(text.begin(), size, message.begin());
  message_size = size;
}

InterruptGuard::InterruptGuard() {
  const sigset_t all = make_interrupts();
  pthread_sigmask(SIG_BLOCK, &all, &before_);
}

InterruptGuard::~InterruptGuard() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

InterruptWatcher::InterruptWatcher() : thread_([this] { watch(); }) {}

InterruptWatcher::~InterruptWatcher() {
  over_ = true;
  thread_.join();
}

void InterruptWatcher::watch() {
  const sigset_t all = make_interrupts();
  constexpr timespec kPoll{0, 20'000'000};
  SteadyClock::time_point first;
  while (!over_) {
    const int signal = sigtimedwait(&all, nullptr, &kPoll);
    if (signal == SIGUSR1) {
      warned_ = true;
      continue;
    }
    const bool again = signal > 0 && signal_ != 0 && SteadyClock::now() - first > kEcho;
    if (again || (signal_ != 0 && SteadyClock::now() - first > kPatience)) end_now(signal_);
    if (signal > 0 && signal_ == 0) {
      first = SteadyClock::now();
      signal_ = signal;
      halt_ = true;
    }
  }
}

}  // namespace strut
