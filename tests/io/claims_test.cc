// Each unit has one runner; the unit of a dead runner passes to another.
#include "io/store/claims.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <vector>

#include "base/error/input_error.h"
#include "tests/faults/run_worker.h"
#include "tests/support/limited_file_size.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using test::Holder;
using test::read_text;
using test::TemporaryFolder;
using Answer = Claims::Answer;

// Short, so that tests do not wait; long compared with the delay of a thread on a loaded machine.
const ClaimOptions kOptions{milliseconds(20), milliseconds(400)};
// For tests in which no lease may end.
const ClaimOptions kLongLease{milliseconds(20), milliseconds(1000000)};

/// Waits until `is_so` holds; false after 10 s, longer than any machine needs.
bool wait_until(const std::function<bool()>& is_so) {
  for (int i = 0; i < 2000; ++i) {
    if (is_so()) return true;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return false;
}

/// Writes a runner's file that differs from that of `model` in one line.
void write_runner(const fs::path& folder, const std::string& name, const Claims& model,
                  const std::string& key, const std::string& value, int counter = 0) {
  std::istringstream lines(read_text(folder / ("runner." + model.runner())));
  std::ofstream stream(folder / ("runner." + name));
  for (std::string line; std::getline(lines, line);) {
    const bool changes = line.starts_with(key + " ");
    if (line.starts_with("counter ")) line = "counter " + std::to_string(counter);
    stream << (changes ? key + " " + value : line) << '\n';
  }
}

std::set<std::string> list_files(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

TEST_CASE("A claimed unit is taken until it is released", "[io]") {
  const TemporaryFolder folder;
  Claims a(Folder(folder / ""), kLongLease), b(Folder(folder / ""), kLongLease);
  CHECK(a.runner() != b.runner());
  CHECK(a.claim("000001") == Answer::kMine);
  CHECK(a.claim("000001") == Answer::kTaken);
  CHECK(b.claim("000001") == Answer::kTaken);
  CHECK(b.claim("000002") == Answer::kMine);
  b.release("000001");  // not its own
  CHECK(b.claim("000001") == Answer::kTaken);
  a.release("000001");
  CHECK(b.claim("000001") == Answer::kMine);
  CHECK(a.may_be_alive(b.runner()));
  CHECK(a.may_be_alive(a.runner()));
}

TEST_CASE("A runner that ends releases its claims and leaves no file", "[io]") {
  const TemporaryFolder folder;
  Claims a(Folder(folder / ""), kLongLease);
  std::string name;
  {
    Claims b(Folder(folder / ""), kLongLease);
    name = b.runner();
    CHECK(b.claim("1") == Answer::kMine);
    CHECK(b.claim("2") == Answer::kMine);
  }
  CHECK_FALSE(a.may_be_alive(name));
  CHECK(list_files(folder / "") == std::set<std::string>{"runner." + a.runner()});
  CHECK(a.claim("1") == Answer::kMine);
}

TEST_CASE("Claims are listed with their runners", "[io]") {
  const TemporaryFolder folder;
  CHECK(list_claims(Folder(folder / "")).empty());
  Claims a(Folder(folder / ""), kLongLease);
  Holder b(folder / "", "000007");
  REQUIRE(b.is_mine());
  CHECK(a.claim("000003") == Answer::kMine);
  const auto claims = list_claims(Folder(folder / ""));
  REQUIRE(claims.size() == 2);
  CHECK(claims[0].unit == "000003");
  CHECK(claims[0].runner == a.runner());
  CHECK(claims[1].unit == "000007");
  CHECK(claims[1].runner == b.runner());
  b.end_unasked(SIGKILL);
  CHECK(list_claims(Folder(folder / "")).size() == 1);
}

TEST_CASE("An invalid name of a unit is refused", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  for (const std::string name : {"", "a/b", "a~b", ".", "..", "runner.x", "new.x"}) {
    CHECK_THROWS_AS(claims.claim(name), std::invalid_argument);
  }
}

TEST_CASE("No two runners in threads hold the same unit", "[io][threads]") {
  const TemporaryFolder folder;
  std::array<std::atomic<int>, 3> holders{};
  std::atomic<int> overlaps{0}, held{0};
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      Claims claims(Folder(folder / ""), kLongLease);
      for (std::size_t round = 0; round < 300; ++round) {
        const std::size_t unit = round % holders.size();
        if (claims.claim(std::to_string(unit)) != Answer::kMine) continue;
        ++held;
        if (++holders[unit] > 1) ++overlaps;
        std::this_thread::yield();
        --holders[unit];
        claims.release(std::to_string(unit));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(overlaps == 0);
  CHECK(held > 0);
  CHECK(list_files(folder / "").empty());
}

TEST_CASE("No two threads of one runner hold the same unit", "[io][threads]") {
  const TemporaryFolder folder;
  constexpr std::size_t kUnits = 200;
  Claims claims(Folder(folder / ""), kLongLease);
  std::array<std::atomic<int>, kUnits> mine{};
  std::atomic<int> holders{0}, overlaps{0};
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < kUnits; ++i) {
        if (claims.claim(std::to_string(i)) == Answer::kMine) ++mine[i];
        if (claims.may_be_alive("elsewhere.1.0123456789abcdef")) ++overlaps;
        // A unit that passes from thread to thread.
        if (claims.claim("shared") != Answer::kMine) continue;
        if (++holders > 1) ++overlaps;
        std::this_thread::yield();
        --holders;
        claims.release("shared");
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(std::all_of(mine.begin(), mine.end(), [](int count) { return count == 1; }));
  CHECK(overlaps == 0);
  CHECK(list_files(folder / "").size() == kUnits + 1);
}

TEST_CASE("No two runners in processes hold the same unit", "[io][threads]") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "claims");
  std::vector<std::thread> threads;
  threads.reserve(3);
  std::array<int, 3> codes{};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    threads.emplace_back([&, i] {
      const std::string command = "exec " STRUT_WORKER " contend " + (folder / "claims").string() +
                                  " " + (folder / "witness").string() + " 300 >/dev/null";
      codes[i] = std::system(command.c_str());
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK((codes == std::array<int, 3>{}));
  CHECK(list_files(folder / "claims").empty());
}

TEST_CASE("The claims of a killed runner are free at once on its host", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  Holder holder(folder / "", "1");
  REQUIRE(holder.is_mine());
  CHECK(claims.claim("1") == Answer::kTaken);
  CHECK(claims.may_be_alive(holder.runner()));
  SECTION("while nobody has asked how it ended") {
    holder.end_unasked(SIGKILL);
    CHECK(claims.claim("1") == Answer::kMine);
    CHECK_FALSE(claims.may_be_alive(holder.runner()));
  }
  SECTION("and after") {
    holder.end(SIGKILL);
    CHECK(claims.claim("1") == Answer::kMine);
    CHECK_FALSE(claims.may_be_alive(holder.runner()));
  }
  claims.release("1");
  // The next runner removes the files of the killed one.
  Claims next(Folder(folder / ""), kLongLease);
  CHECK(list_files(folder / "") ==
        std::set<std::string>{"runner." + claims.runner(), "runner." + next.runner()});
  CHECK_FALSE(claims.may_be_alive(holder.runner()));
}

TEST_CASE("A runner that handles SIGTERM ends normally and releases its claims", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  Holder holder(folder / "", "1");
  REQUIRE(holder.is_mine());
  holder.end(SIGTERM);
  CHECK(list_files(folder / "") == std::set<std::string>{"runner." + claims.runner()});
}

TEST_CASE("One of many runners takes over the claim of a killed runner", "[io][threads]") {
  const TemporaryFolder folder;
  constexpr std::size_t kUnits = 500;
  Holder holder(folder / "", "0");
  REQUIRE(holder.is_mine());
  std::array<std::unique_ptr<Claims>, 4> runners;
  for (auto& runner : runners) runner = std::make_unique<Claims>(Folder(folder / ""), kLongLease);
  holder.end_unasked(SIGKILL);
  for (std::size_t i = 1; i < kUnits; ++i) folder.write(std::to_string(i), holder.runner() + "\n");
  std::array<std::atomic<int>, kUnits> mine{};
  std::vector<std::thread> threads;
  threads.reserve(runners.size());
  for (auto& runner : runners) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < kUnits; ++i) {
        if (runner->claim(std::to_string(i)) == Answer::kMine) ++mine[i];
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(std::all_of(mine.begin(), mine.end(), [](int count) { return count == 1; }));
  // No right to take over remains.
  CHECK(list_files(folder / "").size() == kUnits + runners.size() + 1);
}

TEST_CASE("A runner killed while it takes over blocks nobody", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  Holder first(folder / "", "1"), second(folder / "", "2");
  REQUIRE((first.is_mine() && second.is_mine()));
  first.end_unasked(SIGKILL);
  second.end_unasked(SIGKILL);
  // As if the second had died while it held the right to replace the first one's claim.
  const std::string nonce = first.runner().substr(first.runner().rfind('.') + 1);
  fs::rename(folder / "2", folder / ("1~" + nonce));
  CHECK(claims.claim("1") == Answer::kMine);
  CHECK(list_files(folder / "").count("1~" + nonce) == 0);
}

TEST_CASE("The claim of another host is held while its counter changes, and free one lease later",
          "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kOptions);
  const std::string runner = "elsewhere.example.org.1.0123456789abcdef";
  std::string key, value;
  std::tie(key, value) = GENERATE(std::pair<std::string, std::string>{"host", "elsewhere"},
                                  std::pair<std::string, std::string>{"boot", "another-boot"},
                                  std::pair<std::string, std::string>{"namespace", "pid:[1]"});
  INFO(key);
  folder.write("1", runner + "\n");
  const auto start = std::chrono::steady_clock::now();
  for (int beat = 0; std::chrono::steady_clock::now() - start < 3 * kOptions.lease; ++beat) {
    write_runner(folder / "", runner, claims, key, value, beat);
    REQUIRE(claims.claim("1") == Answer::kTaken);
    REQUIRE(claims.may_be_alive(runner));
    std::this_thread::sleep_for(milliseconds(20));
  }
  const auto last = std::chrono::steady_clock::now();
  CHECK(claims.claim("1") == Answer::kTaken);
  CHECK(wait_until([&] { return claims.claim("1") == Answer::kMine; }));
  CHECK(std::chrono::steady_clock::now() - last >= kOptions.lease - milliseconds(40));
  CHECK_FALSE(claims.may_be_alive(runner));
}

TEST_CASE("A reused process number is not mistaken for the old runner", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  // This process with another start time.
  write_runner(folder / "", "a.1.000000000000000a", claims, "start", "12");
  folder.write("1", "a.1.000000000000000a\n");
  CHECK_FALSE(claims.may_be_alive("a.1.000000000000000a"));
  CHECK(claims.claim("1") == Answer::kMine);
  // The same start time: the same process.
  write_runner(folder / "", "a.1.000000000000000b", claims, "none", "");
  folder.write("2", "a.1.000000000000000b\n");
  CHECK(claims.may_be_alive("a.1.000000000000000b"));
  CHECK(claims.claim("2") == Answer::kTaken);
}

TEST_CASE("A stopped runner keeps its claim for one lease, and its name", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kOptions);
  Holder holder(folder / "", "1");
  REQUIRE(holder.is_mine());
  holder.send(SIGSTOP);
  std::this_thread::sleep_for(milliseconds(50));  // the counter has stopped
  CHECK(claims.claim("1") == Answer::kTaken);
  const auto start = std::chrono::steady_clock::now();
  CHECK(wait_until([&] { return claims.claim("1") == Answer::kMine; }));
  CHECK(std::chrono::steady_clock::now() - start >= kOptions.lease - milliseconds(40));
  CHECK(claims.may_be_alive(holder.runner()));
  // It continues, and leaves the new holder its claim.
  holder.send(SIGCONT);
  holder.end(SIGTERM);
  CHECK(read_text(folder / "1") == claims.runner() + "\n");
}

TEST_CASE("Empty and wrong claims block no runner", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kOptions);
  folder.write("1", "");
  folder.write("2", "no such runner\n");
  folder.write("3", "../../etc/passwd\n");
  for (const std::string unit : {"1", "2", "3"}) CHECK(claims.claim(unit) == Answer::kMine);
  // An empty runner's file, as a power cut may leave it: only the lease can decide.
  folder.write("runner.x.1.000000000000000c", "");
  folder.write("4", "x.1.000000000000000c\n");
  CHECK(claims.claim("4") == Answer::kTaken);
  CHECK(wait_until([&] { return claims.claim("4") == Answer::kMine; }));
}

TEST_CASE("A truncated runner's file does not count as that of a dead runner", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  const std::string text = read_text(folder / ("runner." + claims.runner()));
  folder.write("1", "half.1.000000000000000d\n");
  for (std::size_t size = 0; size <= text.size(); ++size) {
    folder.write("runner.half.1.000000000000000d", text.substr(0, size));
    INFO("'" << text.substr(0, size) << "'");
    REQUIRE(claims.may_be_alive("half.1.000000000000000d"));
    REQUIRE(claims.claim("1") == Answer::kTaken);
  }
}

TEST_CASE("The heartbeat continues after its file was removed", "[io]") {
  const TemporaryFolder folder;
  Claims claims(Folder(folder / ""), kLongLease);
  const fs::path file = folder / ("runner." + claims.runner());
  fs::remove(file);
  REQUIRE(wait_until([&] { return fs::exists(file); }));
  const std::string before = read_text(file);
  CHECK(wait_until([&] { return read_text(file) != before; }));
}

TEST_CASE("A full disk stalls the counter, not the process", "[io]") {
  const TemporaryFolder folder;
  Claims a(Folder(folder / ""), kLongLease), b(Folder(folder / ""), kLongLease);
  REQUIRE(a.claim("1") == Answer::kMine);
  const fs::path file = folder / ("runner." + a.runner());
  {
    const test::LimitedFileSize limit(0);
    std::signal(SIGXFSZ, SIG_DFL);
    std::this_thread::sleep_for(milliseconds(100));
    const std::string before = read_text(file);
    std::this_thread::sleep_for(milliseconds(100));
    CHECK(read_text(file) == before);
    CHECK_THROWS_AS(b.claim("2"), EnvironmentError);
    a.release("1");
  }
  const std::string before = read_text(file);
  CHECK(wait_until([&] { return read_text(file) != before; }));
  CHECK(b.claim("1") == Answer::kMine);
}

TEST_CASE("Every failing call on claims is an error, and no two runners hold the same unit",
          "[io]") {
  for (const std::string kind : {"open", "write", "link", "rename", "read", "unlink"}) {
    for (int n = 1;; ++n) {
      INFO(kind << " " << n);
      const TemporaryFolder folder;
      fs::create_directories(folder / "root");
      const fs::path fired = folder / "fired";
      const std::string fault = "STRUT_FAULT=" + kind + ":" + std::to_string(n) +
                                ":5:once STRUT_FAULT_FIRED=" + fired.string();
      const auto outcome = test::run_worker(
          test::preload_faults(folder / "root", fault),
          "contend " + (folder / "root").string() + " " + (folder / "witness").string() + " 2");
      CHECK((outcome.code == 0 || outcome.code == 3));
      // No remaining file names a runner that is alive.
      Claims claims(Folder(folder / "root"), kLongLease);
      CHECK(claims.claim("u") == Answer::kMine);
      if (!fs::exists(fired)) {
        CHECK(outcome.out == "2\n");
        break;
      }
    }
  }
}

TEST_CASE("Claims do not read the wall clock", "[io]") {
  const TemporaryFolder folder;
  const std::string arguments =
      "contend " + (folder / "claims").string() + " " + (folder / "witness").string() + " 50";
  fs::create_directories(folder / "claims");
  const std::string preload = test::preload_faults(folder / "claims", "STRUT_NO_WALL_CLOCK=1");
  Holder holder(folder / "claims", "u");
  REQUIRE(holder.is_mine());
  // The counter of another runner and the lease, then a takeover.
  CHECK(test::run_worker(preload, arguments).out == "0\n");
  holder.end_unasked(SIGKILL);
  CHECK(test::run_worker(preload, arguments).out == "50\n");
  // The check detects a process that reads the time.
  CHECK(test::run_worker(preload, "time").code == -1);
  CHECK(test::run_worker("", "time").code == 0);
}

}  // namespace
}  // namespace strut
