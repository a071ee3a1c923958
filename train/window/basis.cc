#include "train/window/basis.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "base/text/range.h"

namespace strut {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstMap = Eigen::Map<const VectorXd>;

/// Records held in memory at a time; one of 1000 samples and two channels takes 16 kB.
constexpr std::size_t kPieceRows = 64;
/// Draws of the hit time per record.
constexpr int kDraws = 2;
/// Directions beyond those requested: the iteration converges with the ratio of the variances of
/// the last requested and the last of all directions.
constexpr int kSpareDirections = 8, kIterations = 5;
/// Stream of the iteration's random start.
constexpr std::uint64_t kStartStream = 0x62617369;

Index to_index(std::size_t i) { return static_cast<Index>(i); }

ConstMap map_row(std::span<const double> rows, std::size_t row, std::size_t columns) {
  return {rows.data() + row * columns, to_index(columns)};
}

/// Calls use(row number, record) for the records of the training part, as recorded.
template <class F>
void for_each_training(const WindowRecords& records, const Split& split, const F& use) {
  const auto piece = [&](std::span<const double> rows, std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = static_cast<std::int64_t>(first + i);
      if (split.find_part(number) != Part::kTrain) continue;
      use(number, rows.subspan(i * records.rows.columns(), records.rows.columns()));
    }
  };
  for_each_piece(records.rows, piece, kPieceRows);
}

/// Writes a channel's unshifted window, without its mean and divided by sigma.
void fill_centered(const WindowRecords& records, std::span<const double> row, std::size_t channel,
                   double sigma, VectorXd& window) {
  const Index n = to_index(records.grid.samples);
  const std::size_t begin = records.spare + records.grid.margin();
  const ConstMap y(row.data() + channel * records.samples() + begin, n);
  window.segment(to_index(channel) * n, n) = (y.array() - y.mean()) / sigma;
}

VectorXd calc_centered(const WindowRecords& records, std::span<const double> row,
                       const NoiseModel& noise) {
  VectorXd window(to_index(records.channels.size() * records.grid.samples));
  for (std::size_t c = 0; c < records.channels.size(); ++c) {
    fill_centered(records, row, c, noise.sigma[c], window);
  }
  return window;
}

std::vector<double> find_reference(const WindowRecords& records, const Split& split,
                                   const NoiseModel& noise) {
  VectorXd mean = VectorXd::Zero(to_index(records.channels.size() * records.grid.samples));
  for_each_training(records, split, [&](std::int64_t, std::span<const double> row) {
    mean += calc_centered(records, row, noise);
  });
  mean /= static_cast<double>(split.count(Part::kTrain));
  double min = std::numeric_limits<double>::infinity();
  VectorXd nearest = mean;
  for_each_training(records, split, [&](std::int64_t, std::span<const double> row) {
    VectorXd window = calc_centered(records, row, noise);
    const double distance = (window - mean).squaredNorm();
    if (distance >= min) return;
    min = distance;
    nearest.swap(window);
  });
  return {nearest.begin(), nearest.end()};
}

/// Aligned, whitened windows of the training part, noise-free.
RowStore make_windows(const WindowRecords& records, const Split& split,
                      const WindowTransform& transform, const RowStoreOptions& store) {
  RowStore windows(transform.window_size(), store);
  std::vector<double> record(transform.record_size()), window(transform.window_size());
  std::int64_t lost = 0;
  const int draws = transform.noise.hit_time > 0.0 ? kDraws : 1;
  for (int copy = 0; copy < draws; ++copy) {
    for_each_training(records, split, [&](std::int64_t number, std::span<const double> row) {
      draw_record(records, row, transform.noise, NoiseDraw(transform.noise, number, copy), true,
                  record);
      const RecordView view{record, transform.grid.record_samples()};
      const WindowAlignment alignment = find_alignment(transform, view);
      if (!alignment.found) ++lost;
      read_white_window(transform, view, alignment.begin, window);
      windows.append(window);
    });
  }
  if (lost == 0) return windows;
  throw InputError(fmt::format(
      "--align: {} of {} records agree best with the reference at the end of +/-{} s; must reach "
      "further, or the window must contain the bump",
      lost, windows.row_count(),
      format_number(static_cast<double>(transform.grid.lags) * transform.grid.interval)));
}

VectorXd calc_mean(const RowStore& windows) {
  VectorXd sum = VectorXd::Zero(to_index(windows.columns()));
  const auto piece = [&](std::span<const double> rows, std::size_t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) sum += map_row(rows, i, windows.columns());
  };
  for_each_piece(windows, piece, kPieceRows);
  return sum / static_cast<double>(windows.row_count());
}

MatrixXd make_start(std::size_t size, Index directions, std::uint64_t seed) {
  MatrixXd start(to_index(size), directions);
  std::uint64_t counter = 0;
  for (double& value : start.reshaped()) value = calc_normal(seed, kStartStream, counter++);
  return start;
}

MatrixXd orthonormalize(const MatrixXd& columns) {
  const Eigen::HouseholderQR<MatrixXd> qr(columns);
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), columns.cols());
}

/// Products of the windows' covariance with orthonormal directions Q.
struct Products {
  MatrixXd covariance;  // covariance of the coordinates, Q' C Q
  MatrixXd image;       // C Q
};

Products multiply(const RowStore& windows, const VectorXd& mean, const MatrixXd& directions) {
  Products sums{MatrixXd::Zero(directions.cols(), directions.cols()),
                MatrixXd::Zero(directions.rows(), directions.cols())};
  VectorXd x, coordinates;
  const auto piece = [&](std::span<const double> rows, std::size_t, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      x = map_row(rows, i, windows.columns()) - mean;
      coordinates.noalias() = directions.transpose() * x;
      sums.image.noalias() += x * coordinates.transpose();
      sums.covariance.noalias() += coordinates * coordinates.transpose();
    }
  };
  for_each_piece(windows, piece, kPieceRows);
  const auto n = static_cast<double>(windows.row_count());
  return {sums.covariance / n, sums.image / n};
}

/// Principal directions with a standard deviation above 1, largest first, at most `max`.
std::vector<double> find_directions(const RowStore& windows, const VectorXd& mean, int max,
                                    std::uint64_t seed) {
  const std::size_t size = windows.columns();
  const Index count = to_index(
      std::min({static_cast<std::size_t>(max + kSpareDirections), size - 1, windows.row_count()}));
  MatrixXd directions = orthonormalize(make_start(size, count, seed));
  for (int step = 0; step < kIterations; ++step) {
    directions = orthonormalize(multiply(windows, mean, directions).image);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(
      multiply(windows, mean, directions).covariance);
  std::vector<double> basis;
  for (Index k = 0; k < std::min<Index>(max, count); ++k) {
    const Index at = count - 1 - k;  // eigenvalues ascend
    if (!(ritz.eigenvalues()(at) > 1.0)) break;
    const VectorXd direction = directions * ritz.eigenvectors().col(at);
    basis.insert(basis.end(), direction.begin(), direction.end());
  }
  return basis;
}

}  // namespace

WindowTransform make_window_transform(const WindowRecords& records, const Split& split,
                                      const NoiseModel& noise, const WindowChoice& choice,
                                      const RowStoreOptions& store) {
  WindowTransform transform;
  transform.channels = records.channels;
  transform.noise = noise;
  transform.grid = records.grid;
  if (records.grid.lags > 0) transform.reference = find_reference(records, split, noise);
  const RowStore windows = make_windows(records, split, transform, store);
  const VectorXd mean = calc_mean(windows);
  transform.mean.assign(mean.begin(), mean.end());
  transform.basis = find_directions(windows, mean, choice.components, noise.seed);
  if (transform.basis.empty()) {
    throw InputError(
        "the records of the training part differ by less than the noise: the window contains no "
        "information; choose another window, other channels, or less noise");
  }
  return transform;
}

}  // namespace strut
