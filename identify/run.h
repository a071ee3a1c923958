// Measured runs of a car, for the fit of its simulation.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "estimate/measured_run.h"
#include "estimate/sensor_noise.h"
#include "io/store/column_map.h"

namespace strut {

/// Name, unit and meaning of channels (CarChannel).
std::vector<ColumnInfo> list_columns(const std::vector<int>& channels);

/// Reads the times and `channels` (CarChannel) of a file as a run of the car in `setup`, weighted
/// by `noise`; `map`: the file's columns. Throws InputError that names the file.
MeasuredRun read_measured_run(const std::filesystem::path& file, const Case& setup,
                              const std::vector<int>& channels, const SensorNoise& noise,
                              const ColumnMap& map = {});

/// Keeps the samples from `from` to `to` [s]. Throws InputError where there are none.
void keep_window(MeasuredRun& run, double from, double to);

/// Indices into run.channels of those whose readings, two or more, are all the same: a working
/// sensor has noise.
std::vector<std::size_t> find_constant_channels(const MeasuredRun& run);

}  // namespace strut
