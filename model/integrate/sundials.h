// Ownership of the objects that SUNDIALS allocates.
#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>

#include <memory>

namespace strut {

struct SundialsDeleter {
  void operator()(_generic_N_Vector* v) const { N_VDestroy(v); }
  void operator()(_generic_SUNMatrix* m) const { SUNMatDestroy(m); }
  void operator()(_generic_SUNLinearSolver* s) const { SUNLinSolFree(s); }
  void operator()(_generic_SUNNonlinearSolver* s) const { SUNNonlinSolFree(s); }
};

/// N_Vector, SUNMatrix, SUNLinearSolver and SUNNonlinearSolver are pointers to these types.
template <class Object>
using SundialsPointer = std::unique_ptr<Object, SundialsDeleter>;

struct SundialsContext {
  SundialsContext() { SUNContext_Create(nullptr, &raw); }
  ~SundialsContext() { SUNContext_Free(&raw); }
  SundialsContext(const SundialsContext&) = delete;
  SundialsContext& operator=(const SundialsContext&) = delete;
  SUNContext raw = nullptr;
};

}  // namespace strut
