#include "diagnose/campaign/measured_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "diagnose/campaign/units.h"
#include "io/store/measurement.h"

namespace strut {
namespace {

/// Minimum number of samples of a run.
constexpr std::size_t kMinSamples = 20;

/// The value of a column's cell in the channel's SI unit.
double convert(const CampaignColumn& c, double value) {
  const UnitScale unit = find_unit_scale(c.unit, c.si);
  return c.sign * (c.scale * (unit.factor * value + unit.offset)) + c.offset;
}

Measurement read_columns(const Campaign& campaign, const CampaignRun& run) {
  MeasurementRequest request;
  request.part = MeasuredPart::kHistory;
  request.missing = MissingCells::kNan;
  request.required.push_back(campaign.time.column);
  for (const CampaignColumn& c : campaign.columns) {
    (c.optional ? request.optional : request.required).push_back(c.column);
  }
  return read_measurement(run.file, request);
}

/// Throws unless the clock goes forward at every row.
std::vector<double> read_clock(const Campaign& campaign, const Measurement& file) {
  std::vector<double> times = file.values(campaign.time.column);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isnan(times[i])) {
      throw InputError(fmt::format("{}: {} is missing", file.locate(i), campaign.time.column));
    }
    times[i] = convert(campaign.time, times[i]);
    if (i == 0 || times[i] > times[i - 1]) continue;
    throw InputError(
        fmt::format("{}: the clock {}: {} = {} s after {} s; it must ascend from row to row",
                    file.locate(i), times[i] < times[i - 1] ? "runs backwards" : "stands still",
                    campaign.time.column, format_number(times[i]), format_number(times[i - 1])));
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

MeasuredColumn take_column(const CampaignColumn& c, std::size_t at, const std::vector<double>& raw,
                           const std::pair<std::size_t, std::size_t>& rows) {
  MeasuredColumn column{at, {}, 0};
  column.values.reserve(rows.second - rows.first);
  for (std::size_t i = rows.first; i < rows.second; ++i) {
    column.values.push_back(convert(c, raw[i]));  // NaN stays NaN
    column.missing += std::isnan(raw[i]) ? 1 : 0;
  }
  return column;
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
  const Measurement file = read_columns(campaign, run);
  MeasuredTable table;
  table.name = run.file.string();
  const std::vector<double> times = read_clock(campaign, file);
  const auto rows = find_window(run, times);
  if (rows.second < rows.first + kMinSamples) {
    throw InputError(fmt::format("{}: {} samples{} from {} to {} s; must be at least {}",
                                 table.name, rows.second - rows.first,
                                 run.window ? " in the window" : "", format_rounded(times.front()),
                                 format_rounded(times.back()), kMinSamples));
  }
  table.times.assign(times.begin() + static_cast<std::ptrdiff_t>(rows.first),
                     times.begin() + static_cast<std::ptrdiff_t>(rows.second));
  even_clock(table.times);
  for (std::size_t i = 0; i < campaign.columns.size(); ++i) {
    const CampaignColumn& c = campaign.columns[i];
    const CsvColumn* raw = file.find(c.column);
    if (raw == nullptr) continue;
    table.columns.push_back(take_column(c, i, raw->values, rows));
    const MeasuredColumn& column = table.columns.back();
    if (c.role == ColumnRole::kOutput) check_varies(table.name, c, column);
    if (column.missing == 0) continue;
    table.notes.push_back(fmt::format("{}: {}: {} of {} samples are missing", table.name, c.channel,
                                      column.missing, column.values.size()));
  }
  return table;
}

}  // namespace strut
