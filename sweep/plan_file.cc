#include "sweep/plan_file.h"

#include "io/format/hdf5.h"
#include "io/format/named_texts.h"

namespace strut {
namespace {

constexpr std::int64_t kSchemaVersion = 1;
constexpr char kFactsGroup[] = "/facts", kLayersName[] = "/layers";

std::string describe_draw(const Plan& plan) {
  const SampleRequest& sample = plan.request().sample;
  if (sample.method != SampleMethod::kGrid) return "samples 0 .. cases - 1";
  return sample.count < 0 ? "all points of the grid" : "the case ids in /drawn";
}

std::vector<double> flatten(const std::vector<Layer>& layers) {
  std::vector<double> rows;
  rows.reserve(4 * layers.size());
  for (const Layer& layer : layers) {
    rows.insert(rows.end(), {layer.lower, layer.upper, static_cast<double>(layer.population),
                             static_cast<double>(layer.drawn)});
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
  file.write(kLayersName, flatten(plan.layers()), 4,
             {"1",
              "strata by " + plan.request().sample.by + ": bounds, cases there are, cases drawn",
              {"lower", "upper", "population", "drawn"}});
  file.commit();
}

PlanRecord read_plan(const std::filesystem::path& path) {
  const Hdf5Reader file(path, kPlanSeal);
  const std::int64_t version = file.read_integer_attribute("/", "schema_version");
  if (version != kSchemaVersion) {
    throw InputError(path.string() + ": schema_version = " + std::to_string(version) +
                     ": must be " + std::to_string(kSchemaVersion));
  }
  PlanRecord record{read_sweep_extent(path, file), read_named_texts(path, file, kFactsGroup),
                    file.read(kLayersName).values};
  if (record.extent.plan_hash != calc_hash(record.facts)) {
    throw InputError(path.string() + ": plan_hash: not that of /facts; damaged; " +
                     kPlanSeal.remedy);
  }
  return record;
}

void require_same_plan(const std::filesystem::path& path, const PlanRecord& record,
                       const Plan& plan) {
  if (record.extent != plan.make_extent() || record.layers != flatten(plan.layers())) {
    throw InputError(
        path.string() +
        ": damaged, or its cases, /drawn or /layers are not what this version plans; " +
        kPlanSeal.remedy);
  }
}

}  // namespace strut
