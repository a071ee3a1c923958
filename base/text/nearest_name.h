// Which known name a misspelled one most likely meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace strut {

/// Number of insertions, deletions, replacements and swaps of neighbors that turn `a` into `b`
/// (optimal string alignment distance).
int edit_distance(std::string_view a, std::string_view b);

/// The known name closest to `name`, or "" where none is close enough to be a misspelling of it
/// (more than two edits and more than a third of its letters), or too long to be one. Ties go to
/// the first.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// "; did you mean 'x'?" for `nearest_name`, or "".
std::string suggest_name(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c"; of many names the first, and how many more there are.
std::string join_names(const std::vector<std::string>& names);

}  // namespace strut
