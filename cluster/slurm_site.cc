#include "cluster/slurm_site.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <set>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "cluster/file_system.h"
#include "cluster/slurm.h"
#include "cluster/slurm_commands.h"
#include "cluster/slurm_options.h"

namespace strut::slurm {
namespace {

namespace fs = std::filesystem;

constexpr double kSlowSeconds = 5.0;     // answers that take longer are worth a warning
constexpr std::int64_t kSingleJobs = 2;  // jobs of a submission after its arrays

std::int64_t read_count(const Settings& settings, const std::string& key) {
  const auto found = settings.find(key);
  if (found == settings.end()) return SiteLimits().tasks;
  return parse_number<std::int64_t>(found->second).value_or(SiteLimits().tasks);
}

/// Reads max_array_tasks of SchedulerParameters, if the site sets it.
std::int64_t read_max_array_tasks(const Settings& settings) {
  const auto found = settings.find("SchedulerParameters");
  const std::string key = "max_array_tasks=";
  const std::size_t at = found == settings.end() ? std::string::npos : found->second.find(key);
  if (at == std::string::npos) return SiteLimits().tasks;
  const std::string value = found->second.substr(at + key.size());
  return parse_number<std::int64_t>(value.substr(0, value.find(','))).value_or(SiteLimits().tasks);
}

std::string find_host() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string name = host.data();
  return name.substr(0, name.find('.'));
}

/// Throws InputError if nodes of the partition are other machines and the folder lies on a disk of
/// this one.
void check_folder(const std::string& partition, const fs::path& folder) {
  const std::string kind = find_local_file_system(folder);
  if (kind.empty()) return;
  const std::string here = find_host();
  std::set<std::string> others;
  for (const std::string& node :
       split(ask({"sinfo", "-h", "-N", "-p", partition, "-O", "NodeHost:256"}), '\n')) {
    const std::string host = node.substr(0, node.find_first_of(". "));
    if (!host.empty() && host != here) others.insert(host);
  }
  if (others.empty()) return;
  throw InputError(fmt::format(
      "{}: lies on a file system of this machine only ({}); the nodes of partition {} ({}{}) "
      "cannot see it; put the sweep into a folder that all see, such as your home, or add --shared "
      "if they do see it",
      folder.string(), kind, partition, *others.begin(), others.size() > 1 ? ", ..." : ""));
}

Finding examine_scheduler(const std::string& version, double seconds) {
  return {
      "scheduler", seconds < kSlowSeconds ? Health::kGood : Health::kWarning,
      fmt::format("Slurm {}, answers in {} ms", version, format_rounded(std::round(1e3 * seconds))),
      ""};
}

Finding examine_arrays(const std::string& array_tasks, const std::string& jobs) {
  return {"job arrays", Health::kGood,
          fmt::format("{} tasks per array, {} jobs at once", array_tasks, jobs),
          "larger submissions are split"};
}

Finding examine_requeue(bool is_allowed) {
  if (!is_allowed) {
    return {"requeue", Health::kWarning, "not allowed by the site",
            "submit again for shards that a time limit or a failed node left"};
  }
  return {"requeue", Health::kGood, "allowed",
          "tasks continue after a time limit or a failed node"};
}

Finding examine_partition(const Partition& partition) {
  const std::string limit = std::isfinite(partition.seconds)
                                ? fmt::format("{} per task", format_slurm_time(partition.seconds))
                                : "no time limit";
  return {"partition", partition.is_up ? Health::kGood : Health::kBad,
          fmt::format("{}, {}, {}", partition.name, partition.is_up ? "up" : "down", limit), ""};
}

}  // namespace

Partition find_partition(const std::string& wanted) {
  std::vector<std::string> names;
  for (const std::string& line : split(ask({"sinfo", "-a", "-h", "-o", "%P|%l|%a"}), '\n')) {
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() != 3) continue;
    Partition partition{parts[0], parse_slurm_time(parts[1]).value_or(SiteLimits().seconds),
                        parts[2] == "up"};
    const bool is_default = !partition.name.empty() && partition.name.back() == '*';
    if (is_default) partition.name.pop_back();
    if (wanted.empty() ? is_default : partition.name == wanted) return partition;
    names.push_back(partition.name);
  }
  if (wanted.empty()) {
    throw InputError(fmt::format(
        "--partition: missing, and this site has no default; partitions: {}", join_names(names)));
  }
  throw InputError(fmt::format("--partition {}: does not exist{}; partitions: {}", wanted,
                               suggest_name(wanted, names), join_names(names)));
}

SiteLimits check_site(const Resources& resources, const fs::path& folder) {
  const std::string fault = SlurmDispatcher::find_fault();
  if (!fault.empty()) {
    throw EnvironmentError(fmt::format(
        "{}; --to slurm needs a Slurm that answers here, --to local works everywhere", fault));
  }
  const Settings settings = read_settings();
  const Partition partition = find_partition(resources.partition);
  if (!partition.is_up) {
    throw InputError(fmt::format(
        "--partition {}: is down according to sinfo; name another, or wait", partition.name));
  }
  if (resources.seconds > partition.seconds) {
    throw InputError(fmt::format("--time {}: must be at most the limit of the partition, {}",
                                 format_slurm_time(resources.seconds),
                                 format_slurm_time(partition.seconds)));
  }
  if (!resources.is_shared) check_folder(partition.name, folder);
  const std::string queue = ask({"squeue", "-h", "-a", "-r", "-o", "%A"});
  const std::int64_t queued = std::count(queue.begin(), queue.end(), '\n');
  const std::int64_t array_tasks =
      std::min(read_count(settings, "MaxArraySize"), read_max_array_tasks(settings));
  if (array_tasks <= 0) {
    throw EnvironmentError(
        "MaxArraySize: this site allows no job arrays; run `strut run DIR` in a job of your own");
  }
  return {array_tasks,
          std::max<std::int64_t>(1, read_count(settings, "MaxJobCount") - queued - kSingleJobs),
          partition.seconds};
}

Findings examine_site(const Resources& resources, const fs::path& folder) {
  if (const std::string fault = SlurmDispatcher::find_fault(); !fault.empty()) {
    return {{"scheduler", Health::kBad, fault, "--to local works"}};
  }
  const auto start = std::chrono::steady_clock::now();
  Settings settings;
  try {
    settings = read_settings();
  } catch (const EnvironmentError& e) {
    return {{"scheduler", Health::kBad, e.what(), "nothing can be submitted right now"}};
  }
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
  Findings findings = {examine_scheduler(settings["SLURM_VERSION"], waited.count()),
                       examine_arrays(settings["MaxArraySize"], settings["MaxJobCount"]),
                       examine_requeue(settings["JobRequeue"] != "0")};
  try {
    const Partition partition = find_partition(resources.partition);
    findings.push_back(examine_partition(partition));
    check_folder(partition.name, folder);
    findings.push_back({"folder on the nodes", Health::kGood, "no obstacle found", ""});
  } catch (const InputError& e) {
    findings.push_back({"partition", Health::kBad, e.what(), "nothing can run there"});
  }
  return findings;
}

}  // namespace strut::slurm
