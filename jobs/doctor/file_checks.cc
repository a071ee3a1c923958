#include "jobs/doctor/file_checks.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "cluster/file_system.h"
#include "io/file/folder.h"
#include "io/store/sweep_folder.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

/// A folder that vanishes with this object, which signals wait for.
class TrialFolder {
 public:
  explicit TrialFolder(const fs::path& parent) {
    std::string name = (parent / "doctor.XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw file_failure(name, "cannot be made", errno);
    path_ = name;
  }
  ~TrialFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TrialFolder(const TrialFolder&) = delete;
  TrialFolder& operator=(const TrialFolder&) = delete;

  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  const InterruptGuard guard_;
  fs::path path_;
};

/// errno; 0: it worked.
int write_file(const fs::path& path, std::size_t bytes, int flags, bool flushes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0600);
  if (file < 0) return errno;
  const std::string data(bytes, 'x');
  int failure = ::write(file, data.data(), data.size()) == static_cast<ssize_t>(bytes) ? 0 : errno;
  if (failure == 0 && flushes && ::fsync(file) != 0) failure = errno;
  ::close(file);
  return failure;
}

std::string explain(int failure) { return failure == 0 ? "works" : std::strerror(failure); }

Finding check_exclusive_create(const TrialFolder& folder) {
  const int first = write_file(folder / "claim", 1, O_EXCL, false);
  const int second = write_file(folder / "claim", 1, O_EXCL, false);
  const bool holds = first == 0 && second == EEXIST;
  return {"exclusive create", holds ? Health::kGood : Health::kBad,
          first != 0    ? explain(first)
          : second == 0 ? "two got the same file"
                        : "one of two gets it",
          holds ? "runners claim shards without locks"
                : "runners may do the same shards: wasted work, no wrong data"};
}

/// A shard is published by a name that never replaces another.
Finding check_publishing(const TrialFolder& folder) {
  write_file(folder / "new", 1, 0, false);
  write_file(folder / "old", 1, 0, false);
  const fs::path made = folder / "new", old = folder / "old", target = folder / "target";
  const bool links = ::link(made.c_str(), target.c_str()) == 0;
  const bool link_keeps = ::link(made.c_str(), old.c_str()) != 0 && errno == EEXIST;
  if (links && link_keeps) {
    return {"publishing", Health::kGood, "by link(2), which never replaces",
            "a published shard is never changed"};
  }
  const bool rename_keeps =
      ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, old.c_str(), RENAME_NOREPLACE) != 0 &&
      errno == EEXIST;
  if (rename_keeps) {
    return {"publishing", Health::kGood, "by renameat2(2), no links here",
            "a published shard is never changed"};
  }
  return {"publishing", Health::kBad, "neither link(2) nor renameat2(2) refuses to replace a file",
          "shards cannot be published here"};
}

Finding check_rename(const TrialFolder& folder) {
  write_file(folder / "a", 3, 0, false);
  write_file(folder / "b", 5, 0, false);
  std::error_code error;
  fs::rename(folder / "a", folder / "b", error);
  const bool holds = !error && fs::file_size(folder / "b", error) == 3;
  return {"rename", holds ? Health::kGood : Health::kBad,
          error   ? error.message()
          : holds ? "replaces whole"
                  : "does not replace",
          holds ? "reports and records are whole or absent" : "records may be torn"};
}

Finding check_flush(const TrialFolder& folder) {
  constexpr std::size_t kBytes = 65536;
  constexpr double kSlow = 0.1;  // s
  std::array<double, 9> costs{};
  for (double& cost : costs) {
    const auto start = SteadyClock::now();
    const int failure = write_file(folder / "flushed", kBytes, O_TRUNC, true);
    cost = seconds_since(start);
    if (failure != 0) {
      return {"flush to disk", Health::kBad, explain(failure),
              "a power cut may lose shards that were reported as done"};
    }
  }
  std::nth_element(costs.begin(), costs.begin() + costs.size() / 2, costs.end());
  const double median = costs[costs.size() / 2];
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f ms for 64 kB", 1e3 * median);
  return {"flush to disk", median < kSlow ? Health::kGood : Health::kWarning, text.data(),
          median < kSlow ? "a published shard survives a power cut"
                         : "slow: plan larger shards, as each is flushed once"};
}

Finding check_clock(const TrialFolder& folder) {
  constexpr double kMuch = 2.0;  // s
  write_file(folder / "time", 1, 0, false);
  struct stat facts {};
  ::stat((folder / "time").c_str(), &facts);
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  const double skew = static_cast<double>(facts.st_mtim.tv_sec - now.tv_sec) +
                      1e-9 * static_cast<double>(facts.st_mtim.tv_nsec - now.tv_nsec);
  const bool much = std::abs(skew) > kMuch;
  return {"clock of the file system", much ? Health::kWarning : Health::kGood,
          format_rounded(std::round(100.0 * skew) / 100.0 + 0.0) + " s off this machine's",
          much ? "claims do not need it; rates and times to go in `strut status` are off"
               : "claims do not need it, rates are right"};
}

Finding check_space(const fs::path& folder, const SpaceNeeds& needs) {
  struct statvfs facts {};
  ::statvfs(folder.c_str(), &facts);
  const double free = static_cast<double>(facts.f_bavail) * static_cast<double>(facts.f_frsize);
  const bool enough = free > 1.1 * needs.bytes;
  return {"space", enough ? Health::kGood : Health::kBad,
          format_bytes(free) + " free, " + format_bytes(needs.bytes) + " still needed at most",
          enough ? "" : "the sweep would stop on a full disk; what is written stays"};
}

Finding check_inodes(const fs::path& folder, const SpaceNeeds& needs) {
  struct statvfs facts {};
  ::statvfs(folder.c_str(), &facts);
  const std::string needed = format_count(needs.files) + " files still needed";
  // Some file systems make them as they go, and report none.
  if (facts.f_files == 0) return {"files", Health::kGood, "no limit told, " + needed, ""};
  const auto free = static_cast<std::int64_t>(facts.f_favail);
  const bool enough = free > needs.files;
  return {"files", enough ? Health::kGood : Health::kBad, format_count(free) + " free, " + needed,
          enough ? "" : "plan larger shards: a file each"};
}

Finding check_sight(const fs::path& folder) {
  const std::string local = find_local_file_system(folder);
  return {"file system", Health::kGood, local.empty() ? "of a network, or unknown" : local,
          local.empty() ? "other machines may see it"
                        : "of this machine alone: for `strut run` and --to local"};
}

/// Links in place of what strut writes: commands that would write through them refuse to.
Finding check_links(const fs::path& path) {
  const Folder folder(path);
  std::string links;
  for (const std::string& name : folder.list()) {
    std::error_code error;
    const fs::path leads_to = fs::read_symlink(folder.path_of(name), error);
    if (!error) links += (links.empty() ? "" : ", ") + name + " -> " + leads_to.string();
  }
  if (links.empty()) return {"links inside", Health::kGood, "none", ""};
  const bool is_sweep = fs::exists(SweepFolder{path}.plan());
  return {"links inside", is_sweep ? Health::kBad : Health::kWarning, links,
          "nothing is written through a link inside a sweep's folder; put what it leads to in its "
          "place, or let the whole folder be behind a link"};
}

}  // namespace

Findings check_file_system(const fs::path& folder, const SpaceNeeds& needs) {
  const TrialFolder trial(folder);
  return {check_sight(folder),        check_links(folder),         check_exclusive_create(trial),
          check_publishing(trial),    check_rename(trial),         check_flush(trial),
          check_space(folder, needs), check_inodes(folder, needs), check_clock(trial)};
}

}  // namespace strut
