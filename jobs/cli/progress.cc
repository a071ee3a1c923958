#include "jobs/cli/progress.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "jobs/cli/interrupt.h"
#include "jobs/cli/machine.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/terminal.h"

namespace strut {
namespace {

std::function<std::string()> describe_elapsed(const std::string& doing) {
  return [doing, start = now()] { return doing + ", " + format_duration(now() - start); };
}

}  // namespace

ProgressLine::ProgressLine(std::function<std::string()> line)
    : line_(std::move(line)), live_(is_live_terminal(STDERR_FILENO)) {
  if (get_verbosity() == Verbosity::kQuiet) return;
  // A signal is for the threads that work: this one would end the program amid what they guard.
  const InterruptGuard guard;
  thread_ = std::thread([this] { work(); });
}

ProgressLine::ProgressLine(const std::string& doing) : ProgressLine(describe_elapsed(doing)) {}

ProgressLine::~ProgressLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  over_changed_.notify_all();
  thread_.join();
  erase_live_line();
}

void ProgressLine::work() {
  const auto pause = live_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000);
  std::unique_lock lock(mutex_);
  while (!over_changed_.wait_for(lock, pause, [this] { return over_; })) {
    live_ ? show_live_line(line_()) : show_line(line_());
  }
}

std::string format_progress(std::int64_t done, std::int64_t total, const std::string& what,
                            double seconds) {
  std::string line = format_count(done) + "/" + format_count(total) + " " + what;
  if (done > 0 && done < total) {
    const double left = static_cast<double>(total - done) / static_cast<double>(done);
    line += ", " + format_duration(left * seconds) + " to go";
  }
  return line;
}

std::string format_duration(double seconds) {
  if (!std::isfinite(seconds)) return "unknown";
  struct Unit {
    const char* name;
    long long seconds;
  };
  constexpr std::array<Unit, 4> kUnits = {{{"d", 86400}, {"h", 3600}, {"min", 60}, {"s", 1}}};
  const long long whole = std::llround(seconds);
  for (std::size_t i = 0; i + 1 < kUnits.size(); ++i) {
    const Unit &large = kUnits[i], &small = kUnits[i + 1];
    if (whole < large.seconds) continue;
    return std::to_string(whole / large.seconds) + " " + large.name + " " +
           std::to_string(whole % large.seconds / small.seconds) + " " + small.name;
  }
  char text[32];
  std::snprintf(text, sizeof text, seconds < 10.0 ? "%.2g s" : "%.0f s", seconds);
  return text;
}

std::string format_bytes(double bytes) {
  constexpr std::array<const char*, 5> kNames = {"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < kNames.size()) bytes /= 1000.0, ++unit;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.3g %s", bytes, kNames[unit]);
  return text;
}

std::string format_count(std::int64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, ",");
  return digits;
}

}  // namespace strut
