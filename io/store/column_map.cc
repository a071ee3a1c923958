#include "io/store/column_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kTimeChannel[] = "time";
/// Keys of a channel that move its readings to another clock.
constexpr const char* kUnusedKeys[] = {"clock", "delay"};

fs::path make_canonical(const fs::path& path) {
  std::error_code error;  // a path that does not exist stays as it is
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path : canonical;
}

void keep_rows(std::size_t first, std::size_t last, Measurement& measurement) {
  const auto cut = [&](auto& list) {
    if (list.empty()) return;
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(last), list.end());
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first));
  };
  for (CsvColumn& column : measurement.columns) cut(column.values);
  cut(measurement.lines);
}

/// Keeps the rows in the file's window. Of several windows none is meant.
void cut_window(const ColumnMap& map, Measurement& measurement) {
  const CsvColumn* time = measurement.find(kTimeChannel);
  const auto found = map.windows.find(make_canonical(measurement.path));
  if (time == nullptr || found == map.windows.end()) return;
  if (found->second.size() > 1) {
    measurement.notes.push_back(
        fmt::format("{}: the whole file is used; the campaign has {} windows of it",
                    measurement.path.string(), found->second.size()));
    return;
  }
  const std::pair<double, double>& window = found->second.front();
  measurement.notes.push_back(fmt::format("{}: only {} to {} s is used, the campaign's window",
                                          measurement.path.string(), window.first, window.second));
  const auto is_inside = [&](double t) { return t >= window.first && t <= window.second; };
  const auto first = std::find_if(time->values.begin(), time->values.end(), is_inside);
  const auto last = std::find_if(time->values.rbegin(), time->values.rend(), is_inside).base();
  if (first >= last) {
    throw InputError(fmt::format("{}: no sample lies in the campaign's window of {} to {} s",
                                 measurement.path.string(), window.first, window.second));
  }
  const auto begin = time->values.begin();
  keep_rows(static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin),
            measurement);
}

}  // namespace

MappedColumn read_mapped_column(const Table& columns, const std::string& channel,
                                const std::string& si) {
  MappedColumn c;
  c.channel = channel;
  c.si = si;
  const Table table = columns.table(channel);
  c.column = table.text_or("column", channel);
  c.unit = table.text_or("unit", "");
  try {
    find_unit_scale(c.unit, c.si);
  } catch (const InputError& e) {
    throw table.error("unit", e.what());
  }
  c.sign = table.number_or("sign", 1.0);
  c.has_sign = table.has("sign");
  if (c.sign != 1.0 && c.sign != -1.0) throw table.error("sign", "must be 1 or -1");
  c.scale = table.number_or("scale", 1.0);
  c.has_scale = table.has("scale");
  if (c.scale == 0.0) throw table.error("scale", "must not be 0");
  c.offset = table.number_or("offset", 0.0);
  return c;
}

ColumnConversion find_conversion(const fs::path& file, const std::string& stated,
                                 const MappedColumn& mapped, std::vector<std::string>& notes) {
  // A scale without a unit is the user's own conversion.
  const bool is_taken = mapped.unit.empty() && !mapped.has_scale;
  ColumnConversion conversion{{}, mapped.sign * mapped.scale, mapped.offset};
  try {
    conversion.unit = find_unit_scale(is_taken ? stated : mapped.unit, mapped.si);
  } catch (const InputError& e) {
    throw InputError(fmt::format(
        "{}: column '{}': {}; if the file is wrong, give unit in [columns] {} of a campaign",
        file.string(), mapped.column, e.what(), mapped.channel));
  }
  const bool differs = !mapped.unit.empty() && !stated.empty() &&
                       normalize_unit(mapped.unit) != normalize_unit(stated);
  if (differs) {
    notes.push_back(
        fmt::format("{}: {}: the file says that column '{}' is in {}; read in {}, as the campaign "
                    "says",
                    file.string(), mapped.channel, mapped.column, stated, mapped.unit));
  }
  return conversion;
}

MappedColumn ColumnMap::find(const ColumnInfo& channel) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const MappedColumn& c) { return c.channel == channel.name; });
  if (found != columns.end()) return *found;
  MappedColumn own;
  own.channel = own.column = channel.name;
  own.si = channel.unit;
  return own;
}

ColumnMap read_column_map(const fs::path& campaign, const std::vector<ColumnInfo>& channels,
                          const std::vector<std::string>& known) {
  const Document document(campaign);
  const Table root = document.root();
  const Table columns = root.table("columns");
  ColumnMap map;
  for (const ColumnInfo& channel : channels) {
    if (!columns.has(channel.name)) continue;
    map.columns.push_back(read_mapped_column(columns, channel.name, channel.unit));
    const Table entry = columns.table(channel.name);
    for (const char* key : kUnusedKeys) {
      if (!entry.has(key)) continue;
      throw entry.error(key, "is for compare and diagnose; identify reads channels of one clock");
    }
  }
  for (const std::string& name : columns.keys()) {
    const auto is_known = [&](const std::string& other) { return other == name; };
    if (std::any_of(known.begin(), known.end(), is_known)) continue;
    throw columns.error(name, "is not a channel of this model" + suggest_name(name, known));
  }
  if (!root.has("run")) return map;
  for (const Table& run : root.tables("run")) {
    if (!run.has("window")) continue;
    const std::vector<double> window = run.numbers("window");
    if (window.size() != 2 || !(window[0] < window[1])) {
      throw run.error("window", "must be [from, to] in s, from < to");
    }
    map.windows[make_canonical(run.file("file"))].emplace_back(window[0], window[1]);
  }
  return map;
}

Measurement read_channels(const fs::path& file, MeasuredPart part,
                          const std::vector<ColumnInfo>& channels,
                          const std::vector<ColumnInfo>& optional, const ColumnMap& map) {
  MeasurementRequest request;
  request.part = part;
  for (const ColumnInfo& channel : channels) request.required.push_back(map.find(channel).column);
  for (const ColumnInfo& channel : optional) request.optional.push_back(map.find(channel).column);
  Measurement measurement = read_measurement(file, request);
  std::vector<ColumnInfo> all = channels;
  all.insert(all.end(), optional.begin(), optional.end());
  std::vector<CsvColumn> converted;  // beside those of the file, since columns may swap their names
  for (const ColumnInfo& channel : all) {
    const MappedColumn mapped = map.find(channel);
    const CsvColumn* const found = measurement.find(mapped.column);
    if (found == nullptr) continue;
    CsvColumn column = *found;
    const ColumnConversion conversion =
        find_conversion(file, column.unit, mapped, measurement.notes);
    for (double& value : column.values) value = conversion.convert(value);
    column.name = channel.name;
    column.unit = channel.unit;
    converted.push_back(std::move(column));
    measurement.conversions.push_back(conversion);
  }
  measurement.columns = std::move(converted);
  if (part == MeasuredPart::kHistory) cut_window(map, measurement);
  return measurement;
}

}  // namespace strut
