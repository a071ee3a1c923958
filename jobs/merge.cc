#include "jobs/merge.h"

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <iostream>

#include "base/text/build_info.h"
#include "io/file/file_seal.h"
#include "io/format/json.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "sweep/merge.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

MergeInput make_input(const Plan& plan) {
  MergeInput input{plan.make_extent(), plan.make_schema()};
  if (input.schema.history.empty()) {
    input.schema.history_samples = 0;
    input.schema.history_interval = 0.0;
  }
  return input;
}

void print(const MergeReport& report, const fs::path& output, bool as_json) {
  if (as_json) {
    Json json = Json::object();
    json["file"] = output.string();
    json["cases"] = report.cases;
    json["failed"] = report.failed;
    json["shards"] = report.shards;
    json["missing_shards"] = report.missing;
    json["data_digest"] = report.data_digest;
    std::cout << format_json(json) << "\n";
    return;
  }
  std::cout << fmt::format("{}: {} ({} failed) of {}", output.string(),
                           format_count(report.cases, "case"), format_count(report.failed),
                           format_count(report.shards, "shard"));
  if (report.missing > 0) {
    std::cout << fmt::format("; {} MISSING", format_count(report.missing, "shard"));
  }
  std::cout << fmt::format("\ndata digest {}\n", report.data_digest);
}

}  // namespace

Arguments describe_merge() {
  Arguments arguments("strut merge DIR -o dataset.h5 [OPTIONS]",
                      "Writes the cases of all shards of the sweep in DIR to one HDF5 file for "
                      "other tools. It has\n"
                      "the datasets of a shard, in the order of the plan; retried cases replace "
                      "the failed ones. If a\n"
                      "shard is missing or damaged, the exit code is 2 and nothing is written; "
                      "failed cases are rows\n"
                      "of NaN.",
                      "  strut merge cars -o dataset.h5\n"
                      "  strut merge cars -o so_far.h5 --partial");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"h5", "hdf5"}), "file to write");
  arguments.add_removed("virtual",
                        "a view over shards cannot be verified; `strut merge DIR -o FILE` writes a "
                        "copy");
  arguments.add_switch("partial", "leave out missing shards instead of refusing");
  arguments.add_switch("force", "replace FILE if it exists");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_merge(const Arguments& arguments) {
  const OpenSweep sweep = open_sweep(arguments);
  const fs::path output = find_output_file(arguments, {}, kMergedSeal.name);
  refuse_source("output", output);
  MergeOptions options;
  options.partial = arguments.is_on("partial");
  const BuildInfo& build = get_build_info();
  options.provenance = {{"strut_version", build.version}, {"commit", build.commit}};
  InterruptWatcher interrupt;
  std::atomic<std::int64_t> done{0};
  MergeReport report;
  {
    const double start = now();
    const ProgressLine line([&] {
      return format_progress(done, sweep.plan.case_count(), "cases merged", now() - start);
    });
    report =
        merge_sweep(sweep.folder, make_input(sweep.plan), output, options, [&](std::int64_t cases) {
          done = cases;
          return !interrupt.halt();
        });
  }
  if (report.data_digest.empty()) {
    print_error("interrupted; nothing is written");
    suggest_again(arguments, "starts over");
    return 128 + interrupt.signal();
  }
  print(report, output, arguments.is_on("json"));
  suggest_next({"strut", "train", output.string(), "-o", "model.h5"});
  return kExitDone;
}

}  // namespace strut
