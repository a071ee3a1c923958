#include "tests/reference/reference_trajectory.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>

namespace strut::reference {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kStateSize = 25;
constexpr std::size_t kWheels = kCorners;

VectorXd pack(const ReducedState& s) {
  VectorXd y(kStateSize);
  y << s.position, s.quaternion, Eigen::Map<const Eigen::Vector4d>(s.q.data()), s.velocity,
      s.angular_velocity, Eigen::Map<const Eigen::Vector4d>(s.q_dot.data()),
      Eigen::Map<const Eigen::Vector4d>(s.spin.data());
  return y;
}

ReducedState unpack(const double* data) {
  const Eigen::Map<const Eigen::Matrix<double, kStateSize, 1>> y(data);
  ReducedState s;
  s.position = y.segment<3>(0);
  s.quaternion = y.segment<4>(3);
  s.velocity = y.segment<3>(11);
  s.angular_velocity = y.segment<3>(14);
  for (std::size_t i = 0; i < kWheels; ++i) {
    s.q[i] = y[static_cast<Index>(7 + i)];
    s.q_dot[i] = y[static_cast<Index>(17 + i)];
    s.spin[i] = y[static_cast<Index>(21 + i)];
  }
  return s;
}

/// dQ/dt = Q (0, w) / 2, w in chassis axes.
Eigen::Vector4d calc_quaternion_rate(const Eigen::Vector4d& wxyz, const Vector3d& w) {
  const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const Eigen::Quaterniond rate = q * Eigen::Quaterniond(0.0, w.x(), w.y(), w.z());
  return 0.5 * Eigen::Vector4d(rate.w(), rate.x(), rate.y(), rate.z());
}

/// Data of CVODE's callbacks; the last closed state starts the next Newton iteration.
struct Problem {
  const FullCoordinateCar& car;
  std::vector<std::vector<double>> kinks;  // by corner
  ReferenceState last;
  bool has_last = false;
  std::string failure;

  const ReferenceState& assemble(const double* y) {
    last = car.assemble(unpack(y), has_last ? &last : nullptr);
    has_last = true;
    return last;
  }
};

int calc_rates(double, N_Vector y, N_Vector y_dot, void* user) {
  auto& problem = *static_cast<Problem*>(user);
  try {
    const ReferenceState& state = problem.assemble(N_VGetArrayPointer(y));
    const ReducedState& s = state.reduced;
    const ReducedAcceleration a = problem.car.calc_accelerations(state);
    ReducedState rate;
    rate.position = state.bodies[0].orientation * s.velocity;
    rate.quaternion = calc_quaternion_rate(s.quaternion, s.angular_velocity);
    rate.q = s.q_dot;
    rate.velocity = a.linear;
    rate.angular_velocity = a.angular;
    rate.q_dot = a.q_ddot;
    rate.spin = a.spin_dot;
    Eigen::Map<VectorXd>(N_VGetArrayPointer(y_dot), kStateSize) = pack(rate);
    return 0;
  } catch (const std::exception& error) {
    problem.failure = error.what();
    return -1;
  }
}

/// Zero where a tire touches the road, where its load vanishes, and at kinks of the road.
int calc_events(double, N_Vector y, double* events, void* user) {
  auto& problem = *static_cast<Problem*>(user);
  try {
    const ReferenceState& state = problem.assemble(N_VGetArrayPointer(y));
    for (int corner = 0; corner < kCorners; ++corner) {
      const WheelContact contact = problem.car.calc_contact(state, corner);
      *events++ = contact.deflection;
      *events++ = contact.raw_load / problem.car.forces().tire.stiffness;
      const double x = problem.car.get_wheel_center(state, corner).x();
      for (const double kink : problem.kinks[static_cast<std::size_t>(corner)]) {
        *events++ = x - kink;
      }
    }
    return 0;
  } catch (const std::exception& error) {
    problem.failure = error.what();
    return -1;
  }
}

/// CVODE's objects, freed together.
class Solver {
 public:
  Solver(Problem* problem, const ReducedState& initial, const TrajectoryOptions& options)
      : problem_(*problem) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    y_ = N_VNew_Serial(kStateSize, context_);
    Eigen::Map<VectorXd>(N_VGetArrayPointer(y_), kStateSize) = pack(initial);
    memory_ = CVodeCreate(CV_ADAMS, context_);
    check(CVodeInit(memory_, calc_rates, 0.0, y_), "CVodeInit");
    check(CVodeSStolerances(memory_, options.tolerance, options.tolerance), "CVodeSStolerances");
    check(CVodeSetUserData(memory_, problem), "CVodeSetUserData");
    iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
    check(CVodeSetNonlinearSolver(memory_, iteration_), "CVodeSetNonlinearSolver");
    check(CVodeSetMaxNumSteps(memory_, options.max_steps), "CVodeSetMaxNumSteps");
    int events = 2 * kCorners;
    for (const auto& kinks : problem->kinks) events += static_cast<int>(kinks.size());
    check(CVodeRootInit(memory_, events, calc_events), "CVodeRootInit");
  }
  ~Solver() {
    CVodeFree(&memory_);
    SUNNonlinSolFree(iteration_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  ReducedState advance(double time, TrajectoryStatistics* statistics) {
    while (now_ < time) {
      const int flag = CVode(memory_, time, y_, &now_, CV_NORMAL);
      check(flag, "CVode");
      if (flag != CV_ROOT_RETURN) continue;
      count(statistics);
      ++statistics->events;
      check(CVodeReInit(memory_, now_, y_), "CVodeReInit");
    }
    return unpack(N_VGetArrayPointer(y_));
  }

  /// Adds what CVODE counted since its last start.
  void count(TrajectoryStatistics* statistics) {
    long steps = 0, evaluations = 0;
    CVodeGetNumSteps(memory_, &steps);
    CVodeGetNumRhsEvals(memory_, &evaluations);
    statistics->steps += steps;
    statistics->evaluations += evaluations;
  }

 private:
  void check(int flag, const char* function) const {
    if (flag >= 0) return;
    throw std::runtime_error(std::string("full-coordinate model: ") + function + " returned " +
                             std::to_string(flag) + " at t = " + std::to_string(now_) + ": " +
                             problem_.failure);
  }

  Problem& problem_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
  double now_ = 0.0;
};

}  // namespace

std::vector<ReducedState> integrate(const FullCoordinateCar& car, const ReducedState& initial,
                                    const std::vector<double>& times,
                                    const TrajectoryOptions& options,
                                    TrajectoryStatistics* statistics) {
  Problem problem{car, {}, {}, false, {}};
  for (int corner = 0; corner < kCorners; ++corner) {
    problem.kinks.push_back(car.forces().laws.kinks(corner));
  }
  Solver solver(&problem, initial, options);
  TrajectoryStatistics counts;
  std::vector<ReducedState> samples;
  samples.reserve(times.size());
  for (const double time : times) samples.push_back(solver.advance(time, &counts));
  solver.count(&counts);
  if (statistics != nullptr) *statistics = counts;
  return samples;
}

}  // namespace strut::reference
