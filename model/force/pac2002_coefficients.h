// Coefficients of a PAC2002 tire, named as in the property file.
#pragma once

namespace strut {

// List of the coefficients: X(section of the .tir, name, default, unit, meaning). The struct and
// the reader are generated from it.
#define STRUT_PAC2002_COEFFICIENTS(X)                                                              \
  X("MODEL", LONGVL, 16.7, "m/s", "speed of the measurement, reference of the rolling resistance") \
  X("DIMENSION", UNLOADED_RADIUS, 0.0, "m", "free radius R0")                                      \
  X("VERTICAL", FNOMIN, 0.0, "N", "nominal load Fz0")                                              \
  X("VERTICAL", BREFF, 0.0, "1", "rolling radius: slope at low load")                              \
  X("VERTICAL", DREFF, 0.0, "1", "rolling radius: peak value")                                     \
  X("VERTICAL", FREFF, 0.0, "1", "rolling radius: slope at high load")                             \
  X("VERTICAL_FORCE_RANGE", FZMIN, 0.0, "N", "minimum load at which the coefficients hold")        \
  X("VERTICAL_FORCE_RANGE", FZMAX, 1e9, "N", "maximum load at which the coefficients hold")        \
  X("SCALING_COEFFICIENTS", LFZO, 1.0, "1", "scale of the nominal load")                           \
  X("SCALING_COEFFICIENTS", LCX, 1.0, "1", "scale of the shape factor of Fx")                      \
  X("SCALING_COEFFICIENTS", LMUX, 1.0, "1", "scale of the peak friction of Fx")                    \
  X("SCALING_COEFFICIENTS", LEX, 1.0, "1", "scale of the curvature of Fx")                         \
  X("SCALING_COEFFICIENTS", LKX, 1.0, "1", "scale of the slip stiffness")                          \
  X("SCALING_COEFFICIENTS", LHX, 1.0, "1", "scale of the horizontal shift of Fx")                  \
  X("SCALING_COEFFICIENTS", LVX, 1.0, "1", "scale of the vertical shift of Fx")                    \
  X("SCALING_COEFFICIENTS", LGAX, 1.0, "1", "scale of camber in Fx")                               \
  X("SCALING_COEFFICIENTS", LCY, 1.0, "1", "scale of the shape factor of Fy")                      \
  X("SCALING_COEFFICIENTS", LMUY, 1.0, "1", "scale of the peak friction of Fy")                    \
  X("SCALING_COEFFICIENTS", LEY, 1.0, "1", "scale of the curvature of Fy")                         \
  X("SCALING_COEFFICIENTS", LKY, 1.0, "1", "scale of the cornering stiffness")                     \
  X("SCALING_COEFFICIENTS", LHY, 1.0, "1", "scale of the horizontal shift of Fy")                  \
  X("SCALING_COEFFICIENTS", LVY, 1.0, "1", "scale of the vertical shift of Fy")                    \
  X("SCALING_COEFFICIENTS", LGAY, 1.0, "1", "scale of camber in Fy")                               \
  X("SCALING_COEFFICIENTS", LTR, 1.0, "1", "scale of the pneumatic trail")                         \
  X("SCALING_COEFFICIENTS", LRES, 1.0, "1", "scale of the residual torque")                        \
  X("SCALING_COEFFICIENTS", LGAZ, 1.0, "1", "scale of camber in Mz")                               \
  X("SCALING_COEFFICIENTS", LXAL, 1.0, "1", "scale of the influence of alpha on Fx")               \
  X("SCALING_COEFFICIENTS", LYKA, 1.0, "1", "scale of the influence of kappa on Fy")               \
  X("SCALING_COEFFICIENTS", LVYKA, 1.0, "1", "scale of the side force induced by kappa")           \
  X("SCALING_COEFFICIENTS", LS, 1.0, "1", "scale of the moment arm of Fx")                         \
  X("SCALING_COEFFICIENTS", LSGKP, 1.0, "1", "scale of the longitudinal relaxation length")        \
  X("SCALING_COEFFICIENTS", LSGAL, 1.0, "1", "scale of the lateral relaxation length")             \
  X("SCALING_COEFFICIENTS", LMX, 1.0, "1", "scale of the overturning couple")                      \
  X("SCALING_COEFFICIENTS", LVMX, 1.0, "1", "scale of the shift of the overturning couple")        \
  X("SCALING_COEFFICIENTS", LMY, 1.0, "1", "scale of the rolling resistance")                      \
  X("LONGITUDINAL_COEFFICIENTS", PCX1, 1.0, "1", "shape factor C")                                 \
  X("LONGITUDINAL_COEFFICIENTS", PDX1, 1.0, "1", "friction at nominal load")                       \
  X("LONGITUDINAL_COEFFICIENTS", PDX2, 0.0, "1", "friction with load")                             \
  X("LONGITUDINAL_COEFFICIENTS", PDX3, 0.0, "1/rad^2", "friction with camber squared")             \
  X("LONGITUDINAL_COEFFICIENTS", PEX1, 0.0, "1", "curvature at nominal load")                      \
  X("LONGITUDINAL_COEFFICIENTS", PEX2, 0.0, "1", "curvature with load")                            \
  X("LONGITUDINAL_COEFFICIENTS", PEX3, 0.0, "1", "curvature with load squared")                    \
  X("LONGITUDINAL_COEFFICIENTS", PEX4, 0.0, "1", "curvature while driving")                        \
  X("LONGITUDINAL_COEFFICIENTS", PKX1, 10.0, "1", "slip stiffness / Fz at nominal load")           \
  X("LONGITUDINAL_COEFFICIENTS", PKX2, 0.0, "1", "slip stiffness with load")                       \
  X("LONGITUDINAL_COEFFICIENTS", PKX3, 0.0, "1", "slip stiffness, exponent with load")             \
  X("LONGITUDINAL_COEFFICIENTS", PHX1, 0.0, "1", "horizontal shift at nominal load")               \
  X("LONGITUDINAL_COEFFICIENTS", PHX2, 0.0, "1", "horizontal shift with load")                     \
  X("LONGITUDINAL_COEFFICIENTS", PVX1, 0.0, "1", "vertical shift / Fz at nominal load")            \
  X("LONGITUDINAL_COEFFICIENTS", PVX2, 0.0, "1", "vertical shift with load")                       \
  X("LONGITUDINAL_COEFFICIENTS", RBX1, 0.0, "1/rad", "combined slip: slope")                       \
  X("LONGITUDINAL_COEFFICIENTS", RBX2, 0.0, "1", "combined slip: slope with kappa")                \
  X("LONGITUDINAL_COEFFICIENTS", RCX1, 1.0, "1", "combined slip: shape factor")                    \
  X("LONGITUDINAL_COEFFICIENTS", REX1, 0.0, "1", "combined slip: curvature")                       \
  X("LONGITUDINAL_COEFFICIENTS", REX2, 0.0, "1", "combined slip: curvature with load")             \
  X("LONGITUDINAL_COEFFICIENTS", RHX1, 0.0, "rad", "combined slip: shift")                         \
  X("LONGITUDINAL_COEFFICIENTS", PTX1, 0.0, "1", "relaxation length / R0 at nominal load")         \
  X("LONGITUDINAL_COEFFICIENTS", PTX2, 0.0, "1", "relaxation length with load")                    \
  X("LONGITUDINAL_COEFFICIENTS", PTX3, 0.0, "1", "relaxation length, exponent with load")          \
  X("OVERTURNING_COEFFICIENTS", QSX1, 0.0, "1", "constant overturning couple")                     \
  X("OVERTURNING_COEFFICIENTS", QSX2, 0.0, "1/rad", "overturning couple of camber")                \
  X("OVERTURNING_COEFFICIENTS", QSX3, 0.0, "1", "overturning couple of Fy")                        \
  X("LATERAL_COEFFICIENTS", PCY1, 1.0, "1", "shape factor C")                                      \
  X("LATERAL_COEFFICIENTS", PDY1, 1.0, "1", "friction at nominal load")                            \
  X("LATERAL_COEFFICIENTS", PDY2, 0.0, "1", "friction with load")                                  \
  X("LATERAL_COEFFICIENTS", PDY3, 0.0, "1/rad^2", "friction with camber squared")                  \
  X("LATERAL_COEFFICIENTS", PEY1, 0.0, "1", "curvature at nominal load")                           \
  X("LATERAL_COEFFICIENTS", PEY2, 0.0, "1", "curvature with load")                                 \
  X("LATERAL_COEFFICIENTS", PEY3, 0.0, "1", "curvature with the sign of alpha")                    \
  X("LATERAL_COEFFICIENTS", PEY4, 0.0, "1/rad", "curvature with camber and the sign of alpha")     \
  X("LATERAL_COEFFICIENTS", PKY1, -10.0, "1/rad", "maximum cornering stiffness / Fz0")             \
  X("LATERAL_COEFFICIENTS", PKY2, 1.0, "1", "load / Fz0 of the maximum cornering stiffness")       \
  X("LATERAL_COEFFICIENTS", PKY3, 0.0, "1/rad", "cornering stiffness with camber")                 \
  X("LATERAL_COEFFICIENTS", PHY1, 0.0, "rad", "horizontal shift at nominal load")                  \
  X("LATERAL_COEFFICIENTS", PHY2, 0.0, "rad", "horizontal shift with load")                        \
  X("LATERAL_COEFFICIENTS", PHY3, 0.0, "1", "horizontal shift with camber")                        \
  X("LATERAL_COEFFICIENTS", PVY1, 0.0, "1", "vertical shift / Fz at nominal load")                 \
  X("LATERAL_COEFFICIENTS", PVY2, 0.0, "1", "vertical shift with load")                            \
  X("LATERAL_COEFFICIENTS", PVY3, 0.0, "1/rad", "vertical shift with camber")                      \
  X("LATERAL_COEFFICIENTS", PVY4, 0.0, "1/rad", "vertical shift with camber and load")             \
  X("LATERAL_COEFFICIENTS", RBY1, 0.0, "1", "combined slip: slope")                                \
  X("LATERAL_COEFFICIENTS", RBY2, 0.0, "1/rad", "combined slip: slope with alpha")                 \
  X("LATERAL_COEFFICIENTS", RBY3, 0.0, "rad", "combined slip: shift of alpha in the slope")        \
  X("LATERAL_COEFFICIENTS", RCY1, 1.0, "1", "combined slip: shape factor")                         \
  X("LATERAL_COEFFICIENTS", REY1, 0.0, "1", "combined slip: curvature")                            \
  X("LATERAL_COEFFICIENTS", REY2, 0.0, "1", "combined slip: curvature with load")                  \
  X("LATERAL_COEFFICIENTS", RHY1, 0.0, "1", "combined slip: shift")                                \
  X("LATERAL_COEFFICIENTS", RHY2, 0.0, "1", "combined slip: shift with load")                      \
  X("LATERAL_COEFFICIENTS", RVY1, 0.0, "1", "side force of kappa at nominal load")                 \
  X("LATERAL_COEFFICIENTS", RVY2, 0.0, "1", "side force of kappa with load")                       \
  X("LATERAL_COEFFICIENTS", RVY3, 0.0, "1/rad", "side force of kappa with camber")                 \
  X("LATERAL_COEFFICIENTS", RVY4, 0.0, "1/rad", "side force of kappa with alpha")                  \
  X("LATERAL_COEFFICIENTS", RVY5, 0.0, "1", "side force of kappa: shape factor")                   \
  X("LATERAL_COEFFICIENTS", RVY6, 0.0, "1", "side force of kappa: slope")                          \
  X("LATERAL_COEFFICIENTS", PTY1, 0.0, "1", "maximum relaxation length / R0")                      \
  X("LATERAL_COEFFICIENTS", PTY2, 1.0, "1", "load / Fz0 of the maximum relaxation length")         \
  X("ROLLING_COEFFICIENTS", QSY1, 0.0, "1", "rolling resistance")                                  \
  X("ROLLING_COEFFICIENTS", QSY2, 0.0, "1", "rolling resistance with Fx")                          \
  X("ROLLING_COEFFICIENTS", QSY3, 0.0, "1", "rolling resistance with speed")                       \
  X("ROLLING_COEFFICIENTS", QSY4, 0.0, "1", "rolling resistance with speed to the fourth")         \
  X("ALIGNING_COEFFICIENTS", QBZ1, 0.0, "1/rad", "trail: slope at nominal load")                   \
  X("ALIGNING_COEFFICIENTS", QBZ2, 0.0, "1/rad", "trail: slope with load")                         \
  X("ALIGNING_COEFFICIENTS", QBZ3, 0.0, "1/rad", "trail: slope with load squared")                 \
  X("ALIGNING_COEFFICIENTS", QBZ4, 0.0, "1/rad", "trail: slope with camber")                       \
  X("ALIGNING_COEFFICIENTS", QBZ5, 0.0, "1/rad", "trail: slope with absolute camber")              \
  X("ALIGNING_COEFFICIENTS", QBZ9, 0.0, "1/rad", "residual torque: slope")                         \
  X("ALIGNING_COEFFICIENTS", QBZ10, 0.0, "1", "residual torque: slope with B C of Fy")             \
  X("ALIGNING_COEFFICIENTS", QCZ1, 1.0, "1", "trail: shape factor")                                \
  X("ALIGNING_COEFFICIENTS", QDZ1, 0.0, "1", "trail: peak at nominal load")                        \
  X("ALIGNING_COEFFICIENTS", QDZ2, 0.0, "1", "trail: peak with load")                              \
  X("ALIGNING_COEFFICIENTS", QDZ3, 0.0, "1/rad", "trail: peak with camber")                        \
  X("ALIGNING_COEFFICIENTS", QDZ4, 0.0, "1/rad^2", "trail: peak with camber squared")              \
  X("ALIGNING_COEFFICIENTS", QDZ6, 0.0, "1", "residual torque: peak at nominal load")              \
  X("ALIGNING_COEFFICIENTS", QDZ7, 0.0, "1", "residual torque: peak with load")                    \
  X("ALIGNING_COEFFICIENTS", QDZ8, 0.0, "1/rad", "residual torque: peak with camber")              \
  X("ALIGNING_COEFFICIENTS", QDZ9, 0.0, "1/rad", "residual torque: peak with camber and load")     \
  X("ALIGNING_COEFFICIENTS", QEZ1, 0.0, "1", "trail: curvature at nominal load")                   \
  X("ALIGNING_COEFFICIENTS", QEZ2, 0.0, "1", "trail: curvature with load")                         \
  X("ALIGNING_COEFFICIENTS", QEZ3, 0.0, "1", "trail: curvature with load squared")                 \
  X("ALIGNING_COEFFICIENTS", QEZ4, 0.0, "1", "trail: curvature with the sign of alpha")            \
  X("ALIGNING_COEFFICIENTS", QEZ5, 0.0, "1/rad", "trail: curvature with camber")                   \
  X("ALIGNING_COEFFICIENTS", QHZ1, 0.0, "rad", "trail: shift at nominal load")                     \
  X("ALIGNING_COEFFICIENTS", QHZ2, 0.0, "rad", "trail: shift with load")                           \
  X("ALIGNING_COEFFICIENTS", QHZ3, 0.0, "1", "trail: shift with camber")                           \
  X("ALIGNING_COEFFICIENTS", QHZ4, 0.0, "1", "trail: shift with camber and load")                  \
  X("ALIGNING_COEFFICIENTS", SSZ1, 0.0, "1", "moment arm of Fx / R0")                              \
  X("ALIGNING_COEFFICIENTS", SSZ2, 0.0, "1", "moment arm of Fx with Fy")                           \
  X("ALIGNING_COEFFICIENTS", SSZ3, 0.0, "1/rad", "moment arm of Fx with camber")                   \
  X("ALIGNING_COEFFICIENTS", SSZ4, 0.0, "1/rad", "moment arm of Fx with camber and load")

/// Coefficients of one tire, named as in the property file.
template <class T>
struct Pac2002 {
#define STRUT_PAC2002_FIELD(section, name, value, unit, meaning) T name = T(value);
  STRUT_PAC2002_COEFFICIENTS(STRUT_PAC2002_FIELD)
#undef STRUT_PAC2002_FIELD
  bool operator==(const Pac2002&) const = default;
};

/// The tire mounted on the other side of the car: coefficients that are odd under reflection at the
/// wheel plane change their sign. Converts a file measured on a right tire to the left.
template <class T>
Pac2002<T> mirror_tire(Pac2002<T> p) {
  for (T* odd : {&p.RHX1, &p.QSX1, &p.PEY3, &p.PHY1, &p.PHY2, &p.PVY1, &p.PVY2, &p.RBY3, &p.RVY1,
                 &p.RVY2, &p.QBZ4, &p.QDZ3, &p.QDZ6, &p.QDZ7, &p.QEZ4, &p.QHZ1, &p.QHZ2, &p.SSZ1}) {
    *odd = -*odd;
  }
  return p;
}

}  // namespace strut
