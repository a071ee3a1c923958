// The reference integrator: SUNDIALS CVODE with contact events and the snapshot as roots.

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "model/integrate/sundials.h"
#include "model/kernel/simulation.h"

namespace strut {
namespace {

/// A decay rate [1/s] of spin or strut from which the implicit BDF formulas cost less than Adams
/// formulas with fixed-point iteration, whose step it would bound.
constexpr double kStiffDecay = 5000.0;
constexpr int kMaxRoots = 2 * kCorners + 1;

/// What CVODE's callbacks see.
struct Problem {
  CarSystem<double>* system;
  long derivatives = 0;
  bool triggered = false;  // the snapshot is taken; its root is switched off
};

int calc_rhs(double t, N_Vector y, N_Vector dy, void* data) {
  Problem& p = *static_cast<Problem*>(data);
  double decay[kMaxStiff];
  p.system->calc_derivative(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy), decay);
  ++p.derivatives;
  return p.system->has_failed() ? 1 : 0;
}

int calc_roots(double t, N_Vector y, double* g, void* data) {
  Problem& p = *static_cast<Problem*>(data);
  p.system->calc_guards(t, N_VGetArrayPointer(y), g);
  g[p.system->guard_count()] = p.triggered ? 1.0 : p.system->get_trigger();
  return 0;
}

/// Owns CVODE's memory block.
struct CvodeMemory {
  CvodeMemory() = default;
  ~CvodeMemory() { CVodeFree(&raw); }
  CvodeMemory(const CvodeMemory&) = delete;
  CvodeMemory& operator=(const CvodeMemory&) = delete;
  void* raw = nullptr;
};

class ReferenceRun {
 public:
  ReferenceRun(const PreparedCase& c, const ReferenceOptions& options, const SamplePlan& plan)
      : newton_{&c.vehicle.layout, &c.vehicle.numbers},
        table_{&c.mechanism->tables},
        system_(options.closure == Closure::kNewton
                    ? CarSystem<double>(c.vehicle, newton_, SpinTreatment::kExplicit, c.trigger_x)
                    : CarSystem<double>(c.vehicle, table_, SpinTreatment::kExplicit, c.trigger_x)),
        problem_{&system_},
        plan_(plan),
        state_(c.start) {
    plan_.duration = c.duration;
    plan_.channel_count = CarChannel::kCount;
    problem_.triggered = !plan.snapshot;
    create(options);
  }
  ReferenceRun(const ReferenceRun&) = delete;
  ReferenceRun& operator=(const ReferenceRun&) = delete;

  LaneResults run() {
    prepare_results();
    double t = 0.0;
    record_due(t);
    while (t < plan_.duration) {
      const double target = sample_ < results_.sample_count
                                ? calc_sample_time<double>(plan_, sample_)
                                : plan_.duration;
      const int flag = CVode(cvode_.raw, std::min(target, plan_.duration), y_.get(), &t, CV_NORMAL);
      if (flag < 0) {
        results_.status[0] = static_cast<int>(system_.get_failure(0));
        results_.failure_time[0] = t;
        break;
      }
      if (flag == CV_ROOT_RETURN) pass_roots(t);
      record_due(t);
    }
    results_.derivative_count = problem_.derivatives;
    results_.final_state.assign(state_.begin(), state_.begin() + system_.size());
    return std::move(results_);
  }

 private:
  void create(const ReferenceOptions& options) {
    system_.start(state_.data());
    double decay[kMaxStiff] = {};
    State<double> dx{};
    system_.calc_derivative(0.0, state_.data(), dx.data(), decay);
    const Workspace<double>& ws = system_.workspace();
    double fastest = *std::max_element(ws.spin_decay.begin(), ws.spin_decay.end());
    if (system_.vehicle().effects.has_states()) {
      fastest = std::max(fastest, *std::max_element(ws.strut_decay.begin(), ws.strut_decay.end()));
    }
    const bool stiff = fastest > kStiffDecay;
    const int n = system_.size();
    y_.reset(N_VMake_Serial(n, state_.data(), context_.raw));
    cvode_.raw = CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context_.raw);
    check(CVodeInit(cvode_.raw, calc_rhs, 0.0, y_.get()), "CVodeInit");
    CVodeSetUserData(cvode_.raw, &problem_);
    CVodeSStolerances(cvode_.raw, options.relative_tolerance, options.absolute_tolerance);
    CVodeSetMaxNumSteps(cvode_.raw, 10000000);
    CVodeSetMaxStep(cvode_.raw, 2e-3);  // no step may jump over the bump
    CVodeSetErrHandlerFn(
        cvode_.raw, [](int, const char*, const char*, char*, void*) {}, nullptr);
    if (stiff) {
      matrix_.reset(SUNDenseMatrix(n, n, context_.raw));
      linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_.raw));
      check(CVodeSetLinearSolver(cvode_.raw, linear_.get(), matrix_.get()), "CVodeSetLinearSolver");
    } else {
      nonlinear_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_.raw));
      check(CVodeSetNonlinearSolver(cvode_.raw, nonlinear_.get()), "CVodeSetNonlinearSolver");
    }
    check(CVodeRootInit(cvode_.raw, system_.guard_count() + 1, calc_roots), "CVodeRootInit");
  }

  static void check(int flag, const char* what) {
    if (flag < 0) throw std::runtime_error(std::string(what) + " failed");
  }

  void prepare_results() {
    results_.lanes = 1;
    results_.status.assign(1, 0);
    results_.failure_time.assign(1, plan_.duration);
    results_.event_time.assign(1, std::nan(""));
    results_.snapshot.assign(CarChannel::kCount, std::nan(""));
    results_.sample_count = count_samples(plan_);
    results_.recorded = plan_.recorded;
    results_.history.assign(static_cast<std::size_t>(results_.sample_count) *
                                static_cast<std::size_t>(plan_.recorded_count()),
                            std::nan(""));
  }

  void observe(double t, double* out) {
    State<double> dx{};
    double decay[kMaxStiff];
    system_.calc_derivative(t, state_.data(), dx.data(), decay);
    system_.observe(t, state_.data(), out);
  }

  void record_due(double t) {
    while (sample_ < results_.sample_count &&
           calc_sample_time<double>(plan_, sample_) <= t + 1e-12) {
      std::array<double, CarChannel::kCount> all;
      observe(t, all.data());
      double* row = results_.history.data() + static_cast<std::size_t>(sample_) *
                                                  static_cast<std::size_t>(plan_.recorded_count());
      if (plan_.recorded.empty()) std::copy(all.begin(), all.end(), row);
      for (const int c : plan_.recorded) *row++ = all[static_cast<std::size_t>(c)];
      ++sample_;
    }
  }

  /// Restarts after a contact event, whose kink no multistep formula may span.
  void pass_roots(double t) {
    int found[kMaxRoots] = {};
    CVodeGetRootInfo(cvode_.raw, found);
    const int guards = system_.guard_count();
    if (found[guards] > 0) {
      problem_.triggered = true;
      results_.event_time[0] = t;
      observe(t, results_.snapshot.data());
    }
    bool restart = false;
    for (int g = 0; g < guards; ++g) {
      if (found[g] == 0) continue;
      system_.cross(g, true);
      restart = true;
      ++results_.event_count;
    }
    if (restart) check(CVodeReInit(cvode_.raw, t, y_.get()), "CVodeReInit");
  }

  SundialsContext context_;
  NewtonClosure<double> newton_;
  TableClosure<double, double> table_;
  CarSystem<double> system_;
  Problem problem_;
  SamplePlan plan_;
  State<double> state_;
  LaneResults results_;
  int sample_ = 0;
  SundialsPointer<_generic_N_Vector> y_;
  SundialsPointer<_generic_SUNMatrix> matrix_;
  SundialsPointer<_generic_SUNLinearSolver> linear_;
  SundialsPointer<_generic_SUNNonlinearSolver> nonlinear_;
  CvodeMemory cvode_;  // last: freed before what it uses
};

}  // namespace

LaneResults run_cvode(const PreparedCase& c, const ReferenceOptions& options,
                      const SamplePlan& plan) {
  return ReferenceRun(c, options, plan).run();
}

}  // namespace strut
