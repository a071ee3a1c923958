#include "model/car/trim.h"

#include <fmt/format.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/car/trim_equations.h"
#include "model/integrate/sundials.h"

namespace strut {
namespace {

using Problem = TrimProblem<double, double>;

bool is_finite(const Problem& p, const double* r) {
  return std::all_of(r, r + p.size(), [](double v) { return std::isfinite(v); });
}

int calc_kinsol_residual(N_Vector u, N_Vector f, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  double* r = N_VGetArrayPointer(f);
  calc_trim_residual(problem, N_VGetArrayPointer(u), r);
  return is_finite(problem, r) ? 0 : 1;
}

/// Solves calc_trim_residual = 0 for u by KINSOL, whose flag is ignored: the residual at u decides.
void solve_with_kinsol(Problem& p, double* u) {
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

TrimResult solve(Problem p) {
  std::array<double, TrimIndex::kCount> u{}, residual{};
  solve_with_kinsol(p, u.data());
  TrimResult result{};
  result.state = calc_trim_residual(p, u.data(), residual.data());
  for (int i = 0; i < p.size(); ++i) {
    result.residual = std::max(result.residual, std::abs(residual[i]));
  }
  for (int c = 0; c < kCorners; ++c) result.load[c] = p.workspace.contact[c].load;
  if (is_finite(p, residual.data()) && result.residual < kMaxTrimResidual &&
      !(p.workspace.travel_excess > 0.0))
    return result;
  throw ModelError(fmt::format(
      "the car has no equilibrium {} within +/-{:g} mm of travel (residual {:g} m/s^2): a spring "
      "is too soft for its load, or another parameter is far from plausible",
      p.rolling ? "rolling" : "at rest", 1e3 * p.closure.tables->half_travel, result.residual));
}

}  // namespace

TrimResult solve_rest(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                      double center_height) {
  return solve({&vehicle, {&tables}, center_height, 0.0, false});
}

TrimResult solve_rolling(const Vehicle<double>& vehicle, const VehicleTables<double>& tables,
                         double center_height, double speed) {
  return solve({&vehicle, {&tables}, center_height, speed, true});
}

}  // namespace strut
