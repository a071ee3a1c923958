// plan_and_run_a_sweep SWEEP.toml DIR: plans a sweep, simulates what is missing, reads it back.
#include <atomic>
#include <cstdio>
#include <exception>
#include <thread>

#include "io/store/dataset.h"
#include "sweep/choose_settings.h"
#include "sweep/run.h"

namespace {

int run(const char* request, const char* directory) {
  const strut::SweepFolder folder = strut::make_sweep_folder(directory, strut::make_plan(request));
  const strut::Plan plan = strut::open_sweep_folder(folder);

  strut::RunOptions options;
  options.kernel = &strut::list_kernels().front();  // the widest of this processor
  options.threads = static_cast<int>(std::thread::hardware_concurrency());
  strut::RunProgress progress;     // another thread may watch it
  std::atomic<bool> halt = false;  // true ends the run; running again goes on from there
  const strut::RunSummary summary = strut::run_sweep(folder, plan, options, progress, halt);
  std::fprintf(stderr, "%lld cases simulated, %lld failed\n",
               static_cast<long long>(progress.written), static_cast<long long>(summary.failed));

  strut::Dataset dataset({folder.root});
  const strut::ShardSchema& schema = dataset.schema();
  std::printf("case_id");
  for (const auto& column : schema.parameters) std::printf(",%s", column.name.c_str());
  for (const auto& column : schema.snapshot) std::printf(",%s", column.name.c_str());
  std::printf("\n");
  for (std::size_t piece = 0; piece < dataset.piece_count(); ++piece) {
    const strut::ShardRows& rows = dataset.read_piece(piece);
    const std::size_t p = schema.parameters.size(), s = schema.snapshot.size();
    for (std::size_t row = 0; row < rows.size(); ++row) {
      std::printf("%lld", static_cast<long long>(rows.case_id[row]));
      for (std::size_t i = 0; i < p; ++i) std::printf(",%.17g", rows.parameters[row * p + i]);
      for (std::size_t i = 0; i < s; ++i) std::printf(",%.17g", rows.snapshot[row * s + i]);
      std::printf("\n");
    }
  }
  return summary.failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    return run(argv[1], argv[2]);
  } catch (const std::exception& e) {  // InputError: the request; EnvironmentError: the disk
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
