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
  std::vector<CsvColumn> columns;
  for (const IdentifiedRow& row : rows) {
    std::size_t c = 0;
    const auto add = [&](const std::string& name, const std::string& unit, double value) {
      if (c == columns.size()) columns.push_back({name, unit, {}});
      columns[c++].values.push_back(value);
    };
    const auto add_interval = [&](const std::string& name, const std::string& unit, double value,
                                  double half_width) {
      add(name, unit, value);
      add(name + "_low", unit, value - half_width);
      add(name + "_high", unit, value + half_width);
    };
    add("row", "1", static_cast<double>(&row - rows.data()));
    for (const IdentifiedParameter& p : row.parameters) {
      add_interval(p.name, p.unit, p.value, p.half_width);
    }
    add("in_range", "1", row.in_range() ? 1.0 : 0.0);
    for (const IdentifiedParameter& p : row.parameters) {
      if (!p.wear) continue;
      add_interval(p.name + "_wear", "%", p.wear->percent, p.wear->half_width);
      add(p.name + "_beyond_limit", "1", p.wear->beyond);
      if (p.change) add_interval(p.name + "_change", "%", p.change->percent, p.change->half_width);
    }
  }
  write_csv(path, columns);
}

}  // namespace strut
