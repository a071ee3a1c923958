#include "sweep/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>

#include "base/error/input_error.h"
#include "model/integrate/run_status.h"
#include "sweep/shard_store.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

constexpr std::int64_t kRateWindow = 60;  // s

/// Cases/s over the journal's last minute; 0 if it has no recent entry.
double calc_rate(const Journal& journal) {
  const std::int64_t now = std::time(nullptr);
  std::int64_t first = now, cases = 0;
  for (const JournalEntry& entry : journal.entries) {
    if (entry.duplicate || entry.time < now - kRateWindow || entry.time > now) continue;
    // The first entry marks when work on the others began.
    if (entry.time < first) {
      first = entry.time;
    } else {
      cases += entry.cases;
    }
  }
  return now > first ? static_cast<double>(cases) / static_cast<double>(now - first) : 0.0;
}

/// Number of failed cases of an entry that a resume may mend; the run itself has retried once.
std::int64_t count_mendable(const JournalEntry& entry) {
  constexpr int kAtOnce = 1;
  std::int64_t count = 0;
  for (const RunStatusInfo& info : kRunStatuses) {
    const auto failures = entry.failures.find(info.name);
    const int last = get_last_attempt(static_cast<std::int32_t>(info.status));
    if (last > kAtOnce && failures != entry.failures.end()) count += failures->second;
  }
  return count;
}

/// Sets the first case of a status to the first one in a shard, unless the shard is damaged.
void find_first_case(const ShardRecords& records, std::int64_t shard, const std::string& status,
                     FailureCount& count) {
  try {
    const ShardRows rows = records.read_rows(shard, ShardParts::kTables);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (get_run_status_name(rows.status[row]) != status) continue;
      count.first_case = rows.case_id[row];
      count.first_reason = rows.reason[row];
      return;
    }
  } catch (const std::runtime_error&) {  // its seal was right; verify checks every byte
  }
}

void add_shard(const ShardRecords& records, const Plan& plan, const FoundShard& found,
               SweepStatus& status) {
  const auto add_fault = [&](const std::string& fault) {
    status.faults.push_back(fault);
    status.left += plan.shard_size(found.shard);
  };
  if (!found.entry) return add_fault(found.fault);
  const JournalEntry& entry = *found.entry;
  try {
    status.digest.add(DataDigest::parse(entry.digest));
  } catch (const InputError& e) {
    return add_fault(e.what());
  }
  for (const auto& [reason, cases] : entry.failures) {
    FailureCount& count = status.failures[reason];
    if (count.cases == 0) find_first_case(records, found.shard, reason, count);
    count.cases += cases;
  }
  const std::int64_t failed = count_failures(entry);
  status.failed += failed;
  if (failed > 0 && !records.has_retries(found.shard)) status.untried += count_mendable(entry);
  status.done += entry.cases - failed;
  status.bytes += entry.bytes;
  status.simulation_seconds += entry.seconds;
  ++status.shards_present;
}

}  // namespace

SweepStatus read_status(const SweepFolder& folder, const Plan& plan) {
  SweepStatus status;
  status.cases = plan.case_count();
  status.shards = plan.shard_count();
  // Claims first: a shard that is published in between is then counted as done, not lost.
  if (const auto claims = Folder(folder.root).find_folder(folder.claims().filename().string())) {
    status.claims = list_claims(*claims);
  }
  const ShardRecords records(folder, plan.make_extent());
  std::int64_t present = 0;
  std::vector<std::int64_t> shards = list_shards(folder);
  const auto end = std::lower_bound(shards.begin(), shards.end(), status.shards);
  for (auto foreign = end; foreign != shards.end(); ++foreign) {
    status.faults.push_back(fmt::format("{}: the plan has no such shard; {}",
                                        folder.shard(*foreign).string(), kShardSeal.remedy));
  }
  shards.erase(end, shards.end());
  for (const FoundShard& found : records.read(shards)) {
    present += plan.shard_size(found.shard);
    add_shard(records, plan, found, status);
  }
  status.left += status.cases - present;
  std::map<std::string, std::int64_t> running;  // cases in unpublished shards, by runner
  std::map<std::string, std::uint64_t> work;
  for (const ClaimInfo& claim : status.claims) {
    const std::int64_t shard = SweepFolder::parse_shard_name(claim.unit);
    const bool open = shard >= 0 && shard < status.shards &&
                      !std::binary_search(shards.begin(), shards.end(), shard);
    if (!open) continue;
    running[claim.runner] += plan.shard_size(shard);
    work[claim.runner] = claim.work;
  }
  for (const auto& [runner, cases] : running) {
    status.running += cases;
    // A shard may have been published since the heartbeat.
    const std::uint64_t simulated = std::min(static_cast<std::uint64_t>(cases), work[runner]);
    status.simulated += static_cast<std::int64_t>(simulated);
  }
  status.duplicates = records.duplicates();
  status.rate = status.running > 0 ? calc_rate(records.journal()) : 0.0;
  status.seconds_left = status.rate > 0.0
                            ? static_cast<double>(status.left - status.simulated) / status.rate
                            : std::numeric_limits<double>::quiet_NaN();
  return status;
}

}  // namespace strut
