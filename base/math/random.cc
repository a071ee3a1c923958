#include "base/math/random.h"

#include <Random123/philox.h>

namespace strut {

std::array<std::uint32_t, 4> calc_philox(const std::array<std::uint32_t, 4>& counter,
                                         const std::array<std::uint32_t, 2>& key) {
  using Philox = r123::Philox4x32_R<10>;
  const Philox::ctr_type c = {{counter[0], counter[1], counter[2], counter[3]}};
  const Philox::key_type k = {{key[0], key[1]}};
  const Philox::ctr_type r = Philox()(c, k);
  return {r[0], r[1], r[2], r[3]};
}

std::uint64_t calc_random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  const auto low = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const auto high = [](std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); };
  const auto block = calc_philox({low(counter), high(counter), low(stream), high(stream)},
                                 {low(seed), high(seed)});
  return block[0] | static_cast<std::uint64_t>(block[1]) << 32;
}

double calc_uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
  return static_cast<double>(calc_random_bits(seed, stream, counter) >> 11) * 0x1p-53;
}

}  // namespace strut
