#include "identify/run.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "identify/history.h"

namespace strut {

std::vector<ColumnInfo> list_columns(const std::vector<int>& channels) {
  std::vector<ColumnInfo> columns;
  columns.reserve(channels.size());
  for (const int channel : channels) {
    const ChannelInfo& info = list_car_channels()[static_cast<std::size_t>(channel)];
    columns.push_back({info.name, info.unit, info.description});
  }
  return columns;
}

MeasuredRun read_measured_run(const std::filesystem::path& file, const Case& setup,
                              const std::vector<int>& channels, const SensorNoise& noise,
                              const ColumnMap& map) {
  const std::vector<ColumnInfo> columns = list_columns(channels);
  const Measurement history = read_history(file, columns, map);
  MeasuredRun run{file.string(), setup, history.values(kTimeColumn), {}};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    run.channels.push_back({channels[c], noise[static_cast<std::size_t>(channels[c])],
                            history.values(columns[c].name),
                            make_column_reading(history.conversion(columns[c].name))});
  }
  check_measured_run(run);
  return run;
}

void keep_window(MeasuredRun& run, double from, double to) {
  const double first = run.times.front(), last = run.times.back();
  cut_window(run, from, to);
  if (!run.times.empty()) return;
  throw InputError(fmt::format("no sample of {} lies in it; its times are {} to {} s", run.name,
                               format_number(first), format_number(last)));
}

std::vector<std::size_t> find_constant_channels(const MeasuredRun& run) {
  std::vector<std::size_t> constant;
  for (std::size_t c = 0; c < run.channels.size(); ++c) {
    const std::vector<double>& values = run.channels[c].values;
    const bool is_constant = std::all_of(
        values.begin(), values.end(), [&values](double value) { return value == values.front(); });
    if (is_constant && values.size() >= 2) constant.push_back(c);
  }
  return constant;
}

}  // namespace strut
