#include "io/store/heartbeat.h"

#include <fcntl.h>

#include <csignal>
#include <map>
#include <new>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>

#include "io/file/file_sync.h"

namespace strut {

namespace {

constexpr std::size_t kCounterDigits = 20;  // of any 64 bits

// No signal is delivered to the calling thread, nor to threads it starts: those go to the threads
// that expect them.
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

std::string write_runner_text(const ProcessIdentity& identity, std::uint64_t counter) {
  std::string digits = std::to_string(counter);
  digits.insert(0, kCounterDigits - digits.size(), '0');
  return "host " + identity.host + "\nboot " + identity.boot + "\nnamespace " +
         identity.name_space + "\nprocess " + identity.process + "\nstart " + identity.start +
         "\ncounter " + digits + "\n";
}

RunnerFile read_runner_text(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream lines(text);
  // Without its end a line may be cut short: half a number would be another process's.
  for (std::string line; std::getline(lines, line) && !lines.eof();) {
    const auto space = line.find(' ');
    if (space != std::string::npos) values[line.substr(0, space)] = line.substr(space + 1);
  }
  return {{values["host"], values["boot"], values["namespace"], values["process"], values["start"]},
          text};
}

Heartbeat::Heartbeat(const Folder& folder, std::string file, ProcessIdentity identity,
                     std::chrono::milliseconds interval)
    : folder_(folder), file_(std::move(file)), identity_(std::move(identity)), interval_(interval) {
  const BlockedSignals blocked;
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error& error) {
    throw EnvironmentError(folder_.path_of(file_).string() +
                           ": no thread for the heartbeat: " + error.what());
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

// Opened each time: on a network file system others see it from the close on. Written in place,
// which a full disk allows; where it does not, the counter stands still and the claims go to
// others in time. Made anew where somebody removed it.
void Heartbeat::beat(std::uint64_t counter) const {
  try {
    const std::string text = write_runner_text(identity_, counter);
    const FileDescriptor file = folder_.open_file(file_, O_WRONLY | O_CREAT);
    if (file.is_open()) write_once(file.get(), std::as_bytes(std::span(text)));
  } catch (const std::exception&) {  // one beat less
  }
}

}  // namespace strut
