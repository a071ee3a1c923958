#include "io/table/column_name.h"

#include <algorithm>

#include "io/format/text_line.h"
#include "io/table/units.h"

namespace strut {
namespace {

constexpr std::string_view kBlanks = " \t";

/// The text inside of a pair of brackets that the whole `text` stands in.
std::string_view strip_brackets(std::string_view text) {
  constexpr std::string_view kPairs[] = {"[]", "()", "{}", "<>"};
  for (const std::string_view pair : kPairs) {
    if (text.size() >= 2 && text.front() == pair[0] && text.back() == pair[1]) {
      return trim(text.substr(1, text.size() - 2), kBlanks);
    }
  }
  return text;
}

bool is_dimensionless(std::string_view unit) { return unit == "-" || unit == "1"; }

/// Splits off what stands in brackets at the end; the name keeps "[0]" and the like, an index.
bool split_brackets(std::string_view text, ColumnName& out) {
  constexpr std::string_view kPairs[] = {"[]", "{}", "()"};
  for (const std::string_view pair : kPairs) {
    if (text.empty() || text.back() != pair[1]) continue;
    const auto open = text.rfind(pair[0]);
    if (open == std::string_view::npos || open == 0) return false;
    const std::string_view unit = strip_brackets(text.substr(open));
    const bool is_index =
        !unit.empty() && unit.find_first_not_of("0123456789,: ") == std::string_view::npos;
    const bool is_unit = is_known_unit(unit) || is_dimensionless(unit) || pair[0] != '(';
    if (!is_unit || (is_index && unit != "1")) return false;
    out.name = trim(text.substr(0, open), " \t/");
    out.unit = is_dimensionless(unit) ? "1" : normalize_unit(unit);
    return !out.name.empty();
  }
  return false;
}

/// Whether a text that no brackets mark as a unit is one: not "C" or "F", which rather name a part.
bool is_plain_unit(std::string_view text) {
  const bool is_letter = text.size() == 1 && text.front() >= 'A' && text.front() <= 'Z';
  return is_known_unit(text) && (!is_letter || text == "N");
}

/// Splits at the first `mark` behind which a unit stands. In "speed m/s" none does.
bool split_behind(std::string_view text, std::string_view mark, ColumnName& out) {
  for (auto at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at + 1)) {
    const std::string_view unit = strip_brackets(trim(text.substr(at + mark.size()), kBlanks));
    if (!is_plain_unit(unit)) continue;
    const std::string_view name = trim(text.substr(0, at), kBlanks);
    const std::string_view last_word = name.substr(name.find_last_of(kBlanks) + 1);
    if (name.empty() || is_plain_unit(last_word)) continue;
    out = {std::string(name), normalize_unit(unit)};
    return true;
  }
  return false;
}

}  // namespace

ColumnName split_unit(std::string_view header) {
  const std::string_view text = trim(header, kBlanks);
  ColumnName out;
  if (split_brackets(text, out)) return out;
  for (const std::string_view mark : {"/", ",", " in "}) {
    if (split_behind(text, mark, out)) return out;
  }
  return {std::string(text), ""};
}

std::string parse_unit_cell(std::string_view cell) {
  const std::string_view unit = strip_brackets(trim(cell, kBlanks));
  return is_dimensionless(unit) ? "" : normalize_unit(unit);
}

bool is_unit_cell(std::string_view cell) {
  const std::string_view text = trim(cell, kBlanks);
  return text.empty() || is_dimensionless(text) || is_known_unit(text) ||
         strip_brackets(text) != text;
}

std::string guess_name_unit(std::string_view name) {
  for (auto at = name.find('_'); at != std::string_view::npos; at = name.find('_', at + 1)) {
    if (name.size() - at > kMaxUnitLength) continue;
    std::string unit(name.substr(at + 1));
    // "mm_s" and "m_s2" for mm/s and m/s2
    std::replace(unit.begin(), unit.end(), '_', '/');
    if (at > 0 && is_known_unit(unit)) return normalize_unit(unit);
  }
  return "";
}

}  // namespace strut
