// The interface of a least-squares problem to Levenberg-Marquardt: minimize e'e over the weights w.
#pragma once

#include <cstddef>

namespace strut {

class LeastSquaresProblem {
 public:
  virtual ~LeastSquaresProblem() = default;

  virtual std::size_t weight_count() const = 0;
  /// Length of e; reported means are e'e divided by this.
  virtual double residual_count() const = 0;

  /// Writes H = J'J (lower triangle, by columns) and J'e with J = de/dw; returns e'e. A problem
  /// that uses a sample of its residuals for H may select the sample by `epoch`.
  virtual double calc_gram(const double* weights, int epoch, double* h, double* gradient) = 0;

  /// e'e with the same bits as calc_gram's.
  virtual double calc_loss(const double* weights) = 0;

  /// Whether calc_second_gradient is implemented; without it steps are not accelerated.
  virtual bool has_second_derivative() const { return false; }

  /// Writes J' e", e" = d2e/dt2 along weights + t direction.
  virtual void calc_second_gradient(const double* /*weights*/, const double* /*direction*/,
                                    double* /*gradient*/) {}
};

}  // namespace strut
