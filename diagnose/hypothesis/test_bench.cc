#include "diagnose/hypothesis/test_bench.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "estimate/nuisances.h"
#include "model/effects/names.h"

namespace strut {
namespace {

using Index = Eigen::Index;

Index as_index(std::size_t i) { return static_cast<Index>(i); }

/// Products less what `count` of the unknowns from `begin` on can take (their Schur complement).
Eigen::MatrixXd eliminate(const Eigen::MatrixXd& products, Index begin, Index count) {
  const Index rest = products.rows() - begin - count;
  Eigen::MatrixXd kept(begin + rest, begin + rest), mixed(count, begin + rest);
  kept.topLeftCorner(begin, begin) = products.topLeftCorner(begin, begin);
  kept.topRightCorner(begin, rest) = products.topRightCorner(begin, rest);
  kept.bottomLeftCorner(rest, begin) = products.bottomLeftCorner(rest, begin);
  kept.bottomRightCorner(rest, rest) = products.bottomRightCorner(rest, rest);
  if (count == 0) return kept;
  mixed.leftCols(begin) = products.block(begin, 0, count, begin);
  mixed.rightCols(rest) = products.block(begin, begin + count, count, rest);
  const Eigen::MatrixXd own = products.block(begin, begin, count, count);
  // Unknowns of which the readings say nothing leave zeros.
  Eigen::LDLT<Eigen::MatrixXd> factor(own + 1e-12 * own.diagonal().maxCoeff() *
                                                Eigen::MatrixXd::Identity(count, count));
  kept.noalias() -= mixed.transpose() * factor.solve(mixed);
  return kept;
}

}  // namespace

TestBench::TestBench(const CampaignData& data, const WhitenedFit& fit, int threads)
    : data_(data),
      runs_(fit.runs),
      roads_(fit.roads),
      unknowns_(fit.fit.unknowns),
      values_(fit.fit.values),
      shared_count_(fit.shared_count),
      effects_on_(list_effects_on(data, fit.shared())),
      threads_(threads) {
  const auto model = make_reading_model(data_, runs_, roads_, unknowns_, threads_);
  whitener_ = std::make_unique<Whitener>(*model, fit.spectra, roads_);
  const WhitenedModel whitened(*model, *whitener_);
  std::shared_ptr<const Linearization> given = fit.linearization;
  if (!given) given = std::make_shared<const Linearization>(model->linearize(values_));
  if (!given->failure.empty()) throw InputError(given->failure);
  Linearization at = whitener_->apply(*given, threads_);
  readings_ = given->residual;
  normal_ = calc_normal_equations(whitened, at).information;
  residual_ = std::move(at.residual);
  jacobian_ = std::move(at.jacobian);
  Eigen::MatrixXd regular = normal_;
  regular.diagonal().array() *= 1.0 + 1e-12;
  regular.diagonal().array() += 1e-12;
  regular_normal_.compute(regular);
  simulations_ += model->simulation_count();
}

std::unique_ptr<ReadingModel> TestBench::make_model(const std::vector<Unknown>& added,
                                                    int threads) const {
  std::vector<Unknown> all = unknowns_;
  all.insert(all.end(), added.begin(), added.end());
  return make_reading_model(data_, runs_, roads_, std::move(all), threads);
}

Eigen::MatrixXd TestBench::simulate_columns(const std::vector<Unknown>& added,
                                            const std::vector<std::vector<double>>& points) {
  const auto model = make_model(added, threads_);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(residual_.size(), as_index(points.size()));
  constexpr std::size_t kAtOnce = 64;
  for (std::size_t begin = 0; begin < points.size(); begin += kAtOnce) {
    const std::size_t end = std::min(begin + kAtOnce, points.size());
    std::vector<std::vector<double>> all(end - begin, values_);
    for (std::size_t i = begin; i < end; ++i) {
      all[i - begin].insert(all[i - begin].end(), points[i].begin(), points[i].end());
    }
    const std::vector<Evaluation> evaluations = model->evaluate(all);
    Eigen::MatrixXd differences = Eigen::MatrixXd::Zero(readings_.size(), as_index(end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      const Evaluation& e = evaluations[i - begin];
      if (!e.failure.empty()) continue;  // no such size: a column of zeros is no hypothesis
      differences.col(as_index(i - begin)) = e.residual - readings_;
    }
    columns.middleCols(as_index(begin), differences.cols()) =
        whitener_->apply(differences, threads_);
  }
  simulations_ += model->simulation_count();
  return columns;
}

Eigen::MatrixXd TestBench::simulate_columns(const std::vector<Hypothesis>& hypotheses,
                                            std::vector<HypothesisTrial>& trials) {
  std::vector<Unknown> added;
  for (const Hypothesis& h : hypotheses) {
    for (Unknown& u : make_unknowns(data_, h)) added.push_back(std::move(u));
  }
  const std::vector<double> neutral = list_starts(added);
  std::vector<std::vector<double>> points;
  std::size_t first = 0;
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    const Hypothesis& hypothesis = hypotheses[h];
    const auto twin = std::find_if(trials.begin(), trials.end(), [&](const HypothesisTrial& trial) {
      return are_identical(hypotheses[trial.hypothesis], hypothesis, effects_on_);
    });
    if (twin != trials.end()) {
      const std::size_t other = twin->hypothesis;
      for (std::size_t t = 0, count = trials.size(); t < count; ++t) {
        if (trials[t].hypothesis != other) continue;
        trials.push_back({h, trials[t].beginning, trials[t].columns, trials[t].parameters});
      }
      first += hypothesis.parameters.size();
      continue;
    }
    for (std::size_t b = 0; b < hypothesis.beginnings.size(); ++b) {
      HypothesisTrial trial{h, b, {}, {}};
      for (std::size_t j = 0; j < hypothesis.parameters.size(); ++j) {
        if (!hypothesis.parameters[j].switches) continue;
        std::vector<double> point = neutral;
        for (std::size_t i = 0; i < hypothesis.parameters.size(); ++i) {
          const bool set = i == j || !hypothesis.parameters[i].switches;
          if (set) point[first + i] = hypothesis.beginnings[b][i];
        }
        trial.columns.push_back(points.size());
        trial.parameters.push_back(j);
        points.push_back(std::move(point));
      }
      trials.push_back(std::move(trial));
    }
    first += hypothesis.parameters.size();
  }
  Eigen::MatrixXd columns = simulate_columns(added, points);
  for (const HypothesisTrial& trial : trials) {
    const Hypothesis& h = hypotheses[trial.hypothesis];
    const Eigen::VectorXd own = combine_own_columns(h, h.beginnings[trial.beginning].front());
    if (own.size() > 0) columns.col(as_index(trial.columns.front())) = own;
  }
  return columns;
}

/// The response to a relative error of what each run has as an unknown of its own, from the
/// derivatives by those: both are one motion, and a difference of simulations would leave a false
/// rest beside them. Empty where a run that the error acts on has no such unknown.
Eigen::VectorXd TestBench::combine_own_columns(const Hypothesis& h, double gain) const {
  constexpr const char* kBumpHeightName = "bump_height";  // of the maneuver's parameter
  const bool is_speed = h.effect == EffectName::kSpeedError;
  if (!is_speed && h.effect != EffectName::kBumpHeight) return {};
  const char* name = is_speed ? kSpeedName : kBumpHeightName;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(residual_.size());
  const auto whitened = as_index(whitener_->whitened_count());  // priors stay where they are
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    if (!is_speed && !meets_bump(data_, runs_[r])) continue;
    const auto own = std::find_if(unknowns_.begin(), unknowns_.end(), [&](const Unknown& u) {
      return u.run == static_cast<int>(r) && u.name == name;
    });
    if (own == unknowns_.end()) return {};
    const std::ptrdiff_t at = own - unknowns_.begin();
    const double change = gain * values_[static_cast<std::size_t>(at)] / own->scale;
    sum.head(whitened) += change * jacobian_.col(at).head(whitened);
  }
  return sum;
}

Evidence TestBench::gather(const std::vector<Hypothesis>& hypotheses) {
  Evidence evidence;
  evidence.shared = shared_count_;
  const Eigen::MatrixXd columns = simulate_columns(hypotheses, evidence.trials);
  const auto rows = residual_.size();
  // By run: the shared unknowns, its own, the columns, the residual.
  const auto shared = as_index(shared_count_), count = columns.cols();
  const auto add_products = [&](Index begin, Index length, const std::vector<Index>& own) {
    const auto width = shared + as_index(own.size()) + count + 1;
    Eigen::MatrixXd all(length, width);
    all.leftCols(shared) = jacobian_.block(begin, 0, length, shared);
    for (std::size_t i = 0; i < own.size(); ++i) {
      all.col(shared + as_index(i)) = jacobian_.col(own[i]).segment(begin, length);
    }
    all.middleCols(shared + as_index(own.size()), count) = columns.middleRows(begin, length);
    all.col(width - 1) = residual_.segment(begin, length);
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(width, width);
    products.selfadjointView<Eigen::Lower>().rankUpdate(all.transpose());
    products = products.selfadjointView<Eigen::Lower>();
    return products;
  };
  const auto whitened = as_index(whitener_->whitened_count());
  std::vector<Index> all_own;
  for (Index i = shared; i < jacobian_.cols(); ++i) all_own.push_back(i);
  // Priors of a run's own unknowns belong to the run.
  Eigen::MatrixXd priors = add_products(whitened, rows - whitened, all_own);
  evidence.norms.resize(runs_.size());
  evidence.products.resize(runs_.size());
  share_items(threads_, runs_.size(), [&](std::size_t r, int) {
    std::vector<Index> own;
    for (std::size_t i = shared_count_; i < unknowns_.size(); ++i) {
      if (unknowns_[i].run == static_cast<int>(r)) own.push_back(as_index(i));
    }
    const auto begin = as_index(whitener_->run_begin()[r]);
    const auto length = as_index(whitener_->run_begin()[r + 1]) - begin;
    Eigen::MatrixXd products = add_products(begin, length, own);
    evidence.norms[r] = products.diagonal().segment(products.rows() - 1 - count, count);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Index at = shared + as_index(i);
      products(at, at) += priors(own[i], own[i]);
      const Index last = priors.rows() - 1;
      products(at, products.cols() - 1) += priors(own[i], last);
      products(products.rows() - 1, at) += priors(last, own[i]);
    }
    evidence.products[r] = eliminate(products, shared, as_index(own.size()));
  });
  // What is left of the priors: those of shared unknowns.
  Eigen::MatrixXd of_shared = Eigen::MatrixXd::Zero(shared + count + 1, shared + count + 1);
  of_shared.topLeftCorner(shared, shared) = priors.topLeftCorner(shared, shared);
  of_shared.topRightCorner(shared, 1) = priors.topRightCorner(shared, 1);
  of_shared.bottomLeftCorner(1, shared) = priors.bottomLeftCorner(1, shared);
  evidence.products.push_back(of_shared);
  return evidence;
}

HypothesisFit TestBench::fit(const Hypothesis& hypothesis, const std::vector<double>& beginning,
                             const SearchEffort& effort, const std::vector<double>& from,
                             int threads) const {
  const std::vector<Unknown> own = make_unknowns(data_, hypothesis);
  const SearchGround ground{data_.has_inputs(), unknowns_, values_, *whitener_,
                            residual_,          jacobian_, normal_, regular_normal_};
  return search_hypothesis(ground, *make_model(own, threads), hypothesis, own, beginning, effort,
                           from);
}

}  // namespace strut
