// Writes a trial: the files for the tested program and, elsewhere, the truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/hidden/trial.h"

namespace strut::hidden {

/// Writes DIR/trials/SEED (campaign.toml, the model's file, maneuvers, one CSV per run) and
/// DIR/truths/SEED.json. The first contains no information about the second. Throws
/// std::runtime_error for a file that cannot be written.
void write_trial(const Kit& kit, const Trial& trial, const std::filesystem::path& folder);

/// DIR/truths/SEED.json. It is written last and atomically, so a trial that has it is complete.
std::filesystem::path find_truth(const std::filesystem::path& folder, std::uint64_t seed);

/// The truth as JSON: category, grade, ratios beyond imitation, faults with place, magnitude, ratio
/// and twins, true parameters and their Cramer-Rao bounds (Detector::bounds).
std::string make_truth(const Kit& kit, const Trial& trial);

/// Writes DIR/truths/SHA256SUMS over the truths there, sorted, in the format of sha256sum. Existing
/// lines stay; throws std::runtime_error for a truth that disagrees with its line.
void seal_truths(const std::filesystem::path& folder);

/// The seed in six digits: the name of its trial.
std::string make_trial_name(std::uint64_t seed);

}  // namespace strut::hidden
