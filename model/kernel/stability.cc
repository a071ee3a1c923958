#include "model/kernel/stability.h"

#include <Eigen/Dense>
#include <cmath>

namespace strut {
namespace {

using System = CarSystem<double>;
constexpr int kPast = 3;
constexpr double kDelta = 1e-6;  // of the disturbance, for central differences

/// One step as a map of everything it reads: the state and, for multistep formulas, the past
/// derivatives times the step and the past stiff components.
class StepMap {
 public:
  StepMap(System& system, const PreparedCase& c, const StepOptions& options)
      : system_(system),
        n_(system.size()),
        stiff_(system.stiff_count()),
        h_(options.step),
        multistep_(options.stepper == Stepper::kAbm4) {
    const State<double>& x = c.start;
    State<double> f{};
    double decay[kMaxStiff] = {};
    system_.start(x.data());
    system_.calc_derivative(0.0, x.data(), f.data(), decay);
    base_.resize(n_ + (multistep_ ? kPast * (n_ + stiff_) : 0));
    for (int i = 0; i < n_; ++i) base_[i] = x[static_cast<std::size_t>(i)];
    for (int past = 0; multistep_ && past < kPast; ++past) {
      for (int i = 0; i < n_; ++i)
        base_[derivative(past) + i] = h_ * f[static_cast<std::size_t>(i)];
      for (int i = 0; i < stiff_; ++i) base_[spin(past) + i] = base_[system_.stiff_at(i)];
    }
  }

  const Eigen::VectorXd& base() const { return base_; }

  Eigen::VectorXd step(const Eigen::VectorXd& y) {
    State<double> x{}, x1{}, f{};
    double decay[kMaxStiff] = {};
    StiffWeights<double> weights;
    for (int i = 0; i < n_; ++i) x[static_cast<std::size_t>(i)] = y[i];
    system_.calc_derivative(0.0, x.data(), f.data(), decay);
    update_stiff_weights(decay, h_, stiff_, weights);
    Eigen::VectorXd y1(y.size());
    if (multistep_) {
      read_past(y);
      step_abm4<double>(system_, 0.0, x.data(), f.data(), past_, weights, h_, x1.data(), scratch_);
      write_past(y, f, y1);
    } else {
      step_rk4<double>(system_, 0.0, x.data(), f.data(), weights, h_, x1.data(), scratch_);
    }
    for (int i = 0; i < n_; ++i) y1[i] = x1[static_cast<std::size_t>(i)];
    return y1;
  }

 private:
  int derivative(int past) const { return n_ + past * (n_ + stiff_); }
  int spin(int past) const { return derivative(past) + n_; }

  /// The past of a disturbed step; of past states the formulas read the stiff components only.
  void read_past(const Eigen::VectorXd& y) {
    for (int past = 0; past < kPast; ++past) {
      const auto at = static_cast<std::size_t>(past);
      for (int i = 0; i < n_; ++i) {
        past_f_[at][static_cast<std::size_t>(i)] = y[derivative(past) + i] / h_;
      }
      for (int i = 0; i < stiff_; ++i) {
        past_x_[at][static_cast<std::size_t>(system_.stiff_at(i))] = y[spin(past) + i];
      }
      past_.f[at] = past_f_[at].data();
      past_.x[at] = past_x_[at].data();
    }
  }

  void write_past(const Eigen::VectorXd& y, const State<double>& f, Eigen::VectorXd& y1) const {
    for (int i = 0; i < n_; ++i) y1[derivative(0) + i] = h_ * f[static_cast<std::size_t>(i)];
    for (int i = 0; i < stiff_; ++i) y1[spin(0) + i] = y[system_.stiff_at(i)];
    const int rest = (kPast - 1) * (n_ + stiff_);
    y1.segment(derivative(1), rest) = y.segment(derivative(0), rest);
  }

  System& system_;
  int n_, stiff_;
  double h_;
  bool multistep_;
  Eigen::VectorXd base_;
  std::array<State<double>, kPast> past_x_{}, past_f_{};
  AdamsHistory<double> past_{};
  StepScratch<double, System::kCapacity> scratch_{};
};

double calc_spectral_radius(StepMap map) {
  const Eigen::VectorXd base = map.base();
  Eigen::MatrixXd jacobian(base.size(), base.size());
  for (int i = 0; i < base.size(); ++i) {
    const double delta = kDelta * std::fmax(1.0, std::fabs(base[i]));
    Eigen::VectorXd above = base, below = base;
    above[i] += delta;
    below[i] -= delta;
    jacobian.col(i) = (map.step(above) - map.step(below)) / (above[i] - below[i]);
  }
  if (!jacobian.allFinite()) return INFINITY;
  return Eigen::EigenSolver<Eigen::MatrixXd>(jacobian, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

double calc_amplification(const PreparedCase& c, const IntegrateOptions& options) {
  // The tabulated corners are the same car, at a third of the cost.
  const TableClosure<double, double> closure{&c.mechanism->tables};
  System system(c.vehicle, closure, options.spin, c.trigger_x);
  return calc_spectral_radius(StepMap(system, c, options.step));
}

double find_stable_step(const PreparedCase& c, IntegrateOptions options) {
  double unstable = options.step.step, stable = 1e-6;
  const auto is_stable = [&](double step) {
    options.step.step = step;
    return calc_amplification(c, options) <= kMaxAmplification;
  };
  if (is_stable(unstable)) return unstable;
  if (!is_stable(stable)) return 0.0;
  while (unstable > 1.02 * stable) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

}  // namespace strut
