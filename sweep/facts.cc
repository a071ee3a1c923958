#include "sweep/facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/format_number.h"
#include "io/file/file_bytes.h"
#include "io/file/sha256.h"
#include "io/format/toml_text.h"
#include "model_files/named_files.h"
#include "sweep/choices.h"

namespace strut {
namespace {

constexpr char kAbsent[] = "absent";

void add_sample(const SweepRequest& request, Facts& facts) {
  const SampleRequest& sample = request.sample;
  facts.emplace_back("sample.method", find_name(kSampleMethods, sample.method));
  facts.emplace_back("sample.strata", std::to_string(sample.strata));
  facts.emplace_back("sample.by", sample.by);
  facts.emplace_back("sample.count", sample.count < 0 ? "all" : std::to_string(sample.count));
  facts.emplace_back("sample.seed", std::to_string(sample.seed));
}

void add_grid(const SweepRequest& request, Facts& facts) {
  const auto& axes = request.grid.axes();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    facts.emplace_back(
        fmt::format("grid[{}]", a + 1),
        fmt::format("{} from {} step {} count {}", axes[a].name, format_number(axes[a].from),
                    format_number(axes[a].step), axes[a].count));
  }
}

void add_integrate(const SweepRequest& sweep, Facts& facts) {
  const SolverOptions& request = sweep.integrate;
  if (sweep.accuracy > 0.0) {
    facts.emplace_back("integrate.accuracy", format_number(sweep.accuracy));
  }
  if (request.solver == Solver::kCvode) {
    facts.emplace_back("integrate.method", find_name(kIntegrators, Integrator::kCvode));
    facts.emplace_back("integrate.relative_tolerance",
                       format_number(request.reference.relative_tolerance));
    facts.emplace_back("integrate.absolute_tolerance",
                       format_number(request.reference.absolute_tolerance));
  } else {
    const StepOptions& step = request.options.step;
    facts.emplace_back("integrate.method", get_name(step.stepper));
    facts.emplace_back("integrate.step", format_number(step.step));
    facts.emplace_back("integrate.coarse_step", format_number(step.coarse_step));
    facts.emplace_back("integrate.locate_events", step.locate_events ? "true" : "false");
    facts.emplace_back("integrate.spin", find_name(kSpins, request.options.spin));
    if (sweep.results_version > 2) {
      facts.emplace_back("integrate.symmetry", request.options.symmetry ? "true" : "false");
    }
  }
  facts.emplace_back("integrate.closure", find_name(kClosures, request.options.closure));
}

std::string list_channels(const std::vector<int>& channels) {
  std::vector<std::string> names;
  names.reserve(channels.size());
  for (const int channel : channels) {
    names.push_back(list_car_channels()[static_cast<std::size_t>(channel)].name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void add_record(const SweepRequest& request, Facts& facts) {
  if (request.snapshot.on) {
    facts.emplace_back("record.snapshot.when", kInstants.front());
    facts.emplace_back("record.snapshot.offset", format_number(request.snapshot.offset));
    facts.emplace_back("record.snapshot.channels", list_channels(request.snapshot.channels));
  }
  if (ends_at_snapshot(request)) facts.emplace_back("record.until", "snapshot");
  if (request.history.rate > 0.0) {
    facts.emplace_back("record.history.rate", format_number(request.history.rate));
    facts.emplace_back("record.history.channels", list_channels(request.history.channels));
  }
}

void add_file(const std::string& prefix, const std::filesystem::path& path, Facts& facts) {
  const std::vector<NamedFile> files = list_named_files(path);
  for (const auto& [key, value] : flatten_toml(path)) {
    const auto named = std::find_if(files.begin(), files.end(),
                                    [&name = key](const NamedFile& f) { return f.key == name; });
    facts.emplace_back(
        prefix + key,
        named == files.end() ? value : "SHA-256 " + to_hex(calc_sha256(read_bytes(named->path))));
  }
}

}  // namespace

Facts list_facts(const SweepRequest& request) {
  Facts facts = {{kResultsVersionName, std::to_string(request.results_version)}};
  add_grid(request, facts);
  add_sample(request, facts);
  add_integrate(request, facts);
  add_record(request, facts);
  facts.emplace_back("shards.cases", std::to_string(request.shard_cases));
  facts.emplace_back("order", request.shuffle ? "shuffled" : "by number, slow axes first");
  add_file("vehicle.", request.vehicle, facts);
  add_file("maneuver.", request.maneuver, facts);
  return facts;
}

std::string calc_hash(const Facts& facts) {
  Sha256 hash;
  for (const auto& [name, value] : facts) hash.update(name + " = " + value + "\n");
  return to_hex(hash.finish());
}

std::vector<std::string> compare_facts(const Facts& was, const Facts& is) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : was) {
    const std::string now = find_text(is, name).value_or(kAbsent);
    if (now != value) lines.push_back(fmt::format("{}: was {}, is {}", name, value, now));
  }
  for (const auto& [name, value] : is) {
    if (!find_text(was, name))
      lines.push_back(fmt::format("{}: was {}, is {}", name, kAbsent, value));
  }
  return lines;
}

}  // namespace strut
