#include "io/table/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error/input_error.h"
#include "base/math/spread.h"
#include "io/table/column_name.h"
#include "io/table/units.h"

namespace strut {
namespace {

bool is_time_unit(const std::string& unit) {
  if (unit.empty() || !is_known_unit(unit)) return false;
  try {
    find_unit_scale(unit, "s");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string get_group(const std::string& name) {
  const auto slash = name.rfind('/');
  return slash == std::string::npos ? "" : name.substr(0, slash + 1);
}

std::string get_own_name(const std::string& name) {
  const auto slash = name.rfind('/');
  return slash == std::string::npos ? name : name.substr(slash + 1);
}

/// The values up to the last that is there: a slow column ends early.
std::vector<double> cut_missing_end(std::vector<double> values) {
  while (!values.empty() && std::isnan(values.back())) values.pop_back();
  return values;
}

bool ascends(const std::vector<double>& values) {
  return values.size() > 1 &&
         std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }) &&
         std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

/// Why a column named as a time cannot be the clock.
std::string describe_no_clock(const std::vector<double>& times) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) return fmt::format("no time: its value {} is missing", i + 1);
    if (i > 0 && !(times[i] > times[i - 1])) {
      return fmt::format("no time: its value {} is {:.9g} after {:.9g}", i + 1, times[i],
                         times[i - 1]);
    }
  }
  return "no time: fewer than two values";
}

/// The longest run of equal values at `extreme`.
std::size_t find_longest_run(const std::vector<double>& values, double extreme) {
  std::size_t longest = 0, current = 0;
  for (const double v : values) {
    current = v == extreme ? current + 1 : 0;
    longest = std::max(longest, current);
  }
  return longest;
}

void add_remarks(const std::vector<double>& values, ColumnSummary& column) {
  constexpr std::size_t kMinPlateau = 5, kMinLevels = 12;
  if (column.missing > 0) {
    column.remarks.push_back(fmt::format("{} of {} missing", column.missing, column.count));
  }
  if (column.count == column.missing) return;
  if (column.min == column.max) {
    column.remarks.emplace_back("constant");
    return;
  }
  for (const bool at_max : {false, true}) {
    const std::size_t run = find_longest_run(values, at_max ? column.max : column.min);
    if (run < kMinPlateau) continue;
    column.remarks.push_back(
        fmt::format("{} samples in a row at its {}", run, at_max ? "maximum" : "minimum"));
  }
  std::vector<double> levels = values;
  levels.erase(std::remove_if(levels.begin(), levels.end(), [](double v) { return std::isnan(v); }),
               levels.end());
  std::sort(levels.begin(), levels.end());
  const auto count = std::unique(levels.begin(), levels.end()) - levels.begin();
  if (static_cast<std::size_t>(count) < kMinLevels && levels.size() > kMinLevels) {
    column.remarks.push_back(fmt::format("only {} different values", count));
  }
}

ColumnSummary summarize_column(const TableFile& file, const std::string& name,
                               std::vector<double>& values) {
  ColumnSummary column;
  column.name = name;
  try {
    CsvColumn read = file.read(name);
    column.header = read.header;
    column.unit = read.unit;
    values = std::move(read.values);
  } catch (const InputError& e) {
    column.fault = e.what();
    return column;
  }
  if (column.unit.empty()) column.guessed_unit = guess_name_unit(get_own_name(name));
  column.count = values.size();
  const auto is_missing = [](double v) { return !std::isfinite(v); };
  column.missing =
      static_cast<std::size_t>(std::count_if(values.begin(), values.end(), is_missing));
  bool is_first = true;
  for (const double v : values) {
    if (is_missing(v)) continue;
    column.min = is_first ? v : std::min(column.min, v);
    column.max = is_first ? v : std::max(column.max, v);
    is_first = false;
  }
  column.mean = calc_mean(values);
  column.spread = calc_spread(values);
  return column;
}

void make_clock(std::vector<double> times, ColumnSummary& column) {
  const std::string unit = column.unit.empty() ? column.guessed_unit : column.unit;
  const double factor = is_time_unit(unit) ? find_unit_scale(unit, "s").factor : 1.0;
  for (double& t : times) t *= factor;
  column.is_clock = true;
  column.times = summarize_clock(times);
}

/// The clock of a column: the last before it in its group, or else the group's first, or else the
/// file's first.
int find_clock(const std::vector<ColumnSummary>& columns, std::size_t at) {
  int before = -1, in_group = -1, any = -1;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].is_clock) continue;
    const int number = static_cast<int>(i);
    if (any < 0) any = number;
    if (get_group(columns[i].name) != get_group(columns[at].name)) continue;
    if (in_group < 0) in_group = number;
    if (i < at) before = number;
  }
  return before >= 0 ? before : in_group >= 0 ? in_group : any;
}

}  // namespace

bool is_time_name(std::string_view name) {
  std::string text;
  for (const char c : name) text += c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c;
  const auto number = text.find(" (");
  text = text.substr(0, number);
  if (const std::string unit = guess_name_unit(text); is_time_unit(unit)) {
    text.resize(text.size() - unit.size() - 1);
  }
  constexpr const char* kNames[] = {"t",    "time",  "timestamp", "timestamps",   "clock",
                                    "zeit", "temps", "elapsed",   "elapsed time", "tempo"};
  return std::find(std::begin(kNames), std::end(kNames), text) != std::end(kNames);
}

ClockSummary summarize_clock(const std::vector<double>& times) {
  constexpr double kGap = 1.5, kJitters = 6.0;
  ClockSummary clock;
  clock.first = times.front();
  clock.last = times.back();
  std::vector<double> intervals;
  intervals.reserve(times.size());
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  clock.interval = calc_quantile(intervals, 0.5);
  // A jitter of a standard deviation on both sides of the median.
  const double jitter = 0.5 * (calc_quantile(intervals, 0.84) - calc_quantile(intervals, 0.16));
  const double longest = std::max(kGap * clock.interval, clock.interval + kJitters * jitter);
  std::vector<double> regular;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    if (intervals[i] < longest) {
      regular.push_back(intervals[i]);
      continue;
    }
    if (clock.gaps++ == 0) clock.first_gap = times[i];
    clock.dropped += static_cast<std::size_t>(std::llround(intervals[i] / clock.interval)) - 1;
  }
  // Better than the median where times are printed with few digits.
  clock.interval = calc_mean(regular);
  clock.jitter = calc_spread(regular);
  return clock;
}

TableSummary summarize_table(const TableFile& file) {
  TableSummary table;
  table.format = file.format();
  table.notes = file.notes();
  std::vector<std::size_t> ascending;
  bool has_named_time = false;
  for (const std::string& name : file.names()) {
    std::vector<double> values;
    ColumnSummary column = summarize_column(file, name, values);
    const std::vector<double> times = cut_missing_end(values);
    const bool is_ascending = column.fault.empty() && ascends(times);
    const std::string unit = column.unit.empty() ? column.guessed_unit : column.unit;
    const bool is_named_time = is_time_name(get_own_name(name));
    has_named_time = has_named_time || is_named_time;
    if (is_ascending && (is_named_time || is_time_unit(unit))) {
      make_clock(times, column);
    } else if (column.fault.empty()) {
      if (is_named_time) column.remarks.push_back(describe_no_clock(times));
      add_remarks(values, column);
    }
    if (is_ascending) ascending.push_back(table.columns.size());
    table.columns.push_back(std::move(column));
  }
  const bool has_clock = std::any_of(table.columns.begin(), table.columns.end(),
                                     [](const ColumnSummary& column) { return column.is_clock; });
  if (!has_clock && !has_named_time && !ascending.empty()) {
    ColumnSummary& column = table.columns[ascending.front()];
    make_clock(cut_missing_end(file.read(column.name).values), column);
    column.remarks.emplace_back("taken for the time: it ascends");
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!table.columns[i].is_clock) table.columns[i].clock = find_clock(table.columns, i);
  }
  return table;
}

}  // namespace strut
