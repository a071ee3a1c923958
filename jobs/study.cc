#include "jobs/study.h"

#include <iostream>

#include "jobs/build_info.h"
#include "jobs/command.h"
#include "jobs/interrupt.h"
#include "jobs/machine.h"
#include "jobs/open_sweep.h"
#include "jobs/progress.h"
#include "jobs/run.h"
#include "jobs/study/noise_limits.h"
#include "jobs/study/noise_report.h"
#include "jobs/study/report.h"
#include "jobs/study/tables.h"
#include "jobs/study/trainings.h"
#include "sweep/run.h"
#include "train/training_table.h"

namespace strut {
namespace {

Arguments make_arguments() {
  Arguments arguments(
      "strut study STUDY.toml -o DIR [OPTIONS]",
      "Simulates, trains and evaluates a table of networks: cases with each preload, numbers of\n"
      "cases, networks, inputs and seeds (every key: docs/studies.md). Prints the errors beside\n"
      "published ones and writes DIR/report.html, results.json, tables.csv, figures, models and\n"
      "sweeps; with a [noise] section also what sensor noise does to it. Running it again does\n"
      "only what is missing; Ctrl-C stops it cleanly.",
      "  strut study examples/studies/paper_quick.toml -o study\n"
      "  strut study examples/studies/paper.toml -o study --threads 2");
  arguments.add_option("output,o", "DIR", "folder of the study");
  arguments.add_option("threads", "N",
                       "trainings at a time, one thread each (default: all processors)");
  arguments.add_switch("json", "print results.json instead of tables");
  return arguments;
}

/// Simulates what a sweep lacks; false where a signal came.
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
    const ProgressLine line([&] {
      return name + ": " + format_count(progress.present + progress.simulated) + "/" +
             format_count(plan.case_count()) + " cases simulated";
    });
    summary = run_sweep(folder, plan, options, progress, halt);
  }
  for (const std::string& note : summary.notes) std::cerr << "strut: " << note << "\n";
  for (const auto& [shard, what] : summary.damaged) {
    throw InputError(what + "; `strut verify " + folder.root.string() +
                     " --quarantine` moves it aside, then run this again");
  }
  if (summary.failed > 0) {
    std::cerr << "strut: " << name << ": " << format_count(summary.failed)
              << " cases failed and are left out\n";
  }
  return !halt;
}

std::string describe_progress(const TrainingTableProgress& progress, double start) {
  const std::size_t done = progress.trained + progress.kept;
  std::string line = format_count(static_cast<std::int64_t>(done)) + "/" +
                     format_count(static_cast<std::int64_t>(progress.total)) + " trainings";
  if (progress.work_done > 0.0) {
    const double left = progress.work / progress.work_done - 1.0;
    line += ", about " + format_duration(left * (now() - start)) + " to go";
  }
  return line;
}

/// Trains what is missing; false where a signal came.
bool train_all(const StudyFolder& folder, const StudyRequest& request, int threads,
               std::atomic<bool>& halt) {
  const std::vector<TableTraining> trainings = list_study_trainings(folder, request);
  const BuildInfo& build = get_build_info();
  const TrainingTableOptions options{
      folder.models(), threads, {{"strut_version", build.version}, {"commit", build.commit}}};
  TrainingTableProgress progress;
  TrainingTableSummary summary;
  const double start = now();
  {
    const ProgressLine line([&] { return describe_progress(progress, start); });
    summary = run_training_table(trainings, options, progress, halt);
  }
  for (const std::string& note : summary.notes) std::cerr << "strut: " << note << "\n";
  std::cerr << "strut: " << summary.trained << " networks trained in "
            << format_duration(now() - start) << ", " << summary.kept << " were there already\n";
  return !summary.stopped;
}

/// Bounds and fits of the noise section; false where a signal came.
bool fit_all(const StudyFolder& folder, const StudyRequest& request, int threads,
             std::atomic<bool>& halt) {
  const NoiseStudyData data = open_noise_data(folder, request);
  NoiseLimitsProgress progress;
  std::vector<std::string> notes;
  bool whole = false;
  {
    const ProgressLine line([&] {
      return "noise: " + std::to_string(progress.done) + "/" + std::to_string(progress.total) +
             " bounds and fits";
    });
    whole =
        update_noise_limits(*request.noise, data, folder.noise(), threads, progress, notes, halt);
  }
  for (const std::string& note : notes) std::cerr << "strut: " << note << "\n";
  return whole;
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

bool work(const StudyFolder& folder, const StudyRequest& request, int threads,
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
  for (const StudySummary& s : summarize(request, results)) std::cout << make_line(s) << "\n";
  if (results.noise) std::cout << make_noise_line(*results.noise) << "\n";
}

}  // namespace

int run_study(const std::vector<std::string>& words) {
  Arguments arguments = make_arguments();
  if (!arguments.parse(words)) return kExitDone;
  const auto& names = arguments.positional();
  if (names.size() != 1) {
    throw arguments.usage_error(std::to_string(names.size()) + " files; expected STUDY.toml");
  }
  if (!arguments.has("output")) throw arguments.usage_error("--output: missing");
  const StudyRequest asked = read_study(names.front());
  const int threads = find_threads(arguments);
  InterruptWatcher watcher;
  const StudyFolder folder = make_study_folder(arguments.text("output"), asked);
  const StudyRequest request = open_study_folder(folder);
  if (!work(folder, request, threads, watcher.halt())) {
    std::cerr << "strut: interrupted; what is simulated and trained is kept, the same command goes "
                 "on\n";
    return 128 + watcher.signal();
  }
  const StudyOutput output = write_study_output(folder, request);
  if (arguments.is_on("json")) {
    std::cout << make_json(request, output.results).dump() << "\n";
  } else {
    print_tables(request, output.results);
  }
  for (const std::string& note : output.notes) std::cerr << "strut: " << note << "\n";
  std::cerr << "strut: " << folder.report().string() << "\n";
  return kExitDone;
}

}  // namespace strut
