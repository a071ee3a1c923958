#include "jobs/bench/pipeline.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "jobs/cli/clock.h"
#include "jobs/cli/machine.h"
#include "jobs/cli/scratch_folder.h"
#include "sweep/choose_settings.h"
#include "sweep/run.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

struct SweepTime {
  RunSummary summary;
  double seconds = 0.0;
};

SweepTime time_sweep(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                     std::atomic<bool>& halt) {
  RunProgress progress;
  const double start = now();
  SweepTime time{run_sweep(folder, plan, options, progress, halt)};
  time.seconds = now() - start;
  return time;
}

double read_peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Runs the first `result.cases` cases of the plan in a new folder, and the spin control before and
/// after.
PipelineFigure measure(const Plan& plan, const Kernel& kernel, int threads, double best_spin,
                       const fs::path& scratch, std::atomic<bool>& halt, PipelineResult& result) {
  RunOptions options;
  options.kernel = &kernel;
  options.threads = threads;
  options.end_shard = (result.cases - 1) / plan.request().shard_cases + 1;
  const ScratchFolder temporary(scratch, "strut_bench");
  const double start = now();
  const SweepFolder folder = make_sweep_folder(temporary.path() / "sweep", plan);
  result.plan_seconds = now() - start;
  const double before = measure_spins(threads);
  const SweepTime time = time_sweep(folder, plan, options, halt);
  const double spin = 0.5 * (before + measure_spins(threads)) / best_spin;
  const RunSummary& summary = time.summary;
  result.prepare = summary.simulation.prepare;
  result.integrate = summary.simulation.integrate + summary.simulation.retry;
  result.compress = summary.compress;
  result.write = summary.write;
  const auto cases = static_cast<double>(result.cases);
  result.bytes_per_case = std::llround(static_cast<double>(summary.bytes) / cases);
  result.resume_seconds = time_sweep(folder, plan, options, halt).seconds;
  return {kernel.isa, kernel.lanes, threads, cases / time.seconds, spin};
}

}  // namespace

PipelineResult measure_pipeline(const fs::path& file, std::int64_t cases, int cores,
                                double best_spin, const fs::path& scratch,
                                std::atomic<bool>& halt) {
  const Plan plan = make_plan(file);
  PipelineResult result;
  result.sweep = file.filename().string();
  const std::int64_t shard = plan.request().shard_cases;
  result.cases = std::min((cases + shard - 1) / shard * shard, plan.case_count());
  for (std::size_t k = list_kernels().size(); k-- > 1 && !halt;) {
    result.figures.push_back(measure(plan, list_kernels()[k], 1, best_spin, scratch, halt, result));
  }
  for (int threads = 1; threads <= cores && !halt; ++threads) {
    result.figures.push_back(
        measure(plan, list_kernels().front(), threads, best_spin, scratch, halt, result));
  }
  result.peak_memory = read_peak_memory();
  return result;
}

Json make_json(const PipelineResult& result) {
  Json figures = Json::array();
  for (const PipelineFigure& f : result.figures) {
    figures.push_back(Json{{"isa", f.isa},
                           {"lanes", f.lanes},
                           {"threads", f.threads},
                           {"runs_per_s", f.runs_per_s},
                           {"spin_control", f.spin_control}});
  }
  return Json{{"sweep", result.sweep},
              {"cases", result.cases},
              {"runs", figures},
              {"thread_seconds", Json{{"prepare", result.prepare},
                                      {"integrate", result.integrate},
                                      {"compress", result.compress},
                                      {"write", result.write}}},
              {"output_share", result.output_fraction()},
              {"bytes_per_case", result.bytes_per_case},
              {"plan_seconds", result.plan_seconds},
              {"resume_seconds", result.resume_seconds},
              {"peak_memory_bytes", result.peak_memory}};
}

void print_pipeline(std::ostream& stream, const PipelineResult& result) {
  stream << fmt::format("\nsweep of {} cases ({}), plan to shards\n", result.cases, result.sweep);
  stream << fmt::format("{:<16} {:>6} {:>8} {:>10} {:>19}\n", "instruction set", "lanes", "threads",
                        "runs/s", "spin of one thread");
  for (const PipelineFigure& f : result.figures) {
    stream << fmt::format("{:<16} {:>6} {:>8} {:>10.1f} {:>19.2f}\n", f.isa, f.lanes, f.threads,
                          f.runs_per_s, f.spin_control);
  }
  const double all = result.prepare + result.integrate + result.compress + result.write;
  stream << fmt::format(
      "last run: prepare {:.1f} %, integrate {:.1f} %, compress {:.2f} %, write {:.2f} %; {} bytes "
      "a "
      "case\n",
      100.0 * result.prepare / all, 100.0 * result.integrate / all, 100.0 * result.compress / all,
      100.0 * result.write / all, result.bytes_per_case);
  stream << fmt::format(
      "planning {:.0f} ms, running the finished sweep again {:.0f} ms, peak memory {:.0f} MB\n",
      1e3 * result.plan_seconds, 1e3 * result.resume_seconds, 1e-6 * result.peak_memory);
}

}  // namespace strut
