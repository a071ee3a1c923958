#include "diagnose/campaign/measured_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "diagnose/campaign/move_to_clock.h"
#include "io/store/measurement.h"

namespace strut {
namespace {

/// Minimum number of samples of a run.
constexpr std::size_t kMinSamples = 20;

/// Columns of one clock, with that first.
Measurement read_columns(const Campaign& campaign, const CampaignRun& run,
                         const std::string& clock) {
  MeasurementRequest request;
  request.part = MeasuredPart::kHistory;
  request.missing = MissingCells::kNan;
  request.required.push_back(clock);
  for (const CampaignColumn& c : campaign.columns) {
    if ((c.clock.empty() ? campaign.time.column : c.clock) != clock) continue;
    (c.optional ? request.optional : request.required).push_back(c.column);
  }
  return read_measurement(run.file, request);
}

/// Throws unless the clock goes forward at every row. A slower clock beside others has no times at
/// the end.
std::vector<double> read_clock(const Campaign& campaign, const Measurement& file,
                               const std::string& clock, std::vector<std::string>& notes) {
  std::vector<double> times = file.values(clock);
  CampaignColumn column = campaign.time;
  column.column = clock;
  const ColumnConversion conversion =
      find_conversion(file.path, file.find(clock)->unit, column, notes);
  while (!times.empty() && std::isnan(times.back())) times.pop_back();
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isnan(times[i])) {
      throw InputError(fmt::format("{}: {} is missing", file.locate(i), clock));
    }
    times[i] = conversion.convert(times[i]);
    if (i == 0 || times[i] > times[i - 1]) continue;
    throw InputError(
        fmt::format("{}: the clock {}: {} = {} s after {} s; it must ascend from row to row",
                    file.locate(i), times[i] < times[i - 1] ? "runs backwards" : "stands still",
                    clock, format_number(times[i]), format_number(times[i - 1])));
  }
  return times;
}

/// Rows [first, last) of the run's window.
std::pair<std::size_t, std::size_t> find_window(const CampaignRun& run,
                                                const std::vector<double>& times) {
  if (!run.window) return {0, times.size()};
  const auto [from, to] = *run.window;
  const auto first = std::lower_bound(times.begin(), times.end(), from);
  const auto last = std::upper_bound(first, times.end(), to);
  return {static_cast<std::size_t>(first - times.begin()),
          static_cast<std::size_t>(last - times.begin())};
}

/// Throws where all readings are equal: a working sensor has noise.
void check_varies(const std::string& name, const CampaignColumn& c, const MeasuredColumn& column) {
  const std::size_t count = column.values.size() - column.missing;
  if (count == 0) {
    throw InputError(
        fmt::format("{}: {} (column '{}') has no reading at all", name, c.channel, c.column));
  }
  const auto is_there = [](double v) { return !std::isnan(v); };
  const double first = *std::find_if(column.values.begin(), column.values.end(), is_there);
  const bool constant = std::all_of(column.values.begin(), column.values.end(),
                                    [&](double v) { return std::isnan(v) || v == first; });
  if (!constant) return;
  throw InputError(fmt::format(
      "{}: {} (column '{}') is {} {} in all {} readings, but a working sensor has noise; is it the "
      "right column?",
      name, c.channel, c.column, format_number(first), c.si, count));
}

/// Keeps rows [first, last) of a column, and counts those that are missing.
void keep_rows(const std::pair<std::size_t, std::size_t>& rows, MeasuredColumn& column) {
  std::vector<double>& values = column.values;
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(rows.second), values.end());
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows.first));
  column.missing = static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }));
}

/// Adds the columns of `clock` with their values at `times`, those of the campaign's clock: all of
/// them where it is that clock.
void add_columns(const Campaign& campaign, const Measurement& file, const std::string& clock,
                 const std::vector<double>& own_times, const std::vector<double>& times,
                 std::vector<MeasuredColumn>& columns, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < campaign.columns.size(); ++i) {
    const CampaignColumn& c = campaign.columns[i];
    const CsvColumn* raw = file.find(c.column);
    if ((c.clock.empty() ? campaign.time.column : c.clock) != clock || raw == nullptr) continue;
    const ColumnConversion conversion = find_conversion(file.path, raw->unit, c, notes);
    std::vector<double> values(raw->values.begin(),
                               raw->values.begin() + static_cast<std::ptrdiff_t>(own_times.size()));
    for (double& value : values) value = conversion.convert(value);  // NaN stays NaN
    const ColumnReading reading = make_column_reading(conversion, c.delay);
    if (c.clock.empty() && c.delay == 0.0) {
      columns.push_back({i, std::move(values), 0, reading});
      continue;
    }
    std::vector<double> own = own_times;
    for (double& t : own) t -= c.delay;
    columns.push_back(
        {i, move_to_clock(own, values, times, c.role == ColumnRole::kInput), 0, reading});
  }
}

std::vector<std::string> list_clocks(const Campaign& campaign) {
  std::vector<std::string> clocks = {campaign.time.column};
  for (const CampaignColumn& c : campaign.columns) {
    if (c.clock.empty() || std::find(clocks.begin(), clocks.end(), c.clock) != clocks.end()) {
      continue;
    }
    clocks.push_back(c.clock);
  }
  return clocks;
}

/// The largest of 1, 0.1, 0.01, ... of which all numbers are multiples; 0 if it is below 1e-7.
double find_resolution(const std::vector<double>& numbers) {
  for (double step = 1.0; step > 0.5e-7; step *= 0.1) {
    const bool fits = std::all_of(numbers.begin(), numbers.end(), [step](double x) {
      return std::abs(x / step - std::round(x / step)) < 1e-6 * std::max(1.0, std::abs(x / step));
    });
    if (fits) return step;
  }
  return 0.0;
}

}  // namespace

const MeasuredColumn* MeasuredTable::find(const std::vector<CampaignColumn>& campaign_columns,
                                          const std::string& channel) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const MeasuredColumn& c) {
    return campaign_columns[c.at].channel == channel;
  });
  return found == columns.end() ? nullptr : &*found;
}

double MeasuredTable::rate() const {
  std::vector<double> intervals;
  intervals.reserve(times.size());
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return 1.0 / *middle;
}

bool even_clock(std::vector<double>& times) {
  const double resolution = find_resolution(times);
  if (resolution == 0.0 || times.size() < 3) return false;
  const double first = times.front(), n = static_cast<double>(times.size() - 1);
  double interval = (times.back() - first) / n, begin = first;
  // Least squares, since the end points alone carry their own rounding.
  double sum = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double at = static_cast<double>(i), rest = times[i] - begin - interval * at;
    sum += rest;
    moment += rest * (at - 0.5 * n);
  }
  const double count = n + 1.0, slope = moment * 12.0 / (count * (count * count - 1.0));
  interval += slope;
  begin += sum / count - slope * 0.5 * n;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double even = begin + interval * static_cast<double>(i);
    if (std::abs(times[i] - even) > 0.75 * resolution) return false;
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = begin + interval * static_cast<double>(i);
  }
  return true;
}

MeasuredTable read_measured_table(const Campaign& campaign, const CampaignRun& run) {
  MeasuredTable table;
  table.name = run.file.string();
  std::vector<double> times;
  for (const std::string& clock : list_clocks(campaign)) {
    const Measurement file = read_columns(campaign, run, clock);
    std::vector<double> own = read_clock(campaign, file, clock, table.notes);
    if (clock == campaign.time.column) {
      table.notes.insert(table.notes.end(), file.notes.begin(), file.notes.end());
      times = own;
    }
    add_columns(campaign, file, clock, own, times, table.columns, table.notes);
  }
  const auto rows = find_window(run, times);
  if (rows.second < rows.first + kMinSamples) {
    throw InputError(
        fmt::format("{}: {} samples{}{}; must be at least {}", table.name, rows.second - rows.first,
                    run.window ? " in the window" : "",
                    times.empty() ? ""
                                  : fmt::format(" from {} to {} s", format_rounded(times.front()),
                                                format_rounded(times.back())),
                    kMinSamples));
  }
  table.times.assign(times.begin() + static_cast<std::ptrdiff_t>(rows.first),
                     times.begin() + static_cast<std::ptrdiff_t>(rows.second));
  even_clock(table.times);
  std::sort(table.columns.begin(), table.columns.end(),
            [](const MeasuredColumn& a, const MeasuredColumn& b) { return a.at < b.at; });
  for (MeasuredColumn& column : table.columns) {
    const CampaignColumn& c = campaign.columns[column.at];
    keep_rows(rows, column);
    if (c.role == ColumnRole::kOutput) check_varies(table.name, c, column);
    if (column.missing == 0 || !c.clock.empty() || c.delay != 0.0) continue;
    table.notes.push_back(fmt::format("{}: {}: {} of {} samples are missing", table.name, c.channel,
                                      column.missing, column.values.size()));
  }
  return table;
}

}  // namespace strut
