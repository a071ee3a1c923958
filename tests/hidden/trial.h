// One trial: its hidden faults, drawn from its seed alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tests/hidden/imitation.h"

namespace strut::hidden {

enum class Category { kNone, kOne, kTwo, kUnknown };
const char* get_name(Category category);

/// In each block of 39 consecutive seeds from a multiple of 39 on, 15 hide nothing, 14 one effect
/// of the catalogue, 5 two and 5 an unknown one, in random order: 300, 280, 100, 100 of 780.
Category draw_category(std::uint64_t seed);

struct HiddenFault {
  FaultSetting setting;
  double ratio = 0.0;   // of signal to noise, of this fault alone: grades it
  double target = 0.0;  // of the ratio
  /// Other known causes that these runs cannot tell from this one.
  std::vector<CauseName> twins{};
};

struct Trial {
  std::uint64_t seed = 0;
  Category category = Category::kNone;
  Truth truth;
  std::vector<HiddenFault> faults;
  std::vector<HiddenFault> misfits;  // small, beside the faults
  std::vector<Clock> clocks;         // of each run
  std::vector<double> bias;          // of each sensor
  /// Ratio of all hidden faults beyond the best imitation by one known cause, and by two that are
  /// not the hidden pair.
  double beyond_one = 0.0, beyond_two = 0.0;
  std::vector<double> bounds;  // of each of the kit's parameters, 1 sigma in its unit; may be empty

  /// Grade of the fault that is harder to detect; '-' where nothing is hidden.
  char get_grade() const;
};

/// Parameters, speeds and road of a trial, without faults.
Truth draw_truth(const Kit& kit, std::uint64_t seed);

/// Faults of a trial at the start values of their magnitudes.
std::vector<FaultSetting> draw_faults(const Kit& kit, std::uint64_t seed);

/// The whole trial, its faults sized at its own truth.
Trial draw_trial(const Kit& kit, std::uint64_t seed);

/// The trial of a seed with given faults instead of those that it would draw, graded anew.
Trial grade_trial(const Kit& kit, std::uint64_t seed, const std::vector<FaultSetting>& faults);

}  // namespace strut::hidden
