// Sign, factor and lag of measured channels against the simulation.
//
// A channel m of a recording and its simulation s, both without their means, agree up to a factor f
// and a lag T:
//
//   m(t) ~ f s(t - T),   rho(T) = sum m(t) s(t - T) / sqrt(sum m^2 sum s^2)
//
// The lag is that of the largest |rho|, the sign that of rho there, the factor the least-squares
// one. Worn springs and dampers shift and scale channels as well, so the free parameters are first
// moved to where the shapes agree best: by Gauss-Newton steps to the minimum of
//
//   sum over channels ln(1 - max_T rho^2 + e) + 1 - exp(-|T| / 5 ms) + sum over parameters (ln(p /
//   p0) / 0.35)^2
//
// which no sign, factor or lag of a channel changes.
#pragma once

#include <string>
#include <vector>

#include "estimate/unknown.h"

namespace strut {

struct ChannelAlignment {
  std::size_t run = 0, channel = 0;  // the latter in MeasuredRun::channels
  double correlation = 0.0;          // largest |rho|
  double factor = 1.0;               // with its sign
  double motion = 0.0;               // standard deviation of the simulated channel [u]
  double lag = 0.0;                  // s; positive: the recording is late
  /// (1 - rho^2) for the best lag of the other sign over that of this sign, at least 1.
  double sign_ratio = 1.0;
  /// The same for no lag at all.
  double lag_ratio = 1.0;
  /// Time [s] after which the motion repeats itself, nearly; 0: it does not. Lags of half of it or
  /// more are ambiguous, and smaller ones may be the phase of a resonance.
  double period = 0.0;
};

/// Two channels of a run that could be swapped: their names differ by left and right, or front and
/// rear, or they are channels of a rig in one unit.
struct PossibleSwap {
  std::size_t run = 0, first = 0, second = 0;  // the latter two in MeasuredRun::channels
  double gain = 0.0;  // fall of the cost if each is compared with the other's simulation
};

struct AlignmentOptions {
  double max_lag = 0.3;  // s
  int threads = 1;
};

struct Alignment {
  std::vector<ChannelAlignment> channels;  // by run and channel; those without motion are missing
  std::vector<PossibleSwap> swaps;
  std::vector<double> values;  // of the free parameters
};

/// `free`: parameters that all runs share, at their values in the model's file. Runs that cannot be
/// simulated are left out.
Alignment align_recordings(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& free,
                           const AlignmentOptions& options = {});

}  // namespace strut
