// The machine under a measurement: what it is, what it could do, and how busy others keep it.
#pragma once

#include <string>

#include "io/format/json.h"
#include "model/kernel/simulation.h"

namespace strut {

struct Machine {
  std::string cpu;
  int cores = 1;  // that this process may use
  std::string isa, compiler, commit;
};

Machine read_machine(const Kernel& kernel);
Json make_json(const Machine& machine);

/// Time since some fixed moment [s].
double now();

/// Spin control: rate [1/s] of a fixed chain of dependent multiplications and additions, over some
/// 5 ms. It needs no memory, so whatever slows it (a lower clock, a neighbor on the core) slows
/// what is measured beside it by at least the same factor.
double measure_spin();

/// Sum of the rates of `threads` threads that spin at once.
double measure_spins(int threads);

/// The best of many spins: this machine undisturbed.
double calibrate_spin();

/// Largest number of floating-point operations a second that one core reaches in registers.
double measure_peak(const Kernel& kernel);

}  // namespace strut
