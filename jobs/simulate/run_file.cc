#include "jobs/simulate/run_file.h"

#include <fmt/format.h>

#include <numeric>
#include <set>

#include "base/text/build_info.h"
#include "io/format/hdf5.h"
#include "io/table/csv.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/settings.h"
#include "model_files/find_channel.h"

namespace strut {
namespace {

const std::string kHistory = "/history/", kTime = "time";

void write_run_csv(const std::filesystem::path& path, const RunRecord& run) {
  std::vector<CsvColumn> columns;
  const std::vector<ChannelInfo>& channels = *run.channels;
  for (const int c : run.kept) {
    const ChannelInfo& channel = channels[static_cast<std::size_t>(c)];
    columns.push_back({channel.name, channel.unit, run.results.get_history(c)});
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
  std::vector<std::string> curves;
  for (const int c : run.kept) {
    const ChannelInfo& channel = channels[static_cast<std::size_t>(c)];
    file.write(kHistory + channel.name, run.results.get_history(c),
               {channel.unit, channel.description, {}});
    if (channel.name != kTime) curves.push_back(kHistory + channel.name);
  }
  file.attach_scale(kHistory + kTime, 0, curves);
  if (run.results.has_snapshot()) {
    for (const int c : run.kept) {
      const ChannelInfo& channel = channels[static_cast<std::size_t>(c)];
      write_one(file, "/snapshot/" + channel.name, run.results.get_snapshot(c), channel.unit,
                channel.description);
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

std::vector<int> list_kept(const ModelInfo& model, const std::vector<std::string>& names) {
  std::set<int> kept;
  name_option("channels", [&] {
    for (const std::string& name : names) kept.insert(require_channel(model, name));
  });
  kept.insert(require_channel(model, kTime));
  if (!names.empty()) return {kept.begin(), kept.end()};
  std::vector<int> all(model.channels.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

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
