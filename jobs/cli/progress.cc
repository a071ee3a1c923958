#include "jobs/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "jobs/cli/clock.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/terminal.h"

namespace strut {
namespace {

std::function<std::string()> describe_elapsed(const std::string& doing) {
  return [doing, start = now()] {
    return fmt::format("{}, {}", doing, format_duration(now() - start));
  };
}

}  // namespace

ProgressLine::ProgressLine(std::function<std::string()> line)
    : line_(std::move(line)), live_(is_live_terminal(STDERR_FILENO)) {
  if (get_verbosity() == Verbosity::kQuiet) return;
  // Signals must go to the working threads: this one would end the program amid guarded work.
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
  std::string line = fmt::format("{}/{} {}", format_count(done), format_count(total), what);
  if (done <= 0 || done >= total) return line;
  const double remaining = static_cast<double>(total - done) / static_cast<double>(done);
  return fmt::format("{}, {} to go", line, format_duration(remaining * seconds));
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
    return fmt::format("{} {} {} {}", whole / large.seconds, large.name,
                       whole % large.seconds / small.seconds, small.name);
  }
  return seconds < 10.0 ? fmt::format("{:.2g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string format_bytes(double bytes) {
  constexpr std::array<const char*, 5> kNames = {"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < kNames.size()) bytes /= 1000.0, ++unit;
  return unit == 0 ? fmt::format("{:.0f} {}", bytes, kNames[unit])
                   : fmt::format("{:.3g} {}", bytes, kNames[unit]);
}

std::string format_count(std::int64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, ",");
  return digits;
}

std::string format_count(std::int64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", format_count(count), noun, count == 1 ? "" : "s");
}

}  // namespace strut
