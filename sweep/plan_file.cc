#include "sweep/plan_file.h"

#include "io/hdf5.h"
#include "io/named_texts.h"

namespace strut {
namespace {

constexpr std::int64_t kSchemaVersion = 1;
constexpr char kFactsGroup[] = "/facts";

std::string describe_draw(const Plan& plan) {
  const SampleRequest& sample = plan.request().sample;
  if (sample.method != SampleMethod::kGrid) return "samples 0 .. cases - 1";
  return sample.count < 0 ? "all points of the grid" : "the case ids in /drawn";
}

std::string describe_shards(const Plan& plan) {
  const std::string cases = std::to_string(plan.request().shard_cases);
  return std::to_string(plan.shard_count()) + "; shard s holds positions [s * " + cases +
         ", (s + 1) * " + cases + ") of the run order";
}

void write_layers(Hdf5Writer& file, const Plan& plan) {
  std::vector<double> rows;
  rows.reserve(4 * plan.layers().size());
  for (const Layer& layer : plan.layers()) {
    rows.insert(rows.end(), {layer.lower, layer.upper, static_cast<double>(layer.population),
                             static_cast<double>(layer.drawn)});
  }
  file.write("/layers", rows, 4,
             {"1",
              "strata by " + plan.request().sample.by + ": bounds, cases there are, cases drawn",
              {"lower", "upper", "population", "drawn"}});
}

}  // namespace

void write_plan(const std::filesystem::path& path, const Plan& plan) {
  Hdf5Writer file(Folder(path.parent_path()), path.filename().string());
  file.write_attribute("/", "schema_version", kSchemaVersion);
  file.write_attribute("/", "plan_hash", plan.hash());
  file.write_attribute("/", "points", plan.point_count());
  file.write_attribute("/", "cases", plan.case_count());
  file.write_attribute("/", "draw", describe_draw(plan));
  file.write_attribute("/", "shards", describe_shards(plan));
  write_named_texts(
      file, kFactsGroup, plan.facts(),
      {"what the results depend on", "its value; plan_hash is SHA-256 of all of them"});
  write_layers(file, plan);
  const std::vector<std::int64_t> drawn = plan.list_drawn();
  if (!drawn.empty()) {
    file.write("/drawn", std::span<const std::int64_t>(drawn),
               {"1", "case ids that run, ascending", {}});
  }
  file.commit();
}

PlanRecord read_plan(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::int64_t version = file.read_integer_attribute("/", "schema_version");
  if (version != kSchemaVersion) {
    throw InputError(path.string() + ": schema_version = " + std::to_string(version) +
                     ": must be " + std::to_string(kSchemaVersion));
  }
  PlanRecord record;
  record.hash = file.read_attribute("/", "plan_hash");
  record.facts = read_named_texts(path, file, kFactsGroup);
  if (record.hash != calc_hash(record.facts)) {
    throw InputError(path.string() + ": plan_hash: not that of /facts; the file is damaged");
  }
  if (file.has("/drawn")) record.drawn = file.read_integers("/drawn");
  return record;
}

}  // namespace strut
