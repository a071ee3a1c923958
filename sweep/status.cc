#include "sweep/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>

#include "base/error/input_error.h"
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

/// Number of failed cases of an entry that a smaller step may mend.
std::int64_t count_mendable(const JournalEntry& entry) {
  std::int64_t count = 0;
  for (const RunStatusInfo& info : kRunStatuses) {
    const auto failures = entry.failures.find(info.name);
    if (may_retry(static_cast<std::int32_t>(info.status)) && failures != entry.failures.end())
      count += failures->second;
  }
  return count;
}

void add_shard(const SweepFolder& folder, const ShardRecords& records, const Plan& plan,
               std::int64_t shard, SweepStatus& status) {
  try {
    const JournalEntry entry = records.get(shard);
    for (const auto& [reason, cases] : entry.failures) status.failures[reason] += cases;
    const std::int64_t failed = count_failures(entry);
    status.failed += failed;
    if (failed > 0 && count_retries(folder, shard) == 0) status.untried += count_mendable(entry);
    status.done += entry.cases - failed;
    status.bytes += entry.bytes;
    status.simulation_seconds += entry.seconds;
    status.digest.add(DataDigest::parse(entry.digest));
    ++status.shards_present;
  } catch (const InputError& e) {
    status.faults.emplace_back(e.what());
    status.left += plan.shard_size(shard);
  }
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
  for (const std::int64_t shard : shards) {
    present += plan.shard_size(shard);
    add_shard(folder, records, plan, shard, status);
  }
  status.left += status.cases - present;
  for (const ClaimInfo& claim : status.claims) {
    const std::int64_t shard = SweepFolder::parse_shard_name(claim.unit);
    const bool open = shard >= 0 && shard < status.shards &&
                      !std::binary_search(shards.begin(), shards.end(), shard);
    if (open) status.running += plan.shard_size(shard);
  }
  status.duplicates = records.duplicates();
  status.rate = status.running > 0 ? calc_rate(records.journal()) : 0.0;
  status.seconds_left = status.rate > 0.0 ? static_cast<double>(status.left) / status.rate
                                          : std::numeric_limits<double>::quiet_NaN();
  return status;
}

}  // namespace strut
