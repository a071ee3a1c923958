// Progress of long work: a line rewritten in place on a terminal, printed now and then elsewhere.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace strut {

/// Prints `line()` to standard error from a thread of its own: on a terminal in place, five times a
/// second; elsewhere every ten seconds; with --quiet never. The destructor erases the live line.
class ProgressLine {
 public:
  explicit ProgressLine(std::function<std::string()> line);
  /// For work whose completed fraction is unknown: "DOING, 12 s".
  explicit ProgressLine(const std::string& doing);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

 private:
  void work();

  const std::function<std::string()> line_;
  const bool live_;
  std::mutex mutex_;
  std::condition_variable over_changed_;
  bool over_ = false;
  std::thread thread_;
};

/// "1,200/4,800 cases verified, 12 s to go"; `seconds`: time spent on the `done` ones.
std::string format_progress(std::int64_t done, std::int64_t total, const std::string& what,
                            double seconds);

/// "12 s", "3 min 20 s", "5 h 12 min", "9 d 4 h"; "unknown" if not finite.
std::string format_duration(double seconds);

/// "512 B", "12.3 kB", "4.56 GB"
std::string format_bytes(double bytes);

/// "12,345"
std::string format_count(std::int64_t count);
/// "1 shard", "12,345 shards"
std::string format_count(std::int64_t count, std::string_view noun);

}  // namespace strut
