// Counter-based random numbers: each value is a function of seed, stream and counter, whatever the
// order of the calls and the number of threads.
//
// Philox4x32-10 of J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw: "Parallel random numbers: as
// easy as 1, 2, 3", SC11, doi:10.1145/2063384.2063405, from their library Random123.
#pragma once

#include <array>
#include <cstdint>

namespace strut {

/// The block function itself: ten rounds.
std::array<std::uint32_t, 4> calc_philox(const std::array<std::uint32_t, 4>& counter,
                                         const std::array<std::uint32_t, 2>& key);

/// 64 random bits; each pair of `seed` and `stream` has an independent sequence over `counter`.
std::uint64_t calc_random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter);

/// Uniform on [0, 1), a multiple of 2^-53.
double calc_uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter);

}  // namespace strut
