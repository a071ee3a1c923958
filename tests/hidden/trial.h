// One trial: its hidden faults, drawn from its seed alone.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/hidden/detect.h"
#include "tests/hidden/kit.h"

namespace strut::hidden {

enum class Category { kNone, kOne, kTwo, kUnknown };
const char* get_name(Category category);

/// In each block of 39 consecutive seeds from a multiple of 39 on, 15 hide nothing, 14 one effect
/// of the catalogue, 5 two and 5 an unknown one, in random order: 300, 280, 100, 100 of 780.
Category draw_category(std::uint64_t seed);

struct HiddenFault {
  FaultSetting setting;
  SignalToNoise noise;  // of this fault alone
  double target = 0.0;  // of noise.ratio
  /// The ratio without the part within the error of the surveys.
  double beyond_survey = 0.0;
};

struct Trial {
  std::uint64_t seed = 0;
  Category category = Category::kNone;
  Truth truth;
  std::vector<HiddenFault> faults;
  std::vector<Clock> clocks;  // of each run
  std::vector<double> bias;   // of each sensor
  /// Grade of the fault that is harder to detect; '-' where nothing is hidden.
  char get_grade() const;
  /// The grade by HiddenFault::beyond_survey.
  char get_grade_beyond_survey() const;
  std::vector<double> bounds;  // of each of the kit's parameters, 1 sigma in its unit; may be empty
};

/// Draws trials of a kit; keeps their common data. Safe to use from several threads.
class Sampler {
 public:
  explicit Sampler(const Kit& kit);
  Trial draw(std::uint64_t seed) const;
  const Kit& kit() const { return kit_; }

 private:
  Truth draw_truth(std::uint64_t seed) const;
  std::vector<FaultSetting> draw_faults(std::uint64_t seed, Category category) const;
  HiddenFault size_fault(FaultSetting setting, double target, const Truth& without,
                         const std::vector<std::vector<Signal>>& base) const;
  SignalToNoise measure(const FaultSetting& setting, const Truth& without,
                        const std::vector<std::vector<Signal>>& base) const;
  const Detector& get_detector(double roughness) const;

  Kit kit_;
  std::vector<double> classes_;  // m^3
  std::vector<std::unique_ptr<Detector>> detectors_;
};

/// Min and max magnitude of a fault's search.
std::pair<double, double> find_bracket(const Kit& kit, Fault fault);

/// The place of a fault as in a vehicle file: an axle, "body", "road", a channel; "" where a stand
/// has only one.
std::string get_place(const Kit& kit, const FaultSetting& setting);

/// The place of a fault as in a verdict's where.place: as above, and on a stand "strut", "tire",
/// "body" or "road".
std::string get_where(const Kit& kit, const FaultSetting& setting);

}  // namespace strut::hidden
