// The machine on which a benchmark runs: its description, its peak performance, and how much of it
// is available.
#pragma once

#include <string>

#include "io/format/json.h"
#include "model/kernel/simulation.h"

namespace strut {

struct Machine {
  std::string cpu;
  int cores = 1;  // available to this process
  std::string isa, compiler, commit;
};

Machine read_machine(const Kernel& kernel);
Json make_json(const Machine& machine);

/// Spin control: rate [1/s] of a fixed chain of dependent multiplications and additions, measured
/// for about 5 ms. It uses no memory, so anything that slows it (a lower clock, a neighbor on the
/// core) slows the code measured at the same time by at least the same factor.
double measure_spin();

/// Sum of the spin rates [1/s] of `threads` threads that spin at the same time.
double measure_spins(int threads);

/// Maximum of many spin rates [1/s]: that of the undisturbed machine.
double calibrate_spin();

/// Peak rate of one core [flop/s], operands in registers.
double measure_peak(const Kernel& kernel);

}  // namespace strut
