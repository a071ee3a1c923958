// What `strut simulate` writes: all channels over time, the snapshot, and where they come from.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "jobs/load_case.h"

namespace strut {

enum class RunFormat { kCsv, kHdf5 };

/// By the name's end: .csv, .h5 or .hdf5. Throws InputError.
RunFormat find_run_format(const std::filesystem::path& path);

/// A finished run of one case.
struct RunRecord {
  Case input;
  LaneResults results;  // one lane, with history
  /// How it was made, as (name, text) in the order of the file.
  std::vector<std::pair<std::string, std::string>> provenance;
};

/// True where the snapshot's line was reached.
bool has_snapshot(const LaneResults& results);

/// One channel of the history.
std::vector<double> get_history(const LaneResults& results, int channel);

/// CSV: one column a channel. HDF5: datasets /history/CHANNEL, /snapshot/CHANNEL (one value each,
/// none where the snapshot's line was not reached), /snapshot/event_time, /parameters/NAME, and the
/// provenance as attributes of the file. The file appears whole or not at all. Throws
/// EnvironmentError.
void write_run(const std::filesystem::path& path, RunFormat format, const RunRecord& run);

}  // namespace strut
