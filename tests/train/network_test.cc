// Networks: layout of the weights, predictions against plain loops, start weights.
#include "train/network/network.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "tests/support/test_car.h"
#include "tests/train/network_reference.h"
#include "train/network/kernel.h"

namespace strut {
namespace {

using test::calc_outputs;
using test::make_random_weights;
using test::tolerance;
using Numbers = std::vector<double>;

TEST_CASE("Weights are stored layer by layer, W by rows, then b", "[unit]") {
  const NetworkShape shape({4, 27, 19, 11, 4});
  CHECK(shape.weight_count == 935);
  CHECK(shape.layers[1].weights == 5 * 27);
  CHECK(shape.layers[1].at(0, 1) == 5 * 27 + 1);
  CHECK(shape.layers[1].at(1, 0) == 5 * 27 + 27);
  CHECK(shape.layers[1].at(2, 27) == 5 * 27 + 19 * 27 + 2);
  CHECK_THROWS_AS(NetworkShape({4}), InputError);
  CHECK_THROWS_AS(NetworkShape({4, 0, 4}), InputError);
  CHECK_THROWS_AS(NetworkShape({4, 100000, 4}), InputError);
}

TEST_CASE("Predictions agree with plain loops on every instruction set", "[unit]") {
  for (const TrainKernel& kernel : list_train_kernels()) {
    for (const auto& sizes : test::kShapes) {
      const NetworkShape shape(sizes);
      const Numbers weights = make_random_weights(shape, 3);
      const Predictor predictor(shape, weights, kernel);
      const auto in = static_cast<std::size_t>(shape.inputs());
      const auto out = static_cast<std::size_t>(shape.outputs());
      constexpr std::size_t kRows = 67;
      const Numbers inputs = test::make_uniform(kRows * in, 5);
      Numbers outputs(kRows * out), single(out);
      predictor.predict_rows(inputs.data(), kRows, outputs.data());
      for (std::size_t row = 0; row < kRows; ++row) {
        const Numbers truth = calc_outputs(shape, weights, inputs.data() + row * in);
        predictor.predict(inputs.data() + row * in, single.data());
        for (std::size_t o = 0; o < out; ++o) {
          INFO(kernel.isa << " row " << row << " output " << o);
          // Sums of about ten terms of order one, tanh accurate to 2 ulp.
          CHECK(std::fabs(single[o] - truth[o]) <= tolerance(1e-13));
          CHECK(std::fabs(outputs[row * out + o] - truth[o]) <= tolerance(1e-13));
        }
      }
    }
  }
}

TEST_CASE("Tansig is accurate to two units in the last place and saturates", "[unit]") {
  const NetworkShape shape({1, 1, 1});
  for (const TrainKernel& kernel : list_train_kernels()) {
    const Predictor predictor(shape, {1.0, 0.0, 1.0, 0.0}, kernel);
    double worst = 0.0;
    for (int i = 0; i < 200000; ++i) {
      const double x = (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, -9.0 + 10.3 * i / 200000);
      double y = 0.0;
      predictor.predict(&x, &y);
      const long double truth = std::tanh(static_cast<long double>(x));
      const auto size = static_cast<double>(std::fabs(truth));
      const double unit = std::nextafter(size, 2.0) - size;
      worst = std::max(worst, static_cast<double>(std::fabs(y - truth)) / unit);
    }
    INFO(kernel.isa);
    CHECK(worst <= tolerance(2.0));
    for (const double x : {40.0, 1e300, HUGE_VAL}) {
      double y = 0.0;
      predictor.predict(&x, &y);
      CHECK(y == 1.0);
    }
    double y = 0.0;
    const double nan = std::nan("");
    predictor.predict(&nan, &y);
    CHECK(std::isnan(y));
  }
}

TEST_CASE("Nguyen-Widrow rows have the documented length and spread", "[unit]") {
  const NetworkShape shape({4, 27, 19, 3});
  const Numbers w = make_nguyen_widrow_weights(shape, {-1.0, 1.0}, 7);
  for (std::size_t l = 0; l < 2; ++l) {
    const NetworkLayer& layer = shape.layers[l];
    const double length = 2.0 * 0.7 * std::pow(layer.outputs, 1.0 / layer.inputs);
    for (int o = 0; o < layer.outputs; ++o) {
      double squares = 0.0;
      for (int i = 0; i < layer.inputs; ++i) squares += std::pow(w[layer.at(o, i)], 2);
      CHECK(std::sqrt(squares) == Approx(length).epsilon(tolerance(1e-14)));
      const double position = -1.0 + 2.0 * o / (layer.outputs - 1);
      const double sign = w[layer.at(o, 0)] < 0.0 ? -1.0 : 1.0;
      CHECK(w[layer.at(o, layer.inputs)] == Approx(sign * position * length).margin(1e-14));
    }
  }
  double low = 1.0, high = -1.0;
  for (std::size_t i = shape.layers[2].weights; i < w.size(); ++i) {
    low = std::min(low, w[i]);
    high = std::max(high, w[i]);
  }
  CHECK(low >= -1.0);
  CHECK(low < -0.8);
  CHECK(high < 1.0);
  CHECK(high > 0.8);
  CHECK_THROWS_AS(make_nguyen_widrow_weights(shape, {1.0, 1.0}, 7), InputError);
}

TEST_CASE("Another input range gives the same network on mapped inputs", "[unit][property]") {
  const NetworkShape shape({3, 6, 5, 2});
  const Numbers symmetric = make_nguyen_widrow_weights(shape, {-1.0, 1.0}, 11);
  const Numbers positive = make_nguyen_widrow_weights(shape, {0.0, 1.0}, 11);
  for (int i = 0; i < 20; ++i) {
    const Numbers u = test::make_uniform(3, 100 + i);
    Numbers half(3);
    for (std::size_t k = 0; k < 3; ++k) half[k] = 0.5 * (u[k] + 1.0);
    const Numbers a = calc_outputs(shape, symmetric, u.data());
    const Numbers b = calc_outputs(shape, positive, half.data());
    for (std::size_t o = 0; o < 2; ++o) CHECK(std::fabs(a[o] - b[o]) <= tolerance(1e-13));
  }
}

TEST_CASE("The same seed gives the same start weights, another seed gives others", "[unit]") {
  const NetworkShape shape({4, 8, 4});
  CHECK(make_nguyen_widrow_weights(shape, {}, 1) == make_nguyen_widrow_weights(shape, {}, 1));
  CHECK(make_nguyen_widrow_weights(shape, {}, 1) != make_nguyen_widrow_weights(shape, {}, 2));
  const Numbers w = make_xavier_weights(shape, 1);
  CHECK(w == make_xavier_weights(shape, 1));
  CHECK(w != make_xavier_weights(shape, 2));
  for (const NetworkLayer& layer : shape.layers) {
    const double bound = std::sqrt(6.0 / (layer.inputs + layer.outputs));
    for (std::size_t i = layer.weights; i < layer.biases; ++i) CHECK(std::fabs(w[i]) <= bound);
    for (int o = 0; o < layer.outputs; ++o) CHECK(w[layer.at(o, layer.inputs)] == 0.0);
  }
}

TEST_CASE("A predictor refuses weights that are not finite or do not fit its shape", "[unit]") {
  const NetworkShape shape({2, 3, 1});
  CHECK_THROWS_AS(Predictor(shape, Numbers(12)), InputError);
  Numbers weights(13);
  weights[4] = std::nan("");
  CHECK_THROWS_AS(Predictor(shape, weights), InputError);
}

}  // namespace
}  // namespace strut
