// Figures of a wheel plate against the closed form of a linear corner.
#include "identify/plate.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "base/error/input_error.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using std::numbers::pi;
using test::tolerance;
using Complex = std::complex<double>;

constexpr double kAmplitude = 0.003;  // m, of the plate

RigSpec make_corner() {
  RigSpec spec;
  spec.sprung_mass = 320.0;
  spec.unsprung_mass = 40.0;
  spec.stiffness = 22000.0;
  spec.damping = 1500.0;
  spec.tire_stiffness = 200000.0;
  spec.tire_damping = 100.0;
  spec.gravity = 9.81;
  return spec;
}

double calc_load(const RigSpec& s) { return (s.sprung_mass + s.unsprung_mass) * s.gravity; }

/// Contact force of a plate that moves by e^(i w t), from the two equations of motion.
Complex calc_contact(const RigSpec& s, double frequency) {
  const double w = 2.0 * pi * frequency;
  const Complex iw(0.0, w), z = s.stiffness + iw * s.damping;
  const Complex zt = s.tire_stiffness + iw * s.tire_damping;
  Eigen::Matrix2cd m;
  m << z + zt - w * w * s.unsprung_mass, -z, -z, z - w * w * s.sprung_mass;
  const Eigen::Vector2cd x = m.inverse() * Eigen::Vector2cd(zt, 0.0);
  return zt * (1.0 - x[0]);
}

double get_frequency(double t) { return 25.0 - 24.5 * t / 60.0; }

/// A sweep so slow that the corner is in its steady oscillation throughout.
PlateRecord make_record(const RigSpec& spec, double noise = 0.0, std::uint64_t seed = 1) {
  PlateRecord record{"plate.csv", {}, {}, {}};
  for (int i = 0; i <= 60000; ++i) {
    const double t = 1e-3 * i, theta = 2.0 * pi * (25.0 * t - 0.5 * 24.5 * t * t / 60.0);
    const Complex turn = std::polar(kAmplitude, theta);
    const auto place = static_cast<std::uint64_t>(i);
    record.times.push_back(t);
    record.position.push_back(turn.imag());
    record.force.push_back(calc_load(spec) + (calc_contact(spec, get_frequency(t)) * turn).imag() +
                           noise * test::calc_test_normal(seed, 0, place));
  }
  return record;
}

/// Undamped resonances: the body on spring and tire in series, the wheel between both.
PhaseBand calc_band(const RigSpec& s) {
  const double both = s.stiffness + s.tire_stiffness;
  return {std::sqrt(s.stiffness * s.tire_stiffness / both / s.sprung_mass) / (2.0 * pi),
          std::sqrt(both / s.unsprung_mass) / (2.0 * pi), 0.0};
}

PlateFigures calc_figures(const PlateRecord& record, const PhaseBand& band) {
  return calc_plate_figures(calc_plate_responses(record), calc_static_load(record), band,
                            record.name);
}

struct Truth {
  double eusama = 100.0, eusama_frequency = 0.0;  // %, Hz
  double phase = 360.0, phase_frequency = 0.0;    // degrees, Hz
};

Truth calc_truth(const RigSpec& spec) {
  Truth truth;
  constexpr double kStep = 1e-3;  // Hz
  for (double f = 1.0; f < 25.0; f += kStep) {
    const double low =
        100.0 * (1.0 - kAmplitude * std::abs(calc_contact(spec, f)) / calc_load(spec));
    if (low >= truth.eusama) continue;
    truth.eusama = low;
    truth.eusama_frequency = f;
  }
  const PhaseBand band = calc_band(spec);
  for (double f = band.body; f < band.wheel; f += kStep) {
    const double angle = std::arg(calc_contact(spec, f)) * 180.0 / pi;
    const double lead = angle < 0.0 ? angle + 360.0 : angle;
    if (lead >= truth.phase) continue;
    truth.phase = lead;
    truth.phase_frequency = f;
  }
  return truth;
}

TEST_CASE("Figures of a slow sweep are those of the corner's transfer function", "[reference]") {
  RigSpec spec = make_corner();
  spec.damping = GENERATE(1500.0, 1100.0, 700.0);  // as new to worn
  const Truth truth = calc_truth(spec);
  const PhaseBand band = calc_band(spec);
  const PlateRecord record = make_record(spec);
  const PlateFigures figures = calc_figures(record, band);
  CAPTURE(spec.damping, truth.phase_frequency, band.wheel);
  CHECK(figures.static_load == Approx(calc_load(spec)).epsilon(tolerance(1e-3)));
  // A window spans 5 % of the frequency, over which the response bends.
  CHECK(figures.eusama.value == Approx(truth.eusama).margin(tolerance(0.2)));
  CHECK(figures.eusama.frequency == Approx(truth.eusama_frequency).epsilon(tolerance(0.03)));
  CHECK(figures.phase_angle.value == Approx(truth.phase).margin(tolerance(0.5)));
  CHECK(figures.at_wheel_mode == (truth.phase_frequency > 0.999 * band.wheel));
}

TEST_CASE("Intervals of a wheel plate's figures hold their share of true values",
          "[reference][statistical]") {
  RigSpec spec = make_corner();
  spec.damping = GENERATE(1500.0, 700.0);
  const Truth truth = calc_truth(spec);
  constexpr int kRecords = 40;
  int eusama = 0, phase = 0;
  for (int k = 0; k < kRecords; ++k) {
    const PlateRecord record = make_record(spec, 20.0, 41000 + static_cast<std::uint64_t>(k));
    const PlateFigures f = calc_figures(record, calc_band(spec));
    eusama += std::abs(f.eusama.value - truth.eusama) < 1.96 * f.eusama.sigma ? 1 : 0;
    phase += std::abs(f.phase_angle.value - truth.phase) < 1.96 * f.phase_angle.sigma ? 1 : 0;
  }
  INFO("EUSAMA value " << eusama << ", phase angle " << phase << " of " << kRecords);
  CHECK(eusama >= 33);  // 95 % less three standard deviations of 40 trials
  CHECK(phase >= 33);
}

TEST_CASE("A tire that leaves the plate has a EUSAMA value of zero", "[unit]") {
  RigSpec spec = make_corner();
  spec.damping = 150.0;
  PlateRecord record = make_record(spec);
  for (double& force : record.force) force = std::max(force, 0.0);
  CHECK(calc_figures(record, calc_band(spec)).eusama.value == Approx(0.0).margin(tolerance(2.0)));
}

TEST_CASE("Records that are no plate test are refused", "[unit]") {
  const RigSpec spec = make_corner();
  PlateRecord negative = make_record(spec);
  for (double& force : negative.force) force = -force;
  CHECK_THROWS_WITH(calc_static_load(negative), Contains("wrong sign?"));
  PlateRecord still = make_record(spec);
  for (double& z : still.position) z = 0.0;
  CHECK_THROWS_WITH(calc_plate_responses(still), Contains("must be at least 8"));
}

}  // namespace
}  // namespace strut
