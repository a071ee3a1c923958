// A planned sweep: its cases, their order and their shards. Everything is computed by index, so a
// plan of 10^9 cases costs no more than one of ten.
//
// position  0 .. case_count - 1, the order in which cases run (case_order.h); shard s holds the
//           positions [s * shard_cases, (s + 1) * shard_cases)
// case id   grid: mixed radix of the levels, first axis slowest; latin_hypercube, sobol: the number
//           of the sample
// stratum   0 .. strata - 1 (strata.h)
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/store/shard.h"
#include "io/store/sweep_extent.h"
#include "sweep/facts.h"
#include "sweep/request.h"
#include "sweep/strata.h"

namespace strut {

class Plan {
 public:
  /// Throws InputError that names the key, for example a count beyond the grid or an empty stratum.
  explicit Plan(const SweepRequest& request);
  ~Plan();
  Plan(Plan&&) noexcept;
  Plan& operator=(Plan&&) noexcept;

  const SweepRequest& request() const;
  /// SHA-256 over everything that changes a result, 64 hexadecimal digits.
  const std::string& hash() const;
  const Facts& facts() const;
  const std::vector<Stratum>& strata() const;

  /// Number of grid points or samples that the cases are drawn from.
  std::int64_t point_count() const;
  std::int64_t case_count() const;
  std::int64_t shard_count() const;
  /// Positions [first, last) of a shard.
  std::pair<std::int64_t, std::int64_t> shard_range(std::int64_t shard) const;
  /// Number of cases of a shard.
  std::int64_t shard_size(std::int64_t shard) const;

  /// Ids of the drawn cases, ascending; empty if all run.
  std::vector<std::int64_t> list_drawn() const;
  std::int64_t calc_case_id(std::int64_t position) const;
  /// -1 if the case is not in the plan.
  std::int64_t find_position(std::int64_t case_id) const;
  /// Writes one value per axis.
  void calc_parameters(std::int64_t case_id, std::span<double> values) const;
  int calc_stratum(std::int64_t case_id) const;
  /// The base case with the case's parameters.
  Case make_case(std::int64_t case_id) const;

  SweepExtent make_extent() const;
  ShardSchema make_schema() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace strut
