#include "jobs/interrupt.h"

#include <unistd.h>

#include <initializer_list>

namespace strut {
namespace {

/// Nothing is half done outside of an InterruptGuard, so there is nothing to clean up.
extern "C" void end_now(int signal) { _exit(128 + signal); }

}  // namespace

void end_on_interrupt() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, &end_now);
}

InterruptGuard::InterruptGuard() {
  sigset_t both;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &both, &before_);
}

InterruptGuard::~InterruptGuard() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

}  // namespace strut
