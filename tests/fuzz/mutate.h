// Hostile variants of a file's content.
#pragma once

#include <string>
#include <vector>

#include "tests/fuzz/random.h"

namespace strut::fuzz {

/// Max. length of the content [bytes]; a quadratic reader exceeds its 5 s before.
inline constexpr std::size_t kMaxContent = std::size_t{1} << 20;

/// Properties of a format that mutations use.
struct Dictionary {
  bool is_text = true;  // false: no mutations of lines, words and numbers
  std::vector<std::string> tokens;
  std::vector<std::string> nesting;  // texts that nest one level deeper
};

/// Numbers that are likely to break readers, as texts.
const std::vector<std::string>& list_extreme_numbers();

/// Returns one of `seeds` with some changes: flipped bits, bytes inserted, deleted and repeated,
/// spliced with another seed, tokens of the dictionary, extreme numbers, swapped words and lines;
/// rarely deep nesting, very long lines and very many of them.
std::string mutate(const std::vector<std::string>& seeds, const Dictionary& dictionary,
                   Random& random);

}  // namespace strut::fuzz
