// Proof that a runner is alive: a file with its process, a counter that a thread increments, and
// how far its work is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "io/file/folder.h"
#include "io/file/process_identity.h"

namespace strut {

struct RunnerFile {
  ProcessIdentity identity;
  std::uint64_t work = 0;  // units that the runner counts; 0 where the file does not say
  std::string text;        // the whole file, which changes at every heartbeat
};

/// Returns one key and value per line; for one runner the length is fixed, so that the text can be
/// written in place.
std::string write_runner_text(const ProcessIdentity& identity, std::uint64_t counter,
                              std::uint64_t work);

/// Parses such a text; fields that are missing or truncated are empty.
RunnerFile read_runner_text(const std::string& text);

/// A thread that increments the counter in a runner's file until the destructor. It takes no
/// signals, and failures of the file do not end it: the counter then stalls.
class Heartbeat {
 public:
  using CountWork = std::function<std::uint64_t()>;

  /// `count_work` is called by the thread at each beat; it may be empty. Throws EnvironmentError if
  /// no thread can be started.
  Heartbeat(const Folder& folder, std::string file, ProcessIdentity identity,
            std::chrono::milliseconds interval, CountWork count_work);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  void run();
  void beat(std::uint64_t counter) const;

  Folder folder_;
  std::string file_;
  ProcessIdentity identity_;
  std::chrono::milliseconds interval_;
  CountWork count_work_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace strut
