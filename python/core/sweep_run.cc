#include "python/core/sweep_run.h"

#include <fmt/format.h>

#include "python/core/background.h"
#include "sweep/folder.h"
#include "sweep/run.h"

namespace py = pybind11;

namespace strut {

py::dict run_folder(const std::filesystem::path& root, int threads, bool retry_failed,
                    const py::object& watch) {
  const SweepFolder folder{root};
  const Plan plan = open_sweep_folder(folder);
  RunOptions options;
  options.kernel = &list_kernels().front();
  options.threads = threads;
  options.retry_failed = retry_failed;
  options.provenance = {{"program", "strut (Python)"}};
  RunProgress progress;
  RunSummary summary;
  const auto tell = [&] {
    const std::int64_t done = progress.present + progress.simulated + progress.elsewhere;
    if (!watch.is_none()) watch(progress.cases.load(), done, progress.failed.load());
  };
  run_in_background(
      [&](std::atomic<bool>& stop) { summary = run_sweep(folder, plan, options, progress, stop); },
      tell);
  tell();
  py::dict counts;
  counts["cases"] = progress.cases.load();
  counts["present"] = progress.present.load();
  counts["written"] = progress.written.load();
  counts["elsewhere"] = progress.elsewhere.load();
  counts["failed"] = summary.failed;
  counts["mended"] = summary.mended;
  counts["shards"] = summary.shards_written;
  counts["bytes"] = summary.bytes;
  py::dict damaged;
  for (const auto& [shard, text] : summary.damaged) damaged[py::int_(shard)] = text;
  counts["damaged"] = damaged;
  py::list notes;
  for (const std::string& note : summary.notes) notes.append(note);
  counts["notes"] = notes;
  return counts;
}

}  // namespace strut
