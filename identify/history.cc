#include "identify/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/error/input_error.h"

namespace strut {

Measurement read_history(const std::filesystem::path& file, const std::vector<ColumnInfo>& channels,
                         const ColumnMap& map) {
  std::vector<ColumnInfo> all = {{kTimeColumn, "s", ""}};
  all.insert(all.end(), channels.begin(), channels.end());
  return read_channels(file, MeasuredPart::kHistory, all, {}, map);
}

void require_ascending_times(const Measurement& history) {
  const std::vector<double>& times = history.values(kTimeColumn);
  const auto fault = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
  if (fault == times.end()) return;
  throw InputError(
      fmt::format("{}: time must ascend; sort or cut the file there",
                  history.locate(static_cast<std::size_t>(fault - times.begin()) + 1)));
}

}  // namespace strut
