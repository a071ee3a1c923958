#include "sweep/case_points.h"

#include <boost/random/sobol.hpp>

#include "base/math/random.h"
#include "base/math/strata.h"
#include "sweep/random_streams.h"

namespace strut {

struct CasePoints::Sobol {
  explicit Sobol(std::size_t axes) : engine(axes) {}
  boost::random::sobol engine;  // 64 bits; copied before use, as drawing changes it
};

CasePoints::CasePoints(const SweepRequest& request)
    : method_(request.sample.method),
      grid_(request.grid),
      count_(request.sample.count),
      seed_(request.sample.seed) {
  const std::size_t axes = grid_.axes().size();
  if (method_ == SampleMethod::kSobol) sobol_ = std::make_unique<const Sobol>(axes);
  if (method_ != SampleMethod::kLatinHypercube) return;
  cells_.reserve(axes);
  for (std::size_t a = 0; a < axes; ++a) {
    cells_.emplace_back(count_, seed_, get_stream(RandomStream::kCell, a));
  }
}

CasePoints::~CasePoints() = default;
CasePoints::CasePoints(CasePoints&&) noexcept = default;

std::int64_t CasePoints::size() const {
  return method_ == SampleMethod::kGrid ? grid_.size() : count_;
}

void CasePoints::calc_coordinates(std::int64_t id, std::span<std::int64_t> coordinates) const {
  const auto number = static_cast<std::uint64_t>(id);
  if (method_ == SampleMethod::kGrid) return grid_.calc_levels(id, coordinates);
  if (method_ == SampleMethod::kLatinHypercube) {
    for (std::size_t a = 0; a < coordinates.size(); ++a) {
      const std::int64_t cell = cells_[a].apply(id);
      const std::int64_t begin = scale_down(kCoordinates, cell, count_);
      const std::int64_t width = scale_down(kCoordinates, cell + 1, count_) - begin;
      const std::uint64_t bits =
          calc_random_bits(seed_, get_stream(RandomStream::kOffset, a), number);
      const auto offset = static_cast<std::int64_t>(bits >> 2);
      coordinates[a] = begin + scale_down(width, offset, kCoordinates);
    }
    return;
  }
  // The engine skips the first point, zero, without which the sequence is less even.
  boost::random::sobol engine = sobol_->engine;
  if (id > 0) engine.seed(number - 1);
  for (std::size_t a = 0; a < coordinates.size(); ++a) {
    const std::uint64_t point = id > 0 ? engine() : 0;
    const std::uint64_t shift = calc_random_bits(seed_, get_stream(RandomStream::kShift, a), 0);
    coordinates[a] = static_cast<std::int64_t>((point ^ shift) >> 2);
  }
}

void CasePoints::calc_values(std::int64_t id, std::span<double> values) const {
  const std::size_t axes = values.size();
  std::vector<std::int64_t> coordinates(axes);
  calc_coordinates(id, coordinates);
  for (std::size_t a = 0; a < axes; ++a) {
    const Axis& axis = grid_.axes()[a];
    if (method_ == SampleMethod::kGrid) {
      values[a] = axis.calc_value(coordinates[a]);
    } else {
      const double fraction =
          static_cast<double>(coordinates[a]) / static_cast<double>(kCoordinates);
      values[a] = axis.from + fraction * (axis.last() - axis.from);
    }
  }
}

AxisPart CasePoints::calc_part(std::int64_t id, std::size_t axis) const {
  if (method_ == SampleMethod::kLatinHypercube) return {cells_[axis].apply(id), count_};
  std::vector<std::int64_t> coordinates(grid_.axes().size());
  calc_coordinates(id, coordinates);
  const bool levels = method_ == SampleMethod::kGrid;
  return {coordinates[axis], levels ? grid_.axes()[axis].count : kCoordinates};
}

}  // namespace strut
