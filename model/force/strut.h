// Force elements that act along a line of a corner (spring line, damper line).
//
// An element is a plain struct of T fields. Force is positive in compression (it pushes the mounts
// apart), so its power on the car is force * length_rate. A conservative element computes its
// stored energy; the power of any other is dissipation or input. A new element is a header like
// this and one entry in `StrutElements`, or in `StrutEffects` (strut_effects.h) if it is an effect;
// the dynamics do not depend on the kinds of elements.
#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "base/math/lanes.h"
#include "model/multibody/corner.h"

namespace strut {

/// Line length [m] and its rate [m/s].
template <class T>
struct LineState {
  T length, rate;
};

/// F = k (free_length - length).
template <class T>
struct LinearSpring {
  static constexpr Line kLine = kSpringLine;
  static constexpr bool kConservative = true;
  T stiffness;    // N/m
  T free_length;  // m

  T calc_force(const LineState<T>& line) const { return stiffness * (free_length - line.length); }
  T calc_energy(const LineState<T>& line) const {
    return T(0.5) * stiffness * square(free_length - line.length);
  }
};

/// F = -c d(length)/dt.
template <class T>
struct LinearDamper {
  static constexpr Line kLine = kDamperLine;
  static constexpr bool kConservative = false;
  T damping;  // N s/m

  T calc_force(const LineState<T>& line) const { return -damping * line.rate; }
  T calc_energy(const LineState<T>&) const { return T(0.0); }
};

/// Maximum number of elements of one kind: at most one per corner.
inline constexpr int kMaxElements = 6;

/// The elements of one kind, each at its corner. The list is common to a batch and contains only
/// effects that are on.
template <class Element, int Capacity = kMaxElements>
struct ElementList {
  std::array<Element, Capacity> element;
  std::array<int, Capacity> corner{};
  int count = 0;

  void add(int at_corner, const Element& e) {
    element[static_cast<std::size_t>(count)] = e;
    corner[static_cast<std::size_t>(count)] = at_corner;
    ++count;
  }
};

template <class T>
using StrutElements = std::tuple<ElementList<LinearSpring<T>>, ElementList<LinearDamper<T>>>;

/// Forces of all elements of one strut.
template <class T>
struct StrutForce {
  T spring_force, damper_force;  // N, by line
  T generalized;                 // N, on q
  T power;                       // W, of elements that are not conservative
  T energy;                      // J, stored in conservative elements
};

/// Adds the forces of the elements of one kind.
template <class T, int Corners, class Element>
void add_element_list(const ElementList<Element>& list,
                      const std::array<CornerMotion<T>, Corners>& motion, const T* q_dot,
                      std::array<StrutForce<T>, Corners>& out) {
  for (int i = 0; i < list.count; ++i) {
    const auto corner = static_cast<std::size_t>(list.corner[static_cast<std::size_t>(i)]);
    const Element& element = list.element[static_cast<std::size_t>(i)];
    const CornerMotion<T>& m = motion[corner];
    const LineState<T> line{m.length[Element::kLine], m.length_q[Element::kLine] * q_dot[corner]};
    const T force = element.calc_force(line);
    StrutForce<T>& f = out[corner];
    (Element::kLine == kSpringLine ? f.spring_force : f.damper_force) += force;
    f.generalized += force * m.length_q[Element::kLine];
    if constexpr (Element::kConservative) {
      f.energy += element.calc_energy(line);
    } else {
      f.power += force * line.rate;
    }
  }
}

template <class T, int Corners>
void add_strut_forces(const StrutElements<T>& elements,
                      const std::array<CornerMotion<T>, Corners>& motion, const T* q_dot,
                      std::array<StrutForce<T>, Corners>& out) {
  for (StrutForce<T>& f : out) f = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
  std::apply(
      [&](const auto&... list) { (add_element_list<T, Corners>(list, motion, q_dot, out), ...); },
      elements);
}

}  // namespace strut
