// The measurements of `strut bench`.
#pragma once

#include <atomic>
#include <filesystem>

#include "jobs/bench/report.h"
#include "jobs/case/load_case.h"

namespace strut {

struct BenchRequest {
  CaseSource source;
  const Kernel* kernel = nullptr;
  bool quick = false;
  std::filesystem::path sweep;    // request of a sweep; empty: no sweep is measured
  std::filesystem::path scratch;  // folder for the files of the sweep
};

/// Runs all measurements. Returns soon, with invalid figures, once `halt` is true. Throws
/// InputError, EnvironmentError.
BenchResult run_benchmark(const BenchRequest& request, std::atomic<bool>& halt);

}  // namespace strut
