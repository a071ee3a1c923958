// Many runs of one car that differ in parameters, in lanes and threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "model_files/parameters.h"
#include "sweep/batch_simulator.h"

namespace strut {

struct ManyRequest {
  Case base;
  std::vector<const ParameterInfo*> parameters;
  std::vector<double> values;  // [case][parameter]
  std::size_t count = 0;       // cases
  std::vector<int> channels;   // of snapshot and history
  BatchPlan plan;
  int threads = 1;

  double get_value(std::size_t number, std::size_t parameter) const {
    return values[number * parameters.size() + parameter];
  }
  Case make_case(std::size_t number) const;
};

/// Requirements of all cases together.
struct ManyNeeds {
  double longest_step = 0.0;  // s, that resolves the effects of all cases
  double duration = 0.0;      // s, of the longest case
  double lowest_speed = 0.0;  // m/s
  bool has_sensors = false;   // any of them
};

/// Throws InputError for parameters that set the same quantity, and for a value out of range, with
/// the first case that has one.
ManyNeeds find_needs(const ManyRequest& request);

/// Arrays by channel, then by case; NaN where a case has no value.
struct ManyResults {
  std::size_t sample_count = 0;
  std::vector<std::int32_t> status;              // RunStatus
  std::vector<double> failure_time, event_time;  // s
  std::vector<double> snapshot;                  // [channel][case]
  std::vector<double> history;                   // [channel][case][sample]
  std::vector<std::string> reason;               // "" where a case is done
};

/// Simulates all cases, whose values find_needs has checked; those that fail have a status.
/// `duration`: ManyNeeds::duration. Results do not depend on the number of threads. Returns early,
/// with incomplete results, once `stop` is true.
ManyResults simulate_many(const ManyRequest& request, double duration,
                          const std::atomic<bool>& stop);

}  // namespace strut
