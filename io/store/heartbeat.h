// How a runner shows that it lives: a file with its process and a counter that a thread raises.
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
  std::string text;  // all of it; a heartbeat changes it
};

/// One key and value a line; always the same length, so that it can be written in place.
std::string write_runner_text(const ProcessIdentity& identity, std::uint64_t counter);

/// What is missing, or was cut short, is empty.
RunnerFile read_runner_text(const std::string& text);

/// A thread that raises the counter in a runner's file until the destructor. It takes no signals,
/// and no trouble with the file ends it: then the counter stands still.
class Heartbeat {
 public:
  /// Throws EnvironmentError where no thread can be made.
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
