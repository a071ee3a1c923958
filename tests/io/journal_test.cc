// The journal loses at most the line that a crash tore.
#include "io/store/journal.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/sha256.h"
#include "tests/faults/replay.h"
#include "tests/faults/run_worker.h"
#include "tests/faults/worker_data.h"
#include "tests/support/limited_file_size.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::append_worker_entry;
using test::make_worker_entry;
using test::read_text;
using test::TemporaryFolder;

bool is_same(const JournalEntry& a, const JournalEntry& b) {
  return a.file == b.file && a.cases == b.cases && a.failures == b.failures && a.bytes == b.bytes &&
         a.sha256 == b.sha256 && a.digest == b.digest && a.seconds == b.seconds &&
         a.time == b.time && a.runner == b.runner && a.duplicate == b.duplicate;
}

/// Returns the numbers of the entries, each of which must equal the one written.
std::multiset<int> read_numbers(const fs::path& journal) {
  std::multiset<int> numbers;
  for (const JournalEntry& entry : read_journal(journal).entries) {
    const int number = std::stoi(entry.file.substr(entry.file.find('/') + 1));
    REQUIRE(is_same(entry, make_worker_entry(number)));
    numbers.insert(number);
  }
  return numbers;
}

std::vector<std::string> write_lines(const fs::path& journal, int count) {
  for (int i = 0; i < count; ++i) append_worker_entry(journal, i);
  std::vector<std::string> lines;
  std::ifstream stream(journal);
  for (std::string line; std::getline(stream, line);) lines.push_back(line + "\n");
  REQUIRE(lines.size() == static_cast<std::size_t>(count));
  return lines;
}

TEST_CASE("Journal entries read back, whatever their texts contain", "[io]") {
  const TemporaryFolder folder;
  const fs::path journal = folder / "journal";
  CHECK(read_journal(journal).entries.empty());
  JournalEntry odd = make_worker_entry(1);
  odd.file = "a b=c%20\n file=check=\t\xC3\xA4,:";
  odd.runner.clear();
  odd.failures = {{"", 1}, {"a,b:c d=e%\n", -5}};
  odd.seconds = 1e-300;
  append_journal(Folder(folder / ""), "journal", odd);
  append_worker_entry(journal, 2);
  JournalEntry plain;
  append_journal(Folder(folder / ""), "journal", plain);
  const Journal read = read_journal(journal);
  REQUIRE(read.entries.size() == 3);
  CHECK(read.bad_lines == 0);
  CHECK(is_same(read.entries[0], odd));
  CHECK(is_same(read.entries[1], make_worker_entry(2)));
  CHECK(is_same(read.entries[2], plain));
}

TEST_CASE("A journal line ends with the first digits of its SHA-256", "[io]") {
  const TemporaryFolder folder;
  const std::string line = write_lines(folder / "journal", 1).front();
  const auto at = line.find(" check=");
  REQUIRE(at != std::string::npos);
  CHECK(line.substr(at + 7) == to_hex(calc_sha256(line.substr(0, at))).substr(0, 16) + "\n");
}

TEST_CASE("A journal truncated at any byte keeps the lines before and takes new ones", "[io]") {
  const TemporaryFolder folder;
  const auto lines = write_lines(folder / "whole", 3);
  const std::string text = lines[0] + lines[1] + lines[2];
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const fs::path journal = folder.write("cut", text.substr(0, size));
    std::multiset<int> expected;
    for (std::size_t line = 0, end = 0; line < lines.size(); ++line) {
      end += lines[line].size();
      // A line is valid without its line end.
      if (size + 1 >= end) expected.insert(static_cast<int>(line));
    }
    INFO(size);
    CHECK((read_numbers(journal) == expected));
    const bool is_torn = size > 0 && text[size - 1] != '\n' && text[size] != '\n';
    CHECK(read_journal(journal).bad_lines == (is_torn ? 1 : 0));
    append_worker_entry(journal, 7);
    expected.insert(7);
    CHECK((read_numbers(journal) == expected));
  }
}

TEST_CASE("A flipped byte anywhere in a journal costs at most one line", "[io]") {
  const TemporaryFolder folder;
  const auto lines = write_lines(folder / "whole", 3);
  const std::string text = lines[0] + lines[1] + lines[2];
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char flip : {'\x01', '\x20', '\x7f'}) {
      std::string changed = text;
      changed[at] = static_cast<char>(changed[at] ^ flip);
      const fs::path journal = folder.write("changed", changed);
      const auto numbers = read_numbers(journal);
      const auto in_line = static_cast<int>(
          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
      const bool is_end = text[at] == '\n';
      INFO(at);
      for (int line = 0; line < 3; ++line) {
        CHECK(numbers.count(line) == (line == in_line && !is_end ? 0 : 1));
      }
      CHECK(read_journal(journal).bad_lines >= 1);
    }
  }
}

TEST_CASE("Journal lines may come twice and in any order", "[io]") {
  const TemporaryFolder folder;
  const auto lines = write_lines(folder / "whole", 3);
  const fs::path journal = folder.write("mixed", lines[2] + "\n" + lines[0] + lines[2] + lines[1]);
  CHECK((read_numbers(journal) == std::multiset<int>{0, 1, 2, 2}));
  CHECK(read_journal(journal).bad_lines == 0);
}

TEST_CASE("Foreign bytes in a journal are ignored", "[io]") {
  const TemporaryFolder folder;
  const auto lines = write_lines(folder / "whole", 2);
  std::mt19937 random(1);
  std::string noise(5000, ' ');
  for (char& c : noise) c = static_cast<char>(random());
  const fs::path journal = folder.write("noisy", noise + "\n" + lines[0] + noise + lines[1]);
  CHECK(read_numbers(journal).count(0) == 1);
  CHECK(read_numbers(journal).count(1) == 1);
}

TEST_CASE("Processes that append to a journal concurrently lose no line", "[io][threads]") {
  const TemporaryFolder folder;
  const fs::path journal = folder / "journal";
  constexpr int kEach = 200;
  std::vector<std::thread> threads;
  threads.reserve(3);
  std::array<int, 3> codes{};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    threads.emplace_back([&, i] {
      const std::string command = std::string("exec " STRUT_WORKER " append ") + journal.string() +
                                  " " + std::to_string(1000 * i) + " " + std::to_string(kEach);
      codes[i] = std::system(command.c_str());
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK((codes == std::array<int, 3>{}));
  const auto numbers = read_numbers(journal);
  CHECK(numbers.size() == 3 * kEach);
  CHECK(std::set<int>(numbers.begin(), numbers.end()).size() == 3 * kEach);
  CHECK(read_journal(journal).bad_lines == 0);
}

TEST_CASE("A crash at any operation costs the journal only its unfinished line", "[io]") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "root");
  const fs::path journal = folder / "root/journal", log = folder / "log";
  REQUIRE(test::run_worker(test::preload_faults(folder / "root", "STRUT_RECORD=" + log.string()),
                           "append " + journal.string() + " 0 5")
              .code == 0);
  const auto operations = test::read_recording(log);
  const fs::path replayed = folder / "replayed";
  fs::create_directories(replayed);
  const auto check = [&](const test::FolderState& state, std::size_t done,
                         const std::string& what) {
    INFO(what);
    state.write(replayed);
    std::multiset<int> flushed;
    for (std::size_t i = 0; i < done; ++i) {
      if (operations[i].call == test::FileCall::kSync) {
        flushed.insert(static_cast<int>(flushed.size()));
      }
    }
    append_worker_entry(replayed / "journal", 99);
    const auto numbers = read_numbers(replayed / "journal");
    CHECK(std::includes(numbers.begin(), numbers.end(), flushed.begin(), flushed.end()));
    CHECK(numbers.size() <= flushed.size() + 2);
    CHECK(numbers.count(99) == 1);
  };
  CHECK(test::for_each_crash_state({}, operations, {}, check) >= 30);
}

TEST_CASE("Every failing call on a journal is an error that costs no other line", "[io]") {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"open", "24:once"}, {"write", "28:once"}, {"write", "28:short"},
      {"write", "4:once"}, {"fsync", "5:once"},  {"read", "5:once"}};
  for (const auto& [kind, how] : faults) {
    for (int n = 1;; ++n) {
      INFO(kind << " " << n << " " << how);
      const TemporaryFolder folder;
      fs::create_directories(folder / "root");
      const fs::path journal = folder / "root/journal", fired = folder / "fired";
      const std::string fault = "STRUT_FAULT=" + kind + ":" + std::to_string(n) + ":" + how +
                                " STRUT_FAULT_FIRED=" + fired.string();
      const auto outcome = test::run_worker(test::preload_faults(folder / "root", fault),
                                            "append " + journal.string() + " 0 4");
      CHECK((outcome.code == 0 || outcome.code == 3));
      // The file, or the folder that could not be opened for it.
      const fs::path named = kind == "open" ? journal.parent_path() : journal;
      if (outcome.code == 3) CHECK_THAT(outcome.messages, Contains(named.string()));
      append_worker_entry(journal, 99);
      const auto numbers = read_numbers(journal);
      CHECK(numbers.count(99) == 1);
      if (outcome.code == 0) CHECK(numbers.size() == 5);
      if (!fs::exists(fired)) {
        CHECK(outcome.code == 0);
        CHECK(n > 3);
        break;
      }
    }
  }
}

TEST_CASE("A journal that cannot grow is an error and stays readable", "[io]") {
  const TemporaryFolder folder;
  const fs::path journal = folder / "journal";
  const auto lines = write_lines(journal, 2);
  {
    const test::LimitedFileSize limit(lines[0].size() + lines[1].size() + 10);
    std::signal(SIGXFSZ, SIG_DFL);
    CHECK_THROWS_AS(append_worker_entry(journal, 2), EnvironmentError);
    CHECK_THROWS_AS(append_worker_entry(journal, 3), EnvironmentError);
  }
  CHECK((read_numbers(journal) == std::multiset<int>{0, 1}));
  append_worker_entry(journal, 4);
  CHECK((read_numbers(journal) == std::multiset<int>{0, 1, 4}));
}

TEST_CASE("A journal that is not a regular file is refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path journal = folder / "journal";
  const auto check_refused = [&](const std::string& kind) {
    CAPTURE(kind);
    CHECK_THROWS_WITH(read_journal(journal), Contains("journal: a " + kind));
    CHECK_THROWS_AS(append_worker_entry(journal, 1), InputError);
    fs::remove(journal);
  };
  fs::create_directory(journal);
  check_refused("folder");
  REQUIRE(::mkfifo(journal.c_str(), 0600) == 0);
  check_refused("named pipe");
}

TEST_CASE("A journal that is a link is not appended to", "[io]") {
  const TemporaryFolder folder;
  folder.write("theirs", "text\n");
  fs::create_symlink(folder / "theirs", folder / "journal");
  CHECK_THROWS_AS(append_worker_entry(folder / "journal", 1), InputError);
  fs::remove(folder / "journal");
  fs::create_symlink(folder / "missing", folder / "journal");
  CHECK_THROWS_AS(append_worker_entry(folder / "journal", 1), InputError);
  CHECK(read_text(folder / "theirs") == "text\n");
  CHECK_FALSE(fs::exists(folder / "missing"));
}

}  // namespace
}  // namespace strut
