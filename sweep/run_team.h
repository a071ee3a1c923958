// The same work on every thread of an OpenMP team.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>

namespace strut {

/// Calls `work()` on each of `threads` threads. The first exception turns `halt` true and comes out
/// when all have returned.
template <class Work>
void run_team(int threads, std::atomic<bool>& halt, const Work& work) {
  std::exception_ptr failure;
  std::mutex mutex;
  // libgomp's own fork and join are invisible to ThreadSanitizer; these show it the same order.
  std::atomic<int> forked{0}, joined{0};
  forked.store(1, std::memory_order_release);
#pragma omp parallel num_threads(threads)
  {
    forked.load(std::memory_order_acquire);
    try {
      work();
    } catch (...) {
      halt = true;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    joined.fetch_add(1, std::memory_order_release);
  }
  joined.load(std::memory_order_acquire);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace strut
