// The reference integrator: SUNDIALS CVODE with contact events and the snapshot as roots.

#include <cvode/cvode.h>
#include <fmt/format.h>
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

using System = CarSystem<double>;

/// Decay rate of spin or strut [1/s] above which the implicit BDF formulas cost less than Adams
/// formulas with fixed-point iteration, whose step the rate bounds.
constexpr double kStiffDecay = 5000.0;
constexpr double kMaxStep = 2e-3;  // s; no step may jump over the bump
/// s; towards a state that has no derivative, as at the end of a corner's travel, steps would
/// shrink for ever.
constexpr double kMinStep = 1e-12;
constexpr long kMaxSteps = 10000000;
constexpr int kMaxRoots = 2 * kCorners + 1;  // the guards, then the trigger

/// User data of CVODE's callbacks.
struct Problem {
  System* system;
  long derivatives = 0;
  bool triggered = false;  // the snapshot is taken, its root is switched off
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

void check(int flag, const char* function) {
  if (flag < 0) throw std::runtime_error(fmt::format("{} failed with flag {}", function, flag));
}

/// Owns CVODE's memory block.
struct CvodeMemory {
  CvodeMemory() = default;
  ~CvodeMemory() { CVodeFree(&raw); }
  CvodeMemory(const CvodeMemory&) = delete;
  CvodeMemory& operator=(const CvodeMemory&) = delete;
  void* raw = nullptr;
};

/// CVODE set up for one problem; owns everything that SUNDIALS allocates.
class Cvode {
 public:
  /// Integrates `state` in place from t = 0; problem and state must outlive this.
  Cvode(Problem& problem, State<double>& state, bool stiff, const ReferenceOptions& options)
      : y_(N_VMake_Serial(problem.system->size(), state.data(), context_.raw)) {
    memory_.raw = CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context_.raw);
    check(CVodeInit(memory_.raw, calc_rhs, 0.0, y_.get()), "CVodeInit");
    CVodeSetUserData(memory_.raw, &problem);
    CVodeSStolerances(memory_.raw, options.relative_tolerance, options.absolute_tolerance);
    CVodeSetMaxNumSteps(memory_.raw, kMaxSteps);
    CVodeSetMaxStep(memory_.raw, kMaxStep);
    CVodeSetMinStep(memory_.raw, kMinStep);
    CVodeSetErrHandlerFn(
        memory_.raw, [](int, const char*, const char*, char*, void*) {}, nullptr);
    stiff ? set_newton_solver(problem.system->size()) : set_fixed_point_solver();
    check(CVodeRootInit(memory_.raw, problem.system->guard_count() + 1, calc_roots),
          "CVodeRootInit");
  }

  /// Integrates from `t` to the next root or to `target`; returns CVODE's flag.
  int advance(double target, double& t) {
    return CVode(memory_.raw, target, y_.get(), &t, CV_NORMAL);
  }

  /// Direction in which each root was crossed, 0 where it was not.
  std::array<int, kMaxRoots> get_roots() const {
    std::array<int, kMaxRoots> roots{};
    CVodeGetRootInfo(memory_.raw, roots.data());
    return roots;
  }

  /// Discards the history of the multistep formulas.
  void restart(double t) { check(CVodeReInit(memory_.raw, t, y_.get()), "CVodeReInit"); }

 private:
  void set_newton_solver(int n) {
    matrix_.reset(SUNDenseMatrix(n, n, context_.raw));
    linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_.raw));
    check(CVodeSetLinearSolver(memory_.raw, linear_.get(), matrix_.get()), "CVodeSetLinearSolver");
  }
  void set_fixed_point_solver() {
    nonlinear_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_.raw));
    check(CVodeSetNonlinearSolver(memory_.raw, nonlinear_.get()), "CVodeSetNonlinearSolver");
  }

  SundialsContext context_;
  SundialsPointer<_generic_N_Vector> y_;
  SundialsPointer<_generic_SUNMatrix> matrix_;
  SundialsPointer<_generic_SUNLinearSolver> linear_;
  SundialsPointer<_generic_SUNNonlinearSolver> nonlinear_;
  CvodeMemory memory_;  // last member, because it is freed before the objects that it uses
};

/// Whether a decay rate at the start exceeds kStiffDecay.
bool is_stiff(System& system, const State<double>& start) {
  double decay[kMaxStiff] = {};
  State<double> dx{};
  system.calc_derivative(0.0, start.data(), dx.data(), decay);
  const Workspace<double>& ws = system.workspace();
  double fastest = *std::max_element(ws.spin_decay.begin(), ws.spin_decay.end());
  if (system.vehicle().effects.has_states()) {
    fastest = std::max(fastest, *std::max_element(ws.strut_decay.begin(), ws.strut_decay.end()));
  }
  return fastest > kStiffDecay;
}

/// Results of a plan before the first sample.
LaneResults make_results(const SamplePlan& plan) {
  LaneResults results;
  results.status.assign(1, 0);
  results.failure_time.assign(1, plan.duration);
  results.event_time.assign(1, std::nan(""));
  results.snapshot.assign(CarChannel::kCount, std::nan(""));
  results.sample_count = count_samples(plan);
  results.recorded = plan.recorded;
  results.history.assign(static_cast<std::size_t>(results.sample_count) *
                             static_cast<std::size_t>(plan.recorded_count()),
                         std::nan(""));
  return results;
}

/// A run as far as it is recorded.
struct Recording {
  SamplePlan plan;
  LaneResults results;
  int sample = 0;  // the next one

  double get_next_time() const {
    return sample < results.sample_count ? calc_sample_time<double>(plan, sample) : plan.duration;
  }
};

void observe(System& system, double t, const State<double>& state, double* out) {
  State<double> dx{};
  double decay[kMaxStiff];
  system.calc_derivative(t, state.data(), dx.data(), decay);
  system.observe(t, state.data(), out);
}

/// Records the samples that are due at t.
void record_samples(System& system, double t, const State<double>& state, Recording& recording) {
  LaneResults& results = recording.results;
  while (recording.sample < results.sample_count && recording.get_next_time() <= t + 1e-12) {
    std::array<double, CarChannel::kCount> all;
    observe(system, t, state, all.data());
    const SamplePlan& plan = recording.plan;
    double* row = results.history.data() + static_cast<std::size_t>(recording.sample) *
                                               static_cast<std::size_t>(plan.recorded_count());
    if (plan.recorded.empty()) std::copy(all.begin(), all.end(), row);
    for (const int c : plan.recorded) *row++ = all[static_cast<std::size_t>(c)];
    ++recording.sample;
  }
}

/// Takes the snapshot at its root. After a contact event restarts the integrator, because no
/// multistep formula may span the kink.
void pass_roots(double t, const State<double>& state, Problem& problem, Cvode& cvode,
                LaneResults& results) {
  const std::array<int, kMaxRoots> crossed = cvode.get_roots();
  const int guards = problem.system->guard_count();
  if (crossed[static_cast<std::size_t>(guards)] > 0) {
    problem.triggered = true;
    results.event_time[0] = t;
    observe(*problem.system, t, state, results.snapshot.data());
  }
  bool restart = false;
  for (int g = 0; g < guards; ++g) {
    if (crossed[static_cast<std::size_t>(g)] == 0) continue;
    problem.system->cross(g, true);
    restart = true;
    ++results.event_count;
  }
  if (restart) cvode.restart(t);
}

}  // namespace

LaneResults run_cvode(const PreparedCase& c, const ReferenceOptions& options, SamplePlan plan) {
  plan.duration = c.duration;
  plan.channel_count = CarChannel::kCount;
  const NewtonClosure<double> newton{&c.vehicle.layout, &c.vehicle.numbers};
  const TableClosure<double, double> table{&c.mechanism->tables};
  System system = options.closure == Closure::kNewton
                      ? System(c.vehicle, newton, SpinTreatment::kExplicit, c.trigger_x)
                      : System(c.vehicle, table, SpinTreatment::kExplicit, c.trigger_x);
  State<double> state = c.start;
  system.start(state.data());
  Problem problem{.system = &system, .triggered = !plan.snapshot};
  Cvode cvode(problem, state, is_stiff(system, state), options);

  Recording recording{plan, make_results(plan)};
  LaneResults& results = recording.results;
  double t = 0.0;
  record_samples(system, t, state, recording);
  while (t < plan.duration) {
    const int flag = cvode.advance(std::min(recording.get_next_time(), plan.duration), t);
    if (flag < 0 && plan.until_snapshot && results.has_snapshot()) break;
    if (flag < 0) {
      results.status[0] = static_cast<int>(system.get_failure(0));
      results.failure_time[0] = t;
      break;
    }
    if (flag == CV_ROOT_RETURN) pass_roots(t, state, problem, cvode, results);
    if (plan.until_snapshot && results.sample_count == 0 && results.has_snapshot()) break;
    record_samples(system, t, state, recording);
  }
  results.derivative_count = problem.derivatives;
  results.final_state.assign(state.begin(), state.begin() + system.size());
  return std::move(recording.results);
}

}  // namespace strut
