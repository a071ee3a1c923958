// Lane operations by Highway with static dispatch: the compiler flags decide the target. Elementary
// functions are those of hwy/contrib/math.
#pragma once

#include <hwy/highway.h>

// Must come after highway.h, so it stands apart from the sorted includes.
#include <hwy/contrib/math/math-inl.h>

#include "base/math/lanes.h"

namespace strut {

namespace hn = hwy::HWY_NAMESPACE;

struct HighwayBackend {
  using Tag = hn::ScalableTag<double>;
  using Vector = hn::Vec<Tag>;
  using MaskVector = hn::Mask<Tag>;
  static constexpr Tag kTag{};
  static constexpr int kWidth = static_cast<int>(HWY_LANES(double));

  static Vector broadcast(double x) { return hn::Set(kTag, x); }
  static Vector load(const double* p) { return hn::LoadU(kTag, p); }
  static void store(double* p, Vector a) { hn::StoreU(a, kTag, p); }
  static Vector add(Vector a, Vector b) { return hn::Add(a, b); }
  static Vector sub(Vector a, Vector b) { return hn::Sub(a, b); }
  static Vector mul(Vector a, Vector b) { return hn::Mul(a, b); }
  static Vector div(Vector a, Vector b) { return hn::Div(a, b); }
  static Vector neg(Vector a) { return hn::Neg(a); }
  static MaskVector less(Vector a, Vector b) { return hn::Lt(a, b); }
  static MaskVector less_equal(Vector a, Vector b) { return hn::Le(a, b); }
  static MaskVector mask_and(MaskVector a, MaskVector b) { return hn::And(a, b); }
  static MaskVector mask_or(MaskVector a, MaskVector b) { return hn::Or(a, b); }
  static MaskVector mask_not(MaskVector a) { return hn::Not(a); }
  static bool any(MaskVector a) { return !hn::AllFalse(kTag, a); }
  static bool all(MaskVector a) { return hn::AllTrue(kTag, a); }
  static Vector select(MaskVector m, Vector a, Vector b) { return hn::IfThenElse(m, a, b); }
  static Vector abs(Vector a) { return hn::Abs(a); }
  static Vector sqrt(Vector a) { return hn::Sqrt(a); }
  static Vector min(Vector a, Vector b) { return hn::Min(a, b); }
  static Vector max(Vector a, Vector b) { return hn::Max(a, b); }
  static Vector floor(Vector a) { return hn::Floor(a); }
  static Vector sin(Vector a) { return hn::Sin(kTag, a); }
  static Vector cos(Vector a) { return hn::Cos(kTag, a); }
  static Vector atan(Vector a) { return hn::Atan(kTag, a); }
  static Vector exp(Vector a) { return hn::Exp(kTag, a); }
  static void sin_cos(Vector a, Vector& s, Vector& c) {
    s = sin(a);
    c = cos(a);
  }
  static Vector gather(const double* table, Vector index) {
    const hn::RebindToSigned<Tag> integers;
    return hn::GatherIndex(kTag, table, hn::ConvertTo(integers, index));
  }
};

}  // namespace strut
