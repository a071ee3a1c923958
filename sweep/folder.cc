#include "sweep/folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "io/file/atomic_file.h"
#include "io/store/claims.h"
#include "sweep/choose_settings.h"
#include "sweep/freeze_inputs.h"
#include "sweep/plan_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Name of the claim that a running `strut plan` holds.
constexpr char kPlanUnit[] = "plan";

std::vector<fs::path> list_subfolders(const SweepFolder& folder) {
  return {folder.inputs(),    folder.shards(),     folder.retries(), folder.claims(),
          folder.temporary(), folder.quarantine(), folder.logs()};
}

std::string list_changes(const Facts& was, const Facts& is) {
  return fmt::format("\n  {}", fmt::join(compare_facts(was, is), "\n  "));
}

/// True only for what an interrupted `strut plan` leaves.
bool is_of_interrupted_plan(const SweepFolder& folder, const fs::directory_entry& entry) {
  const auto is_file_of = [&entry](const fs::path& path) {  // or its temporary (AtomicFile)
    return entry.path().filename().string().rfind(path.filename().string(), 0) == 0;
  };
  if (entry.is_regular_file()) return is_file_of(folder.request()) || is_file_of(folder.plan());
  const auto known = list_subfolders(folder);
  if (std::find(known.begin(), known.end(), entry.path()) == known.end()) return false;
  return entry.path() == folder.inputs() || entry.path() == folder.claims() ||
         fs::is_empty(entry.path());
}

void check_free(const SweepFolder& folder) {
  if (!fs::exists(folder.root)) return;
  if (!fs::is_directory(folder.root)) {
    throw InputError(folder.root.string() + ": is a file; must be a new or empty folder");
  }
  for (const auto& entry : fs::directory_iterator(folder.root)) {
    if (is_of_interrupted_plan(folder, entry)) continue;
    throw InputError(fmt::format(
        "{}: not a sweep folder (no plan.h5), but it holds '{}'; must be a new or empty folder",
        folder.root.string(), entry.path().filename().string()));
  }
}

/// The request by the rules of the version that made the plan, with the choices of the plan.
SweepRequest apply_rules_of(const PlanRecord& record, SweepRequest request) {
  for (int version = 1; version <= kResultsVersion; ++version) {
    if (find_text(record.facts, kResultsVersionName) == std::to_string(version)) {
      request.results_version = version;
    }
  }
  if (request.results_version <= 2) {
    request.integrate.options.symmetry = false;
    request.integrate.options.step.refines_events = false;
    request.accuracy = 0.0;
    request.chooses_shards = false;
  }
  adopt_settings(record.facts, request);
  return request;
}

void check_same(const SweepFolder& folder, const Plan& plan) {
  const PlanRecord record = read_plan(folder.plan());
  // Read again where choices of today may stand in the place of what the file leaves open.
  const bool is_open = plan.request().accuracy > 0.0 || plan.request().chooses_shards;
  const Facts facts = list_facts(
      apply_rules_of(record, is_open ? read_request(plan.request().path) : plan.request()));
  if (record.extent.plan_hash == calc_hash(facts)) {
    const Plan found = open_sweep_folder(folder);  // its own files may have been changed
    if (!is_sealed(folder.plan())) write_plan(folder.plan(), found);
    return;
  }
  throw InputError(fmt::format(
      "{}: already planned for a different request than {}; allowed: the same request, or another "
      "folder. Differences:{}",
      folder.root.string(), plan.request().path.string(), list_changes(record.facts, facts)));
}

}  // namespace

void make_subfolders(const SweepFolder& folder) {
  const Folder root(folder.root);
  for (const fs::path& path : list_subfolders(folder)) root.make_folder(path.filename().string());
}

SweepFolder make_sweep_folder(const fs::path& root, const Plan& plan) {
  SweepFolder folder{root.lexically_normal()};
  if (fs::exists(folder.plan())) {
    check_same(folder, plan);
    return folder;
  }
  try {
    check_free(folder);
  } catch (const fs::filesystem_error& e) {
    throw EnvironmentError(root.string() + ": cannot be read: " + e.code().message());
  }
  make_folder(folder.root);
  make_subfolders(folder);
  // If two processes plan into one folder, one continues. If it dies, its claim becomes stale.
  Claims claims(folder.open(folder.claims()), ClaimOptions());
  if (claims.claim(kPlanUnit) != Claims::Answer::kMine) {
    throw EnvironmentError(folder.root.string() +
                           ": another `strut plan` is creating it right now; nothing was changed");
  }
  if (fs::exists(folder.plan())) {
    check_same(folder, plan);
    return folder;
  }
  freeze_inputs(plan.request(), folder);
  SweepRequest frozen = read_request(folder.request());
  adopt_settings(plan.facts(), frozen);
  if (calc_hash(list_facts(frozen)) != plan.hash()) {
    throw EnvironmentError(folder.request().string() +
                           ": its files changed while they were copied; run `strut plan` again");
  }
  write_plan(folder.plan(), plan);
  remove_abandoned_files(Folder(folder.root));
  remove_abandoned_files(folder.open(folder.inputs()));
  return folder;
}

Plan open_sweep_folder(const SweepFolder& folder) {
  if (!fs::exists(folder.plan())) {
    throw InputError(
        folder.root.string() +
        ": not a sweep folder: no plan.h5; `strut plan SWEEP.toml -o DIR` creates one");
  }
  const PlanRecord record = read_plan(folder.plan());
  Plan plan(apply_rules_of(record, read_request(folder.request())));
  if (record.extent.plan_hash != plan.hash()) {
    throw InputError(
        fmt::format("{}: does not match its plan; allowed: the planned request, or another folder. "
                    "Differences:{}",
                    folder.request().string(), list_changes(record.facts, plan.facts())));
  }
  require_same_plan(folder.plan(), record, plan);
  return plan;
}

}  // namespace strut
