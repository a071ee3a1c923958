#include "diagnose/decide/fit_force_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/error/input_error.h"
#include "diagnose/decide/judge_force_map.h"
#include "diagnose/discrepancy/map_prior.h"

namespace strut {
namespace {

using Index = Eigen::Index;

ForceMaps& get_force_maps(CampaignData& data, std::size_t run) {
  return data.runs[run].setup.force_maps();
}

const ForceMaps& get_force_maps(const CampaignData& data) {
  return data.runs[0].setup.force_maps();
}

/// The campaign with a map in its model.
CampaignData add_map(const CampaignData& data, const ForceMap& map) {
  CampaignData with = data;
  for (std::size_t r = 0; r < data.run_count(); ++r)
    add_map_part(get_force_maps(with, r), map, 1.0);
  return with;
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

/// Gauss-Newton on the factors of the shapes and all that a fit adjusts; sizes of the shapes and
/// the noise of the bands are found anew in every step.
class MapSearch {
 public:
  MapSearch(const CampaignData& data, const WhitenedFit& base, const MapBasis& basis, double force,
            int threads)
      : data_(data),
        basis_(basis),
        force_(force),
        threads_(threads),
        now_(base),
        factors_(Eigen::VectorXd::Zero(static_cast<Index>(basis.shapes.size()))) {}

  /// A step. Returns ln of the odds that the readings ask for a map.
  double step() {
    const CampaignData with = add_map(data_, add_shapes(basis_, factors_));
    TestBench bench(with, now_, threads_);
    const Eigen::MatrixXd columns = simulate_shapes(bench, basis_, force_);
    const Eigen::MatrixXd& jacobian = bench.jacobian();
    evidence_ = eliminate_base(columns, jacobian, bench.residual() - columns * factors_);
    prior_ = choose_map_prior(evidence_, basis_.shapes);
    const Eigen::VectorXd change = calc_map_mean(evidence_, prior_) - factors_;
    const Eigen::VectorXd base_change =
        -factor_base(jacobian).solve(jacobian.transpose() * (bench.residual() + columns * change));
    now_.linearization.reset();
    move(bench, change, base_change);
    return prior_.log_likelihood;
  }

  /// Whether the last step led on.
  bool moved() const { return moved_; }

  /// The fit where the search stands: the shapes in combinations, of those that the readings tell.
  WhitenedFit conclude() const {
    const Eigen::MatrixXd combinations = combine_shapes(evidence_, prior_);
    // In units of the prior they are orthonormal.
    const Eigen::VectorXd unit =
        prior_.weights.unaryExpr([](double w) { return w > 0.0 ? 1.0 / w : 0.0; });
    const Eigen::VectorXd found =
        (unit.asDiagonal() * combinations).transpose() * unit.cwiseProduct(factors_);
    const auto shared = static_cast<std::ptrdiff_t>(now_.shared_count);
    WhitenedFit fit = now_;
    std::vector<Unknown> unknowns = now_.fit.unknowns;
    std::vector<double> values = now_.fit.values;
    const std::vector<Unknown> own = make_map_unknowns(basis_, combinations, {0.0, 1.0});
    unknowns.insert(unknowns.begin() + shared, own.begin(), own.end());
    values.insert(values.begin() + shared, found.data(), found.data() + found.size());
    fit.shared_count += own.size();
    const auto model = make_reading_model(data_, fit.runs, fit.roads, unknowns, threads_);
    Linearization at = model->linearize(values);
    if (!at.failure.empty()) throw InputError(at.failure);
    const Whitener whitener(*model, fit.spectra, fit.roads);
    const WhitenedModel whitened(*model, whitener);
    const Linearization seen = whitener.apply(at);
    if (!data_.has_inputs()) {
      fit.linearization = std::make_shared<const Linearization>(std::move(at));
    }
    fit.fit = describe_fit(whitened, seen, values, std::vector<bool>(values.size(), false), false);
    return fit;
  }

 private:
  static constexpr double kEnough = 1.0;  // of chi2: less is no way to go

  /// As far along a step as it leads down.
  void move(const TestBench& bench, const Eigen::VectorXd& change,
            const Eigen::VectorXd& base_change) {
    const double before = bench.residual().squaredNorm() + calc_penalty(factors_);
    moved_ = false;
    for (const double share : {1.0, 0.5, 0.2, 0.05}) {
      const Eigen::VectorXd factors = factors_ + share * change;
      const std::vector<double> values = move_base(share * base_change);
      const auto residual = evaluate(factors, values, bench.whitener());
      if (!residual) continue;
      const double gained = before - residual->squaredNorm() - calc_penalty(factors);
      if (!(gained > 0.0)) continue;
      factors_ = factors;
      now_.fit.values = values;
      moved_ = gained > kEnough;
      if (!now_.is_dominated && now_.roads.empty()) {
        count_excess(bench.whitener(), *residual, now_.spectra);
      }
      return;
    }
  }

  /// Of a prior; a size of 0 leaves nothing to pay for.
  double calc_penalty(const Eigen::VectorXd& factors) const {
    double penalty = 0.0;
    for (Index i = 0; i < factors.size(); ++i) {
      const double w = prior_.weights(i);
      if (w > 0.0) penalty += factors(i) * factors(i) / (w * w);
    }
    return penalty;
  }

  std::vector<double> move_base(const Eigen::VectorXd& change) const {
    std::vector<double> values = now_.fit.values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Unknown& u = now_.fit.unknowns[i];
      values[i] = std::clamp(values[i] + u.scale * change(static_cast<Index>(i)), u.low, u.high);
    }
    return values;
  }

  /// Whitened residual; nothing where it cannot be simulated.
  std::optional<Eigen::VectorXd> evaluate(const Eigen::VectorXd& factors,
                                          std::vector<double> values,
                                          const Whitener& whitener) const {
    std::vector<Unknown> unknowns = now_.fit.unknowns;
    auto map = std::make_shared<const ForceMap>(add_shapes(basis_, factors));
    unknowns.push_back(make_map_unknown("force_map", std::move(map), {}));
    values.push_back(1.0);
    const auto model =
        make_reading_model(data_, now_.runs, now_.roads, std::move(unknowns), threads_);
    const Evaluation e = model->evaluate(values);
    if (!e.failure.empty()) return std::nullopt;
    return whitener.apply_residual(e.residual);
  }

  const CampaignData& data_;
  const MapBasis& basis_;
  double force_;
  int threads_;
  WhitenedFit now_;          // without the map
  Eigen::VectorXd factors_;  // of the shapes
  MapEvidence evidence_;
  MapPrior prior_;
  bool moved_ = false;
};

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

}  // namespace

std::optional<WhitenedFit> fit_force_map(const CampaignData& data, const WhitenedFit& base,
                                         const VisitedStates& states,
                                         const ForceMapOptions& options) {
  const ForceMaps& given = get_force_maps(data);
  if (has_corner_map(given, states.place)) return std::nullopt;
  const MapBasis basis = make_map_basis(states, find_own_map(given, states.place), options.grid);
  if (basis.shapes.empty()) return std::nullopt;
  try {
    constexpr int kMostSteps = 5;
    MapSearch search(data, base, basis, states.force, options.threads);
    for (int step = 0; step < kMostSteps; ++step) {
      if (search.step() < options.log_odds) return std::nullopt;
      if (step > 0 && !search.moved()) break;
    }
    return search.conclude();
  } catch (const InputError&) {  // cannot be simulated with that map
    return std::nullopt;
  }
}

std::optional<ForceMapFit> choose_force_map(const CampaignData& data, const Selection& selection,
                                            const ForceMapOptions& options) {
  const HoldOutSum before(selection.hold_out_before), now(selection.hold_out_after);
  if (!now.is_whole || now.expected == 0.0) return std::nullopt;
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
      map.judged = selection.judge->judge(map.fit.shared());
      const HoldOutSum judged(map.judged);
      map.share = calc_removed_share(now, judged);
      if (!is_map_confirmed(now, judged, options)) continue;
      if (replaces && !explains_causes(before, now, judged, options)) continue;
      if (best) {
        // What was named stays unless a map alone is clearly better.
        const double margin = replaces && !best->replaces_causes ? options.log_odds : 0.0;
        if (judged.calc_log_odds(HoldOutSum(best->judged)) <= margin) continue;
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
