#include "model/kernel/count_flops.h"

#include "model/car/dynamics.h"

namespace strut {

/// A double whose operations are counted.
struct Counted {
  using Mask = bool;
  static constexpr int kWidth = 1;
  double v;

  Counted() = default;
  Counted(double value) : v(value) {}  // NOLINT: as Lanes
};

namespace {

/// Global, since operators have no argument that could carry a counter.
thread_local FlopCount counter;

double arithmetic(double result) {
  ++counter.arithmetic;
  return result;
}
double transcendental(double result) {
  ++counter.transcendental;
  return result;
}
template <class Result>
Result comparison(Result result) {
  ++counter.comparison;
  return result;
}

}  // namespace

// In namespace strut, where argument-dependent lookup finds them from the model's templates.
inline Counted operator+(Counted a, Counted b) { return arithmetic(a.v + b.v); }
inline Counted operator-(Counted a, Counted b) { return arithmetic(a.v - b.v); }
inline Counted operator*(Counted a, Counted b) { return arithmetic(a.v * b.v); }
inline Counted operator/(Counted a, Counted b) { return arithmetic(a.v / b.v); }
inline Counted operator-(Counted a) { return -a.v; }
inline Counted& operator+=(Counted& a, Counted b) { return a = a + b; }
inline Counted& operator-=(Counted& a, Counted b) { return a = a - b; }
inline Counted& operator*=(Counted& a, Counted b) { return a = a * b; }
inline bool operator<(Counted a, Counted b) { return comparison(a.v < b.v); }
inline bool operator>(Counted a, Counted b) { return comparison(a.v > b.v); }
inline bool operator<=(Counted a, Counted b) { return comparison(a.v <= b.v); }
inline bool operator>=(Counted a, Counted b) { return comparison(a.v >= b.v); }
inline Counted sqrt(Counted a) { return arithmetic(std::sqrt(a.v)); }
inline Counted abs(Counted a) { return comparison(std::fabs(a.v)); }
inline Counted floor(Counted a) { return comparison(std::floor(a.v)); }
inline Counted min(Counted a, Counted b) { return comparison(b.v < a.v ? b.v : a.v); }
inline Counted max(Counted a, Counted b) { return comparison(a.v < b.v ? b.v : a.v); }
inline Counted sin(Counted a) { return transcendental(std::sin(a.v)); }
inline Counted cos(Counted a) { return transcendental(std::cos(a.v)); }
inline Counted atan(Counted a) { return transcendental(std::atan(a.v)); }
inline Counted exp(Counted a) { return transcendental(std::exp(a.v)); }
inline void sin_cos(Counted a, Counted& s, Counted& c) { s = sin(a), c = cos(a); }
inline Counted select(bool mask, Counted a, Counted b) { return comparison(mask ? a.v : b.v); }
inline Counted gather(const double* table, Counted at) { return gather(table, at.v); }
inline double get_lane(Counted a, int) { return a.v; }
inline void set_lane(Counted& a, int, double value) { a.v = value; }

namespace {

template <Sides S, class Closure>
void run_once(const Vehicle<Counted>& vehicle, const Closure& closure, const PreparedCase& c) {
  State<Counted> x, dx;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = c.start[i];
  Workspace<Counted> ws{};
  calc_derivative<S>(vehicle, closure, TireMode::kRolling, x.data(), dx.data(), ws);
}

template <Sides S>
FlopCount count_flops(const PreparedCase& c, Closure closure) {
  const Surface* surface = &c.mechanism->surface;
  Vehicle<Counted> vehicle{c.vehicle.layout,
                           pack_lanes<VehicleParameters, Counted>(&c.vehicle.numbers),
                           pack_lanes<Pac2002, Counted>(&c.vehicle.pacejka),
                           {},
                           make_road<Counted>(&surface, &c.bump_center)};
  const CornerForceMaps* const maps[] = {&c.force_maps};
  fill_strut_elements<S>(vehicle, maps);
  counter = {};
  if (closure == Closure::kNewton) {
    run_once<S>(vehicle, NewtonClosure<Counted>{&vehicle.layout, &vehicle.numbers}, c);
  } else {
    run_once<S>(vehicle, TableClosure<Counted, double>{&c.mechanism->tables}, c);
  }
  return counter;
}

}  // namespace

FlopCount count_flops(const PreparedCase& c, const IntegrateOptions& options) {
  return options.symmetry && is_symmetric(c) ? count_flops<Sides::kLeft>(c, options.closure)
                                             : count_flops<Sides::kBoth>(c, options.closure);
}

}  // namespace strut
