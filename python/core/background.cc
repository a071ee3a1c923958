#include "python/core/background.h"

#include <pthread.h>
#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

namespace strut {
namespace {

namespace py = pybind11;

/// The work that goes on in all threads.
class RunningWork {
 public:
  /// False if the program ends: nothing may begin.
  bool add(std::atomic<bool>& stop) {
    const std::lock_guard lock(mutex_);
    if (!is_ending_) stops_.insert(&stop);
    return !is_ending_;
  }
  void remove(std::atomic<bool>& stop) {
    const std::lock_guard lock(mutex_);
    stops_.erase(&stop);
    changed_.notify_all();
  }
  /// Stops all work and waits until it is over.
  void end() {
    std::unique_lock lock(mutex_);
    is_ending_ = true;
    for (std::atomic<bool>* stop : stops_) *stop = true;
    changed_.wait(lock, [this] { return stops_.empty(); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::atomic<bool>*> stops_;
  bool is_ending_ = false;
};

// Never destroyed: threads may outlive the program.
RunningWork* running_work = nullptr;

/// Also in a forked process, where none of the work before runs.
void start_running_work() { running_work = new RunningWork; }

/// A unit of work; the interpreter's lock is held when it begins and ends.
class Work {
 public:
  explicit Work(std::atomic<bool>& stop) : stop_(stop) {
    if (!running_work->add(stop)) throw std::runtime_error("the program is ending");
  }
  ~Work() { running_work->remove(stop_); }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

 private:
  std::atomic<bool>& stop_;
};

}  // namespace

void run_in_background(const std::function<void(std::atomic<bool>& stop)>& work,
                       const std::function<void()>& watch) {
  constexpr std::chrono::milliseconds kInterval(100);
  std::atomic<bool> stop{false};
  const Work running(stop);
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::thread worker([&] {
    try {
      work(stop);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_all();
  });
  std::exception_ptr interruption;
  {
    const py::gil_scoped_release unlocked;
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, kInterval, [&] { return done; })) {
      if (interruption) continue;
      lock.unlock();
      {
        const py::gil_scoped_acquire locked;
        try {
          if (PyErr_CheckSignals() != 0) throw py::error_already_set();
          if (watch) watch();
        } catch (...) {
          interruption = std::current_exception();
          stop = true;
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (interruption) std::rethrow_exception(interruption);
  if (failure) std::rethrow_exception(failure);
}

void end_work_with_interpreter() {
  start_running_work();
  ::pthread_atfork(nullptr, nullptr, &start_running_work);
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    const py::gil_scoped_release unlocked;
    running_work->end();
  }));
}

}  // namespace strut
