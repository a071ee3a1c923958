#include "base/math/strata.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace strut {
namespace {

__extension__ using Wide = __int128;

}  // namespace

std::int64_t scale_down(std::int64_t value, std::int64_t factor, std::int64_t divisor) {
  return static_cast<std::int64_t>(static_cast<Wide>(value) * factor / divisor);
}

int find_stratum(std::int64_t level, std::int64_t levels, int strata) {
  return static_cast<int>(static_cast<Wide>(level) * strata / levels);
}

std::int64_t find_first_level(int stratum, std::int64_t levels, int strata) {
  return static_cast<std::int64_t>((static_cast<Wide>(stratum) * levels + strata - 1) / strata);
}

std::vector<std::int64_t> allocate_proportionally(std::int64_t count,
                                                  std::span<const std::int64_t> populations) {
  const std::int64_t total =
      std::accumulate(populations.begin(), populations.end(), std::int64_t{0});
  if (count < 0 || count > total) {
    throw std::invalid_argument(
        fmt::format("allocate_proportionally: count = {}: must lie in [0, {}]", count, total));
  }
  std::vector<std::int64_t> quotas(populations.size(), 0), remainders(populations.size(), 0);
  if (total == 0) return quotas;
  std::int64_t remaining = count;
  for (std::size_t i = 0; i < populations.size(); ++i) {
    const Wide product = static_cast<Wide>(count) * populations[i];
    quotas[i] = static_cast<std::int64_t>(product / total);
    remainders[i] = static_cast<std::int64_t>(product % total);
    remaining -= quotas[i];
  }
  std::vector<std::size_t> order(populations.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return remainders[a] > remainders[b]; });
  for (std::size_t i = 0; remaining > 0; ++i, --remaining) ++quotas[order[i]];
  return quotas;
}

}  // namespace strut
