// Residuals by time, frequency and state of the model.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace strut {

/// A part of a run, on the run's clock, which for a rig begins at 0: [from, to), the last one
/// [from, to].
struct TimeWindow {
  std::string name;
  double from = 0.0, to = 0.0;  // s
};

struct WindowResidual {
  TimeWindow window;
  std::size_t count = 0;
  double rms = 0.0, nrmse = 0.0;  // the latter over the channel's spread in the whole run
};

/// Frequencies [from, to) in Hz; the last band has no upper end.
struct FrequencyBand {
  double from = 0.0, to = 0.0;
};
inline constexpr std::array<FrequencyBand, 5> kBands = {
    {{0.0, 0.5}, {0.5, 3.0}, {3.0, 8.0}, {8.0, 20.0}, {20.0, 1e9}}};
/// "0.5-3 Hz", "> 20 Hz", "all frequencies"
std::string describe(const FrequencyBand& band);

struct BandResidual {
  FrequencyBand band;
  double residual_rms = 0.0, measured_rms = 0.0, noise_rms = 0.0;
};

/// Residuals binned by a state of the model.
struct StateBin {
  double center = 0.0;  // in the state's unit
  std::size_t count = 0;
  double mean = 0.0, rms = 0.0;
};
struct StateResidual {
  std::string state, unit;
  std::vector<StateBin> bins;
  /// Mean residuals where the state is negative and positive, and the standard error of their
  /// difference, with readings a correlation time apart taken as independent.
  double mean_negative = 0.0, mean_positive = 0.0, difference_sigma = 0.0;
  /// Fraction of the residual's mean square that a curve over the state explains.
  double explained = 0.0;
};

std::vector<WindowResidual> calc_window_residuals(std::span<const double> times,
                                                  std::span<const double> residual,
                                                  double measured_spread,
                                                  const std::vector<TimeWindow>& windows);

/// Rms by frequency band from the periodogram of the whole run, with missing readings interpolated
/// and means subtracted. Squares over the bands add up to those of residual and measurement.
std::vector<BandResidual> calc_band_residuals(std::span<const double> times,
                                              std::span<const double> residual,
                                              std::span<const double> measured, double sigma);

/// Bins residuals into kStateBins bins of equal width between the 0.5 and 99.5 % quantiles of the
/// state; values beyond count in the outermost bins.
inline constexpr std::size_t kStateBins = 16;
StateResidual calc_state_residual(const std::string& name, const std::string& unit,
                                  std::span<const double> state, std::span<const double> residual);

/// Correlation of neighboring residuals.
double calc_neighbor_correlation(std::span<const double> residual);

}  // namespace strut
