#include "jobs/simulate/run_file.h"

#include <fmt/format.h>

#include "base/text/build_info.h"
#include "io/format/hdf5.h"
#include "io/table/csv.h"
#include "jobs/cli/interrupt.h"

namespace strut {
namespace {

void write_run_csv(const std::filesystem::path& path, const RunRecord& run) {
  std::vector<CsvColumn> columns;
  const std::vector<ChannelInfo>& channels = *run.channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    columns.push_back(
        {channels[c].name, channels[c].unit, run.results.get_history(static_cast<int>(c))});
  }
  write_csv(path, columns);
}

void write_one(Hdf5Writer& file, const std::string& name, double value, const std::string& unit,
               const std::string& description) {
  file.write(name, std::vector<double>{value}, {unit, description, {}});
}

void write_run_hdf5(const std::filesystem::path& path, const RunRecord& run) {
  Hdf5Writer file(path);
  const std::vector<ChannelInfo>& channels = *run.channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    file.write("/history/" + channels[c].name, run.results.get_history(static_cast<int>(c)),
               {channels[c].unit, channels[c].description, {}});
  }
  if (run.results.has_snapshot()) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      write_one(file, "/snapshot/" + channels[c].name,
                run.results.get_snapshot(static_cast<int>(c)), channels[c].unit,
                channels[c].description);
    }
    write_one(file, "/snapshot/event_time", run.results.get_event_time(), "s",
              "time at which the rear wheel centers are over the bump's center");
  }
  for (const RunParameter& p : run.parameters) {
    write_one(file, "/parameters/" + p.name, p.value, p.unit, p.description);
  }
  for (const auto& [name, text] : run.provenance) file.write_attribute("/", name, text);
  file.commit();
}

}  // namespace

RunFormat find_run_format(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".csv") return RunFormat::kCsv;
  if (extension == ".h5" || extension == ".hdf5") return RunFormat::kHdf5;
  throw InputError(
      fmt::format("--output = {}: the name must end in .csv, .h5 or .hdf5", path.string()));
}

std::vector<std::pair<std::string, std::string>> describe_program(const CaseSource& source) {
  const BuildInfo& build = get_build_info();
  return {{"strut_version", build.version},
          {"commit", build.commit},
          {"compiler", build.compiler},
          {"instruction_set", list_kernels().front().isa},
          {"vehicle", source.vehicle.string()},
          {"maneuver", source.maneuver.string()},
          {"settings", fmt::format("{}", fmt::join(source.settings, " "))}};
}

void write_run(const std::filesystem::path& path, RunFormat format, const RunRecord& run) {
  const InterruptGuard guard;
  format == RunFormat::kCsv ? write_run_csv(path, run) : write_run_hdf5(path, run);
}

}  // namespace strut
