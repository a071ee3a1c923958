// Measures a whole sweep, from plan to shards, in a scratch folder.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "io/format/json.h"
#include "model/kernel/simulation.h"

namespace strut {

struct PipelineFigure {
  std::string isa;
  int lanes = 1, threads = 1;
  double runs_per_s = 0.0;
  double spin_control =
      0.0;  // spin rate of all threads together, relative to one undisturbed thread
};

struct PipelineResult {
  std::string sweep;  // file name of the request
  std::int64_t cases = 0;
  std::vector<PipelineFigure> figures;
  /// Thread-seconds of the last run, with the widest lanes on all cores.
  double prepare = 0.0, integrate = 0.0, compress = 0.0, write = 0.0;
  std::int64_t bytes_per_case = 0;  // mean, rounded
  double plan_seconds = 0.0;        // from request to folder
  double resume_seconds = 0.0;      // to run the finished sweep again
  double peak_memory = 0.0;         // peak of this process so far [bytes]

  /// Fraction of the thread-seconds spent on compression and disk.
  double output_fraction() const {
    return (compress + write) / (prepare + integrate + compress + write);
  }
};

/// Runs the first `cases` cases, rounded up to whole shards, of the request in `file`, a random
/// sample of its grid, in a folder below `scratch`: with every kernel on one thread, and with the
/// widest on 1 to `cores` threads. `best_spin`: calibrate_spin(). Returns soon, with invalid
/// figures, once `halt` is true. Throws InputError, EnvironmentError.
PipelineResult measure_pipeline(const std::filesystem::path& file, std::int64_t cases, int cores,
                                double best_spin, const std::filesystem::path& scratch,
                                std::atomic<bool>& halt);

Json make_json(const PipelineResult& result);
void print_pipeline(std::ostream& stream, const PipelineResult& result);

}  // namespace strut
