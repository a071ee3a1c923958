// Folders that strut makes: their contents are reached without following links, and only regular
// files are opened.
#include "io/file/folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <catch2/catch.hpp>
#include <iterator>
#include <set>
#include <string>

#include "io/file/atomic_file.h"
#include "io/file/file_bytes.h"
#include "io/file/process_identity.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::read_text;
using test::TemporaryFolder;

/// A folder of ours and a foreign one beside it.
struct Places {
  TemporaryFolder folder;
  fs::path ours = folder / "ours", theirs = folder / "theirs";

  Places() {
    fs::create_directory(ours);
    fs::create_directory(theirs);
    folder.write("theirs/thesis.tex", "years of work");
  }
  bool is_untouched() const {
    return read_text(theirs / "thesis.tex") == "years of work" &&
           std::distance(fs::directory_iterator(theirs), {}) == 1;
  }
};

TEST_CASE("A folder that the user names may be reached by links, its subfolders may not", "[io]") {
  const Places places;
  fs::create_symlink(places.ours, places.folder / "link");
  const Folder root(places.folder / "link");
  CHECK(root.make_folder("sub").list().empty());
  CHECK(fs::is_directory(places.ours / "sub"));
  fs::create_symlink(places.theirs, places.ours / "elsewhere");
  fs::create_symlink(places.folder / "missing", places.ours / "dangling");
  for (const std::string name : {"elsewhere", "dangling"}) {
    CAPTURE(name);
    CHECK_THROWS_WITH(root.open_folder(name), Contains(name + ": a symbolic link"));
    CHECK_THROWS_AS(root.find_folder(name), InputError);
    CHECK_THROWS_AS(root.make_folder(name), InputError);
  }
  CHECK_FALSE(root.find_folder("no"));
  CHECK_THROWS_WITH(root.open_folder("no"), Contains("no such folder"));
  places.folder.write("ours/file", "");
  CHECK_THROWS_WITH(root.open_folder("file"), Contains("file: not a folder; must be one"));
  CHECK_THROWS_AS(Folder(places.ours / "file"), InputError);
  CHECK_THROWS_AS(Folder(places.ours / "no"), InputError);
  CHECK(places.is_untouched());
}

TEST_CASE("An open folder stays the same if another file takes its name", "[io]") {
  const Places places;
  const Folder folder(places.ours);
  fs::rename(places.ours, places.folder / "moved");
  fs::create_symlink(places.theirs, places.ours);
  write_text_file(folder, "note", "text");
  folder.remove("thesis.tex");
  CHECK(read_text(places.folder / "moved/note") == "text");
  CHECK(places.is_untouched());
}

TEST_CASE("Names that lead out of a folder are refused", "[io]") {
  const Places places;
  const Folder folder(places.ours);
  for (const std::string& name :
       {std::string(), std::string("."), std::string(".."), std::string("../theirs/thesis.tex"),
        places.theirs.string(), std::string("a\0b", 3)}) {
    CAPTURE(name);
    CHECK_THROWS_AS(folder.open_file(name, O_RDONLY), InputError);
    CHECK_THROWS_AS(folder.open_folder(name), InputError);
    CHECK_THROWS_AS(folder.remove(name), InputError);
    CHECK_THROWS_AS(folder.make_folder(name), InputError);
  }
  CHECK(places.is_untouched());
}

TEST_CASE("Links, pipes, devices and folders are not opened as files, and nothing waits for them",
          "[io]") {
  const Places places;
  const Folder folder(places.ours);
  const auto check_refused = [&](const std::string& name, const std::string& kind) {
    CAPTURE(name);
    for (const int flags : {O_RDONLY, O_WRONLY | O_CREAT, O_RDWR | O_CREAT | O_APPEND}) {
      CHECK_THROWS_WITH(folder.open_file(name, flags), Contains(name + ": a " + kind));
    }
    CHECK_THROWS_AS(folder.read_if_present(name), InputError);
    CHECK_THROWS_AS(AtomicFile(folder, name), InputError);
  };
  fs::create_symlink(places.theirs / "thesis.tex", places.ours / "link");
  check_refused("link", "symbolic link");
  fs::create_symlink(places.theirs / "missing", places.ours / "dangling");
  check_refused("dangling", "symbolic link");
  REQUIRE(::mkfifo((places.ours / "pipe").c_str(), 0600) == 0);
  check_refused("pipe", "named pipe");
  fs::create_directory(places.ours / "sub");
  check_refused("sub", "folder");
  if (::mknod((places.ours / "zero").c_str(), S_IFCHR | 0600, makedev(1, 5)) == 0) {
    check_refused("zero", "device");
  }
  CHECK(places.is_untouched());
  // The link is removed, not its target.
  folder.remove("link");
  CHECK_FALSE(folder.has("link"));
  CHECK(places.is_untouched());
}

TEST_CASE("Files that a user names are read through links but never from pipes or devices",
          "[io]") {
  const Places places;
  fs::create_symlink(places.theirs / "thesis.tex", places.folder / "link");
  CHECK(read_bytes(places.folder / "link").size() == 13);
  CHECK(read_if_present(places.folder / "link") == "years of work");
  CHECK_THROWS_WITH(read_bytes("/dev/zero"), Contains("/dev/zero: a device"));
  CHECK_THROWS_WITH(read_bytes(places.ours), Contains("a folder"));
  const fs::path pipe = places.folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_bytes(pipe), Contains("a named pipe"));
  CHECK_THROWS_WITH(read_if_present(pipe), Contains("a named pipe"));
  CHECK_THROWS_WITH(read_bytes(places.folder / "missing"), Contains("not found"));
}

TEST_CASE("Moving a file aside replaces no other", "[io]") {
  const Places places;
  const Folder ours(places.ours), theirs(places.theirs);
  write_text_file(ours, "a", "1");
  CHECK_FALSE(ours.move_new("a", theirs, "thesis.tex"));
  CHECK(places.is_untouched());
  CHECK(ours.move_new("a", ours, "b"));
  CHECK(read_text(places.ours / "b") == "1");
}

TEST_CASE("Temporary files of ended processes are removed, others stay", "[io]") {
  const Places places;
  const Folder folder(places.ours);
  std::string own;
  {
    const AtomicFile file(folder, "m.h5");
    own = file.temporary().filename().string();
    CHECK(folder.has(own));
    remove_abandoned_files(folder);
    CHECK(folder.has(own));  // this process is alive
  }
  CHECK_FALSE(folder.has(own));
  // The name that a process with this number and another start time would give.
  const ProcessIdentity identity = find_own_identity();
  const std::string mark = "-" + identity.process + "-" + identity.start + "-";
  const auto at = own.find(mark);
  REQUIRE(at != std::string::npos);
  std::string dead = own;
  dead.replace(at, mark.size(), "-" + identity.process + "-1-");
  std::string other_host = dead;
  other_host.replace(std::string("m.h5.").size(), 8, "ffffffff");
  const std::set<std::string> kept = {other_host, "m.h5.tmp", "m.h5.aaaaaa", "x-1-1-1.tmp", ".tmp"};
  for (const std::string& name : kept) write_text_file(folder, name, "");
  write_text_file(folder, dead, "");
  remove_abandoned_files(folder, "n.h5.");
  CHECK(folder.has(dead));
  write_text_file(places.ours / "m.h5", "");  // removes the temporary file of an earlier writer
  CHECK_FALSE(folder.has(dead));
  for (const std::string& name : kept) CHECK(folder.has(name));
}

}  // namespace
}  // namespace strut
