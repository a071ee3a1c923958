// Readings of three channels whose noise has a source in common.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "diagnose/noise/noise_spectrum.h"
#include "estimate/reading_model.h"

namespace strut::test {

inline constexpr std::size_t kSamples = 240, kChannels = 3;
inline constexpr double kInterval = 0.01;  // s

/// Readings that are the unknown itself, a constant in every channel.
class ConstantModel : public ReadingModel {
 public:
  /// `kept`: the last channel has one sample in `kept`.
  explicit ConstantModel(std::size_t runs, std::size_t kept = 1) : ReadingModel({Unknown{}}) {
    unknowns_.front().name = "constant";
    for (std::size_t r = 0; r < runs; ++r) {
      channels_.push_back({0, 1, 2});
      for (std::size_t t = 0; t < kSamples; ++t) {
        for (std::size_t c = 0; c < kChannels; ++c) {
          if (c + 1 < kChannels || t % kept == 0) readings_.push_back({r, t, c});
        }
      }
    }
  }
  Linearization linearize(const std::vector<double>& values) override {
    Linearization at;
    const auto rows = static_cast<Eigen::Index>(reading_count());
    at.residual = Eigen::VectorXd::Constant(rows, values.front());
    at.jacobian = Eigen::MatrixXd::Ones(rows, 1);
    return at;
  }
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override {
    std::vector<Evaluation> evaluations;
    evaluations.reserve(points.size());
    for (const std::vector<double>& p : points) evaluations.push_back({"", linearize(p).residual});
    return evaluations;
  }
};

/// The response of a channel to one source: weighted, and late by the channel's number of samples.
inline double get_weight(std::size_t channel) { return 3.0 + 2.0 * static_cast<double>(channel); }

/// White sensors of 1 sigma, and the source.
inline NoiseSpectrum make_spectrum() {
  NoiseSpectrum s;
  s.samples = kSamples;
  s.interval = kInterval;
  s.sigma = {1.0, 1.0, 1.0};
  s.response_error = 0.0;
  Eigen::MatrixXcd source(kChannels, kSamples / 2 + 1);
  for (Eigen::Index k = 0; k < source.cols(); ++k) {
    for (Eigen::Index c = 0; c < source.rows(); ++c) {
      const double phase = -2.0 * std::numbers::pi * static_cast<double>(k * c) / kSamples;
      source(c, k) = std::polar(get_weight(static_cast<std::size_t>(c)), phase);
    }
  }
  for (Eigen::Index k = 0; k < source.cols(); ++k) {
    s.common.emplace_back(source.col(k) * source.col(k).adjoint());
  }
  return s;
}

}  // namespace strut::test
