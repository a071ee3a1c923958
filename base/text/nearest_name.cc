#include "base/text/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/text/shorten.h"

namespace strut {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() > kMaxQuoted) return "";
  int best = std::max(2, static_cast<int>(name.size() / 3)) + 1;
  std::string nearest;
  for (const std::string& candidate : known) {
    // The distance is at least the difference of the lengths.
    const auto min_distance = std::abs(std::ssize(name) - std::ssize(candidate));
    if (min_distance >= best) continue;
    const int distance = edit_distance(name, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string suggest_name(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

std::string join_names(const std::vector<std::string>& names) {
  std::string text;
  constexpr std::size_t kMaxNames = 200;
  const std::size_t count = std::min(names.size(), kMaxNames);
  for (std::size_t i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + shorten(names[i]);
  if (count < names.size()) text += fmt::format(" and {} more", names.size() - count);
  return text;
}

}  // namespace strut
