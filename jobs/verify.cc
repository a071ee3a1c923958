#include "jobs/verify.h"

#include <fmt/format.h>

#include <atomic>
#include <iostream>
#include <limits>

#include "io/format/json.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/standard_output.h"
#include "sweep/shard_store.h"
#include "sweep/verify.h"

namespace strut {
namespace {

Json make_json(const VerifyReport& report) {
  Json json = Json::object();
  json["ok"] = report.ok();
  json["data_digest"] = report.data_digest;
  json["cases"] = report.cases;
  json["missing"] = report.missing;
  json["double"] = report.misplaced;
  json["foreign"] = report.foreign;
  json["failed"] = report.failed;
  json["damaged"] = report.damaged;
  json["shards"] = report.shards;
  json["resimulated"] = report.resimulated;
  json["compared_by_tolerance"] = report.compared_by_tolerance;
  json["differing"] = report.differing;
  return json;
}

void print_text(const VerifyReport& report) {
  for (const std::string& what : report.damaged) std::cout << "damaged: " << what << "\n";
  for (const std::string& what : report.differing) {
    std::cout << "differs when simulated again: " << what << "\n";
  }
  std::cout << fmt::format("{} cases: {} missing, {} duplicate, {} foreign; {} sound shards\n",
                           format_count(report.cases), format_count(report.missing),
                           format_count(report.misplaced), format_count(report.foreign),
                           format_count(report.shards));
  if (report.resimulated > 0) {
    std::cout << fmt::format("{} cases simulated again, {} compared bit for bit{}\n",
                             format_count(report.resimulated),
                             format_count(report.resimulated - report.compared_by_tolerance),
                             report.compared_by_tolerance > 0
                                 ? ", the others, made with an instruction set this machine lacks, "
                                   "to 1e-9"
                                 : "");
  }
  std::cout << fmt::format("data digest {}\n", report.data_digest);
  if (report.ok()) {
    std::cout << "sound and complete";
    if (report.failed > 0) {
      std::cout << fmt::format("; {} failed, as `strut status` explains",
                               format_count(report.failed, "case"));
    }
  } else {
    print_styled("NOT sound and complete", Style::kRed);
  }
  std::cout << "\n";
}

/// Moves files that are not the plan's out of the way of `strut run`.
void move_aside(const SweepFolder& folder, const VerifyReport& report) {
  for (const std::string& what : report.damaged) {
    const auto file = folder.root / what.substr(0, what.find(": "));
    if (!std::filesystem::exists(file)) continue;
    quarantine(folder, file);
    print_note("moved to quarantine: " + file.string());
  }
}

void suggest_next_step(const Arguments& arguments, const std::string& root,
                       const VerifyReport& report) {
  const bool is_moved = arguments.is_on("quarantine");
  if (report.ok()) {
    suggest_next({"strut", "train", root, "-o", "model.h5"},
                 "or strut merge, for one file for other tools");
  } else if (!report.damaged.empty() && !is_moved) {
    suggest_next({"strut", "verify", root, "--quarantine"},
                 report.missing > 0 ? "moves damaged files aside, then run"
                                    : "moves files that are not the plan's aside");
  } else if (report.missing > 0) {
    suggest_next({"strut", "run", root}, "simulates what is missing");
  } else if (!report.damaged.empty()) {
    suggest_next({"strut", "verify", root}, "nothing is missing: checks the remaining files");
  } else {
    suggest_next({"strut", "doctor", root},
                 "finds properties of this machine that a sweep cannot rely on");
  }
}

}  // namespace

Arguments describe_verify() {
  Arguments arguments(
      "strut verify DIR [OPTIONS]",
      "Reads every byte of the sweep in DIR and checks checksums, columns and plan, and that no "
      "case is\n"
      "missing, duplicate or foreign. Prints the data digest, which is the same for the same "
      "plan,\n"
      "however it was run.",
      "  strut verify cars --sample 20\n  strut verify cars --quarantine && strut run cars");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("sample", "N", "simulate N cases again and compare bit for bit (default 0)");
  arguments.add_option("seed", "S", "seed of the choice of those cases (default 1)");
  arguments.add_switch("quarantine", "move damaged files aside, so that strut run replaces them");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_verify(const Arguments& arguments) {
  const OpenSweep sweep = open_sweep(arguments);
  VerifyOptions options;
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  options.sample = arguments.integer_or("sample", 0, 0, kMax);
  options.seed = static_cast<std::uint64_t>(arguments.integer_or("seed", 1, 0, kMax));
  options.fallback = &list_kernels().front();
  std::atomic<std::int64_t> read{0};
  VerifyReport report;
  {
    const double start = now();
    const ProgressLine line([&] {
      return read < sweep.plan.case_count() || options.sample == 0
                 ? format_progress(read, sweep.plan.case_count(), "cases verified", now() - start)
                 : fmt::format("simulating {} cases again", format_count(options.sample));
    });
    report =
        verify_sweep(sweep.folder, sweep.plan, options, [&](std::int64_t cases) { read = cases; });
  }
  arguments.is_on("json") ? void(std::cout << format_json(make_json(report)) << "\n")
                          : print_text(report);
  if (arguments.is_on("quarantine")) move_aside(sweep.folder, report);
  suggest_next_step(arguments, sweep.folder.root.string(), report);
  return report.ok() ? kExitDone : kExitNegative;
}

}  // namespace strut
