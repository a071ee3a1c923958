#include "diagnose/fit_force_map.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "diagnose/map_prior.h"
#include "io/input_error.h"

namespace strut {
namespace {

using Index = Eigen::Index;

ForceMaps& get_force_maps(CampaignData& data, std::size_t run) {
  return data.is_rig() ? data.rigs[run].setup.force_maps : data.cars[run].setup.vehicle.force_maps;
}

const ForceMaps& get_force_maps(const CampaignData& data) {
  return data.is_rig() ? data.rigs[0].setup.force_maps : data.cars[0].setup.vehicle.force_maps;
}

/// The campaign with a map in its model.
CampaignData add_map(const CampaignData& data, const ForceMap& map) {
  CampaignData with = data;
  for (std::size_t r = 0; r < data.run_count(); ++r)
    add_map_part(get_force_maps(with, r), map, 1.0);
  return with;
}

/// The fit's values without its map, to linearize anew.
WhitenedFit drop_map(const WhitenedFit& fit) {
  WhitenedFit without;
  without.runs = fit.runs;
  without.spectra = fit.spectra;
  without.is_dominated = fit.is_dominated;
  for (std::size_t i = 0; i < fit.fit.unknowns.size(); ++i) {
    if (fit.fit.unknowns[i].kind == UnknownKind::kForceMap) continue;
    without.fit.unknowns.push_back(fit.fit.unknowns[i]);
    without.fit.values.push_back(fit.fit.values[i]);
    if (i < fit.shared_count) ++without.shared_count;
  }
  return without;
}

std::string name_shape(const std::string& place, std::size_t number) {
  return (place.empty() ? "" : place + "_") + "force_map_" + std::to_string(number + 1);
}

/// An unknown for each column of factors of the shapes.
std::vector<Unknown> make_map_unknowns(const MapBasis& basis, const Eigen::MatrixXd& factors,
                                       const Prior& prior) {
  // 100 %: so far from the prior's 1 that differences are no rounding.
  constexpr double kScale = 100.0;
  std::vector<Unknown> unknowns;
  for (Index i = 0; i < factors.cols(); ++i) {
    auto part = std::make_shared<const ForceMap>(add_shapes(basis, factors.col(i)));
    unknowns.push_back(
        make_map_unknown(name_shape(basis.grid.place, unknowns.size()), std::move(part), prior));
    unknowns.back().scale = kScale;
  }
  return unknowns;
}

/// What each shape does to the whitened readings, by newton.
Eigen::MatrixXd simulate_shapes(TestBench& bench, const MapBasis& basis, double force) {
  // Of the damper's force: what is linear at first may not stay so.
  constexpr double kShare = 0.01, kLeast = 1e-6;
  const double size = std::max(kShare * force, kLeast);
  const std::size_t n = basis.shapes.size();
  const auto identity = Eigen::MatrixXd::Identity(static_cast<Index>(n), static_cast<Index>(n));
  const std::vector<Unknown> shapes = make_map_unknowns(basis, identity, {});
  std::vector<std::vector<double>> points(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) points[i][i] = size;
  return bench.simulate_columns(shapes, points) / size;
}

/// The linear model's shapes and the best of their combinations.
struct MapStart {
  Eigen::MatrixXd factors;  // of the shapes, columns as combine_shapes has them
  Eigen::VectorXd values;   // of the combinations, at their posterior mean
  double log_likelihood = 0.0;
};

/// `known`: factors of the shapes that the bench's model has already.
MapStart find_start(TestBench& bench, const MapBasis& basis, double force,
                    const Eigen::VectorXd& known) {
  const Eigen::MatrixXd columns = simulate_shapes(bench, basis, force);
  const MapEvidence evidence =
      eliminate_base(columns, bench.jacobian(), bench.residual() - columns * known);
  const MapPrior prior = choose_map_prior(evidence, basis.shapes);
  MapStart start{combine_shapes(evidence, prior), {}, prior.log_likelihood};
  const Index n = start.factors.cols();
  const Eigen::MatrixXd information =
      start.factors.transpose() * evidence.information * start.factors +
      Eigen::MatrixXd::Identity(n, n);
  start.values = -information.ldlt().solve(start.factors.transpose() * evidence.gradient);
  return start;
}

/// The fit of combinations of shapes together with everything that `base` adjusts.
WhitenedFit fit_combinations(const CampaignData& data, const WhitenedFit& base,
                             const MapBasis& basis, const MapStart& start,
                             const std::vector<double>& values, int threads) {
  const auto shared = static_cast<std::ptrdiff_t>(base.shared_count);
  std::vector<Unknown> unknowns = base.fit.unknowns;
  std::vector<double> all = base.fit.values;
  const std::vector<Unknown> own = make_map_unknowns(basis, start.factors, {0.0, 1.0});
  unknowns.insert(unknowns.begin() + shared, own.begin(), own.end());
  all.insert(all.begin() + shared, values.begin(), values.end());
  return fit_whitened(data, base.runs, base.spectra, unknowns, all, base.shared_count + own.size(),
                      threads);
}

std::vector<double> get_map_values(const WhitenedFit& fit) {
  std::vector<double> values;
  for (std::size_t i = 0; i < fit.fit.unknowns.size(); ++i) {
    if (fit.fit.unknowns[i].kind == UnknownKind::kForceMap) values.push_back(fit.fit.values[i]);
  }
  return values;
}

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
}

/// The map that is at a place already; null where there is none.
const ForceMap* find_own_map(const ForceMaps& maps, const std::string& place) {
  const auto found = std::find_if(maps.begin(), maps.end(),
                                  [&](const ForceMap& map) { return map.place == place; });
  return found == maps.end() ? nullptr : &*found;
}

/// Whether a corner of the axle has a map of its own, which replaces the axle's.
bool has_corner_map(const ForceMaps& maps, const std::string& axle) {
  return std::any_of(maps.begin(), maps.end(), [&](const ForceMap& map) {
    return is_corner(map.place) && map.place.rfind(axle, 0) == 0;
  });
}

/// Sums over the runs held out; all must have been simulated.
struct Judgment {
  bool is_whole = true;
  double chi2 = 0.0, log_likelihood = 0.0, count = 0.0;

  explicit Judgment(const std::vector<HoldOutRun>& runs) {
    for (const HoldOutRun& run : runs) {
      is_whole = is_whole && run.failure.empty();
      chi2 += run.chi2;
      log_likelihood += run.log_likelihood;
      count += static_cast<double>(run.count);
    }
  }
  /// What a model leaves over what noise does, at least 1: readings count as many times less.
  double misfit() const { return std::max(1.0, chi2 / count); }
  /// ln of the odds of this against another.
  double calc_log_odds(const Judgment& other) const {
    return (log_likelihood - other.log_likelihood) / misfit();
  }
};

}  // namespace

std::optional<WhitenedFit> fit_force_map(const CampaignData& data, const WhitenedFit& base,
                                         const VisitedStates& states,
                                         const ForceMapOptions& options) {
  const ForceMaps& given = get_force_maps(data);
  if (has_corner_map(given, states.place) && !states.place.empty()) return std::nullopt;
  const MapBasis basis = make_map_basis(states, find_own_map(given, states.place), options.grid);
  if (basis.shapes.empty()) return std::nullopt;
  try {
    TestBench bench(data, base, options.threads);
    const auto n = static_cast<Index>(basis.shapes.size());
    const MapStart start = find_start(bench, basis, states.force, Eigen::VectorXd::Zero(n));
    if (start.log_likelihood < options.log_odds) return std::nullopt;
    // From no map: the linear model may promise one that cannot be simulated.
    const std::vector<double> none(static_cast<std::size_t>(start.factors.cols()), 0.0);
    WhitenedFit fit = fit_combinations(data, base, basis, start, none, options.threads);
    const Eigen::VectorXd known = start.factors * as_vector(get_map_values(fit));
    const CampaignData with = add_map(data, add_shapes(basis, known));
    const WhitenedFit around = drop_map(fit);
    TestBench again(with, around, options.threads);
    const MapStart better = find_start(again, basis, states.force, known);
    if (better.log_likelihood < options.log_odds) return std::nullopt;
    const std::vector<double> values(better.values.data(),
                                     better.values.data() + better.values.size());
    return fit_combinations(data, around, basis, better, values, options.threads);
  } catch (const InputError&) {  // cannot be simulated with that map
    return std::nullopt;
  }
}

std::optional<ForceMapFit> choose_force_map(const CampaignData& data, const Selection& selection,
                                            const ForceMapOptions& options) {
  const Judgment now(selection.hold_out_after);
  if (!now.is_whole || now.count == 0.0) return std::nullopt;
  std::optional<ForceMapFit> best;
  for (const bool replaces : {false, true}) {
    if (replaces && selection.causes.empty()) break;
    const WhitenedFit& base = replaces ? selection.base : selection.extended;
    for (VisitedStates& states : list_visited_states(data, base.runs, base.shared())) {
      if (options.progress) {
        options.progress("fitting a force map to the " + states.describe() +
                         (replaces ? " instead of the causes" : ""));
      }
      std::optional<WhitenedFit> fit = fit_force_map(data, base, states, options);
      if (!fit) continue;
      ForceMapFit map{std::move(states), replaces, std::move(*fit), {}, 0.0};
      map.judged = judge_hold_out(data, map.fit.shared(), selection.level, options.threads);
      const Judgment judged(map.judged);
      if (!judged.is_whole || judged.calc_log_odds(now) < options.log_odds) continue;
      map.share = (now.chi2 - judged.chi2) / std::max(now.chi2 - now.count, 1e-9);
      if (map.share < options.least_share) continue;
      if (best) {
        // What was named stays unless a map alone is clearly better.
        const double margin = replaces && !best->replaces_causes ? options.log_odds : 0.0;
        if (judged.calc_log_odds(Judgment(best->judged)) <= margin) continue;
      }
      best = std::move(map);
    }
  }
  return best;
}

ForceMaps list_force_maps_on(const CampaignData& data, const SharedValues& shared) {
  ForceMaps maps = get_force_maps(data);
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    const Unknown& u = shared.unknowns[i];
    if (u.kind == UnknownKind::kForceMap) add_map_part(maps, *u.part, shared.values[i]);
  }
  return maps;
}

double calc_map_sigma(const WhitenedFit& fit, double deflection, double velocity) {
  const std::size_t n = fit.fit.unknowns.size();
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(static_cast<Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const Unknown& u = fit.fit.unknowns[i];
    if (u.kind != UnknownKind::kForceMap) continue;
    slope(static_cast<Index>(i)) = calc_force(*u.part, deflection, velocity);
  }
  return std::sqrt(std::max(0.0, slope.dot(fit.fit.widened.covariance * slope)));
}

}  // namespace strut
