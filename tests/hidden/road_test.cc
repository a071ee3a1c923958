// Bumps and roughness of the generator against geometry and ISO 8608's formula.
#include "tests/hidden/road.h"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "tests/support/tolerance.h"

namespace strut::hidden {

using test::tolerance;

TEST_CASE("Hidden data: a disc on a gentle bump has its center on the offset curve",
          "[reference]") {
  const Bump bump{BumpForm::kCosine, 0.08, 0.9, 0.0};
  const double radius = 0.32, pi = 3.14159265358979323846;
  // A narrow footprint averages by half its variance times the curvature: 12e-6 m^2 * 6 / m.
  const Curve felt = make_felt_bump(bump, radius, 0.02);
  for (const double u : {-0.20, -0.1, 0.0, 0.1, 0.2}) {
    const double z = 0.04 * (1.0 + std::cos(2.0 * pi * u / 0.9));
    const double slope = -0.08 * pi / 0.9 * std::sin(2.0 * pi * u / 0.9);
    const double root = std::hypot(1.0, slope);
    double height = 0.0, felt_slope = 0.0;
    felt.evaluate(u - radius * slope / root, height, felt_slope);
    CHECK(height == Approx(z + radius / root - radius).margin(tolerance(5e-5)));
    CHECK(felt_slope == Approx(slope).margin(tolerance(2e-3)));
  }
}

TEST_CASE("Hidden data: roughness has the density of ISO 8608 and its coherence", "[statistical]") {
  Roughness roughness;
  roughness.degree = 64e-6;
  const double spacing = 0.02;
  const int count = 8192, repeats = 40;
  Eigen::FFT<double> transform;
  std::vector<double> density(count / 2, 0.0);
  std::vector<std::complex<double>> cross(count / 2), left, right;
  for (int i = 0; i < repeats; ++i) {
    const auto tracks =
        make_rough_tracks(roughness, 0.0, count * spacing, 0.0, static_cast<std::uint64_t>(i));
    REQUIRE(tracks.left.height.size() == count);
    transform.fwd(left, tracks.left.height);
    transform.fwd(right, tracks.right.height);
    for (std::size_t k = 1; k < count / 2; ++k) {
      density[k] += std::norm(right[k]) * 2.0 * spacing / count / repeats;
      cross[k] += left[k] * std::conj(right[k]) * (2.0 * spacing / count / repeats);
    }
  }
  // Bins between 0.09 and 0.11, 0.9 and 1.1 cycles/m: averages of hundreds of draws.
  for (const double n : {0.1, 1.0}) {
    double measured = 0.0, formula = 0.0, common = 0.0;
    for (std::size_t k = 1; k < count / 2; ++k) {
      const double at = static_cast<double>(k) / (count * spacing);
      if (std::fabs(at - n) > 0.1 * n) continue;
      measured += density[k];
      formula += 64e-6 * std::pow(at / 0.1, -2.0);
      common += cross[k].real();
    }
    CHECK(measured == Approx(formula).epsilon(tolerance(0.1)));
    CHECK(common / formula == Approx(std::exp(-0.5 * n / 0.35)).margin(tolerance(0.08)));
  }
  CHECK(calc_roughness_density(roughness, 0.01) == 0.0);
}

TEST_CASE("Hidden data: roughness is the same at every call and another for every seed", "[unit]") {
  const Roughness roughness;
  const auto a = make_rough_tracks(roughness, 0.0, 50.0, 0.12, 7);
  const auto b = make_rough_tracks(roughness, 0.0, 50.0, 0.12, 7);
  const auto c = make_rough_tracks(roughness, 0.0, 50.0, 0.12, 8);
  CHECK(a.left.height == b.left.height);
  CHECK(a.right.height == b.right.height);
  CHECK(a.left.height != c.left.height);
}

}  // namespace strut::hidden
