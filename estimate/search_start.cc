#include "estimate/search_start.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math/random.h"
#include "estimate/fit.h"

namespace strut {
namespace {

struct Candidate {
  std::vector<double> values;
  double chi2 = std::numeric_limits<double>::infinity();
};

std::vector<double> draw(const std::vector<Unknown>& unknowns, std::uint64_t number, double reach) {
  constexpr std::uint64_t kSeed = 1;
  std::vector<double> values;
  values.reserve(unknowns.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    double value = u.start;
    const bool is_gain = u.kind == UnknownKind::kInputGain;
    if (number > 0 && (is_gain || u.kind == UnknownKind::kParameter)) {
      const double exponent = 2.0 * calc_uniform(kSeed, i, 2 * number) - 1.0;
      // With a narrow prior, within two of its standard deviations.
      const double known = u.prior.informs() ? 2.0 * u.prior.sigma / u.scale : 1e9;
      const double factor = std::pow(reach, exponent);
      value = u.start + std::clamp(u.scale * (factor - 1.0), -known * u.scale, known * u.scale);
      if (is_gain && calc_uniform(kSeed, i, 2 * number + 1) < 0.5) value = -value;
    }
    values.push_back(std::clamp(value, u.low, u.high));
  }
  return values;
}

double calc_chi2(ReadingModel& model, const std::vector<double>& values) {
  const Evaluation at = model.evaluate(values);
  return at.failure.empty() ? at.residual.squaredNorm() : std::numeric_limits<double>::infinity();
}

/// Takes a few steps of the fit; returns whether they explain the readings.
bool improve(ReadingModel& model, int steps, Candidate& c) {
  constexpr double kExplained = 2.0;  // chi2 per degree
  if (!std::isfinite(c.chi2)) return false;
  FitOptions fit;
  fit.iterations = steps;
  fit.first_damping = 1e-2;
  fit.start = c.values;
  const FitResult result = fit_readings(model, fit);
  c = {result.values, result.chi2};
  return result.chi2_per_degree() < kExplained;
}

void sort(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.chi2 < b.chi2; });
}

}  // namespace

std::vector<double> search_start(ReadingModel& model, const SearchOptions& options) {
  Candidate own{draw(model.unknowns(), 0, options.reach)};
  own.chi2 = calc_chi2(model, own.values);
  if (improve(model, options.steps, own)) return own.values;
  std::vector<Candidate> candidates;
  candidates.reserve(static_cast<std::size_t>(options.draws));
  for (int number = 1; number <= options.draws; ++number) {
    Candidate c{draw(model.unknowns(), static_cast<std::uint64_t>(number), options.reach)};
    c.chi2 = calc_chi2(model, c.values);
    candidates.push_back(std::move(c));
  }
  sort(candidates);
  candidates.resize(static_cast<std::size_t>(std::min(options.survivors, options.draws)));
  for (Candidate& c : candidates) improve(model, options.steps, c);
  candidates.push_back(std::move(own));
  sort(candidates);
  return candidates.front().values;
}

}  // namespace strut
