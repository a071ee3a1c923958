// plan.h5, the identity of a sweep folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sweep/plan.h"

namespace strut {

/// What plan.h5 says, as far as a plan is told from another by it.
struct PlanRecord {
  std::string hash;
  Facts facts;
  std::vector<std::int64_t> drawn;  // empty: all
};

/// Attributes of the file: schema_version, plan_hash, cases, points, draw and shards (the rules, in
/// words). Datasets: /facts/name and /facts/value, of which plan_hash is the hash; /layers, a row
/// each (lower, upper, population, drawn); /drawn, the case ids where not all run. Appears whole or
/// not at all. Throws EnvironmentError.
void write_plan(const std::filesystem::path& path, const Plan& plan);

/// Throws InputError where the file is missing, damaged or of another schema version.
PlanRecord read_plan(const std::filesystem::path& path);

}  // namespace strut
