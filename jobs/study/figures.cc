#include "jobs/study/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/study/bars.h"
#include "study/predictions.h"

namespace strut {
namespace {

std::string make_title(const ColumnInfo& column) { return make_label(column.name, column.unit); }

/// Indices of the two parameters on the axes of a chart of states.
struct Ground {
  std::size_t x = 0, y = 1;
};

/// The parameters of the rear axle, as in the paper's Figure 6, or the first two where it has none.
Ground choose_ground(const std::vector<ColumnInfo>& parameters) {
  std::vector<std::size_t> rear;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (parameters[p].name.starts_with("rear_")) rear.push_back(p);
  }
  if (rear.size() >= 2) return {rear[0], rear[1]};
  return {0, std::min<std::size_t>(1, parameters.size() - 1)};
}

std::vector<double> list_column(const std::vector<std::vector<double>>& rows, std::size_t column) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(row[column]);
  return values;
}

/// An input of the network over two parameters: the cases at their true and at their predicted
/// values.
ChartPanel make_state_panel(const TestPredictions& data, const Ground& ground, std::size_t input) {
  const std::vector<ColumnInfo>& names = data.model.targets;
  ChartSeries network{"network", SeriesKind::kPoints, 2},
      truth{"simulation", SeriesKind::kPoints, 1};
  network.marker = Marker::kCross;
  truth.marker = Marker::kCircle;
  network.x = list_column(data.predicted, ground.x);
  network.y = list_column(data.predicted, ground.y);
  truth.x = list_column(data.reference, ground.x);
  truth.y = list_column(data.reference, ground.y);
  network.value = truth.value = list_column(data.inputs, input);
  return {{make_title(names[ground.x])},
          {make_title(names[ground.y])},
          {std::move(network), std::move(truth)},
          make_words(data.model.inputs[input].name),
          make_title(data.model.inputs[input])};
}

Chart make_state_chart(const TestPredictions& data, const std::string& preload) {
  const Ground ground = choose_ground(data.model.targets);
  Chart chart{"states_" + preload, {}, 2};
  chart.panel_height = 480;
  for (std::size_t c = 0; c < data.model.inputs.size(); ++c) {
    chart.panels.push_back(make_state_panel(data, ground, c));
  }
  chart.caption = fmt::format(
      "As Figure 6 of the paper. States of the {} test cases over {} and {}, by color: circles at "
      "the true parameters, crosses at those that the network identifies from the states.",
      data.inputs.size(), make_words(data.model.targets[ground.x].name),
      make_words(data.model.targets[ground.y].name));
  return chart;
}

/// Absolute percentage errors of a parameter; NaN for an error of 0, which a logarithmic scale
/// cannot show.
std::vector<double> list_percentage_errors(const TestPredictions& data, std::size_t p) {
  std::vector<double> errors;
  errors.reserve(data.reference.size());
  for (std::size_t i = 0; i < data.reference.size(); ++i) {
    const double truth = data.reference[i][p];
    const double error = 100.0 * std::fabs((data.predicted[i][p] - truth) / truth);
    errors.push_back(error > 0.0 ? error : std::nan(""));
  }
  return errors;
}

Chart make_box_chart(const StudyRequest& request, const CellResult& cell,
                     const TestPredictions& data, const std::string& preload) {
  ChartPanel panel{{""}, {"absolute percentage error [%]", true}, {}};
  ChartSeries published{"the paper: mean", SeriesKind::kPoints, 2};
  published.marker = Marker::kTriangle;
  for (std::size_t p = 0; p < data.model.targets.size(); ++p) {
    panel.x.categories.push_back(make_words(data.model.targets[p].name));
    const auto x = static_cast<double>(p + 1);
    ChartSeries box{"", SeriesKind::kBoxes, 1, {}, list_percentage_errors(data, p)};
    box.x.assign(box.y.size(), x);
    panel.series.push_back(std::move(box));
    const double theirs = find_published(request, cell, p, kMape);
    if (std::isnan(theirs)) continue;
    published.x.push_back(x);
    published.y.push_back(theirs);
  }
  const bool any = !published.x.empty();
  if (any) panel.series.push_back(std::move(published));
  panel.x.range = {0.5, static_cast<double>(data.model.targets.size()) + 0.5};
  Chart chart{"errors_" + preload, {std::move(panel)}};
  chart.panel_height = 500;
  chart.caption = fmt::format(
      "As Figure 7 of the paper. Absolute percentage errors of {} on its test cases: "
      "median, quartiles, whiskers to 1.5 times their distance, outliers. The scale is "
      "logarithmic{}.",
      cell.key, any ? "; triangles: the paper's MAPE" : "");
  return chart;
}

Chart make_training_chart(const CellResult& cell, const TrainedModel& model,
                          const std::string& preload) {
  ChartSeries training{"training cases", SeriesKind::kLine, 1};
  ChartSeries validation{"validation cases", SeriesKind::kDashedLine, 2};
  ChartSeries best{"weights kept", SeriesKind::kPoints, 2};
  for (const EpochRecord& r : model.record) {
    training.x.push_back(r.epoch);
    training.y.push_back(r.loss);
    validation.y.push_back(r.validation);
  }
  validation.x = training.x;
  best.x = {static_cast<double>(model.best_epoch)};
  best.y = {model.best_validation};
  Chart chart{"training_" + preload,
              {{{"epoch"},
                {"mean square error of normalized values [1]", true},
                {training, validation, best}}}};
  chart.panel_height = 460;
  chart.caption =
      fmt::format("Loss of a training of {}; stopped by: {}.", cell.key, get_name(model.stop));
  return chart;
}

}  // namespace

std::vector<Chart> make_study_charts(const StudyFolder& folder, const StudyRequest& request,
                                     const StudyResults& results, std::size_t preload) {
  const std::string& name = request.preloads[preload].name;
  const CellResult& main = find_main_cell(request, results, preload);
  const TestPredictions data = predict_test_cases(folder, main);
  std::vector<Chart> charts = {make_state_chart(data, name),
                               make_box_chart(request, main, data, name)};
  for (Chart& bars : make_bar_charts(request, results, preload)) charts.push_back(std::move(bars));
  charts.push_back(make_training_chart(main, data.model, name));
  return charts;
}

}  // namespace strut
