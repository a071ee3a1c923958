// The tabulated corner against Newton's closure.

#include "model/multibody/corner_table.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/model/test_corner.h"

namespace strut {
namespace {

using test::append;
using test::calc_motion;
using test::make_paper_car;
using test::make_travels;
using test::Motion;
using test::tolerance;

/// Largest differences between table and closure over |q| <= travel, each relative to the largest
/// size of its function or to 1 (m, kg m, ...): values, slopes, second derivatives.
std::array<double, 3> compare_table(const AssembledVehicle& car,
                                    const VehicleTables<double>& tables, int corner,
                                    double travel) {
  const TableClosure<double, double> table{&tables};
  const auto collect = [](const Motion& m) {
    std::array<std::vector<double>, 3> lists;
    for (const auto& v : {m.moment, m.coupling, m.center, m.axis, m.upright_rate}) {
      append(lists[0], v);
    }
    append(lists[0], m.inertia);
    lists[0].insert(lists[0].end(), {m.mass, m.length[0], m.length[1]});
    for (const auto& v : {m.moment_q, m.coupling_q, m.center_q, m.axis_q}) append(lists[1], v);
    append(lists[1], m.inertia_q);
    lists[1].insert(lists[1].end(), {m.mass_q, m.length_q[0], m.length_q[1]});
    for (const auto& v : {m.moment_qq, m.center_qq}) append(lists[2], v);
    return lists;
  };
  std::array<std::vector<double>, 3> largest, difference;
  for (const double part : make_travels(201)) {
    const double q = part / kHalfTravel * travel;
    Motion tabulated{};
    REQUIRE(table(corner, q, tabulated) == 0.0);
    table.update_center_acceleration(corner, q, tabulated);
    const auto a = collect(tabulated), b = collect(calc_motion(car, corner, q));
    for (std::size_t order = 0; order < 3; ++order) {
      largest[order].resize(a[order].size(), 1.0);
      difference[order].resize(a[order].size(), 0.0);
      for (std::size_t i = 0; i < a[order].size(); ++i) {
        largest[order][i] = std::max(largest[order][i], std::abs(b[order][i]));
        difference[order][i] = std::max(difference[order][i], std::abs(a[order][i] - b[order][i]));
      }
    }
  }
  std::array<double, 3> worst{};
  for (std::size_t order = 0; order < 3; ++order) {
    for (std::size_t i = 0; i < largest[order].size(); ++i) {
      worst[order] = std::max(worst[order], difference[order][i] / largest[order][i]);
    }
  }
  return worst;
}

TEST_CASE("Tables equal Newton's closure in values, slopes and second derivatives",
          "[unit][property]") {
  const AssembledVehicle car = make_paper_car();
  const VehicleTables<double> tables = tabulate_corners(car);
  for (int corner = 0; corner < kCorners; ++corner) {
    // Coefficients below 1e-11 of T_n(q / 0.1 m) are cut, n from 11 on. At the ends of the travel a
    // derivative multiplies them by n^2 / 0.1 m, the second by n^2 (n^2 - 1) / 3 / (0.1 m)^2; in
    // the inner half by some n / 0.1 m each.
    const auto whole = compare_table(car, tables, corner, kHalfTravel);
    INFO("over the travel: " << whole[0] << ", slopes " << whole[1] << ", second " << whole[2]);
    CHECK(whole[0] < tolerance(1e-10));
    CHECK(whole[1] < tolerance(5e-8));
    CHECK(whole[2] < tolerance(5e-6));
    const auto inner = compare_table(car, tables, corner, 0.5 * kHalfTravel);
    INFO("inner half: " << inner[0] << ", slopes " << inner[1] << ", second " << inner[2]);
    CHECK(inner[0] < tolerance(5e-11));
    CHECK(inner[1] < tolerance(5e-9));
    CHECK(inner[2] < tolerance(5e-7));
  }
}

TEST_CASE("A table places the wheel as its motion functions do", "[unit]") {
  const VehicleTables<double> tables = tabulate_corners(make_paper_car());
  const TableClosure<double, double> table{&tables};
  for (int corner = 0; corner < kCorners; ++corner) {
    Motion full{}, place_only{};
    table(corner, 0.063, full);
    table.place_wheel(corner, 0.063, place_only);
    // The same polynomials, summed in the same order up to contraction to fused operations.
    CHECK(norm(full.center - place_only.center) < tolerance(1e-15));
    CHECK(norm(full.center_q - place_only.center_q) < tolerance(1e-14));
    CHECK(norm(full.axis - place_only.axis) < tolerance(1e-15));
  }
}

}  // namespace
}  // namespace strut
