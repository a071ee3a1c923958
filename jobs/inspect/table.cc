#include "jobs/inspect/table.h"

#include <fmt/format.h>

#include "base/text/format_number.h"

namespace strut {
namespace {

/// "500 Hz, 12 s from 0 s, jitter 3 us, 2 gaps (5 samples dropped), the first at 3.2 s"
std::string describe_clock(const ClockSummary& clock) {
  constexpr double kVisibleJitter = 1e-4;  // of the interval
  std::string text =
      fmt::format("{} Hz, {} s from {} s", format_significant(1.0 / clock.interval),
                  format_significant(clock.last - clock.first), format_rounded(clock.first));
  if (clock.jitter > kVisibleJitter * clock.interval) {
    text += fmt::format(", jitter {} ms", format_significant(1e3 * clock.jitter, 2));
  }
  if (clock.gaps > 0) {
    text += fmt::format(", {} gaps ({} samples dropped), the first at {} s", clock.gaps,
                        clock.dropped, format_rounded(clock.first_gap));
  }
  return text;
}

std::string describe_remarks(const TableSummary& table, const ColumnSummary& column,
                             std::size_t at) {
  std::string text = column.is_clock ? describe_clock(column.times) : "";
  for (const std::string& remark : column.remarks) text += (text.empty() ? "" : "; ") + remark;
  if (!column.fault.empty()) text = fmt::format("not numbers ({})", column.fault);
  // Only where there are several clocks.
  std::size_t clocks = 0;
  for (const ColumnSummary& other : table.columns) clocks += other.is_clock ? 1 : 0;
  if (clocks > 1 && !column.is_clock && column.clock >= 0 && column.clock != static_cast<int>(at)) {
    text += (text.empty() ? "" : "; ") + std::string("over ") +
            table.columns[static_cast<std::size_t>(column.clock)].name;
  }
  return text;
}

std::string describe_unit(const ColumnSummary& column) {
  if (!column.unit.empty()) return column.unit;
  return column.guessed_unit.empty() ? "" : column.guessed_unit + "?";
}

}  // namespace

ReportTable make_inspect_table(const InspectedFile& file) {
  ReportTable table;
  table.caption = fmt::format("{}: {}", file.path.string(), file.table.format);
  table.header = {"column", "unit", "values", "min", "max", "mean", "std. dev."};
  table.text_columns = 2;
  bool has_guess = false;
  for (std::size_t k = 0; k < file.table.columns.size(); ++k) {
    const ColumnSummary& c = file.table.columns[k];
    const bool has_values = c.count > c.missing;
    const auto number = [&](double x) { return has_values ? format_significant(x, 4) : ""; };
    table.rows.push_back({c.name, describe_unit(c), std::to_string(c.count - c.missing),
                          number(c.min), number(c.max), number(c.mean), number(c.spread)});
    const std::string remarks = describe_remarks(file.table, c, k);
    if (!remarks.empty()) table.notes.push_back(fmt::format("{}: {}", c.name, remarks));
    has_guess = has_guess || (c.unit.empty() && !c.guessed_unit.empty());
  }
  if (has_guess)
    table.notes.emplace_back(
        "unit?: a guess by the column's name; files are read in SI unless they or the campaign say "
        "otherwise");
  for (const std::string& note : file.table.notes) table.notes.push_back(note);
  return table;
}

Json make_inspect_json(const InspectedFile& file) {
  Json columns = Json::array();
  for (const ColumnSummary& c : file.table.columns) {
    Json column = {{"name", c.name},         {"header", c.header},
                   {"unit", c.unit},         {"guessed_unit", c.guessed_unit},
                   {"count", c.count},       {"missing", c.missing},
                   {"min", c.min},           {"max", c.max},
                   {"mean", c.mean},         {"standard_deviation", c.spread},
                   {"is_clock", c.is_clock}, {"remarks", c.remarks}};
    if (c.clock >= 0) column["clock"] = file.table.columns[static_cast<std::size_t>(c.clock)].name;
    if (!c.fault.empty()) column["fault"] = c.fault;
    if (c.is_clock) {
      column["rate"] = 1.0 / c.times.interval;
      column["duration"] = c.times.last - c.times.first;
      column["jitter"] = c.times.jitter;
      column["gaps"] = c.times.gaps;
      column["dropped"] = c.times.dropped;
    }
    columns.push_back(std::move(column));
  }
  return {{"file", file.path.string()},
          {"format", file.table.format},
          {"columns", std::move(columns)},
          {"notes", file.table.notes}};
}

}  // namespace strut
