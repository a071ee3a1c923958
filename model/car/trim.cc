#include "model/car/trim.h"

#include <fmt/format.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/car/dynamics.h"
#include "model/integrate/sundials.h"

namespace strut {
namespace {

using I = StateIndex;

/// Unknowns u of a trim, and its equations r: the acceleration of each unknown. At rest the
/// unknowns from kSpinSlip on do not exist.
enum Unknown : int {
  kHeight = 0,
  kRoll = 1,
  kPitch = 2,
  kCorner = 3,                     // a coordinate for each corner
  kSpinSlip = kCorner + kCorners,  // for each wheel the deviation from the speed of free rolling
  kUnknowns = kSpinSlip + kCorners
};

/// Units of the unknowns, so that they are of order one.
constexpr double kLengthUnit = 1e-2;  // m
constexpr double kAngleUnit = 1e-2;   // rad
constexpr double kSlipUnit = 1e-2;    // relative to the speed of free rolling
/// Weights of the corner and spin accelerations relative to those of the chassis.
constexpr double kCornerWeight = 0.1;
constexpr double kSpinWeight = 1e-3;

constexpr double kMaxResidual = 1e-8;  // m/s^2

struct TrimProblem {
  const Vehicle<double>* vehicle;
  TableClosure<double, double> closure;
  double center_height = 0.0;  // m, at nominal trim
  double speed = 0.0;          // m/s
  bool rolling = false;
  Workspace<double> workspace{};

  int size() const { return rolling ? kUnknowns : kSpinSlip; }
};

State<double> make_state(const TrimProblem& p, const double* u) {
  State<double> x{};
  const double roll = kAngleUnit * u[kRoll], pitch = kAngleUnit * u[kPitch];
  const double cr = std::cos(0.5 * roll), sr = std::sin(0.5 * roll);
  const double cp = std::cos(0.5 * pitch), sp = std::sin(0.5 * pitch);
  x[I::kPosition + 2] = p.center_height + kLengthUnit * u[kHeight];
  x[I::kQuaternion] = cp * cr;  // pitch about y, then roll about the pitched x
  x[I::kQuaternion + 1] = cp * sr;
  x[I::kQuaternion + 2] = sp * cr;
  x[I::kQuaternion + 3] = -sp * sr;
  for (int c = 0; c < kCorners; ++c) x[I::kCorner + c] = kLengthUnit * u[kCorner + c];
  if (!p.rolling) return x;
  const Vec3<double> v =
      transpose_times(rotation_of(get_quaternion(x.data())), Vec3<double>{p.speed, 0.0, 0.0});
  set_vec3(x.data(), I::kVelocity, v);
  for (int c = 0; c < kCorners; ++c) {
    const double radius = p.vehicle->numbers.tire[axle_of(c)].radius;
    x[I::kSpin + c] = p.speed / radius * (1.0 + kSlipUnit * u[kSpinSlip + c]);
  }
  return x;
}

/// Sets the relaxed slips of all tires to their steady values.
void settle_slips(const Workspace<double>& ws, State<double>& x) {
  for (int c = 0; c < kCorners; ++c) {
    x[I::kKappa + c] = ws.slip[c].kappa;
    x[I::kTanAlpha + c] = ws.slip[c].tan_alpha;
  }
}

/// dx/dt at x; with relaxation the slips of x are settled first.
void evaluate(TrimProblem& p, State<double>& x, State<double>& dx) {
  const TireMode mode = p.rolling ? TireMode::kRolling : TireMode::kFrictionless;
  calc_derivative(*p.vehicle, p.closure, mode, x.data(), dx.data(), p.workspace);
  if (p.rolling && p.vehicle->layout.relaxation) {
    settle_slips(p.workspace, x);
    calc_derivative(*p.vehicle, p.closure, mode, x.data(), dx.data(), p.workspace);
  }
}

/// Writes the weighted accelerations relative to steady motion [m/s^2, rad/s^2] at the unknowns u
/// and the state x of these unknowns. False where they are not finite.
bool calc_residual(TrimProblem& p, const double* u, State<double>& x, double* r) {
  x = make_state(p, u);
  State<double> dx{};
  evaluate(p, x, dx);
  const Workspace<double>& ws = p.workspace;
  const Vec3<double> acceleration = ws.rotation * ws.acceleration;
  r[kHeight] = acceleration.z;
  r[kRoll] = ws.angular_acceleration.x;
  r[kPitch] = ws.angular_acceleration.y;
  for (int c = 0; c < kCorners; ++c) r[kCorner + c] = kCornerWeight * ws.corner_acceleration[c];
  if (p.rolling) {
    for (int c = 0; c < kCorners; ++c) {
      const double steady = acceleration.x * x[I::kSpin + c] / p.speed;
      r[kSpinSlip + c] = kSpinWeight * (dx[I::kSpin + c] - steady);
    }
  }
  return std::all_of(r, r + p.size(), [](double v) { return std::isfinite(v); });
}

int calc_kinsol_residual(N_Vector u, N_Vector f, void* data) {
  State<double> x;
  const bool finite = calc_residual(*static_cast<TrimProblem*>(data), N_VGetArrayPointer(u), x,
                                    N_VGetArrayPointer(f));
  return finite ? 0 : 1;
}

/// Solves calc_residual = 0 for u by KINSOL, whose flag is ignored: the residual at u decides.
void solve_with_kinsol(TrimProblem& p, double* u) {
  const SundialsContext context;
  const int n = p.size();
  const SundialsPointer<_generic_N_Vector> x(N_VMake_Serial(n, u, context.raw));
  const SundialsPointer<_generic_N_Vector> one(N_VNew_Serial(n, context.raw));
  N_VConst(1.0, one.get());
  const SundialsPointer<_generic_SUNMatrix> matrix(SUNDenseMatrix(n, n, context.raw));
  const SundialsPointer<_generic_SUNLinearSolver> solver(
      SUNLinSol_Dense(x.get(), matrix.get(), context.raw));
  void* kin = KINCreate(context.raw);
  const std::unique_ptr<void*, void (*)(void**)> memory(&kin, [](void** k) { KINFree(k); });
  KINSetUserData(kin, &p);
  KINInit(kin, calc_kinsol_residual, x.get());
  KINSetLinearSolver(kin, solver.get(), matrix.get());
  KINSetFuncNormTol(kin, 1e-11);
  KINSetScaledStepTol(kin, 1e-14);
  KINSetMaxSetupCalls(kin, 3);
  KINSetMaxNewtonStep(kin, 100.0);  // the default is derived from the start, which is zero
  KINSetNumMaxIters(kin, 100);
  KINSetPrintLevel(kin, 0);
  KINSetErrHandlerFn(
      kin, [](int, const char*, const char*, char*, void*) {}, nullptr);
  KINSol(kin, x.get(), KIN_LINESEARCH, one.get(), one.get());
}

TrimResult solve(TrimProblem p) {
  std::array<double, kUnknowns> u{}, residual{};
  solve_with_kinsol(p, u.data());
  TrimResult result{};
  const bool finite = calc_residual(p, u.data(), result.state, residual.data());
  for (int i = 0; i < p.size(); ++i) {
    result.residual = std::max(result.residual, std::abs(residual[i]));
  }
  for (int c = 0; c < kCorners; ++c) result.load[c] = p.workspace.contact[c].load;
  if (finite && result.residual < kMaxResidual && !(p.workspace.travel_excess > 0.0)) return result;
  throw ModelError(fmt::format(
      "the car has no equilibrium {} within +/-{:g} mm of travel (residual {:g} m/s^2): a spring "
      "is too soft for its load, or another parameter is far from plausible",
      p.rolling ? "rolling" : "at rest", 1e3 * p.closure.tables->half_travel, result.residual));
}

TrimProblem make_problem(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                         double center_height) {
  TrimProblem problem{};
  problem.vehicle = &vehicle;
  problem.closure.tables = &tables;
  problem.center_height = center_height;
  return problem;
}

}  // namespace

TrimResult solve_rest(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                      double center_height) {
  return solve(make_problem(vehicle, tables, center_height));
}

TrimResult solve_rolling(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                         double center_height, double speed) {
  TrimProblem problem = make_problem(vehicle, tables, center_height);
  problem.rolling = true;
  problem.speed = speed;
  return solve(problem);
}

}  // namespace strut
