// Starts that are found in lanes are those of KINSOL, whatever is beside them.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/math/linalg.h"
#include "model/car/trim.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::Random;
using test::tolerance;

/// By KINSOL, with its line search.
State<double> find_reference(const PreparedCase& c) {
  Vehicle<double> vehicle = c.vehicle;
  vehicle.layout.on_bump.fill(false);
  vehicle.road = Road<double>{};
  if (!c.starts_driven) vehicle.numbers.drive_torque.fill(0.0);
  return solve_rolling(vehicle, c.mechanism->tables, c.mechanism->car.center_height, c.start_speed)
      .state;
}

/// Cars with other springs, masses, hardpoints, tires and speeds than the paper's.
std::vector<Case> draw_cases(int count) {
  Random random(7);
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Case c = test::make_paper_case();
    for (SuspensionSpec& axle : c.vehicle.suspension) {
      for (StrutSpec& strut : axle.strut) {
        strut.stiffness *= random.uniform(0.8, 1.5);
        strut.damping *= random.uniform(0.0, 2.0);
      }
    }
    c.vehicle.tire.stiffness *= random.uniform(0.7, 1.5);
    c.vehicle.tire.relaxation = i % 7 == 0;
    c.vehicle.whole.mass *= random.uniform(0.9, 1.2);
    c.vehicle.suspension[kFront].strut_top.z += random.uniform(-0.01, 0.01);
    c.maneuver.trim = i % 3 == 0 ? TrimKind::kStatic : TrimKind::kSteady;
    c.maneuver.lead_speed = i % 2 == 0 ? 0.5 : 0.0;
    c.maneuver.speed = random.uniform(2.0, 45.0);
    c.maneuver.drive_torque = random.uniform(0.0, 150.0);
    cases.push_back(std::move(c));
  }
  return cases;
}

std::vector<PreparedCase> assemble(const std::vector<Case>& cases) {
  CasePreparer preparer;
  std::vector<PreparedCase> assembled;
  assembled.reserve(cases.size());
  for (const Case& c : cases) assembled.push_back(preparer.assemble(c));
  return assembled;
}

std::vector<std::string> start(std::vector<PreparedCase>& cases) {
  std::vector<PreparedCase*> pointers;
  pointers.reserve(cases.size());
  for (PreparedCase& c : cases) pointers.push_back(&c);
  return find_starts(list_kernels().front(), pointers);
}

TEST_CASE("Starts that lanes find are those of KINSOL", "[unit][reference]") {
  std::vector<PreparedCase> cases = assemble(draw_cases(60));
  for (const Kernel& kernel : list_kernels()) {
    for (PreparedCase& c : cases) {
      c.start.fill(0.0);
      PreparedCase* const alone[] = {&c};
      // None of them needs the line search.
      REQUIRE(kernel.find_starts(alone, 1) == 1U);
      const State<double> reference = find_reference(c);
      for (std::size_t i = 0; i < reference.size(); ++i) {
        CAPTURE(i);
        CHECK(c.start[i] == Approx(reference[i]).epsilon(1e-9).margin(tolerance(1e-9)));
      }
    }
  }
}

TEST_CASE("A start does not depend on those beside it", "[unit][property]") {
  std::vector<Case> given = draw_cases(21);
  std::vector<PreparedCase> together = assemble(given);
  for (const std::string& reason : start(together)) CHECK(reason.empty());
  std::reverse(given.begin(), given.end());
  std::vector<PreparedCase> reversed = assemble(given);
  start(reversed);
  std::reverse(reversed.begin(), reversed.end());
  std::reverse(given.begin(), given.end());
  for (std::size_t i = 0; i < given.size(); ++i) {
    CHECK(together[i].start == reversed[i].start);
    CHECK(together[i].start == test::prepare(given[i]).start);
  }
}

TEST_CASE("A car that has no equilibrium has a reason, and its neighbors a start", "[unit]") {
  std::vector<Case> given = draw_cases(5);
  given[2].maneuver.drive_torque = 1e5;
  std::vector<PreparedCase> cases = assemble(given);
  const std::vector<std::string> reasons = start(cases);
  for (std::size_t i = 0; i < given.size(); ++i) {
    CHECK(reasons[i].empty() == (i != 2));
    if (i != 2) CHECK(cases[i].start == test::prepare(given[i]).start);
  }
  CHECK(reasons[2].find("no equilibrium") != std::string::npos);
}

TEST_CASE("Elimination takes the largest pivot, and leaves what it should", "[unit]") {
  // The first pivot is zero.
  SquareMatrix<double, 3> a = {{{0.0, 2.0, 1.0}, {1.0, -2.0, -3.0}, {-1.0, 1.0, 2.0}}};
  std::array<double, 3> b = {-8.0, 0.0, 3.0};
  const SquareMatrix<double, 3> kept = a;
  const std::array<double, 3> right = b;
  solve_pivoted(a, b);
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = 0.0;
    for (std::size_t column = 0; column < 3; ++column) sum += kept[row][column] * b[column];
    CHECK(sum == Approx(right[row]).margin(1e-14));
  }
}

}  // namespace
}  // namespace strut
