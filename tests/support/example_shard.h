// A small shard with everything in it: failed cases, NaN, histories.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/store/shard.h"

namespace strut::test {

/// NaN included.
inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

inline ShardSchema make_example_schema() {
  ShardSchema schema;
  schema.parameters = {{"front_stiffness", "N/m", "rate"}, {"front_damping", "N s/m", "rate"}};
  schema.snapshot = {{"pitch_angle", "rad", "angle"}, {"body_position_z", "m", "height"}};
  schema.history = {{"pitch_rate", "rad/s", "rate"}, {"body_acceleration_z", "m/s^2", "of it"}};
  schema.history_samples = 3;
  schema.history_interval = 0.005;
  schema.status_meaning = "0 done, 1 diverged";
  return schema;
}

/// Case ids first_case, first_case + 1, ...; every third case failed.
inline ShardRows make_example_rows(const ShardSchema& schema, std::size_t count,
                                   std::int64_t first_case = 100) {
  ShardRows rows = ShardRows::make(schema, count);
  const auto fill = [](std::vector<double>& values, double offset) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::sin(static_cast<double>(i) + offset) * 40000.0;
    }
  };
  auto shift = static_cast<double>(first_case);
  fill(rows.parameters, shift);
  fill(rows.snapshot, shift + 0.5);
  for (auto& channel : rows.history) fill(channel, shift += 0.1);
  for (std::size_t i = 0; i < count; ++i) {
    rows.case_id[i] = first_case + static_cast<std::int64_t>(i);
    rows.layer[i] = static_cast<std::int32_t>(i % 10);
    rows.event_time[i] = 0.5 + 1e-3 * static_cast<double>(i);
    if (i % 3 != 2) continue;
    rows.status[i] = 1;
    rows.attempt[i] = 1;
    rows.event_time[i] = std::nan("");
    rows.failure_time[i] = 0.25;
    rows.reason[i] = "diverged \xC3\xA9 " + std::to_string(i);
  }
  return rows;
}

inline ShardProvenance make_example_provenance(std::int64_t shard = 7) {
  return {std::string(64, 'a'), shard, {{"commit", "abc"}, {"strut_version", "0.1.0"}}};
}

inline std::vector<std::byte> make_example_image(std::size_t count) {
  const ShardSchema schema = make_example_schema();
  return make_shard_image(compress_shard(schema, make_example_rows(schema, count)),
                          make_example_provenance());
}

}  // namespace strut::test
