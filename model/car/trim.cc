#include "model/car/trim.h"

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "model/car/dynamics.h"
#include "model/integrate/sundials.h"

namespace strut {
namespace {

using I = StateIndex;

/// Unknowns: height, roll, pitch, four corner coordinates; rolling also four spins.
constexpr int kRestUnknowns = 3 + kCorners;
constexpr int kRollingUnknowns = kRestUnknowns + kCorners;

struct TrimProblem {
  const Vehicle<double>* vehicle;
  TableClosure<double, double> closure;
  double center_height = 0.0;
  double speed = 0.0;
  bool rolling = false;
  Workspace<double> workspace{};

  int unknowns() const { return rolling ? kRollingUnknowns : kRestUnknowns; }
  /// Unknowns are of order one: centimeters, hundredths of a radian, hundredths of rolling speed.
  static constexpr double kLength = 1e-2, kAngle = 1e-2, kSlip = 1e-2;
};

State<double> make_state(const TrimProblem& p, const double* u) {
  State<double> x{};
  const double roll = TrimProblem::kAngle * u[1], pitch = TrimProblem::kAngle * u[2];
  const double cr = std::cos(0.5 * roll), sr = std::sin(0.5 * roll);
  const double cp = std::cos(0.5 * pitch), sp = std::sin(0.5 * pitch);
  x[I::kPosition + 2] = p.center_height + TrimProblem::kLength * u[0];
  x[I::kQuaternion] = cp * cr;  // pitch about y, then roll about the pitched x
  x[I::kQuaternion + 1] = cp * sr;
  x[I::kQuaternion + 2] = sp * cr;
  x[I::kQuaternion + 3] = -sp * sr;
  for (int c = 0; c < kCorners; ++c) x[I::kCorner + c] = TrimProblem::kLength * u[3 + c];
  if (!p.rolling) return x;
  const Vec3<double> v =
      transpose_times(rotation_of(get_quaternion(x.data())), Vec3<double>{p.speed, 0.0, 0.0});
  set_vec3(x.data(), I::kVelocity, v);
  for (int c = 0; c < kCorners; ++c) {
    const double radius = p.vehicle->numbers.tire[axle_of(c)].radius;
    x[I::kSpin + c] = p.speed / radius * (1.0 + TrimProblem::kSlip * u[7 + c]);
  }
  return x;
}

/// Steady slip of every tire, so that relaxation starts at rest.
void settle_slips(const Workspace<double>& ws, State<double>& x) {
  for (int c = 0; c < kCorners; ++c) {
    x[I::kKappa + c] = ws.slip[c].kappa;
    x[I::kTanAlpha + c] = ws.slip[c].tan_alpha;
  }
}

void evaluate(TrimProblem& p, State<double>& x, State<double>& dx) {
  const TireMode mode = p.rolling ? TireMode::kRolling : TireMode::kFrictionless;
  calc_derivative(*p.vehicle, p.closure, mode, x.data(), dx.data(), p.workspace);
  if (p.rolling && p.vehicle->layout.relaxation) {
    settle_slips(p.workspace, x);
    calc_derivative(*p.vehicle, p.closure, mode, x.data(), dx.data(), p.workspace);
  }
}

/// Accelerations relative to steady motion, scaled to order one [1 = 1 m/s^2 or rad/s^2]; x is the
/// state of unknowns u. False if not finite.
bool calc_residual(TrimProblem& p, const double* u, State<double>& x, double* r) {
  x = make_state(p, u);
  State<double> dx{};
  evaluate(p, x, dx);
  const Workspace<double>& ws = p.workspace;
  const Vec3<double> acceleration = ws.rotation * ws.acceleration;
  r[0] = acceleration.z;
  r[1] = ws.angular_acceleration.x;
  r[2] = ws.angular_acceleration.y;
  for (int c = 0; c < kCorners; ++c) r[3 + c] = 0.1 * ws.corner_acceleration[c];
  if (p.rolling) {
    for (int c = 0; c < kCorners; ++c) {
      const double steady = acceleration.x * x[I::kSpin + c] / p.speed;
      r[7 + c] = 1e-3 * (dx[I::kSpin + c] - steady);
    }
  }
  return std::all_of(r, r + p.unknowns(), [](double v) { return std::isfinite(v); });
}

int calc_kinsol_residual(N_Vector u, N_Vector f, void* data) {
  State<double> x;
  const bool finite = calc_residual(*static_cast<TrimProblem*>(data), N_VGetArrayPointer(u), x,
                                    N_VGetArrayPointer(f));
  return finite ? 0 : 1;
}

/// Solution u of calc_residual = 0 by KINSOL; returns its flag.
int solve_with_kinsol(TrimProblem& p, double* u) {
  const SundialsContext context;
  const int n = p.unknowns();
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
  KINSetMaxNewtonStep(kin, 100.0);  // the default derives from the start, which is zero
  KINSetNumMaxIters(kin, 100);
  KINSetPrintLevel(kin, 0);
  KINSetErrHandlerFn(
      kin, [](int, const char*, const char*, char*, void*) {}, nullptr);
  return KINSol(kin, x.get(), KIN_LINESEARCH, one.get(), one.get());
}

[[noreturn]] void fail(const TrimProblem& p, double residual) {
  std::ostringstream message;
  message << "static equilibrium: the car finds none " << (p.rolling ? "rolling" : "at rest")
          << " within +-" << 1e3 * p.closure.tables->half_travel << " mm of travel (residual "
          << residual << " m/s^2); a spring is too soft for its load, or a parameter is far off";
  throw ModelError(message.str());
}

TrimResult solve(TrimProblem p) {
  std::array<double, kRollingUnknowns> u{}, residual{};
  solve_with_kinsol(p, u.data());
  TrimResult result{};
  const bool finite = calc_residual(p, u.data(), result.state, residual.data());
  for (int i = 0; i < p.unknowns(); ++i) {
    result.residual = std::max(result.residual, std::abs(residual[i]));
  }
  for (int c = 0; c < kCorners; ++c) result.load[c] = p.workspace.contact[c].load;
  // KINSOL's flag is no judge: what counts is whether the car stands still, inside its travel.
  if (!finite || !(result.residual < 1e-8) || p.workspace.travel_excess > 0.0) {
    fail(p, result.residual);
  }
  return result;
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
