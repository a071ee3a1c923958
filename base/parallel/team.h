// Parallel work in OpenMP teams, in a form that ThreadSanitizer can follow.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace strut {

/// Throws std::system_error where a team of `threads` cannot be started; libgomp would terminate
/// the process instead. The thread that enters the parallel region calls this before it.
inline void check_team(int threads) {
  // libgomp keeps the threads of a team for the next team that the same thread starts.
  thread_local int kept = 1;
  std::vector<std::thread> probes;
  std::atomic<bool> over{false};
  const auto finish = [&] {
    over = true;
    over.notify_all();
    for (std::thread& probe : probes) probe.join();
  };
  try {
    while (kept + static_cast<int>(probes.size()) < threads) {
      probes.emplace_back([&over] { over.wait(false); });
    }
  } catch (const std::system_error& error) {
    finish();
    throw std::system_error(error.code(), std::to_string(threads) + " threads cannot be started");
  }
  finish();
  if (threads > 1) kept = threads;
}

/// Calls `work()` on each of `threads` threads. The first exception sets `halt` and is rethrown
/// when all threads have returned. Throws std::system_error if the threads cannot be started.
template <class Work>
void run_team(int threads, std::atomic<bool>& halt, const Work& work) {
  check_team(threads);
  std::exception_ptr failure;
  std::mutex mutex;
  // ThreadSanitizer does not see the fork and join of libgomp; these atomics give it the same
  // order.
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

/// Calls `work(item, thread)` for item = 0 .. count - 1 on `threads` threads. Free threads take the
/// items in ascending order, so a thread that the system suspends delays only its own item.
/// `thread` is 0 .. threads - 1. The first exception is rethrown; items not yet started are
/// skipped.
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

/// Calls work(item, threads_inside) for each item: side by side with one thread each while they
/// fill more than half of the threads (at least one), those that remain one by one with all.
template <class Work>
void share_large_items(int threads, std::size_t count, const Work& work) {
  const auto team = static_cast<std::size_t>(threads);
  const std::size_t remaining = count % team;
  const std::size_t side_by_side = 2 * remaining > team ? count : count - remaining;
  share_items(threads, side_by_side, [&](std::size_t item, int) { work(item, 1); });
  for (std::size_t item = side_by_side; item < count; ++item) work(item, threads);
}

}  // namespace strut
