// A planned sweep: which cases, in which order, in which shards. Everything is computed by index, so
// a plan of 10^9 cases costs what one of ten does.
//
// position  0 .. case_count - 1, the order in which cases run; shard s holds the positions
//           [s * shard_cases, (s + 1) * shard_cases)
// case id   grid: mixed radix of the levels, first axis slowest; latin_hypercube, sobol: the number
//           of the sample
// layer     stratum of the case, 0 .. strata - 1
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/shard.h"
#include "sweep/request.h"

namespace strut {

/// One stratum.
struct Layer {
  double lower = 0.0, upper = 0.0;  // of the parameter, or of the degradation
  std::int64_t population = 0;      // points of the grid in it
  std::int64_t drawn = 0;
};

class Plan {
 public:
  /// Throws InputError that names the key: a count beyond the grid, an empty layer, ...
  explicit Plan(const SweepRequest& request);
  ~Plan();
  Plan(Plan&&) noexcept;

  const SweepRequest& request() const;
  /// 64 digits: SHA-256 over everything that changes a result.
  const std::string& hash() const;
  const std::vector<Layer>& layers() const;

  std::int64_t case_count() const;
  std::int64_t shard_count() const;
  /// Positions [first, last) of a shard.
  std::pair<std::int64_t, std::int64_t> shard_range(std::int64_t shard) const;

  std::int64_t calc_case_id(std::int64_t position) const;
  /// -1 where the case is not in the plan.
  std::int64_t find_position(std::int64_t case_id) const;
  /// One value per axis.
  void calc_parameters(std::int64_t case_id, std::span<double> values) const;
  int calc_layer(std::int64_t case_id) const;
  /// The base case with the case's parameters.
  Case make_case(std::int64_t case_id) const;

  ShardSchema make_schema() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "name = value" of everything that enters the plan's hash, in order.
using Facts = std::vector<std::pair<std::string, std::string>>;
Facts list_facts(const SweepRequest& request);

/// Lines "name: was A, is B" where two requests differ.
std::vector<std::string> compare_facts(const Facts& was, const Facts& is);

}  // namespace strut
