// Mistakes of a recording that one look at it reveals, before any fit.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/names/name_table.h"

namespace strut {

enum class FindingKind {
  kSign,
  kFactor,
  kLag,
  kSwapped,
  kStranger,
  kDroppedSamples,
  kUnevenClock,
  kSaturation,
  kQuantization,
  kMains,
  kCopy,
};
inline constexpr std::array<Named<FindingKind>, 11> kFindingKinds = {{
    {FindingKind::kSign, "sign"},
    {FindingKind::kFactor, "factor"},
    {FindingKind::kLag, "lag"},
    {FindingKind::kSwapped, "swapped"},
    {FindingKind::kStranger, "no_agreement"},
    {FindingKind::kDroppedSamples, "dropped_samples"},
    {FindingKind::kUnevenClock, "uneven_clock"},
    {FindingKind::kSaturation, "saturation"},
    {FindingKind::kQuantization, "quantization"},
    {FindingKind::kMains, "mains"},
    {FindingKind::kCopy, "copy"},
}};
static_assert(names_all(kFindingKinds, FindingKind::kCopy));

struct RecordingFinding {
  FindingKind kind = FindingKind::kSign;
  std::string run;      // the file; "": all of them
  std::string channel;  // "": all of them, or the clock
  /// kSign: -1; kFactor: the factor; kLag: s; kStranger: the largest correlation;
  /// kDroppedSamples: their number; kUnevenClock: jitter
  /// [s]; kQuantization: the step; kMains: Hz; kCopy: the fraction of common readings.
  double size = 0.0;
  std::string what;    // "looks negated"
  std::string advice;  // "sign = -1"; "": none
  /// kCopy: numbers of the two runs, whose files may have one name.
  std::array<std::size_t, 2> copies{};

  /// Whether it is corrected in the campaign: in its columns, clock or start values. The lag of one
  /// channel may also be its filter, and the rest is of the sensors.
  bool is_mistake() const;
  /// "drive.csv: front_left_deflection looks negated: sign = -1"
  std::string describe() const;
};

}  // namespace strut
