// Work on every thread of an OpenMP team, in a form that ThreadSanitizer can follow.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>
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

/// Calls `work(item, thread)` for item = 0 .. count - 1 on `threads` threads, each item as soon as
/// one is free, in ascending order: a thread that the system holds back delays only its own item.
/// `thread` is 0 .. threads - 1. The first exception comes out; items not yet begun are left out.
template <class Work>
void share_items(int threads, std::size_t count, const Work& work) {
  if (threads == 1 || count < 2) {
    for (std::size_t item = 0; item < count; ++item) work(item, 0);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::atomic<bool> halt{false};
  run_team(threads, halt, [&] {
    const int thread = omp_get_thread_num();
    for (std::size_t item = next++; item < count && !halt; item = next++) work(item, thread);
  });
}

}  // namespace strut
