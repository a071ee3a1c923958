// The page of `strut bench --report DIR`: speed over error of all settings, beside other
// simulators.
#pragma once

#include <filesystem>

#include "jobs/bench/report.h"

namespace strut {

/// Throws InputError, which names the option, if the page would replace anything in the folder but
/// an earlier page of a benchmark.
void check_bench_page(const std::filesystem::path& folder);

/// Writes FOLDER/report.html and its figure, and FOLDER/bench.json, the output of --json. Throws
/// EnvironmentError.
void write_bench_page(const std::filesystem::path& folder, const BenchResult& result,
                      const std::vector<FigureRatio>& ratios);

}  // namespace strut
