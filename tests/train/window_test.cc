// Windows of records and their components, the inputs of a network.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "base/error/input_error.h"
#include "tests/support/test_car.h"
#include "tests/train/pulse_records.h"
#include "train/data/shift.h"
#include "train/window/rows.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using Eigen::Index;
using test::TemporaryFolder;
using test::tolerance;

const std::vector<ColumnInfo> kChannels = {{"a", "m", ""}, {"b", "m", ""}};

/// Maximum error of sin(w t), sampled every h, interpolated between its samples.
double calc_sine_error(double h) {
  const double w = 3.0;
  std::vector<double> signal, between(20);
  for (int i = 0; i < 40; ++i) signal.push_back(std::sin(w * h * i));
  double worst = 0.0;
  for (const double u : {0.1, 0.5, 0.8}) {
    read_shifted(signal, 7.0 + u, between);
    for (std::size_t i = 0; i < between.size(); ++i) {
      const double truth = std::sin(w * h * (7.0 + u + static_cast<double>(i)));
      worst = std::max(worst, std::abs(between[i] - truth));
    }
  }
  return worst;
}

TEST_CASE("A shifted sine equals the sine at the shifted time to sixth order", "[property]") {
  for (const double h : {0.1, 0.05}) {
    // The remainder at u = 1/2, its maximum: w^6 h^6 / 6! times (5/2 3/2 1/2)^2.
    const double bound = 225.0 / 64.0 / 720.0 * std::pow(3.0 * h, 6);
    CHECK(calc_sine_error(h) <= bound * (1.0 + 1e-6));
    CHECK(calc_sine_error(h) >= 0.5 * bound);
  }
  // Up to terms of the next order.
  CHECK(calc_sine_error(0.1) / calc_sine_error(0.05) == Approx(64.0).epsilon(0.1));
}

TEST_CASE("Interpolated white noise has the variance of the weights", "[statistical]") {
  CHECK(calc_shift_gain(0.0) == 1.0);
  CHECK(calc_shift_gain(0.3) == Approx(calc_shift_gain(0.7)));
  const double u = GENERATE(0.2, 0.5);
  const NoiseModel noise{{1.0}, {0.0}};
  std::vector<double> signal(60000), between(signal.size() - 10);
  NoiseDraw(noise, 1, 0).add(0, signal);
  read_shifted(signal, 3.0 + u, between);
  double squares = 0.0;
  for (const double y : between) squares += y * y / static_cast<double>(between.size());
  // Five standard errors of a variance, sqrt(2 / n), at most doubled by the correlation.
  CHECK(calc_shift_gain(u) == Approx(squares).epsilon(10.0 * std::sqrt(2.0 / 60000.0)));
}

TEST_CASE("A shift by whole samples copies, and one beyond the signal is refused", "[unit]") {
  const std::vector<double> signal = {0, 1, 4, 9, 16, 25, 36, 49};
  std::vector<double> window(3);
  read_shifted(signal, 2.0, window);
  CHECK(window == std::vector{4.0, 9.0, 16.0});
  CHECK_THROWS_AS(read_shifted(signal, 1.9, window), std::logic_error);
  CHECK_THROWS_AS(read_shifted(signal, 3.0, window), std::logic_error);
}

/// Two channels of 40 samples and five orthonormal directions, the first that of a bias.
WindowTransform make_plain_transform() {
  const std::size_t n = 40;
  WindowTransform transform;
  transform.channels = kChannels;
  transform.noise = {{0.5, 2.0}, {3.0, 0.0}};
  transform.grid = {0.01, 0, n, 0};
  transform.mean.assign(2 * n, 0.0);
  Eigen::MatrixXd columns(2 * n, 5);
  for (Index i = 0; i < columns.rows(); ++i) {
    columns(i, 0) = i < static_cast<Index>(n) ? 1.0 : 0.0;
    for (Index k = 1; k < 5; ++k) columns(i, k) = std::sin(0.1 * static_cast<double>(i * (k + 1)));
  }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
                            Eigen::MatrixXd::Identity(2 * n, 5);
  transform.basis.assign(q.reshaped().begin(), q.reshaped().end());
  return transform;
}

TEST_CASE("Components of noise and bias have unit variance and no correlation", "[statistical]") {
  const WindowTransform transform = make_plain_transform();
  const std::size_t n = transform.grid.samples;
  const int records = 20000;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(5, 5);
  double residual = 0.0;
  for (int r = 0; r < records; ++r) {
    std::vector<double> record(2 * n, 0.0), components(5);
    const NoiseDraw draw(transform.noise, r, 0);
    for (std::size_t c = 0; c < 2; ++c) draw.add(c, std::span(record).subspan(c * n, n));
    residual += read_components(transform, {record, n}, components).residual / records;
    const Eigen::Map<const Eigen::VectorXd> x(components.data(), 5);
    covariance += x * x.transpose() / records;
  }
  // Five standard errors of a variance, sqrt(2 / n), and of a covariance, sqrt(1 / n).
  const double error = 5.0 / std::sqrt(records);
  for (Index i = 0; i < 5; ++i) {
    for (Index j = 0; j < 5; ++j) {
      CHECK(std::abs(covariance(i, j) - (i == j ? 1.0 : 0.0)) <
            (i == j ? std::sqrt(2.0) : 1.0) * error);
    }
  }
  CHECK(residual == Approx(1.0).epsilon(error));
}

/// Records of pulses in memory, as read from a dataset.
struct Pulses {
  explicit Pulses(std::size_t count, const NoiseModel& noise = test::make_pulse_noise(),
                  const WindowChoice& choice = {0.3, 1.5, 0.1, 10})
      : file(test::write_pulses(folder, count)), data({file}, {.histories = true}) {
    const std::size_t spare = count_spare(data.schema(), noise);
    const WindowGrid grid = make_window_grid(data.schema(), choice, spare);
    records =
        read_window_records(data, {{"imu_acceleration_z", "imu_rate_y"}, {}}, grid, spare, {});
  }

  TemporaryFolder folder;
  std::filesystem::path file;
  Dataset data;
  WindowRecords records;
};

TEST_CASE("A window is found anywhere in a record, to a hundredth of a sample", "[unit]") {
  const Pulses pulses(40);
  const WindowTransform transform = make_window_transform(
      pulses.records, Split(40, 0.7, 0.15, 1), test::make_pulse_noise(), {0.3, 1.5, 0.1, 10}, {});
  const double start = GENERATE(0.4, 1.0, 1.4037);
  std::vector<double> record;
  for (std::size_t c = 0; c < 2; ++c) {
    for (int i = 0; i < 300; ++i) record.push_back(test::calc_pulse(c, 0.01 * i, start, 4.5, 20.5));
  }
  const WindowAlignment alignment = find_alignment(transform, {record, 300});
  CHECK(alignment.found);
  // The window begins 0.2 s before the pulse. The reference is another record, whose faster or
  // slower sine shifts the best agreement slightly.
  CHECK(alignment.begin == Approx((start - 0.2) / 0.01).margin(0.2));
  std::vector<double> later(record.size());
  for (std::size_t c = 0; c < 2; ++c) {
    for (int i = 0; i < 300; ++i) {
      later[c * 300 + static_cast<std::size_t>(i)] =
          test::calc_pulse(c, 0.01 * i, start + 0.0537, 4.5, 20.5);
    }
  }
  CHECK(find_alignment(transform, {later, 300}).begin - alignment.begin ==
        Approx(5.37).margin(0.01));
  CHECK(!find_alignment(transform, {std::span(record).first(2 * 130), 130}).found);
  CHECK_THROWS_WITH(find_alignment(transform, {std::span(record).first(2 * 128), 128}),
                    Contains("128 samples; the window needs at least 129"));
}

TEST_CASE("The basis spans the eigenvectors of the largest eigenvalues of the records' covariance",
          "[reference]") {
  NoiseModel noise = test::make_pulse_noise();
  noise.hit_time = 0.0;
  const WindowChoice choice{0.3, 0.9, 0.0, 5};
  const Pulses pulses(60, noise, choice);
  const Split split(60, 0.7, 0.15, 1);
  const WindowTransform transform = make_window_transform(pulses.records, split, noise, choice, {});
  CHECK(transform.reference.empty());
  // Dense, by definition: C^(-1/2) y of each channel.
  const Index n = static_cast<Index>(transform.grid.samples);
  Eigen::MatrixXd windows(2 * n, 42);
  Index column = 0;
  std::vector<double> row(pulses.records.rows.columns());
  for (int i = 0; i < 60; ++i) {
    if (split.find_part(i) != Part::kTrain) continue;
    pulses.records.rows.read(static_cast<std::size_t>(i), 1, row.data());
    for (Index c = 0; c < 2; ++c) {
      const auto at = static_cast<std::size_t>(c);
      const Eigen::MatrixXd covariance =
          Eigen::MatrixXd::Identity(n, n) * std::pow(noise.sigma[at], 2) +
          Eigen::MatrixXd::Constant(n, n, std::pow(noise.bias[at], 2));
      const Eigen::Map<const Eigen::VectorXd> y(row.data() + c * n, n);
      windows.col(column).segment(c * n, n) =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).operatorInverseSqrt() * y;
    }
    ++column;
  }
  REQUIRE(column == 42);
  windows.colwise() -= windows.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(windows * windows.transpose() / 42.0);
  const auto count = static_cast<Index>(transform.components());
  CHECK(count == std::min<Index>(5, (solver.eigenvalues().array() > 1.0).count()));
  REQUIRE(count > 1);
  const Eigen::MatrixXd truth = solver.eigenvectors().rightCols(count);
  const Eigen::Map<const Eigen::MatrixXd> basis(transform.basis.data(), 2 * n, count);
  CHECK((basis.transpose() * basis - Eigen::MatrixXd::Identity(count, count)).norm() <
        tolerance(1e-12));
  // Five iterations reduce the error by the fifth power of the eigenvalues' ratio.
  CHECK((basis * basis.transpose() - truth * truth.transpose()).norm() < tolerance(1e-6));
}

TrainingRows make_rows(Pulses& pulses, int threads, const RowStoreOptions& store = {}) {
  return make_window_rows(pulses.data, {{"imu_acceleration_z", "imu_rate_y"}, {}}, {},
                          {0.3, 1.5, 0.1, 10}, test::make_pulse_noise(), threads, store);
}

std::vector<double> read_all(const RowStore& rows) {
  std::vector<double> values(rows.row_count() * rows.columns());
  rows.read(0, rows.row_count(), values.data());
  return values;
}

TEST_CASE("The rows of a window do not depend on threads and stores", "[property]") {
  Pulses pulses(60);
  const TrainingRows rows = make_rows(pulses, 1), shared = make_rows(pulses, 2),
                     filed = make_rows(pulses, 2, {.memory = 1000, .scratch = pulses.folder / "."});
  REQUIRE(rows.window);
  for (const TrainingRows* other : {&shared, &filed}) {
    CHECK(other->window->basis == rows.window->basis);
    CHECK(other->window->residual_mean == rows.window->residual_mean);
    CHECK(read_all(other->train) == read_all(rows.train));
    CHECK(read_all(other->validate) == read_all(rows.validate));
    CHECK(read_all(other->test) == read_all(rows.test));
  }
}

TEST_CASE("Copies of a record stay in the part of their case and differ", "[property]") {
  Pulses pulses(60);
  const TrainingRows rows = make_rows(pulses, 1);
  const std::size_t k = rows.window->components();
  CHECK(rows.usable == 60);
  std::set<double> seen;
  std::size_t cases = 0;
  for (const RowStore* part : {&rows.train, &rows.validate, &rows.test}) {
    const std::vector<double> values = read_all(*part);
    std::multiset<double> sizes;
    std::set<double> firsts;
    for (std::size_t i = 0; i < part->row_count(); ++i) {
      sizes.insert(values[i * (k + 2) + k]);
      firsts.insert(values[i * (k + 2)]);
    }
    for (const double size : sizes) CHECK(sizes.count(size) == 3);
    CHECK(firsts.size() == part->row_count());
    seen.insert(sizes.begin(), sizes.end());
    cases += part->row_count() / 3;
  }
  CHECK(cases == 60);
  CHECK(seen.size() == 60);
}

TEST_CASE("The residual of a noisy record is noise alone, for any alignment", "[statistical]") {
  Pulses pulses(60);
  const TrainingRows rows = make_rows(pulses, 1);
  // 232 degrees of freedom: 0.093, more where interpolation correlates them; 126 records.
  CHECK(rows.window->residual_mean == Approx(1.0).margin(0.04));
  CHECK(rows.window->residual_deviation < 0.13);
}

TEST_CASE("A window that does not fit the data is refused", "[unit]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = test::write_pulses(folder, 30);
  Dataset data({file}, {.histories = true});
  const auto check = [&](const RowChoice& rows, const WindowChoice& window, const char* text) {
    CHECK_THROWS_WITH(make_window_rows(data, rows, {}, window, test::make_pulse_noise(), 1, {}),
                      Contains(text));
  };
  const RowChoice both{{"imu_acceleration_z", "imu_rate_y"}, {}};
  check(both, {0.1, 1.0}, "--window = 0.1:1: must begin before it ends and lie in [0.17, 1.83] s");
  check(both, {0.5, 2.0}, "--window = 0.5:2");
  check(both, {1.0, 0.5}, "begin before it ends");
  check(both, {0.5, 1.0, 1.0}, "the histories, 2 s, have no room between the 1.12 s");
  check({{"imu_acceleration_z", "pitch_angle"}, {}}, {0.4, 1.0},
        "no history channel 'pitch_angle'");
  check({{"imu_acceleration_z", "imu_rate_y"}, {"mass"}}, {0.4, 1.0}, "no parameter 'mass'");
  check({{"imu_acceleration_z"}, {}}, {0.4, 1.0}, "each of the 1 channels");
  check(both, {0.8, 1.0, 0.01}, "--align");
}

TEST_CASE("Histories are read only on request", "[io]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = test::write_pulses(folder, 12);
  Dataset without({file}), with({file}, {.histories = true});
  CHECK(without.schema().history.size() == 2);
  CHECK(without.read_piece(0).history.empty());
  CHECK(without.read(2, 3).history.empty());
  CHECK(with.read(2, 3).history[1].size() == 3 * test::kPulseSamples);
  CHECK(without.read(2, 3).parameters == with.read(2, 3).parameters);
}

}  // namespace
}  // namespace strut
