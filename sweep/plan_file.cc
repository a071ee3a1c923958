#include "sweep/plan_file.h"

#include <fmt/format.h>

#include "io/format/hdf5.h"
#include "io/format/named_texts.h"

namespace strut {
namespace {

constexpr std::int64_t kSchemaVersion = 1;
constexpr char kFactsGroup[] = "/facts", kStrataName[] = "/layers";

std::string describe_draw(const Plan& plan) {
  const SampleRequest& sample = plan.request().sample;
  if (sample.method != SampleMethod::kGrid) return "samples 0 .. cases - 1";
  return sample.count < 0 ? "all points of the grid" : "the case ids in /drawn";
}

/// Rows of /layers.
std::vector<double> flatten(const std::vector<Stratum>& strata) {
  std::vector<double> rows;
  rows.reserve(4 * strata.size());
  for (const Stratum& stratum : strata) {
    rows.insert(rows.end(), {stratum.lower, stratum.upper, static_cast<double>(stratum.population),
                             static_cast<double>(stratum.drawn)});
  }
  return rows;
}

}  // namespace

void write_plan(const std::filesystem::path& path, const Plan& plan) {
  Hdf5Writer file(Folder(path.parent_path()), path.filename().string(),
                  {.seal = SealLabel{kPlanSeal, {{"plan", plan.hash()}}}});
  file.write_attribute("/", "schema_version", kSchemaVersion);
  file.write_attribute("/", "draw", describe_draw(plan));
  write_sweep_extent(file, plan.make_extent());
  write_named_texts(
      file, kFactsGroup, plan.facts(),
      {"what the results depend on", "its value; plan_hash is SHA-256 of all of them"});
  file.write(kStrataName, flatten(plan.strata()), 4,
             {"1",
              "strata by " + plan.request().sample.by + ": bounds, cases there are, cases drawn",
              {"lower", "upper", "population", "drawn"}});
  file.commit();
}

PlanRecord read_plan(const std::filesystem::path& path) {
  const Hdf5Reader file(path, kPlanSeal);
  const std::int64_t version = file.read_integer_attribute("/", "schema_version");
  if (version != kSchemaVersion) {
    throw InputError(
        fmt::format("{}: schema_version = {}: must be {}", path.string(), version, kSchemaVersion));
  }
  PlanRecord record{read_sweep_extent(path, file), read_named_texts(path, file, kFactsGroup),
                    file.read(kStrataName).values};
  if (record.extent.plan_hash != calc_hash(record.facts)) {
    throw InputError(fmt::format("{}: damaged: plan_hash is not the hash of /facts; {}",
                                 path.string(), kPlanSeal.remedy));
  }
  return record;
}

void require_same_plan(const std::filesystem::path& path, const PlanRecord& record,
                       const Plan& plan) {
  if (record.extent != plan.make_extent() || record.strata != flatten(plan.strata())) {
    throw InputError(fmt::format(
        "{}: damaged, or its cases, /drawn or /layers differ from what this version plans; {}",
        path.string(), kPlanSeal.remedy));
  }
}

}  // namespace strut
