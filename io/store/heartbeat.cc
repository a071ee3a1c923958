#include "io/store/heartbeat.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <csignal>
#include <map>
#include <new>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/text/parse_number.h"
#include "io/file/file_sync.h"

namespace strut {

namespace {

// Blocks all signals in the calling thread and in threads that it starts, so that other threads
// receive them.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &old_mask_);
  }
  ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &old_mask_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t old_mask_{};
};

}  // namespace

std::string write_runner_text(const ProcessIdentity& identity, std::uint64_t counter,
                              std::uint64_t work) {
  // 20 digits hold any 64 bits.
  return fmt::format(
      "host {}\nboot {}\nnamespace {}\nprocess {}\nstart {}\ncounter {:020}\nwork {:020}\n",
      identity.host, identity.boot, identity.name_space, identity.process, identity.start, counter,
      work);
}

RunnerFile read_runner_text(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream lines(text);
  // A line without its end may be truncated: part of a number would name another process.
  for (std::string line; std::getline(lines, line) && !lines.eof();) {
    const auto space = line.find(' ');
    if (space != std::string::npos) values[line.substr(0, space)] = line.substr(space + 1);
  }
  return {{values["host"], values["boot"], values["namespace"], values["process"], values["start"]},
          parse_number<std::uint64_t>(values["work"]).value_or(0),
          text};
}

Heartbeat::Heartbeat(const Folder& folder, std::string file, ProcessIdentity identity,
                     std::chrono::milliseconds interval, CountWork count_work)
    : folder_(folder),
      file_(std::move(file)),
      identity_(std::move(identity)),
      interval_(interval),
      count_work_(std::move(count_work)) {
  const BlockedSignals blocked;
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error& error) {
    throw EnvironmentError(fmt::format("{}: the thread of the heartbeat cannot be started: {}",
                                       folder_.path_of(file_).string(), error.what()));
  }
}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_all();
  thread_.join();
}

void Heartbeat::run() {
  std::unique_lock lock(mutex_);
  for (std::uint64_t counter = 1; !stopped_.wait_for(lock, interval_, [this] { return stop_; });
       ++counter) {
    beat(counter);
  }
}

// Opens the file each time, since on a network file system others see the content once it is
// closed. Writes in place, which a full disk usually allows; if not, the counter stalls and the
// claims pass to other runners. Makes the file again if it was removed.
void Heartbeat::beat(std::uint64_t counter) const {
  try {
    const std::string text = write_runner_text(identity_, counter, count_work_ ? count_work_() : 0);
    const FileDescriptor file = folder_.open_file(file_, O_WRONLY | O_CREAT);
    if (file.is_open()) write_once(file.get(), std::as_bytes(std::span(text)));
  } catch (const std::exception&) {  // this beat is lost
  }
}

}  // namespace strut
