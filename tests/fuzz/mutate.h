// Hostile variants of a file's content.
#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/random.h"

namespace strut::fuzz {

/// Longest content, in bytes: quadratic readers need more than their 5 s by then.
inline constexpr std::size_t kMaxContent = std::size_t{1} << 20;

/// What is special to a format.
struct Dictionary {
  bool is_text = true;  // else changes of lines, words and numbers are left out
  std::vector<std::string> tokens;
  std::vector<std::string> nesting;  // what goes one level deeper
};

/// Numbers at which readers go wrong, as texts.
const std::vector<std::string>& list_extreme_numbers();

/// One of `seeds` with some changes: flipped bits, bytes inserted, deleted and repeated, spliced
/// with another seed, tokens of the dictionary, extreme numbers, swapped words and lines; rarely
/// deep nesting, very long lines and very many of them.
std::string mutate(const std::vector<std::string>& seeds, const Dictionary& dictionary,
                   Random& random);

}  // namespace strut::fuzz
