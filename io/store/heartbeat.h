// Proof that a runner is alive: a file with its process and a counter that a thread increments.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "io/file/folder.h"
#include "io/file/process_identity.h"

namespace strut {

struct RunnerFile {
  ProcessIdentity identity;
  std::string text;  // the whole file, which changes at every heartbeat
};

/// Returns one key and value per line; for one runner the length is fixed, so that the text can be
/// written in place.
std::string write_runner_text(const ProcessIdentity& identity, std::uint64_t counter);

/// Parses such a text; fields that are missing or truncated are empty.
RunnerFile read_runner_text(const std::string& text);

/// A thread that increments the counter in a runner's file until the destructor. It takes no
/// signals, and failures of the file do not end it: the counter then stalls.
class Heartbeat {
 public:
  /// Throws EnvironmentError if no thread can be started.
  Heartbeat(const Folder& folder, std::string file, ProcessIdentity identity,
            std::chrono::milliseconds interval);
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
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace strut
