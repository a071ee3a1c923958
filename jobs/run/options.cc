#include "jobs/run/options.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/text/parse_number.h"
#include "jobs/cli/provenance.h"

namespace strut {
namespace {

/// Reads --shards A:B; either number may be omitted.
void read_shards(const Arguments& arguments, const Plan& plan, RunOptions& options) {
  options.end_shard = plan.shard_count();
  if (!arguments.has("shards")) return;
  const std::string text = arguments.text("shards");
  const std::size_t colon = text.find(':');
  const auto parse = [&](const std::string& number, std::int64_t fallback) {
    return number.empty() ? fallback : parse_number<std::int64_t>(number).value_or(-1);
  };
  const std::int64_t first = parse(text.substr(0, colon), 0);
  const std::int64_t end =
      colon == std::string::npos ? -1 : parse(text.substr(colon + 1), plan.shard_count());
  if (first < 0 || end <= first || end > plan.shard_count()) {
    throw InputError(fmt::format(
        "--shards {}: must be A:B with 0 <= A < B <= {}, the number of shards of this sweep", text,
        plan.shard_count()));
  }
  options.first_shard = first;
  options.end_shard = end;
}

}  // namespace

RunOptions read_run_options(const Arguments& arguments, const Plan& plan, bool retries) {
  RunOptions options;
  options.kernel = &find_kernel(arguments);
  options.threads = find_threads(arguments);
  options.retry_failed = retries;
  read_shards(arguments, plan, options);
  const double lease = arguments.number_or("lease", 30.0, between(1.0, 86400.0, "s"));
  options.claims.lease = std::chrono::milliseconds(std::llround(1e3 * lease));
  options.provenance = make_run_provenance();
  return options;
}

std::optional<TaskRun> find_task(const Arguments& arguments, const OpenSweep& sweep,
                                 RunOptions& options) {
  if (!arguments.has("task")) return std::nullopt;
  if (arguments.has("shards"))
    throw InputError("--task, --shards: mutually exclusive; give one of them");
  std::optional<TaskRun> task(std::in_place, sweep.folder, arguments.text("task"),
                              sweep.plan.shard_count());
  options.first_shard = task->shards().first;
  options.end_shard = task->shards().end;
  return task;
}

}  // namespace strut
