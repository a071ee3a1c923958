// A trial written down: what the user of the tested program has, and, elsewhere, the truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/hidden/trial.h"

namespace strut::hidden {

/// Writes DIR/trials/SEED (campaign.toml, the model's file, maneuvers, one CSV a run) and
/// DIR/truths/SEED.json. Nothing in the first tells of the second.
/// Throws std::runtime_error for a file that cannot be written.
void write_trial(const Kit& kit, const Trial& trial, const std::filesystem::path& folder);

/// DIR/truths/SEED.json; it is written last and at once, so where it is the trial is whole.
std::filesystem::path find_truth(const std::filesystem::path& folder, std::uint64_t seed);

/// The truth as JSON: category, grade, faults with place, magnitude and ratios, true parameters and
/// their Cramer-Rao bounds (Detector::bounds). The grade, and the grade of what is beyond the
/// surveys, which scores go by.
std::string make_truth(const Kit& kit, const Trial& trial);

/// DIR/truths/SHA256SUMS over the truths there, sorted, as sha256sum writes it. Lines that are
/// there stay; throws std::runtime_error for a truth that is not what its line seals.
void seal_truths(const std::filesystem::path& folder);

/// The seed in six digits: the name of its trial.
std::string make_trial_name(std::uint64_t seed);

}  // namespace strut::hidden
