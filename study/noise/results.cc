#include "study/noise/results.h"

#include <algorithm>
#include <cmath>

#include "model_files/find_channel.h"
#include "study/noise/limits_file.h"
#include "train/model/evaluate.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Root mean square errors of a model on its test cases; sets the parameters of the study.
std::vector<double> evaluate(const fs::path& file, const fs::path& data, NoiseStudy& study) {
  const TrainedModel model = read_trained_model(file);
  study.parameters = model.targets;
  Dataset dataset({data}, {.histories = model.window.has_value()});
  const ModelEvaluation evaluation = evaluate_model(model, dataset, EvaluatedPart::kTest);
  std::vector<double> errors;
  errors.reserve(evaluation.metrics.size());
  for (const Metrics& metrics : evaluation.metrics) errors.push_back(metrics.rms_error);
  return errors;
}

/// Standard deviation of a parameter that is uniform over the levels of an axis or between its
/// bounds.
double calc_spread(const Axis& axis, SampleMethod method) {
  if (method != SampleMethod::kGrid) return std::abs(axis.last() - axis.from) / std::sqrt(12.0);
  const auto n = static_cast<double>(axis.count);
  return std::abs(axis.step) * std::sqrt((n * n - 1.0) / 12.0);
}

/// Root mean square of `get(case)`.
template <class Case, class Get>
double calc_rms(const std::vector<Case>& cases, const Get& get) {
  double sum = 0.0;
  for (const Case& c : cases) sum += get(c) * get(c);
  return std::sqrt(sum / static_cast<double>(cases.size()));
}

/// Largest over smallest `get(case)`.
template <class Case, class Get>
double calc_variation(const std::vector<Case>& cases, const Get& get) {
  double low = get(cases.front()), high = low;
  for (const Case& c : cases) {
    low = std::min(low, get(c));
    high = std::max(high, get(c));
  }
  return high / low;
}

void add_fits(const std::vector<FittedCase>& fits, NoisePoint& point) {
  const auto n = static_cast<double>(fits.size());
  for (const FittedCase& fit : fits) {
    point.converged += fit.converged ? 1 : 0;
    point.chi2_per_degree += fit.chi2_per_degree / n;
    point.fit_seconds += fit.seconds / n;
  }
  for (std::size_t p = 0; p < point.errors.size(); ++p) {
    WindowErrors& errors = point.errors[p].window;
    errors.bound =
        calc_rms(fits, [p](const FittedCase& f) { return f.bounds.parameters[p].bound; });
    errors.fit = calc_rms(
        fits, [p](const FittedCase& f) { return f.estimates[p] - f.bounds.parameters[p].truth; });
  }
}

void add_sensors(const std::vector<std::string>& channels, const NoiseModel& noise, bool in_window,
                 NoiseStudy& study) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto channel = static_cast<std::size_t>(find_car_channel(channels[c]));
    study.sensors.push_back(
        {channels[c], list_car_channels()[channel].unit, noise.sigma[c], noise.bias[c], in_window});
  }
}

NoiseStudy describe_study(const NoiseStudyRequest& request, const NoiseStudyData& data) {
  NoiseStudy study;
  for (const NoiseSnapshots& snapshots : data.snapshots)
    study.preloads.push_back(snapshots.preload);
  study.window_preload = study.preloads.back();
  add_sensors(data.inputs, make_snapshot_noise(request, data.inputs, 1.0), false, study);
  const std::vector<std::string> channels = list_history_channels(data.window);
  add_sensors(channels, make_window_noise(request, channels, 1.0), true, study);
  study.rate = data.window.history.rate;
  study.from = request.window.from;
  study.to = request.window.to;
  study.hit_time = request.hit_time;
  study.copies = request.copies;
  const SweepRequest& sweep = data.snapshots.back().sweep;
  for (const Axis& axis : sweep.grid.axes()) {
    study.spread.push_back(calc_spread(axis, sweep.sample.method));
  }
  return study;
}

template <class Case, class Get>
std::vector<double> list_variations(std::size_t parameters, const std::vector<Case>& cases,
                                    const Get& get) {
  std::vector<double> variations;
  variations.reserve(parameters);
  for (std::size_t p = 0; p < parameters; ++p) {
    variations.push_back(calc_variation(cases, [&](const Case& c) { return get(c, p); }));
  }
  return variations;
}

/// Appends the errors of one preload's snapshots to every point.
void add_snapshots(const NoiseSnapshots& snapshots, const fs::path& models, const fs::path& limits,
                   const std::vector<std::string>& names, NoiseStudy& study) {
  const auto bounded = read_bounds(find_bounds_file(limits, snapshots), names);
  study.snapshot_variation.push_back(
      list_variations(names.size(), bounded,
                      [](const BoundedCase& c, std::size_t p) { return c.parameters[p].bound; }));
  for (NoisePoint& point : study.points) {
    const fs::path file = models / (make_snapshot_name(snapshots, point.scale) + ".h5");
    const std::vector<double> errors = evaluate(file, snapshots.data, study);
    for (std::size_t p = 0; p < names.size(); ++p) {
      const double bound =
          calc_rms(bounded, [p](const BoundedCase& c) { return c.parameters[p].bound; });
      point.errors[p].snapshots.push_back({point.scale * bound, errors[p]});
    }
  }
}

void add_windows(const NoiseStudyData& data, const fs::path& models, const fs::path& limits,
                 const std::vector<std::string>& names, NoiseStudy& study) {
  for (NoisePoint& point : study.points) {
    const fs::path file = models / (make_window_name(point.scale) + ".h5");
    const std::vector<double> errors = evaluate(file, data.window_data, study);
    const auto fits = read_fits(find_fits_file(limits, point.scale), names);
    add_fits(fits, point);
    for (std::size_t p = 0; p < names.size(); ++p) point.errors[p].window.network = errors[p];
    study.fits = fits.size();
    if (&point != &find_real_point(study)) continue;
    study.window_variation = list_variations(
        names.size(), fits,
        [](const FittedCase& f, std::size_t p) { return f.bounds.parameters[p].bound; });
  }
}

}  // namespace

NoiseStudy read_noise_study(const NoiseStudyRequest& request, const NoiseStudyData& data,
                            const fs::path& models, const fs::path& limits) {
  NoiseStudy study = describe_study(request, data);
  const std::vector<std::string> names = list_axes(data.snapshots.back().sweep);
  study.points.resize(request.scales.size());
  for (std::size_t i = 0; i < study.points.size(); ++i) {
    study.points[i].scale = request.scales[i];
    study.points[i].errors.resize(names.size());
  }
  for (const NoiseSnapshots& snapshots : data.snapshots) {
    add_snapshots(snapshots, models, limits, names, study);
  }
  add_windows(data, models, limits, names, study);
  return study;
}

const NoisePoint& find_real_point(const NoiseStudy& study) {
  return *std::min_element(study.points.begin(), study.points.end(),
                           [](const NoisePoint& a, const NoisePoint& b) {
                             return std::abs(std::log(a.scale)) < std::abs(std::log(b.scale));
                           });
}

WindowRatios calc_window_ratios(const NoisePoint& point) {
  WindowRatios ratios;
  for (const NoiseErrors& e : point.errors) {
    ratios.network = std::max(ratios.network, e.window.network / e.window.bound);
    ratios.fit = std::max(ratios.fit, e.window.fit / e.window.bound);
  }
  return ratios;
}

}  // namespace strut
