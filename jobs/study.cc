#include "jobs/study.h"

#include <fmt/format.h>

#include <iostream>

#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/provenance.h"
#include "jobs/study/noise_report.h"
#include "jobs/study/report.h"
#include "jobs/study/tables.h"
#include "study/noise/limits.h"
#include "study/result_files.h"
#include "study/trainings.h"
#include "sweep/run.h"
#include "train/training_table.h"

namespace strut {
namespace {

/// Simulates the missing cases of a sweep; false where a signal came.
bool run_study_sweep(const SweepFolder& folder, const Plan& plan, int threads,
                     std::atomic<bool>& halt) {
  const std::string name = folder.root.filename().string();
  RunOptions options;
  options.kernel = &list_kernels().front();
  options.threads = threads;
  options.end_shard = plan.shard_count();
  options.provenance = make_run_provenance();
  RunProgress progress;
  RunSummary summary;
  {
    const Stage stage(name + ": simulation");
    const ProgressLine line([&, start = now()] {
      const std::int64_t left = plan.case_count() - progress.present;
      return name + ": " +
             format_progress(progress.simulated, left, "cases simulated", now() - start);
    });
    summary = run_sweep(folder, plan, options, progress, halt);
  }
  print_notes(summary.notes);
  for (const auto& [shard, what] : summary.damaged) {
    throw InputError(fmt::format(
        "{}; move it aside by `strut verify {} --quarantine`, then run this command again", what,
        folder.root.string()));
  }
  if (summary.failed > 0) {
    print_note(
        fmt::format("{}: {} cases failed and are left out", name, format_count(summary.failed)));
  }
  return !halt;
}

std::string describe_progress(const TrainingTableProgress& progress, double start) {
  const std::size_t done = progress.trained + progress.kept;
  std::string line = fmt::format("{}/{} trainings", format_count(static_cast<std::int64_t>(done)),
                                 format_count(static_cast<std::int64_t>(progress.total)));
  if (progress.work_done > 0.0) {
    const double left = progress.work / progress.work_done - 1.0;
    line += fmt::format(", about {} to go", format_duration(left * (now() - start)));
  }
  return line;
}

/// Trains the missing networks; false where a signal came.
bool train_all(const StudyFolder& folder, const StudyRequest& request, int threads,
               std::atomic<bool>& halt) {
  const std::vector<TableTraining> trainings = list_study_trainings(folder, request);
  const TrainingTableOptions options{folder.models(), threads, make_provenance()};
  TrainingTableProgress progress;
  TrainingTableSummary summary;
  const double start = now();
  {
    const ProgressLine line([&] { return describe_progress(progress, start); });
    summary = run_training_table(trainings, options, progress, halt);
  }
  print_notes(summary.notes);
  print_note(fmt::format("{} networks trained in {}, {} were there already", summary.trained,
                         format_duration(now() - start), summary.kept));
  return !summary.stopped;
}

/// Computes the missing bounds and fits of the noise section; false where a signal came.
bool fit_all(const StudyFolder& folder, const StudyRequest& request, int threads,
             std::atomic<bool>& halt) {
  const NoiseStudyData data = open_noise_data(folder, request);
  NoiseLimitsProgress progress;
  NoiseLimitsSummary summary;
  {
    const Stage stage("noise");
    const ProgressLine line([&, start = now()] {
      return "noise: " + format_progress(static_cast<std::int64_t>(progress.done),
                                         static_cast<std::int64_t>(progress.total),
                                         "bounds and fits", now() - start);
    });
    summary = update_noise_limits(*request.noise, data, {folder.noise(), threads}, progress, halt);
  }
  print_notes(summary.notes);
  return !summary.stopped;
}

bool simulate_all(const StudyFolder& folder, const StudyRequest& request, int threads,
                  std::atomic<bool>& halt) {
  for (const auto& [name, cell] : list_study_sweeps(request)) {
    const Plan plan = plan_study_sweep(folder, request, cell);
    if (!run_study_sweep(folder.sweep(name), plan, threads, halt)) return false;
  }
  if (!request.noise) return true;
  const Plan plan = plan_window_sweep(folder, request);
  return run_study_sweep(get_window_sweep(folder, request), plan, threads, halt);
}

/// Does everything that the folder lacks; false where a signal came.
bool complete(const StudyFolder& folder, const StudyRequest& request, int threads,
              std::atomic<bool>& halt) {
  return simulate_all(folder, request, threads, halt) &&
         train_all(folder, request, threads, halt) &&
         (!request.noise || fit_all(folder, request, threads, halt));
}

void print_tables(const StudyRequest& request, const StudyResults& results) {
  for (std::size_t p = 0; p < request.preloads.size(); ++p) {
    for (const ReportTable& table : make_study_tables(request, results, p, TableDetail::kMedian)) {
      std::cout << make_text(table) << "\n";
    }
  }
  for (const std::string& remark : request.published.remarks) std::cout << remark << "\n";
  if (results.noise) {
    for (const ReportTable& table : make_noise_tables(*results.noise)) {
      std::cout << make_text(table) << "\n";
    }
  }
  for (const StudySummary& s : summarize(request, results)) {
    std::cout << describe_summary(s) << "\n";
  }
  if (results.noise) std::cout << describe_noise_result(*results.noise) << "\n";
}

}  // namespace

Arguments describe_study() {
  Arguments arguments(
      "strut study STUDY.toml -o DIR [OPTIONS]",
      "Simulates, trains and evaluates a table of networks: cases with each preload, numbers of\n"
      "cases, networks, inputs and seeds (every key: docs/studies.md). Prints the errors beside\n"
      "published ones and writes DIR/report.html, results.json, tables.csv, figures, models and\n"
      "sweeps; a [noise] section adds the errors with sensor noise and their limits. Running it\n"
      "again completes what is missing; Ctrl-C stops it cleanly.",
      "  strut study examples/studies/paper_quick.toml -o study\n"
      "  strut study examples/studies/paper.toml -o study --threads 2");
  arguments.add_operand(ArgumentValue::file("STUDY.toml", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::folder("DIR"), "folder of the study");
  arguments.add_option("threads", "N",
                       "trainings at a time, one thread each (default: all processors)");
  arguments.add_switch("json", "print results.json instead of tables");
  return arguments;
}

int run_study(const Arguments& arguments) {
  const std::string& study = arguments.only_operand();
  if (!arguments.has("output"))
    throw arguments.usage_error("--output: missing; name the folder to write with -o");
  check_output_folder("output", arguments.text("output"));
  const StudyRequest asked = read_study(study);
  const int threads = find_threads(arguments);
  prepare_interrupt(arguments, "continues");
  InterruptWatcher watcher;
  const StudyFolder folder = make_study_folder(arguments.text("output"), asked);
  const StudyRequest request = open_study_folder(folder);
  if (!complete(folder, request, threads, watcher.halt())) {
    print_error("interrupted; simulations and trainings are kept, the same command continues");
    suggest_again(arguments, "continues");
    return 128 + watcher.signal();
  }
  const StudyResults results = [&] {
    const Stage stage("tables and figures");
    const ProgressLine line("writing tables and figures");
    return write_study_output(folder, request);
  }();
  if (arguments.is_on("json")) {
    std::cout << format_json(make_json(request, results)) << "\n";
  } else {
    print_tables(request, results);
  }
  print_note(folder.report().string());
  suggest_page(folder.report().string());
  return kExitDone;
}

}  // namespace strut
