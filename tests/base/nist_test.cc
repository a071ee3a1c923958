// NIST's hard nonlinear regressions (StRD), by the core that trains networks. Data and certified
// values: data/README.md. Jacobians are analytic.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>

#include "base/least_squares/levenberg_marquardt.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;
using Numbers = std::vector<double>;

/// y(x; b), and its derivatives by b into j.
using TrainedModel = double (*)(double x, const double* b, double* j);

struct Regression {
  const char* name;
  TrainedModel model;
  std::vector<Numbers> starts;
  Numbers certified;
  double certified_sum;  // sum of squares
};

double calc_mgh09(double x, const double* b, double* j) {
  const double above = x * x + x * b[1], below = x * x + x * b[2] + b[3];
  const double y = b[0] * above / below;
  j[0] = above / below;
  j[1] = b[0] * x / below;
  j[2] = -y * x / below;
  j[3] = -y / below;
  return y;
}

double calc_mgh10(double x, const double* b, double* j) {
  j[0] = std::exp(b[1] / (x + b[2]));
  const double y = b[0] * j[0];
  j[1] = y / (x + b[2]);
  j[2] = -y * b[1] / ((x + b[2]) * (x + b[2]));
  return y;
}

double calc_thurber(double x, const double* b, double* j) {
  const double above = b[0] + x * (b[1] + x * (b[2] + x * b[3]));
  const double below = 1.0 + x * (b[4] + x * (b[5] + x * b[6]));
  double power = 1.0;
  for (int i = 0; i < 4; ++i, power *= x) j[i] = power / below;
  power = x;
  for (int i = 4; i < 7; ++i, power *= x) j[i] = -above * power / (below * below);
  return above / below;
}

double calc_rat43(double x, const double* b, double* j) {
  const double e = std::exp(b[1] - b[2] * x), base = 1.0 + e;
  j[0] = std::pow(base, -1.0 / b[3]);
  const double y = b[0] * j[0];
  j[1] = -y * e / (b[3] * base);
  j[2] = y * x * e / (b[3] * base);
  j[3] = y * std::log(base) / (b[3] * b[3]);
  return y;
}

double calc_eckerle4(double x, const double* b, double* j) {
  const double z = (x - b[2]) / b[1], bell = std::exp(-0.5 * z * z) / b[1];
  const double y = b[0] * bell;
  j[0] = bell;
  j[1] = y * (z * z - 1.0) / b[1];
  j[2] = y * z / b[1];
  return y;
}

double calc_box_bod(double x, const double* b, double* j) {
  const double e = std::exp(-b[1] * x);
  j[0] = 1.0 - e;
  j[1] = b[0] * x * e;
  return b[0] * (1.0 - e);
}

double calc_bennett5(double x, const double* b, double* j) {
  const double base = b[1] + x;
  j[0] = std::pow(base, -1.0 / b[2]);
  const double y = b[0] * j[0];
  j[1] = -y / (b[2] * base);
  j[2] = y * std::log(base) / (b[2] * b[2]);
  return y;
}

double calc_lanczos1(double x, const double* b, double* j) {
  double y = 0.0;
  for (int i = 0; i < 6; i += 2) {
    j[i] = std::exp(-b[i + 1] * x);
    j[i + 1] = -b[i] * x * j[i];
    y += b[i] * j[i];
  }
  return y;
}

const std::vector<Regression>& list_regressions() {
  static const std::vector<Regression> regressions{
      {"MGH09",
       calc_mgh09,
       {{25.0, 39.0, 41.5, 39.0}, {0.25, 0.39, 0.415, 0.39}},
       {1.9280693458e-01, 1.9128232873e-01, 1.2305650693e-01, 1.3606233068e-01},
       3.0750560385e-04},
      {"MGH10",
       calc_mgh10,
       {{2.0, 400000.0, 25000.0}, {0.02, 4000.0, 250.0}},
       {5.6096364710e-03, 6.1813463463e+03, 3.4522363462e+02},
       8.7945855171e+01},
      {"Thurber",
       calc_thurber,
       {{1000.0, 1000.0, 400.0, 40.0, 0.7, 0.3, 0.03},
        {1300.0, 1500.0, 500.0, 75.0, 1.0, 0.4, 0.05}},
       {1.2881396800e+03, 1.4910792535e+03, 5.8323836877e+02, 7.5416644291e+01, 9.6629502864e-01,
        3.9797285797e-01, 4.9727297349e-02},
       5.6427082397e+03},
      {"Rat43",
       calc_rat43,
       {{100.0, 10.0, 1.0, 1.0}, {700.0, 5.0, 0.75, 1.3}},
       {6.9964151270e+02, 5.2771253025e+00, 7.5962938329e-01, 1.2792483859e+00},
       8.7864049080e+03},
      {"Eckerle4",
       calc_eckerle4,
       {{1.0, 10.0, 500.0}, {1.5, 5.0, 450.0}},
       {1.5543827178e+00, 4.0888321754e+00, 4.5154121844e+02},
       1.4635887487e-03},
      {"BoxBOD",
       calc_box_bod,
       {{1.0, 1.0}, {100.0, 0.75}},
       {2.1380940889e+02, 5.4723748542e-01},
       1.1680088766e+03},
      {"Bennett5",
       calc_bennett5,
       {{-2000.0, 50.0, 0.8}, {-1500.0, 45.0, 0.85}},
       {-2.5235058043e+03, 4.6736564644e+01, 9.3218483193e-01},
       5.2404744073e-04},
      {"Lanczos1",
       calc_lanczos1,
       {{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4.0, 6.3}},
       {9.5100000027e-02, 1.0000000001e+00, 8.6070000013e-01, 3.0000000002e+00, 1.5575999998e+00,
        5.0000000001e+00},
       1.4307867721e-25}};
  return regressions;
}

struct Observation {
  double y, x;
};

std::vector<Observation> read_observations(const std::string& name) {
  const std::string path = std::string(STRUT_SOURCE_DIR) + "/tests/data/nist/" + name + ".txt";
  std::ifstream stream(path);
  std::vector<Observation> observations;
  for (Observation o{}; stream >> o.y >> o.x;) observations.push_back(o);
  INFO(path);
  REQUIRE(observations.size() >= 6);
  return observations;
}

class RegressionProblem : public LeastSquaresProblem {
 public:
  explicit RegressionProblem(const Regression& regression)
      : regression_(&regression), observations_(read_observations(regression.name)) {}

  std::size_t weight_count() const override { return regression_->certified.size(); }
  double residual_count() const override { return static_cast<double>(observations_.size()); }

  double calc_gram(const double* b, int, double* h, double* gradient) override {
    const std::size_t n = weight_count();
    std::fill_n(h, n * n, 0.0);
    std::fill_n(gradient, n, 0.0);
    Numbers j(n);
    double sum = 0.0;
    for (const Observation& o : observations_) {
      const double e = regression_->model(o.x, b, j.data()) - o.y;
      sum += e * e;
      for (std::size_t c = 0; c < n; ++c) {
        gradient[c] += j[c] * e;
        for (std::size_t r = c; r < n; ++r) h[c * n + r] += j[c] * j[r];
      }
    }
    return sum;
  }

  double calc_loss(const double* b) override {
    Numbers j(weight_count());
    double sum = 0.0;
    for (const Observation& o : observations_) {
      const double e = regression_->model(o.x, b, j.data()) - o.y;
      sum += e * e;
    }
    return sum;
  }

 private:
  const Regression* regression_;
  std::vector<Observation> observations_;
};

/// Digits that a has in common with b: -log10 of the relative error.
double count_digits(double a, double b) { return -std::log10(std::fabs(a - b) / std::fabs(b)); }

TEST_CASE("Jacobians of the NIST regressions agree with differences", "[unit]") {
  for (const Regression& r : list_regressions()) {
    const std::size_t n = r.certified.size();
    for (const Observation& o : read_observations(r.name)) {
      Numbers j(n), unused(n);
      r.model(o.x, r.certified.data(), j.data());
      for (std::size_t i = 0; i < n; ++i) {
        Numbers up = r.certified, down = r.certified;
        const double step = 1e-6 * std::fabs(r.certified[i]);
        up[i] += step;
        down[i] -= step;
        const double y_up = r.model(o.x, up.data(), unused.data());
        const double y_down = r.model(o.x, down.data(), unused.data());
        INFO(r.name << " x " << o.x << " parameter " << i);
        // Central differences: 1e-10 of rounding, and (step / width)^2 z^2 / 6 of curvature, which
        // is 3e-7 in the tails of Eckerle4's bell, 13 widths out.
        const double scale = std::fabs(y_up) / std::fabs(r.certified[i]) + std::fabs(j[i]);
        CHECK(std::fabs((y_up - y_down) / (2.0 * step) - j[i]) <= tolerance(1e-6) * scale);
      }
    }
  }
}

/// Marquardt's scaling, since the parameters differ by up to eight decades. One of the sixteen
/// needs another: from the first start of BoxBOD an early step leads to a plateau, unless it is
/// short.
LevenbergMarquardtOptions make_options(const Regression& regression, std::size_t start) {
  LevenbergMarquardtOptions options;
  options.scale = DampingScale::kDiagonal;
  options.first_damping = 1.0;
  options.min_gradient = 0.0;
  options.epochs = 10000;  // MGH10 from the first start follows a bent valley for 5,000
  if (std::string(regression.name) == "BoxBOD" && start == 0) {
    options.scale = DampingScale::kLargestDiagonal;
    options.first_damping = 1000.0;
  }
  return options;
}

TEST_CASE("NIST regressions are solved to six certified digits from both starts", "[reference]") {
  for (const Regression& r : list_regressions()) {
    for (std::size_t start = 0; start < r.starts.size(); ++start) {
      RegressionProblem problem(r);
      LevenbergMarquardt solver(problem, nullptr, make_options(r, start));
      solver.start(r.starts[start]);
      const TrainingSummary summary = solver.run();
      INFO(r.name << " from start " << start + 1 << ": " << summary.make_line());
      for (std::size_t i = 0; i < r.certified.size(); ++i) {
        CHECK(count_digits(summary.weights[i], r.certified[i]) >= 6.0 / tolerance(1.0));
      }
      // The data of Lanczos1 have 13 digits: what is left of the sum is their rounding.
      const double digits = r.certified_sum > 1e-20 ? 6.0 : 1.0;
      CHECK(count_digits(problem.calc_loss(summary.weights.data()), r.certified_sum) >= digits);
    }
  }
}

}  // namespace
}  // namespace strut
