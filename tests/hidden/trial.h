// What one trial hides, drawn from its seed alone.
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

/// Of 39 seeds in a row, beginning at a multiple of 39, 15 hide nothing, 14 one effect of the
/// catalogue, 5 two and 5 something unknown, in random order: 300, 280, 100, 100 of 780.
Category draw_category(std::uint64_t seed);

struct HiddenFault {
  FaultSetting setting;
  SignalToNoise noise;  // of this fault alone
  double target = 0.0;  // of noise.ratio
  /// The ratio, or less: what strays from the surveys no further than they err is theirs.
  double beyond_survey = 0.0;
};

struct Trial {
  std::uint64_t seed = 0;
  Category category = Category::kNone;
  Truth truth;
  std::vector<HiddenFault> faults;
  std::vector<Clock> clocks;  // of each run
  std::vector<double> bias;   // of each sensor
  /// Grade of the fault that is harder to see; '-' where nothing is hidden.
  char get_grade() const;
  /// The same of what is beyond the surveys.
  char get_grade_beyond_survey() const;
  std::vector<double> bounds;  // of each of the kit's parameters, 1 sigma in its unit; may be empty
};

/// Draws trials of a kit; keeps what they share. Safe to use from several threads.
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

/// Magnitudes that a fault's search may not pass, the smaller first.
std::pair<double, double> find_bracket(const Kit& kit, Fault fault);

/// Where a fault is, in the words of a vehicle file: an axle, "body", "road", a channel; "" for
/// what a stand has only one of.
std::string get_place(const Kit& kit, const FaultSetting& setting);

/// Where a fault is, in the words of a verdict's where.place: as above, and of a stand "strut",
/// "tire", "body" or "road".
std::string get_where(const Kit& kit, const FaultSetting& setting);

}  // namespace strut::hidden
