#include "model/kernel/stability.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace strut {
namespace {

using System = CarSystem<double>;
constexpr int kPast = 3;                 // past steps that a multistep formula reads
constexpr double kDisturbance = 1e-6;    // relative to max(1, |component|)
constexpr double kMinStep = 1e-6;        // s, lower end of the search
constexpr double kStepPrecision = 1.02;  // ratio of the last unstable to the last stable step

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// One step as a map from y to y: y holds everything that the step reads. Components of y:
///   x (n);  for multistep formulas then, for each past step from the newest,
///   h f (n) and the stiff components of x (stiff)
struct StepMap {
  System* system;
  double h;
  bool multistep;
  int n, stiff;

  int size() const { return n + (multistep ? kPast * (n + stiff) : 0); }
  int derivative_at(int past) const { return n + past * (n + stiff); }
  int stiff_at(int past) const { return derivative_at(past) + n; }
};

StepMap make_step_map(System& system, const StepOptions& options) {
  return {&system, options.step, options.stepper == Stepper::kAbm4, system.size(),
          system.stiff_count()};
}

/// y of a car that has moved steadily in the state x.
Eigen::VectorXd make_steady_point(const StepMap& map, const State<double>& x) {
  State<double> f{};
  double decay[kMaxStiff] = {};
  map.system->start(x.data());
  map.system->calc_derivative(0.0, x.data(), f.data(), decay);
  Eigen::VectorXd y(map.size());
  for (int i = 0; i < map.n; ++i) y[i] = x[at(i)];
  for (int past = 0; map.multistep && past < kPast; ++past) {
    for (int i = 0; i < map.n; ++i) y[map.derivative_at(past) + i] = map.h * f[at(i)];
    for (int i = 0; i < map.stiff; ++i) y[map.stiff_at(past) + i] = y[map.system->stiff_at(i)];
  }
  return y;
}

/// States and derivatives of the past steps; of the states only the stiff components, which are all
/// that the formulas read.
struct Past {
  std::array<State<double>, kPast> x{}, f{};
};

Past read_past(const StepMap& map, const Eigen::VectorXd& y) {
  Past past;
  for (int k = 0; k < kPast; ++k) {
    for (int i = 0; i < map.n; ++i) past.f[at(k)][at(i)] = y[map.derivative_at(k) + i] / map.h;
    for (int i = 0; i < map.stiff; ++i) {
      past.x[at(k)][at(map.system->stiff_at(i))] = y[map.stiff_at(k) + i];
    }
  }
  return past;
}

/// Writes the past of the next step: the current step becomes the newest, the oldest is dropped.
void shift_past(const StepMap& map, const Eigen::VectorXd& y, const State<double>& f,
                Eigen::VectorXd& next) {
  for (int i = 0; i < map.n; ++i) next[map.derivative_at(0) + i] = map.h * f[at(i)];
  for (int i = 0; i < map.stiff; ++i) next[map.stiff_at(0) + i] = y[map.system->stiff_at(i)];
  const int kept = (kPast - 1) * (map.n + map.stiff);
  next.segment(map.derivative_at(1), kept) = y.segment(map.derivative_at(0), kept);
}

Eigen::VectorXd take_step(const StepMap& map, const Eigen::VectorXd& y) {
  State<double> x{}, x1{}, f{};
  double decay[kMaxStiff] = {};
  StiffWeights<double> weights;
  StepScratch<double, System::kCapacity> scratch{};
  for (int i = 0; i < map.n; ++i) x[at(i)] = y[i];
  map.system->calc_derivative(0.0, x.data(), f.data(), decay);
  update_stiff_weights(decay, map.h, map.stiff, weights);
  Eigen::VectorXd next(y.size());
  if (map.multistep) {
    const Past past = read_past(map, y);
    AdamsHistory<double> history{};
    for (std::size_t k = 0; k < kPast; ++k) {
      history.x[k] = past.x[k].data();
      history.f[k] = past.f[k].data();
    }
    step_abm4<double>(*map.system, 0.0, x.data(), f.data(), history, weights, map.h, x1.data(),
                      scratch);
    shift_past(map, y, f, next);
  } else {
    step_rk4<double>(*map.system, 0.0, x.data(), f.data(), weights, map.h, x1.data(), scratch);
  }
  for (int i = 0; i < map.n; ++i) next[i] = x1[at(i)];
  return next;
}

/// Jacobian of the map at y by central differences.
Eigen::MatrixXd calc_jacobian(const StepMap& map, const Eigen::VectorXd& y) {
  Eigen::MatrixXd jacobian(y.size(), y.size());
  for (int i = 0; i < y.size(); ++i) {
    const double delta = kDisturbance * std::fmax(1.0, std::fabs(y[i]));
    Eigen::VectorXd above = y, below = y;
    above[i] += delta;
    below[i] -= delta;
    jacobian.col(i) = (take_step(map, above) - take_step(map, below)) / (above[i] - below[i]);
  }
  return jacobian;
}

double calc_spectral_radius(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return INFINITY;
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

double calc_amplification(const PreparedCase& c, const IntegrateOptions& options) {
  // The tabulated corners are the same car, at a third of the cost.
  const TableClosure<double, double> closure{&c.mechanism->tables};
  System system(c.vehicle, closure, options.spin, c.trigger_x);
  const StepMap map = make_step_map(system, options.step);
  return calc_spectral_radius(calc_jacobian(map, make_steady_point(map, c.start)));
}

double find_stable_step(const PreparedCase& c, IntegrateOptions options) {
  double unstable = options.step.step, stable = kMinStep;
  const auto is_stable = [&](double step) {
    options.step.step = step;
    return calc_amplification(c, options) <= kMaxAmplification;
  };
  if (is_stable(unstable)) return unstable;
  if (!is_stable(stable)) return 0.0;
  while (unstable > kStepPrecision * stable) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

}  // namespace strut
