// Wear: the loss of a spring's or damper's rate in per cent of new.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "identify/identified.h"
#include "model/car/case.h"

namespace strut {

/// The locations by which wear is reported.
enum class WearLocations { kByAxle, kByCorner };

/// Lists the parameters that wear lowers (Parameter::wears_at), location by location.
std::vector<std::string> list_wear_parameters(WearLocations locations);

/// The scale on which the wear of one parameter is measured.
struct WearScale {
  std::string name;
  double fresh = 0.0;                                       // rate of the new part, above 0
  double limit = std::numeric_limits<double>::quiet_NaN();  // stated limit [%]; NaN: none
};

/// Makes the scales of those of `names` that wear lowers and whose rate in the new car `fresh` is
/// above 0.
std::vector<WearScale> make_wear_scales(const Case& fresh, const std::vector<std::string>& names);

/// Sets the limit of one scale; of all where `name` is "". Throws InputError for an unknown name,
/// with the nearest one, and for a limit outside of (0, 100) %.
void set_wear_limit(std::vector<WearScale>& scales, const std::string& name, double limit);

/// Least probability of wear beyond a limit, and of none, that is reported.
inline constexpr double kLeastBeyond = 1e-3;

/// Measures the wear of the row's parameters on the scales of their names:
///
///   wear = 100 (1 - value / fresh), half width 100 h / fresh,
///   P(wear > limit) = Phi((fresh (1 - limit / 100) - value) / (h / 1.96))
///
/// with h the widened half width of a fit, the half width of a network. The posterior is thus taken
/// as Gaussian: that of a fit in its linear model with a flat prior (Laplace's approximation; D. J.
/// C. MacKay, Information Theory, Inference, and Learning Algorithms, 2003, ch. 27), that of a
/// network as the normal distribution with the same 95 % interval. Its tails are not known beyond
/// kLeastBeyond, which bounds the probability and its complement. A parameter that is not in range
/// has neither interval nor probability.
void add_wear(IdentifiedRow& row, const std::vector<WearScale>& scales);

/// Sets the change of wear since `before`, a measurement of the same car by the same method, both
/// with their wear: its half width is sqrt(h1^2 + h2^2), for errors that are independent. Errors of
/// the model that are the same both times cancel.
void add_wear_change(IdentifiedRow& now, const IdentifiedRow& before);

}  // namespace strut
