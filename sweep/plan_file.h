// Reads and writes plan.h5, the identity of a sweep folder.
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
  std::vector<double> strata;  // rows of /layers
};

/// Writes a sealed file, atomically. Attributes: schema_version, plan_hash, cases, points,
/// shard_cases, draw and shards (the rules, in words). Datasets: /facts/name and /facts/value,
/// which plan_hash is the hash of; /layers, one row per stratum (lower, upper, population, drawn);
/// /drawn, the case ids if not all run. Throws EnvironmentError.
void write_plan(const std::filesystem::path& path, const Plan& plan);

/// Throws InputError if the file is missing, damaged or of another schema version.
PlanRecord read_plan(const std::filesystem::path& path);

/// Throws InputError if `record`, read from `path`, differs from `plan` in cases or strata although
/// the hashes agree.
void require_same_plan(const std::filesystem::path& path, const PlanRecord& record,
                       const Plan& plan);

}  // namespace strut
