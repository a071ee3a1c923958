#include "jobs/cli/machine.h"

#include <omp.h>

#include <algorithm>
#include <fstream>

#include "base/parallel/team.h"
#include "base/text/build_info.h"
#include "jobs/cli/clock.h"

namespace strut {
namespace {

std::string read_cpu_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// Keeps the compiler from removing the computation of `value`.
void keep(const double& value) { asm volatile("" : : "m"(value)); }

}  // namespace

Machine read_machine(const Kernel& kernel) {
  const BuildInfo& build = get_build_info();
  return {read_cpu_name(), omp_get_num_procs(), kernel.isa, build.compiler, build.commit};
}

Json make_json(const Machine& machine) {
  return Json{{"cpu", machine.cpu},
              {"cores", machine.cores},
              {"isa", machine.isa},
              {"compiler", machine.compiler},
              {"commit", machine.commit}};
}

double measure_spin() {
  constexpr int kLinks = 2500000;
  const double start = now();
  double x = start;
  for (int i = 0; i < kLinks; ++i) x = x * 0.999999 + 1e-6;
  const double seconds = now() - start;
  keep(x);
  return kLinks / seconds;
}

double measure_spins(int threads) {
  constexpr int kSpins = 8;
  double sum = 0.0;
  check_team(threads);
#pragma omp parallel num_threads(threads) reduction(+ : sum)
  {
    measure_spin();  // wakes the thread
#pragma omp barrier
    for (int i = 0; i < kSpins; ++i) sum += measure_spin() / kSpins;
  }
  return sum;
}

double calibrate_spin() {
  double best = 0.0;
  for (int i = 0; i < 40; ++i) best = std::max(best, measure_spin());
  return best;
}

double measure_peak(const Kernel& kernel) {
  constexpr long kRounds = 2000000;
  double best = 0.0, sink = 0.0;
  for (int i = 0; i < 15; ++i) {
    const double start = now();
    const double operations = kernel.run_peak_loop(kRounds, sink);
    best = std::max(best, operations / (now() - start));
  }
  keep(sink);
  return best;
}

}  // namespace strut
