#include "benchmarks/lm_peers.h"

#include <cstdio>
#include <cstdlib>

#include "benchmarks/cpu_time.h"

#ifdef STRUT_HAS_GSL
#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_version.h>
#endif
#ifdef STRUT_HAS_CERES
#include <ceres/ceres.h>
#endif

namespace strut {
namespace {

using Numbers = std::vector<double>;

/// Residuals, explicit Jacobian and second derivative of the training rows, block by block.
class ExplicitProblem {
 public:
  explicit ExplicitProblem(const test::StudyProblem& study)
      : shape_(test::StudyProblem::make_shape()),
        validation_rows_(study.make_validation()),
        validation_(shape_, validation_rows_),
        x_(4 * kRows),
        t_(4 * kRows),
        a_(shape_.activation_rows * kBlockRows),
        d_((4 * shape_.delta_rows + 1) * kBlockRows),
        scratch_(get_scratch_size(shape_)),
        second_(4 * kBlockRows) {
    study.make_training().read(0, kRows, x_.data(), t_.data());
  }

  static constexpr std::size_t kRows = 1400, kResiduals = 4 * kRows;
  std::size_t weight_count() const { return shape_.weight_count; }

  double calc_validation(const double* w) {
    return validation_.calc_loss(w) / validation_.residual_count();
  }

  /// Writes e and, if `jacobian` is not null, J by rows.
  void evaluate(const double* w, double* e, double* jacobian) {
    for_each_block(
        w,
        [&](std::size_t row, std::size_t s) {
          for (std::size_t k = 0; k < 4; ++k) {
            e[4 * row + k] = get(shape_.layers.back().output_row + k, s) - t_[4 * row + k];
            if (jacobian != nullptr) fill_row(k, s, jacobian + (4 * row + k) * weight_count());
          }
        },
        jacobian != nullptr);
  }

  void evaluate_second(const double* w, const double* direction, double* second) {
    direction_ = direction;
    for_each_block(
        w,
        [&](std::size_t row, std::size_t s) {
          for (std::size_t k = 0; k < 4; ++k) second[4 * row + k] = second_[k * kBlockRows + s];
        },
        false);
    direction_ = nullptr;
  }

 private:
  double get(std::size_t row, std::size_t s) const { return a_[row * kBlockRows + s]; }

  template <class F>
  void for_each_block(const double* w, const F& use, bool backward) {
    const TrainKernel& kernel = get_train_kernel();
    const Block block{a_.data(), kBlockRows};
    for (std::size_t first = 0; first < kRows; first += kBlockRows) {
      const std::size_t rows = std::min(kBlockRows, kRows - first);
      load_inputs(shape_, x_.data() + 4 * first, rows, block);
      kernel.run_forward(shape_, w, block);
      if (backward) kernel.run_backward(shape_, w, block, rows, d_.data());
      if (direction_ != nullptr) {
        kernel.calc_second_derivative(shape_, w, direction_, block, scratch_.data(),
                                      second_.data());
      }
      for (std::size_t s = 0; s < rows; ++s) use(first + s, s);
    }
  }

  /// dy_k / dw of column s of the block.
  void fill_row(std::size_t k, std::size_t s, double* row) const {
    for (const NetworkLayer& layer : shape_.layers) {
      const bool last = &layer == &shape_.layers.back();
      for (int o = 0; o < layer.outputs; ++o) {
        const auto unit = static_cast<std::size_t>(o);
        const double delta =
            last ? (unit == k ? 1.0 : 0.0)
                 : d_[(k * shape_.delta_rows + layer.delta_row + unit) * kBlockRows + s];
        double* to = row + layer.at(o, 0);
        for (std::size_t i = 0; i < static_cast<std::size_t>(layer.inputs); ++i) {
          to[i] = delta * get(layer.input_row + i, s);
        }
        row[layer.biases + unit] = delta;
      }
    }
  }

  NetworkShape shape_;
  MemorySource validation_rows_;
  NetworkProblem validation_;
  Numbers x_, t_, a_, d_, scratch_, second_;
  const double* direction_ = nullptr;
};

[[maybe_unused]] void print_row(const char* start, int iterations, double seconds, bool reached) {
  std::printf("  %-24s %5d iterations %27.3f CPU s%s\n", start, iterations, seconds,
              reached ? "" : "   not reached");
}

#ifdef STRUT_HAS_GSL
ExplicitProblem& get_problem(void* parameters) {
  return *static_cast<ExplicitProblem*>(parameters);
}

int calc_residuals(const gsl_vector* w, void* parameters, gsl_vector* e) {
  get_problem(parameters).evaluate(w->data, e->data, nullptr);
  return GSL_SUCCESS;
}
int calc_jacobian(const gsl_vector* w, void* parameters, gsl_matrix* j) {
  Numbers e(ExplicitProblem::kResiduals);
  get_problem(parameters).evaluate(w->data, e.data(), j->data);
  return GSL_SUCCESS;
}
int calc_second(const gsl_vector* w, const gsl_vector* v, void* parameters, gsl_vector* second) {
  get_problem(parameters).evaluate_second(w->data, v->data, second->data);
  return GSL_SUCCESS;
}

void run_gsl(ExplicitProblem& problem, const char* start, const Numbers& weights) {
  gsl_multifit_nlinear_parameters options = gsl_multifit_nlinear_default_parameters();
  options.trs = gsl_multifit_nlinear_trs_lmaccel;
  options.scale = gsl_multifit_nlinear_scale_levenberg;
  options.solver = gsl_multifit_nlinear_solver_cholesky;
  gsl_multifit_nlinear_fdf functions{};
  functions.f = calc_residuals;
  functions.df = calc_jacobian;
  functions.fvv = calc_second;
  functions.n = ExplicitProblem::kResiduals;
  functions.p = problem.weight_count();
  functions.params = &problem;
  gsl_multifit_nlinear_workspace* workspace =
      gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &options, functions.n, functions.p);
  const gsl_vector_const_view w = gsl_vector_const_view_array(weights.data(), weights.size());
  const double begin = read_cpu_time();
  gsl_multifit_nlinear_init(&w.vector, &functions, workspace);
  int iterations = 0;
  bool reached = false;
  while (!reached && iterations < 300 && gsl_multifit_nlinear_iterate(workspace) == GSL_SUCCESS) {
    ++iterations;
    reached = problem.calc_validation(gsl_multifit_nlinear_position(workspace)->data) <= 1e-6;
  }
  print_row(start, iterations, read_cpu_time() - begin, reached);
  gsl_multifit_nlinear_free(workspace);
}
#endif

#ifdef STRUT_HAS_CERES
class CeresCost : public ceres::CostFunction {
 public:
  explicit CeresCost(ExplicitProblem& problem) : problem_(&problem) {
    set_num_residuals(static_cast<int>(ExplicitProblem::kResiduals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.weight_count()));
  }
  bool Evaluate(double const* const* w, double* e, double** jacobians) const override {
    problem_->evaluate(w[0], e, jacobians != nullptr ? jacobians[0] : nullptr);
    return true;
  }

 private:
  ExplicitProblem* problem_;
};

class CeresStop : public ceres::IterationCallback {
 public:
  CeresStop(ExplicitProblem& problem, const Numbers& weights)
      : problem_(&problem), weights_(&weights) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    reached = problem_->calc_validation(weights_->data()) <= 1e-6;
    return reached ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool reached = false;

 private:
  ExplicitProblem* problem_;
  const Numbers* weights_;
};

void run_ceres(ExplicitProblem& problem, const char* start, Numbers weights) {
  ceres::Problem model;
  model.AddResidualBlock(new CeresCost(problem), nullptr, weights.data());
  CeresStop stop(problem, weights);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 300;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 0.0;
  options.update_state_every_iteration = true;
  options.callbacks.push_back(&stop);
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  const double begin = read_cpu_time();
  ceres::Solve(options, &model, &summary);
  print_row(start, static_cast<int>(summary.iterations.size()) - 1, read_cpu_time() - begin,
            stop.reached);
}
#endif

}  // namespace

void run_peers([[maybe_unused]] const test::StudyProblem& study) {
  [[maybe_unused]] constexpr const char* kStart = "x0";
#ifdef STRUT_HAS_GSL
  std::printf("GSL %s, lmaccel, Cholesky\n", GSL_VERSION);
  ExplicitProblem gsl_problem(study);
  run_gsl(gsl_problem, kStart, study.read_start(kStart));
#else
  std::printf("GSL (libgsl-dev) is not installed\n");
#endif
#ifdef STRUT_HAS_CERES
  std::printf("Ceres %s, dense normal equations\n", CERES_VERSION_STRING);
  ExplicitProblem ceres_problem(study);
  run_ceres(ceres_problem, kStart, study.read_start(kStart));
#else
  std::printf("Ceres (libceres-dev) is not installed\n");
#endif
}

}  // namespace strut
