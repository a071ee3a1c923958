#include "jobs/noise_study.h"

#include <algorithm>
#include <cmath>

#include "diagnose/fit.h"
#include "io/config.h"
#include "io/shard_layout.h"
#include "jobs/machine.h"
#include "model/parallel/team.h"
#include "sweep/design.h"
#include "sweep/find_channel.h"
#include "sweep/plan.h"
#include "train/evaluate.h"
#include "train/window_rows.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Of the channels, in their order.
std::vector<double> scale_noise(const std::vector<std::string>& channels, const SensorNoise& noise,
                                double scale) {
  std::vector<double> values;
  values.reserve(channels.size());
  for (const std::string& name : channels) {
    values.push_back(scale * noise[static_cast<std::size_t>(find_car_channel(name))]);
  }
  return values;
}

std::vector<std::string> list_history_channels(const SweepRequest& sweep) {
  std::vector<std::string> names;
  names.reserve(sweep.history.channels.size());
  for (const int channel : sweep.history.channels) {
    names.push_back(list_car_channels()[static_cast<std::size_t>(channel)].name);
  }
  return names;
}

std::vector<std::string> list_targets(const NoiseStudyData& data) {
  std::vector<std::string> names;
  names.reserve(data.snapshot.grid.axes().size());
  for (const Axis& axis : data.snapshot.grid.axes()) names.push_back(axis.name);
  return names;
}

std::string make_model_name(const char* kind, double scale) {
  return std::string("noise_") + kind + "_" + format_number(scale);
}

TableTraining make_training(const NoiseStudyRequest& request, const TrainingRequest& like,
                            double scale) {
  TableTraining training;
  training.request = like;
  NoiseModel noise;
  noise.copies = request.copies;
  noise.seed = like.seed;
  training.request.noise = noise;
  training.name = make_model_name("snapshot", scale);
  return training;
}

TableTraining make_snapshot_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                     const TrainingRequest& like, double scale) {
  TableTraining training = make_training(request, like, scale);
  training.data = data.snapshot_data;
  training.request.rows.inputs = data.inputs;
  NoiseModel& noise = *training.request.noise;
  noise.sigma = scale_noise(data.inputs, make_default_noise(), scale);
  noise.bias.assign(noise.sigma.size(), 0.0);
  return training;
}

TableTraining make_window_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                   const TrainingRequest& like, double scale) {
  TableTraining training = make_training(request, like, scale);
  training.name = make_model_name("window", scale);
  training.data = data.window_data;
  training.request.rows.inputs = list_history_channels(data.window);
  training.request.rows.targets = list_targets(data);
  WindowChoice window;
  window.from = request.from;
  window.to = request.to;
  training.request.window = window;
  NoiseModel& noise = *training.request.noise;
  noise.sigma = scale_noise(training.request.rows.inputs, make_default_noise(), scale);
  noise.bias = scale_noise(training.request.rows.inputs, make_default_bias(), 1.0);
  noise.hit_time = request.hit_time;
  return training;
}

/// 1 sigma of each parameter from the snapshot.
std::vector<double> calc_snapshot_bounds(const NoiseStudyData& data) {
  SensitivityOptions options;
  options.integrate = make_accurate(data.snapshot.integrate);
  const Sensitivity s =
      calc_sensitivity(make_base_point(data.snapshot, {}, {}), data.snapshot.grid.axes(),
                       data.snapshot.snapshot.offset, options);
  std::vector<int> channels;
  channels.reserve(data.inputs.size());
  for (const std::string& name : data.inputs) channels.push_back(find_car_channel(name));
  const Bounds bounds =
      calc_bounds(calc_information(s, s.snapshot, channels, make_default_noise()));
  std::vector<double> sigma;
  sigma.reserve(bounds.bound.size());
  for (std::size_t i = 0; i < bounds.bound.size(); ++i) {
    sigma.push_back(0.01 * bounds.bound[i] * s.parameters[i].scale);
  }
  return sigma;
}

/// What is not known of a record: the unknowns of a fit, the parameters first.
std::vector<Unknown> list_unknowns(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                   const std::vector<MeasuredRun>& runs) {
  std::vector<Unknown> unknowns;
  for (const std::string& name : list_targets(data)) {
    unknowns.push_back(make_parameter(runs, name));
  }
  NuisanceSigmas sigmas;
  sigmas.hit_time = request.hit_time;
  sigmas.speed = 0.0;
  for (const Axis& axis : data.window.grid.axes()) {
    // Of the uniform distribution over the axis.
    if (axis.name == "speed") sigmas.speed = std::abs(axis.last() - axis.from) / std::sqrt(12.0);
  }
  for (Unknown& u : make_nuisances(runs, sigmas, unknowns)) unknowns.push_back(std::move(u));
  return unknowns;
}

/// The records that a window's network is judged by, as a fit takes them.
class RecordReader {
 public:
  RecordReader(const NoiseStudyData& data, const Model& model)
      : base_(make_base_point(data.window, {}, {})), model_(model) {
    Dataset dataset({data.window_data}, {.histories = true});
    RowChoice choice;
    choice.inputs = list_names(model.window->channels);
    choice.targets = list_names(model.targets);
    records_ = read_records_for(*model.window, choice, dataset, {});
    const Split split = make_split(model.usable, model.split);
    for (std::int64_t row = 0; row < split.size(); ++row) {
      if (split.find_part(row) == Part::kTest) cases_.push_back(row);
    }
  }

  std::size_t size() const { return cases_.size(); }

  /// The first copy of a case; `truth`: its parameters.
  MeasuredRun read(std::size_t number, std::vector<double>& truth) const {
    const WindowTransform& transform = *model_.window;
    const WindowGrid& grid = transform.grid;
    std::vector<double> row(records_.rows.columns()), record(transform.record_size());
    records_.rows.read(static_cast<std::size_t>(cases_[number]), 1, row.data());
    truth.assign(row.end() - static_cast<std::ptrdiff_t>(records_.targets.size()), row.end());
    const NoiseDraw draw(transform.noise, cases_[number], 0);
    draw_record(records_, row, transform.noise, draw, false, record);
    MeasuredRun run{"case " + std::to_string(cases_[number]), base_, {}, {}};
    for (std::size_t i = 0; i < grid.samples; ++i) {
      run.times.push_back(grid.interval * static_cast<double>(grid.first + static_cast<long>(i)));
    }
    for (std::size_t c = 0; c < transform.channels.size(); ++c) {
      const auto begin =
          record.begin() + static_cast<std::ptrdiff_t>(c * grid.record_samples() + grid.margin());
      run.channels.push_back({find_car_channel(transform.channels[c].name),
                              transform.noise.sigma[c],
                              {begin, begin + static_cast<std::ptrdiff_t>(grid.samples)}});
    }
    return run;
  }

 private:
  Case base_;
  const Model& model_;
  WindowRecords records_;
  std::vector<std::int64_t> cases_;
};

/// Fits the simulation to the first records that the network was judged by, and adds errors, chi2
/// and time to the point; also the bounds of such a record.
void add_fits(const NoiseStudyRequest& request, const NoiseStudyData& data, const Model& model,
              int threads, NoisePoint& point, std::atomic<bool>& halt) {
  const RecordReader reader(data, model);
  const std::size_t count = std::min(static_cast<std::size_t>(request.fits), reader.size());
  const std::size_t parameters = model.targets.size();
  std::vector<std::vector<double>> errors(count, std::vector<double>(parameters));
  std::vector<double> chi2(count), seconds(count);
  share_items(threads, count, [&](std::size_t i, int) {
    if (halt) return;
    std::vector<double> truth;
    const std::vector<MeasuredRun> runs = {reader.read(i, truth)};
    const double begin = now();
    const FitResult fit = fit_simulation(runs, list_unknowns(request, data, runs));
    seconds[i] = now() - begin;
    chi2[i] = fit.chi2_per_degree();
    for (std::size_t p = 0; p < parameters; ++p) errors[i][p] = fit.values[p] - truth[p];
  });
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    point.chi2_per_degree += chi2[i] / n;
    point.fit_seconds += seconds[i] / n;
    for (std::size_t p = 0; p < parameters; ++p) {
      point.errors[p].window_fit += errors[i][p] * errors[i][p] / n;
    }
  }
  for (NoiseErrors& e : point.errors) e.window_fit = std::sqrt(e.window_fit);
}

void set_window_bounds(const NoiseStudyRequest& request, const NoiseStudyData& data,
                       NoisePoint& point) {
  SensorNoise noise(CarChannel::kCount, 0.0);
  for (const int channel : data.window.history.channels) {
    const auto c = static_cast<std::size_t>(channel);
    noise[c] = point.scale * make_default_noise()[c];
  }
  const std::vector<MeasuredRun> runs = {make_planned_run(make_base_point(data.window, {}, {}),
                                                          noise, data.window.history.rate,
                                                          request.from, request.to)};
  const Uncertainty bounds = calc_fit_bounds(runs, list_unknowns(request, data, runs));
  for (std::size_t p = 0; p < point.errors.size(); ++p) {
    point.errors[p].window_bound = bounds.sigma[p];
  }
}

std::vector<double> evaluate(const fs::path& file, const fs::path& data) {
  const Model model = read_model(file);
  Dataset dataset({data}, {.histories = model.window.has_value()});
  const Evaluation evaluation = evaluate_model(model, dataset, EvaluatedPart::kTest);
  std::vector<double> errors;
  errors.reserve(evaluation.metrics.size());
  for (const Metrics& metrics : evaluation.metrics) errors.push_back(metrics.rms_error);
  return errors;
}

/// Standard deviation of a parameter drawn from the levels of its axis.
double calc_spread(const Axis& axis) {
  const auto n = static_cast<double>(axis.count);
  return std::abs(axis.step) * std::sqrt((n * n - 1.0) / 12.0);
}

}  // namespace

std::vector<TableTraining> list_noise_trainings(const NoiseStudyRequest& request,
                                                const NoiseStudyData& data,
                                                const TrainingRequest& like) {
  std::vector<TableTraining> trainings;
  trainings.reserve(2 * request.scales.size());
  for (const double scale : request.scales) {
    for (const auto& make : {make_snapshot_training, make_window_training}) {
      trainings.push_back(make(request, data, like, scale));
      const SweepRequest& sweep = trainings.back().request.window ? data.window : data.snapshot;
      trainings.back().cases = Plan(sweep).case_count() * request.copies;
    }
  }
  return trainings;
}

bool calc_noise_study(const NoiseStudyRequest& request, const NoiseStudyData& data,
                      const fs::path& models, int threads, NoiseStudy& study,
                      std::atomic<bool>& halt) {
  const std::vector<double> snapshot_bounds = calc_snapshot_bounds(data);
  study.spread.clear();
  for (const Axis& axis : data.snapshot.grid.axes()) study.spread.push_back(calc_spread(axis));
  study.fits = request.fits;
  for (const double scale : request.scales) {
    const fs::path file = models / (make_model_name("window", scale) + ".h5");
    const Model model = read_model(file);
    study.parameters = model.targets;
    NoisePoint point;
    point.scale = scale;
    point.errors.resize(model.targets.size());
    const auto snapshot =
        evaluate(models / (make_model_name("snapshot", scale) + ".h5"), data.snapshot_data);
    const auto window = evaluate(file, data.window_data);
    for (std::size_t p = 0; p < point.errors.size(); ++p) {
      point.errors[p].snapshot_bound = scale * snapshot_bounds[p];
      point.errors[p].snapshot_network = snapshot[p];
      point.errors[p].window_network = window[p];
    }
    set_window_bounds(request, data, point);
    add_fits(request, data, model, threads, point, halt);
    if (halt) return false;
    study.points.push_back(std::move(point));
  }
  return true;
}

Json make_json(const NoiseStudy& study) {
  Json points = Json::array();
  for (const NoisePoint& point : study.points) {
    Json parameters = Json::object();
    for (std::size_t p = 0; p < point.errors.size(); ++p) {
      const NoiseErrors& e = point.errors[p];
      parameters.set(study.parameters[p].name, Json::object()
                                                   .set("snapshot_bound", e.snapshot_bound)
                                                   .set("snapshot_network", e.snapshot_network)
                                                   .set("window_bound", e.window_bound)
                                                   .set("window_network", e.window_network)
                                                   .set("window_fit", e.window_fit));
    }
    points.push(Json::object()
                    .set("scale", point.scale)
                    .set("parameters", parameters)
                    .set("chi2_per_degree", point.chi2_per_degree)
                    .set("fit_seconds", point.fit_seconds));
  }
  Json spread = Json::object();
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    spread.set(study.parameters[p].name, study.spread[p]);
  }
  return Json::object().set("grid_spread", spread).set("fits", study.fits).set("scales", points);
}

}  // namespace strut
