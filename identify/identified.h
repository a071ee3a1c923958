// Identified parameters with their intervals, the same for all methods.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace strut {

/// Loss of a part's rate, in per cent of new. Unknown numbers are NaN.
struct Wear {
  double fresh = 0.0;    // rate of the new part, in the parameter's unit
  double percent = 0.0;  // 100 (1 - value / fresh)
  double half_width = std::numeric_limits<double>::quiet_NaN();  // of its 95 % interval, in points
  double limit = std::numeric_limits<double>::quiet_NaN();       // in per cent; NaN: not stated
  double beyond = std::numeric_limits<double>::quiet_NaN();      // probability of a loss above it
};

/// Growth of the wear since an earlier measurement, in points of per cent of new.
struct WearChange {
  double percent = 0.0;
  double half_width = std::numeric_limits<double>::quiet_NaN();  // of its 95 % interval
};

/// One parameter; unknown numbers are NaN.
struct IdentifiedParameter {
  std::string name, unit;
  double value = std::numeric_limits<double>::quiet_NaN();
  double half_width = std::numeric_limits<double>::quiet_NaN();  // half width of the 95 % interval
  bool in_range = true;  // false: outside of the model's range, or not determined by a fit

  /// The half width for noise as large as the residuals of a fit; a network has no residuals, hence
  /// NaN.
  double widened_half_width = std::numeric_limits<double>::quiet_NaN();
  std::optional<Wear> wear{};          // where the part wears and its new rate is known
  std::optional<WearChange> change{};  // where an earlier measurement is known, too

  double low() const { return value - half_width; }
  double high() const { return value + half_width; }
};

/// A measured channel outside of the training range of a model.
struct OutsideChannel {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;
  double excess = 0.0;  // below low (negative) or above high, as a fraction of high - low
};

/// The parameters from one snapshot, one window or one set of runs.
struct IdentifiedRow {
  std::string source;  // file and line of the measurement: "drive.csv:12"
  std::vector<IdentifiedParameter> parameters;
  std::vector<OutsideChannel> outside;

  /// True where all channels and parameters are in range.
  bool in_range() const;
};

bool are_in_range(const std::vector<IdentifiedRow>& rows);

/// Writes the columns row (from 0), NAME, NAME_low, NAME_high for each parameter, and in_range (1
/// or 0); where the wear is known also NAME_wear, NAME_wear_low, NAME_wear_high [%] and
/// NAME_beyond_limit, where the change is known NAME_change, NAME_change_low, NAME_change_high [%].
/// Unknown numbers are nan. Throws EnvironmentError.
void write_identified_csv(const std::filesystem::path& path,
                          const std::vector<IdentifiedRow>& rows);

}  // namespace strut
