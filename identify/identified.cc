#include "identify/identified.h"

#include <algorithm>

#include "io/table/csv.h"

namespace strut {

bool IdentifiedRow::in_range() const {
  return outside.empty() && std::all_of(parameters.begin(), parameters.end(),
                                        [](const auto& p) { return p.in_range; });
}

bool are_in_range(const std::vector<IdentifiedRow>& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [](const IdentifiedRow& row) { return row.in_range(); });
}

void write_identified_csv(const std::filesystem::path& path,
                          const std::vector<IdentifiedRow>& rows) {
  std::vector<CsvColumn> columns = {{"row", "1", {}}};
  columns.reserve(3 * rows.front().parameters.size() + 2);
  for (const IdentifiedParameter& p : rows.front().parameters) {
    for (const char* end : {"", "_low", "_high"}) columns.push_back({p.name + end, p.unit, {}});
  }
  columns.push_back({"in_range", "1", {}});
  for (const IdentifiedRow& row : rows) {
    std::size_t c = 0;
    const auto add = [&](double value) { columns[c++].values.push_back(value); };
    add(static_cast<double>(&row - rows.data()));
    for (const IdentifiedParameter& p : row.parameters) {
      add(p.value);
      add(p.low());
      add(p.high());
    }
    add(row.in_range() ? 1.0 : 0.0);
  }
  write_csv(path, columns);
}

}  // namespace strut
