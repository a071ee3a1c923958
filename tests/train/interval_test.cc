#include "train/model/interval.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/test_model.h"

namespace strut {
namespace {

TEST_CASE("A conformal width is the ceil(0.95 (n + 1))-th smallest error", "[unit]") {
  const auto get_width = [](std::size_t n) {
    ConformalWidth width(n);
    // 1 to n, each once, in a scattered order (7919 is prime), with either sign.
    for (std::size_t i = 0; i < n; ++i) {
      const auto error = static_cast<double>(i * 7919 % n + 1);
      width.add(i % 2 == 0 ? error : -error);
    }
    return width.get();
  };
  CHECK(std::isinf(get_width(1)));
  CHECK(std::isinf(get_width(18)));
  CHECK(get_width(19) == 19.0);
  CHECK(get_width(20) == 20.0);
  CHECK(get_width(39) == 38.0);
  CHECK(get_width(99) == 95.0);
  CHECK(get_width(300) == 286.0);
  CHECK(std::isinf(ConformalWidth(0).get()));
}

/// Heavy-tailed errors: the distribution must not matter.
double draw_error(std::uint64_t stream, std::uint64_t i) {
  const double u = calc_uniform(11, stream, i);
  return std::tan(1.5 * (u - 0.5)) * std::exp(2.0 * u);
}

TEST_CASE("A conformal interval contains 95 % of new errors on average", "[statistical]") {
  constexpr int kTrials = 2000, kErrors = 99, kNew = 20;
  int held = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    ConformalWidth width(kErrors);
    for (std::uint64_t i = 0; i < kErrors; ++i) width.add(draw_error(trial, i));
    for (std::uint64_t i = 0; i < kNew; ++i) {
      if (std::abs(draw_error(trial, kErrors + i)) <= width.get()) ++held;
    }
  }
  // With n = 99 the probability is exactly 95 / 100. Errors that share a width are correlated: the
  // coverage of one width is Beta(95, 5), deviation 0.0217, and each of 20 has 0.218 of its own.
  const double deviation = std::sqrt((0.0217 * 0.0217 + 0.218 * 0.218 / kNew) / kTrials);
  const double coverage = static_cast<double>(held) / (kTrials * kNew);
  CHECK(std::abs(coverage - 0.95) < 5.0 * deviation);
}

TEST_CASE("A model's intervals are in its targets' units", "[unit]") {
  const TrainedModel model = test::make_random_model();
  const Identifier identifier(model);
  constexpr std::size_t kRows = 99;
  const std::vector<double> inputs = test::draw_inputs(model, kRows);
  RowStore rows(6);
  for (std::size_t i = 0; i < kRows; ++i) {
    std::vector<double> row(inputs.begin() + static_cast<std::ptrdiff_t>(4 * i),
                            inputs.begin() + static_cast<std::ptrdiff_t>(4 * i + 4));
    row.resize(6);
    identifier.identify(row.data(), row.data() + 4);
    row[4] += static_cast<double>(i + 1);         // errors 1 to 99 N/m
    row[5] -= 1e-3 * static_cast<double>(i + 1);  // 0.001 to 0.099 N s/m
    rows.append(row);
  }
  const std::vector<double> ci95 = calc_ci95(model, rows);
  REQUIRE(ci95.size() == 2);
  CHECK(ci95[0] == Approx(95.0).epsilon(1e-9));
  CHECK(ci95[1] == Approx(0.095).epsilon(1e-6));
}

}  // namespace
}  // namespace strut
