// Whitened readings have variance 1, for any common noise of the channels.
#include "diagnose/noise/whitener.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error/check.h"
#include "tests/support/campaign_files.h"
#include "tests/support/common_noise.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::ConstantModel, test::get_weight, test::kChannels, test::kSamples, test::make_spectrum;

/// Sensor noise and the source's, drawn over time; periodic, as the transform has it.
Eigen::VectorXd draw_noise(std::size_t runs) {
  Eigen::VectorXd noise(static_cast<Eigen::Index>(runs * kSamples * kChannels));
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < runs; ++r) {
    for (std::size_t t = 0; t < kSamples; ++t) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const std::size_t earlier = (t + kSamples - c) % kSamples;
        noise(row++) = test::calc_test_normal(r, c, t) +
                       get_weight(c) * test::calc_test_normal(r, 99, earlier);
      }
    }
  }
  return noise;
}

TEST_CASE("Whitened noise has variance one in every channel, whatever its source", "[unit]") {
  constexpr std::size_t kRuns = 40;
  const ConstantModel model(kRuns);
  const Whitener whitener(model, std::vector<NoiseSpectrum>(kRuns, make_spectrum()));
  REQUIRE(whitener.whitened_count() == kRuns * kSamples * kChannels);
  const Eigen::VectorXd whitened = whitener.apply(draw_noise(kRuns));
  std::vector<double> squares(kChannels, 0.0), counts(kChannels, 0.0);
  for (std::size_t i = 0; i < whitener.whitened_count(); ++i) {
    const double w = whitened(static_cast<Eigen::Index>(i));
    squares[whitener.places()[i].channel] += w * w;
    ++counts[whitener.places()[i].channel];
  }
  // 9600 numbers a channel: 1 sigma of the mean square is 1.4 %.
  for (std::size_t c = 0; c < kChannels; ++c) {
    CHECK(squares[c] / counts[c] == Approx(1.0).margin(test::tolerance(0.06)));
  }
}

TEST_CASE("Without sources whitening keeps every sum of squares", "[unit]") {
  const ConstantModel model(2);
  std::vector<NoiseSpectrum> spectra(2, make_spectrum());
  for (NoiseSpectrum& s : spectra) s.common.clear();
  const Whitener whitener(model, spectra);
  const Eigen::VectorXd noise = draw_noise(2);
  const Eigen::VectorXd whitened = whitener.apply(noise);
  CHECK(whitened.squaredNorm() == Approx(noise.squaredNorm()).epsilon(test::tolerance(1e-12)));
  CHECK(whitener.calc_log_likelihood(whitened, 0) + whitener.calc_log_likelihood(whitened, 1) ==
        Approx(-0.5 * noise.squaredNorm()).epsilon(test::tolerance(1e-12)));
}

TEST_CASE("The log determinant is that of the readings' covariance over time", "[unit]") {
  // At every frequency the covariance 1 + w w' over the channels has the determinant 1 + w'w, and
  // 240 samples have 240 numbers per channel: half of ln(1 + 9 + 25 + 49) for each.
  const ConstantModel model(1);
  const Whitener whitener(model, {make_spectrum()});
  const double expected = 0.5 * kSamples * std::log(84.0);
  CHECK(whitener.get_log_determinant(0) == Approx(expected).epsilon(test::tolerance(1e-12)));
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(kSamples * kChannels);
  CHECK(whitener.calc_log_likelihood(none, 0) == Approx(-expected).epsilon(test::tolerance(1e-12)));
}

TEST_CASE("The common part of a source weighs little, the rest as much as sensors allow",
          "[unit]") {
  const ConstantModel model(1);
  const Whitener whitener(model, {make_spectrum()});
  // As the source moves the channels, and across it.
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(kSamples * kChannels, 2);
  for (std::size_t t = 0; t < kSamples; ++t) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double phase = 2.0 * std::numbers::pi * 10.0 *
                           (static_cast<double>(t) - static_cast<double>(c)) / kSamples;
      const auto row = static_cast<Eigen::Index>(t * kChannels + c);
      columns(row, 0) = get_weight(c) * std::cos(phase);
      if (c < 2) columns(row, 1) = (c == 0 ? get_weight(1) : -get_weight(0)) * std::cos(phase);
    }
  }
  const Eigen::MatrixXd whitened = whitener.apply(columns);
  const double power = 9.0 + 25.0 + 49.0;
  CHECK(whitened.col(0).squaredNorm() ==
        Approx(columns.col(0).squaredNorm() / (1.0 + power)).epsilon(test::tolerance(1e-9)));
  CHECK(whitened.col(1).squaredNorm() ==
        Approx(columns.col(1).squaredNorm()).epsilon(test::tolerance(1e-9)));
}

TEST_CASE("Noise in excess of a spectrum is counted by run and band", "[unit]") {
  constexpr std::size_t kRuns = 2;
  const ConstantModel model(kRuns);
  std::vector<NoiseSpectrum> spectra(kRuns, make_spectrum());
  for (NoiseSpectrum& s : spectra) s.common.clear();
  const Whitener whitener(model, spectra);
  Eigen::VectorXd noise(static_cast<Eigen::Index>(kRuns * kSamples * kChannels));
  for (Eigen::Index i = 0; i < noise.size(); ++i) {
    const bool second = i >= noise.size() / 2;
    noise(i) = (second ? 3.0 : 1.0) * test::calc_test_normal(5, 0, static_cast<std::uint64_t>(i));
  }
  count_excess(whitener, whitener.apply(noise), spectra);
  const std::size_t band = find_noise_band(30.0);
  CHECK(spectra[0].excess[band] == Approx(1.0).margin(test::tolerance(0.2)));
  CHECK(spectra[1].excess[band] == Approx(9.0).margin(test::tolerance(1.8)));
}

TEST_CASE("What chance adds to few readings is hardly an excess", "[unit]") {
  // Standard deviation 0.1: three of it are kept but for 4/3, one is chance, 80 are all kept.
  CHECK(shrink_excess(1.3, 200.0) == Approx(1.3 - 0.4 / 3.0));
  CHECK(shrink_excess(1.1, 200.0) == 1.0);
  CHECK(shrink_excess(0.2, 200.0) == 1.0);
  CHECK(shrink_excess(9.0, 200.0) == Approx(9.0).margin(0.01));
  // Mean squares of 20 standard normal numbers.
  constexpr std::uint64_t kSets = 4000, kReadings = 20;
  double sum = 0.0;
  for (std::uint64_t set = 0; set < kSets; ++set) {
    double square = 0.0;
    for (std::uint64_t i = 0; i < kReadings; ++i) {
      const double z = test::calc_test_normal(6, set, i);
      square += z * z;
    }
    sum += shrink_excess(square / kReadings, static_cast<double>(kReadings));
  }
  CHECK(sum / kSets == Approx(1.0).margin(0.02));
}

TEST_CASE("Noise below its spectrum is no negative excess", "[unit]") {
  const ConstantModel model(1);
  std::vector<NoiseSpectrum> spectra = {make_spectrum()};
  spectra[0].common.clear();
  const Whitener whitener(model, spectra);
  // At most a twentieth of sqrt(1 + 49) sigmas.
  count_excess(whitener, 0.05 * whitener.apply(draw_noise(1)), spectra);
  for (const double excess : spectra[0].excess) CHECK(excess == 1.0);
}

TEST_CASE("Missing readings do not make noise look smaller", "[unit]") {
  constexpr std::size_t kRuns = 20;
  const ConstantModel model(kRuns, 5);
  std::vector<NoiseSpectrum> spectra(kRuns, make_spectrum());
  for (NoiseSpectrum& s : spectra) s.common.clear();
  const Whitener whitener(model, spectra);
  Eigen::VectorXd noise(static_cast<Eigen::Index>(model.reading_count()));
  for (Eigen::Index i = 0; i < noise.size(); ++i) {
    noise(i) = test::calc_test_normal(6, 0, static_cast<std::uint64_t>(i));
  }
  CHECK(whitener.get_share(0) == Approx((2.0 + 0.2) / 3.0).epsilon(test::tolerance(1e-12)));
  const double mean =
      whitener.apply(noise).squaredNorm() / static_cast<double>(whitener.whitened_count());
  CHECK(mean == Approx(whitener.get_share(0)).epsilon(test::tolerance(0.05)));
}

TEST_CASE("Quick lengths are even and of small factors", "[unit]") {
  CHECK(find_quick_length(1500) == 1500);
  CHECK(find_quick_length(1501) == 1500);
  CHECK(find_quick_length(1999) == 1944);
  CHECK(find_quick_length(2) == 2);
}

TEST_CASE("Noise or a residual that is not finite is refused, not whitened", "[unit]") {
  const ConstantModel model(1);
  NoiseSpectrum spectrum = make_spectrum();
  const Whitener whitener(model, {spectrum});
  Eigen::VectorXd residual =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(model.reading_count()));
  residual(7) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(whitener.apply(residual), CheckError);
  spectrum.common[3](1, 1) = residual(7);
  CHECK_THROWS_AS(Whitener(model, {spectrum}), CheckError);
}

}  // namespace
}  // namespace strut
