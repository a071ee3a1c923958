// The content of a sweep file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/math/grid.h"
#include "model/car/case.h"
#include "model/kernel/simulation.h"

namespace strut {

enum class SampleMethod { kGrid, kLatinHypercube, kSobol };

struct SampleRequest {
  SampleMethod method = SampleMethod::kGrid;
  int strata = 10;          // default: at most the number of levels of `by`
  std::string by;           // a grid parameter, or kDegradation; default: the first axis
  std::int64_t count = -1;  // -1: all
  std::uint64_t seed = 1;
};

struct SnapshotRequest {
  bool on = true;
  double offset = 0.0;        // m, distance of the snapshot's line ahead of the bump's center
  std::vector<int> channels;  // CarChannel
};

struct HistoryRequest {
  double rate = 0.0;  // 1/s; 0: none
  std::vector<int> channels;
};

/// Increment it with every change after which the same request yields different numbers. A folder
/// that was planned by an earlier version is finished by that one's rules:
/// 1: starts by KINSOL; every run goes on to its duration.
/// 1 and 2: both sides of a car that moves symmetrically are computed; the lift-off of both wheels
///    of an axle may take two steps; an open integrator is RK4 with Newton's closure, and a shard
///    has 512 cases unless the file says otherwise.
inline constexpr int kResultsVersion = 3;

struct SweepRequest {
  std::filesystem::path path, vehicle, maneuver;  // files that it was read from
  Case base;
  Grid grid;
  SampleRequest sample;
  SolverOptions integrate;
  /// > 0: the file leaves the integrator open, and this is the bound of its error
  /// (choose_settings.h).
  double accuracy = 0.0;
  SnapshotRequest snapshot;
  HistoryRequest history;
  int shard_cases = 512;
  bool chooses_shards = false;  // the file leaves them open: shard_cases is their maximum
  bool shuffle = true;          // run order, see case_order.h
  int results_version = kResultsVersion;
};

/// Reads a sweep file; docs/sweeps.md lists every key. Throws InputError with file, line, key,
/// value and what is allowed.
SweepRequest read_request(const std::filesystem::path& path);

/// Longest step [s] that resolves the effects of every case (model/longest_step.h): the default
/// step is halved to it.
double find_longest_step(const SweepRequest& request);

/// Longest duration of all cases [s].
double find_longest_duration(const SweepRequest& request);

/// Whether each run ends with its snapshot: nothing after it is recorded.
bool ends_at_snapshot(const SweepRequest& request);

/// Method that finds the state in which each case starts: that of the version that planned the
/// sweep.
StartMethod get_start_method(const SweepRequest& request);

/// Samples that the simulations of this request record.
SamplePlan make_sample_plan(const SweepRequest& request);

}  // namespace strut
