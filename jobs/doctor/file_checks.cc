#include "jobs/doctor/file_checks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "cluster/file_system.h"
#include "io/file/folder.h"
#include "io/store/sweep_folder.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/scratch_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Writes `bytes` bytes. Returns 0 or errno.
int write_file(const fs::path& path, std::size_t bytes, int flags, bool flush) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0600);
  if (file < 0) return errno;
  const std::string data(bytes, 'x');
  int failure = ::write(file, data.data(), data.size()) == static_cast<ssize_t>(bytes) ? 0 : errno;
  if (failure == 0 && flush && ::fsync(file) != 0) failure = errno;
  ::close(file);
  return failure;
}

std::string explain(int failure) { return failure == 0 ? "works" : std::strerror(failure); }

Finding check_exclusive_create(const fs::path& folder) {
  const int first = write_file(folder / "claim", 1, O_EXCL, false);
  const int second = write_file(folder / "claim", 1, O_EXCL, false);
  const bool holds = first == 0 && second == EEXIST;
  return {"exclusive create", holds ? Health::kGood : Health::kBad,
          first != 0    ? explain(first)
          : second == 0 ? "both of two attempts succeed"
                        : "one of two attempts succeeds",
          holds ? "runners claim shards without locks"
                : "runners may simulate the same shards: wasted time, correct data"};
}

/// A shard is published under its name without ever replacing a file.
Finding check_publishing(const fs::path& folder) {
  write_file(folder / "new", 1, 0, false);
  write_file(folder / "old", 1, 0, false);
  const fs::path made = folder / "new", old = folder / "old", target = folder / "target";
  const bool links = ::link(made.c_str(), target.c_str()) == 0;
  const bool link_keeps = ::link(made.c_str(), old.c_str()) != 0 && errno == EEXIST;
  if (links && link_keeps) {
    return {"publishing", Health::kGood, "by link(2), which never replaces a file",
            "a published shard is never changed"};
  }
  const bool rename_keeps =
      ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, old.c_str(), RENAME_NOREPLACE) != 0 &&
      errno == EEXIST;
  if (rename_keeps) {
    return {"publishing", Health::kGood, "by renameat2(2), as there are no hard links",
            "a published shard is never changed"};
  }
  return {"publishing", Health::kBad, "neither link(2) nor renameat2(2) refuses to replace a file",
          "shards cannot be published here"};
}

Finding check_rename(const fs::path& folder) {
  write_file(folder / "a", 3, 0, false);
  write_file(folder / "b", 5, 0, false);
  std::error_code error;
  fs::rename(folder / "a", folder / "b", error);
  const bool holds = !error && fs::file_size(folder / "b", error) == 3;
  return {"rename", holds ? Health::kGood : Health::kBad,
          error   ? error.message()
          : holds ? "replaces atomically"
                  : "does not replace",
          holds ? "reports and records are complete or absent" : "records may be incomplete"};
}

Finding check_flush(const fs::path& folder) {
  constexpr std::size_t kBytes = 65536;
  constexpr double kSlow = 0.1;  // [s]
  std::array<double, 9> costs{};
  for (double& cost : costs) {
    const double start = now();
    const int failure = write_file(folder / "flushed", kBytes, O_TRUNC, true);
    cost = now() - start;
    if (failure != 0) {
      return {"flush to disk", Health::kBad, explain(failure),
              "a power cut may lose shards that were reported as done"};
    }
  }
  std::nth_element(costs.begin(), costs.begin() + costs.size() / 2, costs.end());
  const double median = costs[costs.size() / 2];
  return {"flush to disk", median < kSlow ? Health::kGood : Health::kWarning,
          fmt::format("{:.1f} ms for 64 kB", 1e3 * median),
          median < kSlow ? "a published shard survives a power cut"
                         : "slow: plan larger shards, each of which is flushed once"};
}

Finding check_clock(const fs::path& folder) {
  constexpr double kMaxSkew = 2.0;  // [s]
  write_file(folder / "time", 1, 0, false);
  struct stat facts {};
  ::stat((folder / "time").c_str(), &facts);
  timespec here{};
  ::clock_gettime(CLOCK_REALTIME, &here);
  const double skew = static_cast<double>(facts.st_mtim.tv_sec - here.tv_sec) +
                      1e-9 * static_cast<double>(facts.st_mtim.tv_nsec - here.tv_nsec);
  const bool is_off = std::abs(skew) > kMaxSkew;
  return {"clock of the file system", is_off ? Health::kWarning : Health::kGood,
          fmt::format("{} s off this machine's",
                      format_rounded(std::round(100.0 * skew) / 100.0 + 0.0)),
          is_off ? "claims do not need it; rates and times to go in `strut status` are wrong"
                 : "claims do not need it, rates are right"};
}

Finding check_space(const fs::path& folder, const SpaceNeeds& needs) {
  struct statvfs facts {};
  ::statvfs(folder.c_str(), &facts);
  const double free = static_cast<double>(facts.f_bavail) * static_cast<double>(facts.f_frsize);
  const bool enough = free > 1.1 * needs.bytes;
  return {"space", enough ? Health::kGood : Health::kBad,
          fmt::format("{} free, at most {} still needed", format_bytes(free),
                      format_bytes(needs.bytes)),
          enough ? "" : "the sweep would stop at a full disk; files written until then are kept"};
}

Finding check_inodes(const fs::path& folder, const SpaceNeeds& needs) {
  struct statvfs facts {};
  ::statvfs(folder.c_str(), &facts);
  const std::string needed = format_count(needs.files) + " files still needed";
  // Some file systems allocate inodes dynamically and report none.
  if (facts.f_files == 0) return {"files", Health::kGood, "no limit reported, " + needed, ""};
  const auto free = static_cast<std::int64_t>(facts.f_favail);
  const bool enough = free > needs.files;
  return {"files", enough ? Health::kGood : Health::kBad, format_count(free) + " free, " + needed,
          enough ? "" : "plan larger shards, each of which is one file"};
}

Finding check_visibility(const fs::path& folder) {
  const std::string local = find_local_file_system(folder);
  return {"file system", Health::kGood, local.empty() ? "network or unknown" : local,
          local.empty() ? "other machines may see it"
                        : "local to this machine: for `strut run` and --to local"};
}

/// Looks for links in place of files that strut writes: commands refuse to write through them.
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
  return {
      "links inside", is_sweep ? Health::kBad : Health::kWarning, links,
      "commands refuse to write through links inside a sweep's folder; replace each by its target, "
      "or make the whole folder a link"};
}

}  // namespace

Findings check_file_system(const fs::path& folder, const SpaceNeeds& needs) {
  const InterruptGuard guard;  // the scratch folder is removed before a signal takes effect
  const ScratchFolder scratch(folder, "doctor");
  const fs::path& trial = scratch.path();
  return {check_visibility(folder),   check_links(folder),         check_exclusive_create(trial),
          check_publishing(trial),    check_rename(trial),         check_flush(trial),
          check_space(folder, needs), check_inodes(folder, needs), check_clock(trial)};
}

}  // namespace strut
