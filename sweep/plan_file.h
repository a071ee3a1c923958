// plan.h5, the identity of a sweep folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sweep/plan.h"

namespace strut {

/// The content of plan.h5.
struct PlanRecord {
  SweepExtent extent;
  Facts facts;
  std::vector<double> layers;  // rows of /layers
};

/// Attributes of the file: schema_version, plan_hash, cases, points, shard_cases, draw and shards
/// (the rules, in words). Datasets: /facts/name and /facts/value, of which plan_hash is the hash;
/// /layers, a row each (lower, upper, population, drawn); /drawn, the case ids where not all run.
/// Sealed. Appears whole or not at all. Throws EnvironmentError.
void write_plan(const std::filesystem::path& path, const Plan& plan);

/// Throws InputError where the file is missing, damaged or of another schema version.
PlanRecord read_plan(const std::filesystem::path& path);

/// Throws InputError where `record` of the file `path` has the hash of `plan` but other cases.
void require_same_plan(const std::filesystem::path& path, const PlanRecord& record,
                       const Plan& plan);

}  // namespace strut
