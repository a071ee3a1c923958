// A search with derivatives of few points reports why it ends.
#include "diagnose/noise/chord_search.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/tolerance.h"

namespace strut {
namespace {

constexpr std::size_t kSamples = 64;

/// Residuals of one shape, times a function of the one unknown; NaN: it cannot be simulated there.
class ShapedModel : public ReadingModel {
 public:
  using Function = std::function<double(double)>;
  explicit ShapedModel(Function size) : ReadingModel({Unknown{}}), size_(std::move(size)) {
    unknowns_.front().name = "x";
    unknowns_.front().low = -std::numeric_limits<double>::infinity();
    unknowns_.front().high = std::numeric_limits<double>::infinity();
    channels_ = {{0}};
    for (std::size_t t = 0; t < kSamples; ++t) readings_.push_back({0, t, 0});
  }
  Linearization linearize(const std::vector<double>& values) override {
    constexpr double kSide = 1e-6;
    ++linearizations;
    const double slope =
        (size_(values.front() + kSide) - size_(values.front() - kSide)) / (2.0 * kSide);
    return {"", size_(values.front()) * make_shape(), slope * make_shape()};
  }
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override {
    std::vector<Evaluation> evaluations;
    for (const std::vector<double>& p : points) {
      const double size = size_(p.front());
      if (std::isnan(size)) {
        evaluations.push_back({"not here", {}});
      } else {
        evaluations.push_back({"", size * make_shape()});
      }
    }
    return evaluations;
  }

  int linearizations = 0;

 private:
  static Eigen::VectorXd make_shape() {
    Eigen::VectorXd shape(kSamples);
    for (Eigen::Index t = 0; t < shape.size(); ++t)
      shape(t) = std::sin(0.7 * static_cast<double>(t));
    return shape;
  }

  Function size_;
};

/// White noise of 1 sigma.
Whitener make_whitener(const ReadingModel& model) {
  NoiseSpectrum s;
  s.samples = kSamples;
  s.interval = 0.01;
  s.sigma = {1.0};
  s.response_error = 0.0;
  s.common.assign(kSamples / 2 + 1, Eigen::MatrixXcd::Zero(1, 1));
  return {model, {s}};
}

TEST_CASE("A chord search finds a smooth minimum", "[unit]") {
  ShapedModel model([](double x) { return 5.0 * std::expm1(0.3 * (x - 2.0)); });
  ChordSearch search(model, {4.0});
  search.search(make_whitener(model));
  CHECK(search.values().front() == Approx(2.0).margin(test::tolerance(0.05)));
  CHECK_FALSE(search.at_kink());
}

TEST_CASE("A chord search distinguishes a kink from a point that cannot be simulated", "[unit]") {
  ShapedModel kinked([](double x) { return 10.0 + std::abs(x - 1.0); });
  ChordSearch at_kink(kinked, {3.0});
  at_kink.search(make_whitener(kinked));
  CHECK(at_kink.values().front() == Approx(1.0).margin(test::tolerance(0.6)));
  CHECK(at_kink.at_kink());

  ShapedModel walled(
      [](double x) { return x < 0.9 ? std::numeric_limits<double>::quiet_NaN() : x + 5.0; });
  ChordSearch at_wall(walled, {1.0});
  at_wall.search(make_whitener(walled));
  CHECK(at_wall.values().front() == 1.0);
  CHECK_FALSE(at_wall.at_kink());
}

TEST_CASE("A chord search does not recompute derivatives at the same point", "[unit]") {
  ShapedModel model([](double x) { return 10.0 + std::abs(x - 1.0); });
  ChordSearch search(model, {3.0});
  search.search(make_whitener(model));
  const int taken = model.linearizations;
  search.renew();
  CHECK(model.linearizations == taken);
}

}  // namespace
}  // namespace strut
