#include "jobs/bench/pipeline.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ostream>

#include "jobs/cli/machine.h"
#include "sweep/run.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with its owner.
class ScratchFolder {
 public:
  explicit ScratchFolder(const fs::path& parent) {
    std::string name = (parent / "strut_bench_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw EnvironmentError(parent.string() + ": no folder can be made: " + std::strerror(errno));
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

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

/// The first `result.cases` cases of the plan in a fresh folder, the spin control beside it.
PipelineFigure measure(const Plan& plan, const Kernel& kernel, int threads, double best_spin,
                       const fs::path& scratch, std::atomic<bool>& halt, PipelineResult& result) {
  RunOptions options;
  options.kernel = &kernel;
  options.threads = threads;
  options.end_shard = (result.cases - 1) / plan.request().shard_cases + 1;
  const ScratchFolder place(scratch);
  const double start = now();
  const SweepFolder folder = make_sweep_folder(place.path() / "sweep", plan);
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
  const Plan plan(read_request(file));
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
              {"output_share", result.output_share()},
              {"bytes_per_case", result.bytes_per_case},
              {"plan_seconds", result.plan_seconds},
              {"resume_seconds", result.resume_seconds},
              {"peak_memory_bytes", result.peak_memory}};
}

void print_pipeline(std::ostream& stream, const PipelineResult& result) {
  char line[256];
  std::snprintf(line, sizeof line, "\nsweep of %ld cases (%s), plan to shards\n",
                static_cast<long>(result.cases), result.sweep.c_str());
  stream << line;
  std::snprintf(line, sizeof line, "%-16s %6s %8s %10s %19s\n", "instruction set", "lanes",
                "threads", "runs/s", "spin of one thread");
  stream << line;
  for (const PipelineFigure& f : result.figures) {
    std::snprintf(line, sizeof line, "%-16s %6d %8d %10.1f %19.2f\n", f.isa.c_str(), f.lanes,
                  f.threads, f.runs_per_s, f.spin_control);
    stream << line;
  }
  const double all = result.prepare + result.integrate + result.compress + result.write;
  std::snprintf(line, sizeof line,
                "of the last: prepare %.1f %%, integrate %.1f %%, compress %.2f %%, write %.2f "
                "%%; %lld bytes a case\n",
                100.0 * result.prepare / all, 100.0 * result.integrate / all,
                100.0 * result.compress / all, 100.0 * result.write / all,
                static_cast<long long>(result.bytes_per_case));
  stream << line;
  std::snprintf(line, sizeof line,
                "planning %.0f ms, running the finished sweep again %.0f ms, peak memory %.0f MB\n",
                1e3 * result.plan_seconds, 1e3 * result.resume_seconds, 1e-6 * result.peak_memory);
  stream << line;
}

}  // namespace strut
