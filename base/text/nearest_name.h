// Suggestions for misspelled names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace strut {

/// Number of insertions, deletions, replacements and swaps of neighbors that turn `a` into `b`
/// (optimal string alignment distance).
int edit_distance(std::string_view a, std::string_view b);

/// The known name closest to `name`; "" where `name` is longer than kMaxQuoted, or where every
/// known name is more than two edits and more than a third of the letters of `name` away. Ties go
/// to the first.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// "; did you mean 'x'?" for `nearest_name`, or "".
std::string suggest_name(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c"; names beyond the first 200 are only counted ("and 7 more"). Long names are shortened.
std::string join_names(const std::vector<std::string>& names);

}  // namespace strut
