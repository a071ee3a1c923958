// A published file is whole or absent, whichever call fails or process is killed.
#include "io/file/publish.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <thread>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/atomic_file.h"
#include "tests/faults/replay.h"
#include "tests/faults/run_worker.h"
#include "tests/faults/worker_data.h"
#include "tests/support/limited_file_size.h"
#include "tests/support/small_disk.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;
using test::FolderState;
using test::make_worker_text;
using test::read_text;
using test::TemporaryFolder;

constexpr std::size_t kSize = 100000;

struct SweepLike {
  TemporaryFolder folder;
  fs::path root, target, temporary;

  SweepLike() : root(folder / "sweep"), target(root / "shards/000042.h5"), temporary(root / "tmp") {
    fs::create_directories(root / "shards");
    fs::create_directories(temporary);
  }

  std::string arguments() const {
    return "publish " + target.string() + " " + std::to_string(kSize) + " " + temporary.string() +
           " host.1.abc";
  }
  bool has_leftover() const { return !fs::is_empty(temporary); }
};

Published publish_at(const fs::path& target, const std::string& text, const fs::path& temporary,
                     const std::string& owner) {
  return publish(Folder(target.parent_path()), target.filename().string(),
                 std::as_bytes(std::span(text)), Folder(temporary), owner);
}

Published publish_text(const SweepLike& sweep, const std::string& text) {
  return publish_at(sweep.target, text, sweep.temporary, "host.1.abc");
}

TEST_CASE("A published file holds the bytes, and no other file remains", "[io]") {
  const SweepLike sweep;
  for (const std::size_t size : {0, 1, 100000, (1 << 20) - 1, 1 << 20, (1 << 20) + 1, 3000000}) {
    const std::string text = make_worker_text(size);
    CHECK(publish_text(sweep, text) == Published::kNew);
    CHECK(read_text(sweep.target) == text);
    CHECK_FALSE(sweep.has_leftover());
    fs::remove(sweep.target);
  }
}

TEST_CASE("A published file is never replaced", "[io]") {
  const SweepLike sweep;
  CHECK(publish_text(sweep, "first") == Published::kNew);
  CHECK(publish_text(sweep, "second") == Published::kPresent);
  CHECK(read_text(sweep.target) == "first");
  CHECK_FALSE(sweep.has_leftover());
}

TEST_CASE("One of many concurrent publishers is first", "[io][threads]") {
  const SweepLike sweep;
  for (int round = 0; round < 20; ++round) {
    std::array<Published, 4> answers{};
    std::vector<std::thread> threads;
    threads.reserve(answers.size());
    for (std::size_t i = 0; i < answers.size(); ++i) {
      threads.emplace_back([&, i] { answers[i] = publish_text(sweep, std::string(20000, 'x')); });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(std::count(answers.begin(), answers.end(), Published::kNew) == 1);
    CHECK(fs::file_size(sweep.target) == 20000);
    CHECK_FALSE(sweep.has_leftover());
    fs::remove(sweep.target);
  }
}

TEST_CASE("A crash at any operation leaves a published file whole or absent", "[io]") {
  const SweepLike sweep;
  const fs::path log = sweep.folder / "log";
  const auto outcome = test::run_worker(
      test::preload_faults(sweep.root, "STRUT_RECORD=" + log.string()), sweep.arguments());
  REQUIRE(outcome.code == 0);
  REQUIRE(outcome.out == "new\n");
  const auto operations = test::read_recording(log);
  const std::string text = make_worker_text(kSize);
  const std::string name = "shards/000042.h5";
  int whole = 0, absent = 0;
  const auto check = [&](const FolderState& state, std::size_t, const std::string& what) {
    INFO(what);
    ++(state.has(name) ? whole : absent);
    if (state.has(name)) CHECK((state.content(name) == text));
  };
  const int states = test::for_each_crash_state({}, operations, {}, check);
  CHECK(states >= 10);
  CHECK(whole >= 2);
  CHECK(absent >= 7);
  // The last state of the recording must equal the folder.
  FolderState last;
  for (const test::Operation& operation : operations) last.apply(operation);
  CHECK(last.names().size() == 1);
  CHECK((read_text(sweep.target) == text));
  // The folder is flushed after the file got its name.
  CHECK(operations.back().call == test::FileCall::kSyncFolder);
  CHECK(operations.back().path == "shards");
}

// Makes the N-th call of a kind fail, N = 1, 2, ..., until there is no N-th call.
int check_all_faults(const std::string& kind, int error_number, const std::string& mode) {
  for (int n = 1;; ++n) {
    INFO(kind << " " << n << " " << mode);
    const SweepLike sweep;
    const fs::path fired = sweep.folder / "fired";
    const std::string fault = "STRUT_FAULT=" + kind + ":" + std::to_string(n) + ":" +
                              std::to_string(error_number) + ":" + mode +
                              " STRUT_FAULT_FIRED=" + fired.string();
    const auto outcome =
        test::run_worker(test::preload_faults(sweep.root, fault), sweep.arguments());
    const bool is_whole =
        fs::exists(sweep.target) && read_text(sweep.target) == make_worker_text(kSize);
    CHECK((is_whole || !fs::exists(sweep.target)));
    if (kind != "unlink") CHECK_FALSE(sweep.has_leftover());
    CHECK((outcome.code == 0 || outcome.code == 3));
    if (outcome.code == 0) CHECK(is_whole);
    // The file, or the folder that could not be opened for it.
    const fs::path named = kind == "open" ? sweep.root : sweep.target;
    if (outcome.code == 3) CHECK_THAT(outcome.messages, Contains(named.string()));
    if (!fs::exists(fired)) return n - 1;
  }
}

TEST_CASE("No failing call leaves a wrong published file or a temporary one", "[io]") {
  for (const std::string mode : {"once", "forever"}) {
    CHECK(check_all_faults("open", EMFILE, mode) == 4);  // both folders, the file, its folder again
    CHECK(check_all_faults("write", ENOSPC, mode) == 1);
    CHECK(check_all_faults("write", EIO, mode) == 1);
    CHECK(check_all_faults("fsync", EIO, mode) == 2);  // the file and its folder
    CHECK(check_all_faults("read", EIO, mode) == 2);   // the bytes and the end
    CHECK(check_all_faults("link", EIO, mode) == 1);
    CHECK(check_all_faults("link", EPERM, mode) == 1);
    CHECK(check_all_faults("unlink", EIO, mode) == 1);
  }
  CHECK(check_all_faults("write", ENOSPC, "short") == 1);
  CHECK(check_all_faults("write", EINTR, "once") == 1);
  CHECK(check_all_faults("read", 0, "flip") == 2);
}

TEST_CASE("Publishing without links replaces no file either", "[io]") {
  const SweepLike sweep;
  const std::string variables =
      test::preload_faults(sweep.root, "STRUT_FAULT=link:1:1:forever STRUT_FAULT_FIRED=" +
                                           (sweep.folder / "fired").string());
  CHECK(test::run_worker(variables, sweep.arguments()).out == "new\n");
  CHECK((read_text(sweep.target) == make_worker_text(kSize)));
  CHECK_FALSE(sweep.has_leftover());
  fs::resize_file(sweep.target, 7);
  CHECK(test::run_worker(variables, sweep.arguments()).out == "present\n");
  CHECK(fs::file_size(sweep.target) == 7);
  CHECK_FALSE(sweep.has_leftover());
  CHECK(fs::exists(sweep.folder / "fired"));
}

TEST_CASE("A disk that returns other bytes is an error, and nothing is published", "[io]") {
  const SweepLike sweep;
  const auto outcome = test::run_worker(
      test::preload_faults(sweep.root, "STRUT_FAULT=read:1:0:flip STRUT_FAULT_FIRED=" +
                                           (sweep.folder / "fired").string()),
      sweep.arguments());
  CHECK(outcome.code == 3);
  CHECK_THAT(outcome.messages, Contains("other bytes than written"));
  CHECK_FALSE(fs::exists(sweep.target));
  CHECK_FALSE(sweep.has_leftover());
}

TEST_CASE("A limit on file size is an error and does not end the process", "[io]") {
  const SweepLike sweep;
  {
    const test::LimitedFileSize limit(50000);
    // The default action of the signal ends the process.
    std::signal(SIGXFSZ, SIG_DFL);
    CHECK_THROWS_WITH(publish_text(sweep, std::string(kSize, 'x')),
                      Contains(sweep.target.string()) && Contains("File too large"));
    CHECK(publish_text(sweep, std::string(1000, 'x')) == Published::kNew);
    sigset_t pending;
    sigpending(&pending);
    CHECK(sigismember(&pending, SIGXFSZ) == 0);
  }
  CHECK(fs::file_size(sweep.target) == 1000);
  CHECK_FALSE(sweep.has_leftover());
}

TEST_CASE("The error for a folder removed after it was opened names the target", "[io]") {
  const SweepLike sweep;
  const Folder shards(sweep.root / "shards"), temporary(sweep.temporary);
  fs::remove(sweep.root / "shards");
  CHECK_THROWS_AS(publish(shards, "1.h5", {}, temporary, "a"), EnvironmentError);
  CHECK_THROWS_WITH(publish(shards, "1.h5", {}, temporary, "a"), Contains("shards/1.h5"));
  CHECK_FALSE(sweep.has_leftover());
}

TEST_CASE("A full disk is an error, published files stay, and more fit once there is space",
          "[io]") {
  const SweepLike sweep;
  const test::SmallDisk disk(sweep.root, 1);
  if (!disk.is_mounted()) {
    WARN("skipped: a small file system can be mounted by root only");
    return;
  }
  fs::create_directories(sweep.temporary);
  fs::create_directories(sweep.root / "shards");
  const std::string text = make_worker_text(300000);
  const auto name = [&](int i) { return sweep.root / "shards" / std::to_string(i); };
  int published = 0;
  std::string message;
  try {
    for (; published < 10; ++published) publish_at(name(published), text, sweep.temporary, "a.1.b");
  } catch (const EnvironmentError& error) {
    message = error.what();
  }
  CHECK(published == 3);
  CHECK_THAT(message, Contains(name(3).string()) && Contains("No space left"));
  CHECK_FALSE(sweep.has_leftover());
  CHECK_FALSE(fs::exists(name(3)));
  for (int i = 0; i < published; ++i) CHECK((read_text(name(i)) == text));
  fs::remove(name(0));
  CHECK(publish_at(name(3), text, sweep.temporary, "a.1.b") == Published::kNew);
  CHECK((read_text(name(3)) == text));
}

TEST_CASE("Every failing call leaves a replaced file old or new", "[io]") {
  for (const std::string kind : {"open", "write", "fsync", "rename"}) {
    for (int n = 1;; ++n) {
      INFO(kind << " " << n);
      const TemporaryFolder folder;
      fs::create_directories(folder / "root");
      const fs::path target = folder.write("root/result", "old"), fired = folder / "fired";
      const std::string fault = "STRUT_FAULT=" + kind + ":" + std::to_string(n) +
                                ":5:once STRUT_FAULT_FIRED=" + fired.string();
      const auto outcome = test::run_worker(test::preload_faults(folder / "root", fault),
                                            "replace " + target.string() + " new");
      const std::string content = read_text(target);
      CHECK((content == "new" || (outcome.code == 3 && content == "old")));
      CHECK((outcome.code == 0 || outcome.code == 3));
      CHECK(std::distance(fs::directory_iterator(folder / "root"), {}) == 1);
      if (!fs::exists(fired)) {
        CHECK(n >= 2);
        break;
      }
    }
  }
}

TEST_CASE("A crash at any operation leaves a replaced file old or new", "[io]") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "root");
  const fs::path target = folder.write("root/result", "old"), log = folder / "log";
  const FolderState before(folder / "root");
  const auto outcome =
      test::run_worker(test::preload_faults(folder / "root", "STRUT_RECORD=" + log.string()),
                       "replace " + target.string() + " brand_new");
  REQUIRE(outcome.code == 0);
  const auto check = [&](const FolderState& state, std::size_t, const std::string& what) {
    INFO(what);
    CHECK((state.content("result") == "old" || state.content("result") == "brand_new"));
  };
  CHECK(test::for_each_crash_state(before, test::read_recording(log), {}, check) >= 8);
}

}  // namespace
}  // namespace strut
