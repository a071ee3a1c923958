#include "estimate/sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "estimate/line_position.h"
#include "estimate/run_prepared.h"
#include "model/channel/car_channels.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

using C = CarChannel;
using Channels = std::array<double, static_cast<std::size_t>(C::kCount)>;

/// Minimum rate at which runs are sampled, so that interpolation between samples is exact enough.
constexpr double kMinRate = 1000.0;  // 1/s

/// One simulation with its position at every sample.
struct Trajectory : LaneRun {
  std::vector<double> offsets;  // ascending
};

/// The cases of a Jacobian: the base, then per parameter +h, -h, +h/2, -h/2.
constexpr std::size_t kRunsPerParameter = 4;
std::size_t get_run(std::size_t parameter, std::size_t which) {
  return 1 + parameter * kRunsPerParameter + which;
}

SensitivityParameter make_parameter(const Case& base, const Axis& axis, double relative_step) {
  const ParameterInfo& info = find_parameter(axis.name);
  SensitivityParameter p{axis.name, info.unit, info.get(base), 0.0, 0.0};
  p.scale = std::max(std::abs(p.base), 0.5 * std::abs(axis.last() - axis.from));
  if (p.scale == 0.0) p.scale = 1.0;
  p.step = relative_step * p.scale;
  return p;
}

/// The base, or the nearest value around which +/-h is allowed.
double calc_center(const SensitivityParameter& p) {
  const Range& allowed = find_parameter(p.name).allowed;
  return std::max(allowed.low + p.step, std::min(allowed.high - p.step, p.base));
}

struct Variant {
  Case setup;
  std::string label;  // for messages
};

std::vector<Variant> list_variants(const Case& base, const std::vector<SensitivityParameter>& ps) {
  std::vector<Variant> variants{{base, "the base point"}};
  variants.reserve(1 + kRunsPerParameter * ps.size());
  for (const SensitivityParameter& p : ps) {
    for (const double steps : {1.0, -1.0, 0.5, -0.5}) {
      const double value = calc_center(p) + steps * p.step;
      Variant v{base, fmt::format("{} = {} {}", p.name, format_number(value), p.unit)};
      set_parameter(v.setup, p.name, value);
      variants.push_back(std::move(v));
    }
  }
  return variants;
}

std::vector<PreparedCase> prepare_all(const std::vector<Variant>& variants, double offset) {
  CasePreparer preparer;
  std::vector<PreparedCase> prepared;
  prepared.reserve(variants.size());
  for (const Variant& v : variants) {
    try {
      prepared.push_back(preparer.prepare(v.setup, offset));
    } catch (const ModelError& e) {
      throw InputError(fmt::format("{}: {}", v.label, e.what()));
    }
  }
  return prepared;
}

void check_run(const Trajectory& run, const std::string& label) {
  const LaneResults& r = *run.results;
  if (run.status() != RunStatus::kDone) {
    throw InputError(fmt::format(
        "the run at {} failed at t = {} s; a design needs complete runs: choose another base point",
        label, format_number(r.get_failure_time(run.lane))));
  }
  if (!r.has_snapshot(run.lane)) {
    throw InputError(
        fmt::format("the run at {} never meets the snapshot's line; choose a longer "
                    "duration or another offset",
                    label));
  }
}

/// Drops all positions from the first standstill or rollback of the wheels on.
void keep_ascending(std::vector<double>& offsets) {
  const auto end = std::adjacent_find(offsets.begin(), offsets.end(),
                                      [](double a, double b) { return !(b > a); });
  if (end != offsets.end()) offsets.erase(end + 1, offsets.end());
}

/// Interpolates the channels at the position `offset`, by the cubic through the four nearest
/// samples.
void sample_at(const Trajectory& run, double offset, Channels& out) {
  constexpr std::size_t kNodes = 4;
  const auto above = std::upper_bound(run.offsets.begin(), run.offsets.end(), offset);
  const auto index = static_cast<std::size_t>(above - run.offsets.begin());
  const std::size_t last_first = run.offsets.size() - kNodes;
  const std::size_t first = std::min(index < 2 ? 0 : index - 2, last_first);
  out.fill(0.0);
  for (std::size_t i = first; i < first + kNodes; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + kNodes; ++j) {
      if (j == i) continue;
      weight *= (offset - run.offsets[j]) / (run.offsets[i] - run.offsets[j]);
    }
    for (std::size_t c = 0; c < out.size(); ++c) out[c] += weight * run.get(i, c);
  }
}

void get_snapshot(const Trajectory& run, Channels& out) {
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = run.results->get_snapshot(static_cast<int>(c), run.lane);
  }
}

/// Jacobians by steps h and h/2.
struct JacobianPair {
  Instant coarse;
  std::vector<double> fine;
};

/// `read(run, channels)` reads the channels of a run.
template <class Read>
JacobianPair calc_jacobians(const std::vector<SensitivityParameter>& parameters, double offset,
                            const Read& read) {
  const std::size_t count = parameters.size();
  JacobianPair pair;
  pair.coarse.jacobian.resize(C::kCount * count);
  pair.fine.resize(C::kCount * count);
  Channels base, values[kRunsPerParameter];
  read(0, base);
  pair.coarse.offset = offset;
  pair.coarse.time = base[C::kTime];
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t which = 0; which < kRunsPerParameter; ++which) {
      read(get_run(p, which), values[which]);
    }
    const double step = parameters[p].step;
    for (std::size_t c = 0; c < C::kCount; ++c) {
      pair.coarse.jacobian[c * count + p] = (values[0][c] - values[1][c]) / (2.0 * step);
      pair.fine[c * count + p] = (values[2][c] - values[3][c]) / step;
    }
  }
  return pair;
}

/// Sums over the instants, for the error of each curve.
struct ErrorSums {
  std::vector<double> difference, size;

  void add(const JacobianPair& pair) {
    difference.resize(pair.fine.size());
    size.resize(pair.fine.size());
    for (std::size_t i = 0; i < pair.fine.size(); ++i) {
      const double d = pair.coarse.jacobian[i] - pair.fine[i];
      difference[i] += d * d;
      size[i] += pair.coarse.jacobian[i] * pair.coarse.jacobian[i];
    }
  }
};

/// Fills in Sensitivity::error and sets curves that are rounding error to zero.
void fill_errors(const ErrorSums& sums, Sensitivity& s) {
  constexpr double kRounding = 0.5;  // difference between h and h/2 relative to the curve's rms
  s.error.assign(sums.size.size(), 0.0);
  for (std::size_t i = 0; i < s.error.size(); ++i) {
    const double ratio = std::sqrt(sums.difference[i] / sums.size[i]);
    if (ratio <= kRounding) {
      s.error[i] = 4.0 / 3.0 * ratio;
      continue;
    }
    s.snapshot.jacobian[i] = 0.0;
    for (Instant& instant : s.instants) instant.jacobian[i] = 0.0;
  }
}

/// Fills in the instants: samples of the base run whose position every run passes.
void fill_instants(const std::vector<Trajectory>& runs, std::size_t stride, Sensitivity& s) {
  double first = runs[0].offsets.front(), last = runs[0].offsets.back();
  for (const Trajectory& run : runs) {
    first = std::max(first, run.offsets.front());
    last = std::min(last, run.offsets.back());
  }
  ErrorSums sums;
  for (std::size_t i = 0; i < runs[0].offsets.size(); i += stride) {
    const double offset = runs[0].offsets[i];
    if (offset < first || offset > last) continue;
    JacobianPair pair = calc_jacobians(s.parameters, offset, [&](std::size_t run, Channels& out) {
      sample_at(runs[run], offset, out);
    });
    sums.add(pair);
    s.instants.push_back(std::move(pair.coarse));
  }
  fill_errors(sums, s);
}

}  // namespace

Sensitivity calc_sensitivity(const Case& base, const std::vector<Axis>& axes, double offset,
                             const SensitivityOptions& options) {
  Sensitivity s;
  s.rate = options.rate;
  s.parameters.reserve(axes.size());
  for (const Axis& axis : axes) {
    s.parameters.push_back(make_parameter(base, axis, options.relative_step));
  }
  const std::vector<Variant> variants = list_variants(base, s.parameters);
  const std::vector<PreparedCase> cases = prepare_all(variants, offset);
  const double stride = std::max(1.0, std::ceil(kMinRate / options.rate));
  SamplePlan plan;
  plan.interval = 1.0 / (options.rate * stride);
  std::vector<Trajectory> runs;
  runs.reserve(cases.size());
  for (LaneRun& run : run_prepared(cases, options.integrate, plan)) {
    runs.push_back({std::move(run), {}});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    check_run(runs[i], variants[i].label);
    runs[i].offsets = calc_line_positions(cases[i], *runs[i].results, runs[i].lane);
    keep_ascending(runs[i].offsets);
  }
  s.snapshot = calc_jacobians(s.parameters, offset, [&](std::size_t run, Channels& out) {
                 get_snapshot(runs[run], out);
               }).coarse;
  fill_instants(runs, static_cast<std::size_t>(stride), s);
  return s;
}

}  // namespace strut
