#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <utility>

#include "base/text/range.h"

namespace strut::fuzz {
namespace {

/// Bytes [begin, end) of a text.
using Range = std::pair<std::size_t, std::size_t>;

Range pick_range(const std::string& text, std::size_t max, Random& random) {
  const std::size_t begin = random.below(text.size() + 1);
  return {begin, std::min(text.size(), begin + random.log_uniform(max))};
}

std::string cut(const std::string& text, const Range& range) {
  return text.substr(range.first, range.second - range.first);
}

void replace(std::string& text, const Range& range, const std::string& by) {
  text.replace(range.first, range.second - range.first, by);
}

std::string repeat(const std::string& piece, std::size_t count) {
  std::string text;
  text.reserve(piece.size() * count);
  for (std::size_t i = 0; i < count; ++i) text += piece;
  return text;
}

/// Finds the runs of characters that `belongs` accepts and whose first character `begins` accepts.
template <class Begins, class Belongs>
std::vector<Range> find_runs(const std::string& text, const Begins& begins,
                             const Belongs& belongs) {
  std::vector<Range> runs;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && belongs(static_cast<unsigned char>(text[end]))) ++end;
    if (end > i && begins(static_cast<unsigned char>(text[i]))) runs.emplace_back(i, end);
    i = std::max(end, i + 1);
  }
  return runs;
}

std::vector<Range> find_words(const std::string& text) {
  return find_runs(
      text, [](unsigned char c) { return std::isalpha(c) != 0; },
      [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

std::vector<Range> find_numbers(const std::string& text) {
  return find_runs(
      text, [](unsigned char c) { return std::isdigit(c) != 0 || c == '-' || c == '.'; },
      [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '+'; });
}

/// Finds the lines, each with its line end.
std::vector<Range> find_lines(const std::string& text) {
  std::vector<Range> lines;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find('\n', i), text.size() - 1) + 1;
    lines.emplace_back(i, end);
    i = end;
  }
  return lines;
}

void change_bytes(std::string& text, Random& random) {
  const std::size_t at = random.below(text.size());
  switch (random.below(4)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
      break;
    case 1:
      text[at] = static_cast<char>(random.next());
      break;
    case 2:
      text.insert(at, 1, static_cast<char>(random.next()));
      break;
    default: {
      // A binary number of 1, 2, 4 or 8 bytes.
      constexpr std::uint64_t kNumbers[] = {0,
                                            1,
                                            ~std::uint64_t{0},
                                            0x7fffffffffffffff,
                                            0x7ff0000000000000,
                                            0x7ff8000000000000,
                                            0x80000000,
                                            0x7fefffffffffffff};
      const std::uint64_t number = kNumbers[random.below(std::size(kNumbers))];
      std::memcpy(text.data() + at, &number,
                  std::min(text.size() - at, std::size_t{1} << random.below(4)));
    }
  }
}

void change_piece(std::string& text, const std::vector<std::string>& seeds, Random& random) {
  const Range range = pick_range(text, 64, random);
  switch (random.below(5)) {
    case 0:
      replace(text, range, "");
      break;
    case 1:
      text.insert(random.below(text.size() + 1), cut(text, range));
      break;
    case 2:
      text.insert(range.first, repeat(cut(text, range), random.log_uniform(64)));
      break;
    case 3:
      text.resize(range.first);
      break;
    default: {
      const std::string& other = random.pick(seeds);
      text.resize(range.first);
      text += other.substr(random.below(other.size() + 1));
    }
  }
}

void change_number(std::string& text, Random& random) {
  const auto numbers = find_numbers(text);
  if (!numbers.empty()) replace(text, random.pick(numbers), random.pick(list_extreme_numbers()));
}

void change_words(std::string& text, const Dictionary& dictionary, Random& random) {
  const auto words = find_words(text);
  if (words.empty()) return;
  const Range word = random.pick(words);
  const bool known = dictionary.tokens.empty() || random.one_in(2);
  replace(text, word, known ? cut(text, random.pick(words)) : random.pick(dictionary.tokens));
}

void change_lines(std::string& text, Random& random) {
  const auto lines = find_lines(text);
  if (lines.empty()) return;
  const Range line = random.pick(lines);
  const Range other = random.pick(lines);
  const std::string copy = cut(text, other);
  switch (random.below(3)) {
    case 0:
      replace(text, line, "");
      break;
    case 1:
      replace(text, line, copy);
      break;
    default:
      text.insert(line.first, copy);
  }
}

void insert_token(std::string& text, const Dictionary& dictionary, Random& random) {
  if (dictionary.tokens.empty()) return change_bytes(text, random);
  text.insert(random.below(text.size() + 1), random.pick(dictionary.tokens));
}

/// Repeats a line, each time with another number.
std::string make_many_lines(const std::string& line, Random& random) {
  const std::size_t at = random.below(line.size());
  const std::size_t count = kMaxContent / (line.size() + 6) >> random.below(6);
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += line.substr(0, at) + std::to_string(i) + line.substr(at);
  }
  return text;
}

/// Makes the content long.
void blow_up(std::string& text, const Dictionary& dictionary, Random& random) {
  if (text.empty()) text = "\n";
  const std::size_t at = random.below(text.size() + 1);
  switch (random.below(3)) {
    case 0: {
      const bool known = !dictionary.nesting.empty();
      const std::string piece =
          known ? random.pick(dictionary.nesting) : cut(text, pick_range(text, 8, random));
      const std::size_t count = kMaxContent / 8 / std::max<std::size_t>(piece.size(), 1);
      // A line of its own, as otherwise the rest of the line is invalid before it is deep.
      const auto lines = find_lines(text);
      text.insert(random.one_in(4) ? at : random.pick(lines).first,
                  repeat(piece, count >> random.below(8)));
      break;
    }
    case 1:
      text.insert(at, random.log_uniform(kMaxContent), random.one_in(2) ? 'a' : '1');
      break;
    default: {
      const auto lines = find_lines(text);
      const Range line = random.pick(lines);
      text.insert(line.first, make_many_lines(cut(text, line), random));
    }
  }
}

void change(std::string& text, const std::vector<std::string>& seeds, const Dictionary& dictionary,
            Random& random) {
  if (text.empty()) text = random.pick(seeds) + "\n";
  switch (random.below(dictionary.is_text ? 8 : 3)) {
    case 0:
      return change_bytes(text, random);
    case 1:
      return change_piece(text, seeds, random);
    case 2:
      return insert_token(text, dictionary, random);
    case 3:
    case 4:
      return change_number(text, random);
    case 5:
    case 6:
      return change_words(text, dictionary, random);
    default:
      return change_lines(text, random);
  }
}

}  // namespace

const std::vector<std::string>& list_extreme_numbers() {
  static const std::vector<std::string> numbers = {"0",
                                                   "-0",
                                                   "-1",
                                                   "1",
                                                   "1e-9",
                                                   "1e308",
                                                   "-1e308",
                                                   "1e-320",
                                                   "1e999",
                                                   "1e16",
                                                   "nan",
                                                   "inf",
                                                   "-inf",
                                                   "2147483648",
                                                   "-2147483649",
                                                   "4294967296",
                                                   "9007199254740993",
                                                   "9223372036854775807",
                                                   "-9223372036854775808",
                                                   "18446744073709551616",
                                                   "0x7fffffffffffffff",
                                                   "1979-05-27"};
  return numbers;
}

std::string mutate(const std::vector<std::string>& seeds, const Dictionary& dictionary,
                   Random& random) {
  constexpr std::size_t kMaxChanges = 8, kRarely = 150;
  std::string text = random.pick(seeds);
  if (random.one_in(kRarely)) {
    blow_up(text, dictionary, random);
  } else {
    const std::size_t changes = random.log_uniform(kMaxChanges);
    for (std::size_t i = 0; i < changes; ++i) change(text, seeds, dictionary, random);
  }
  if (text.size() > kMaxContent) text.resize(kMaxContent);
  return text;
}

}  // namespace strut::fuzz
