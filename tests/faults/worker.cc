// A process of its own that does one thing with a sweep folder's files, to be killed or made fail.
//
//   worker publish TARGET SIZE TEMPORARY OWNER   prints "new" or "present"
//   worker replace TARGET TEXT                   by AtomicFile
//   worker append JOURNAL FIRST COUNT            entries "shards/FIRST.h5", ...
//   worker hold FOLDER UNIT                      prints "mine NAME" or "taken NAME", holds it
//                                                until SIGTERM
//   worker contend FOLDER WITNESS ROUNDS         claims unit "u", makes WITNESS while it holds it,
//                                                and again; prints how often it did
//   worker time                                  reads the wall clock
// Exit codes: 0 done, 3 EnvironmentError, its message on standard error.
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/atomic_file.h"
#include "io/file/publish.h"
#include "io/store/claims.h"
#include "io/store/journal.h"
#include "tests/faults/worker_data.h"

namespace strut::test {
namespace {

const ClaimOptions kClaimOptions{std::chrono::milliseconds(20), std::chrono::milliseconds(400)};

int publish_bytes(const std::vector<std::string>& words) {
  const std::string text = make_worker_text(std::stoul(words.at(2)));
  const std::filesystem::path target = words.at(1);
  const auto published = publish(Folder(target.parent_path()), target.filename().string(),
                                 std::as_bytes(std::span(text)), Folder(words.at(3)), words.at(4));
  std::cout << (published == Published::kNew ? "new\n" : "present\n");
  return 0;
}

int replace_text(const std::vector<std::string>& words) {
  write_text_file(words.at(1), words.at(2));
  return 0;
}

int append_entries(const std::vector<std::string>& words) {
  const int first = std::stoi(words.at(2)), count = std::stoi(words.at(3));
  for (int i = first; i < first + count; ++i) append_worker_entry(words.at(1), i);
  return 0;
}

int hold(const std::vector<std::string>& words) {
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  Claims claims(Folder(words.at(1)), kClaimOptions);
  // After the heartbeat's start: a thread that let the signal through would end the process.
  ::pthread_sigmask(SIG_BLOCK, &end, nullptr);
  const bool mine = claims.claim(words.at(2)) == Claims::Answer::kMine;
  std::cout << (mine ? "mine " : "taken ") << claims.runner() << std::endl;
  int signal = 0;
  ::sigwait(&end, &signal);
  return 0;
}

// Whoever holds the unit adds one byte, and sees nobody else's byte come until it gives it back.
int contend(const std::vector<std::string>& words) {
  Claims claims(Folder(words.at(1)), kClaimOptions);
  int held = 0;
  for (int round = 0; round < std::stoi(words.at(3)); ++round) {
    if (claims.claim("u") != Claims::Answer::kMine) continue;
    const int witness = ::open(words.at(2).c_str(), O_CREAT | O_EXCL | O_WRONLY, 0666);
    if (witness < 0) throw EnvironmentError("two runners hold one unit");
    ::close(witness);
    std::this_thread::yield();
    ::unlink(words.at(2).c_str());
    claims.release("u");
    ++held;
  }
  std::cout << held << std::endl;
  return 0;
}

int run(const std::vector<std::string>& words) {
  const std::string& what = words.at(0);
  if (what == "publish") return publish_bytes(words);
  if (what == "replace") return replace_text(words);
  if (what == "append") return append_entries(words);
  if (what == "hold") return hold(words);
  if (what == "contend") return contend(words);
  if (what == "time") return std::chrono::system_clock::now().time_since_epoch().count() == 0;
  throw std::invalid_argument(what);
}

}  // namespace
}  // namespace strut::test

int main(int count, char** words) {
  try {
    return strut::test::run({words + 1, words + count});
  } catch (const strut::EnvironmentError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}
