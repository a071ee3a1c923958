// The output file of `strut simulate`: all channels over time, the snapshot, and their provenance.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "jobs/case/load_case.h"
#include "model/info/model_info.h"

namespace strut {

enum class RunFormat { kCsv, kHdf5 };

/// Finds the format by the ending of the name: .csv, .h5 or .hdf5. Throws InputError.
RunFormat find_run_format(const std::filesystem::path& path);

/// A parameter of a run, SI units.
struct RunParameter {
  std::string name, unit, description;
  double value;
};

/// A finished run of a car or a rig.
struct RunRecord {
  const std::vector<ChannelInfo>* channels = nullptr;
  std::vector<int> kept = {};  // those in the output, ascending
  LaneResults results;         // one lane, with history of all channels
  std::vector<RunParameter> parameters;
  /// Provenance as (name, text), in the order of the file.
  std::vector<std::pair<std::string, std::string>> provenance;
};

/// The numbers of the channels named and of the time, ascending; of all where none is named. Throws
/// InputError.
std::vector<int> list_kept(const ModelInfo& model, const std::vector<std::string>& names);

/// Version, commit, compiler and instruction set of this program, and the files of the run.
std::vector<std::pair<std::string, std::string>> describe_program(const CaseSource& source);

/// CSV: one column a channel. HDF5: datasets /history/CHANNEL, /snapshot/CHANNEL (one value each,
/// none if the snapshot's line was not reached), /snapshot/event_time, /parameters/NAME, and the
/// provenance as attributes of the file. The file appears whole or not at all. Throws
/// EnvironmentError.
void write_run(const std::filesystem::path& path, RunFormat format, const RunRecord& run);

}  // namespace strut
