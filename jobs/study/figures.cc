#include "jobs/study/figures.h"

#include <algorithm>
#include <cmath>

#include "io/config.h"
#include "jobs/study/bars.h"
#include "train/evaluate.h"

namespace strut {
namespace {

using Rows = std::vector<std::vector<double>>;

const CellResult& find_main(const StudyRequest& request, const StudyResults& results,
                            std::size_t preload) {
  return *std::find_if(results.cells.begin(), results.cells.end(), [&](const CellResult& cell) {
    return cell.cell.preload == preload && is_main(request, cell.cell);
  });
}

/// The training whose mean percentage error, summed over the parameters, is in the middle.
const SeedResult& find_median_seed(const CellResult& cell) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t s = 0; s < cell.seeds.size(); ++s) {
    double sum = 0.0;
    for (const Metrics& m : cell.seeds[s].metrics) sum += m.mean_absolute_percentage;
    order.emplace_back(sum, s);
  }
  std::sort(order.begin(), order.end());
  return cell.seeds[order[(order.size() - 1) / 2].second];
}

/// The test cases of a model, and what it identifies from them; by rows.
struct Identified {
  Model model;
  Rows inputs, reference, predicted;
};

Rows read_columns(const RowStore& store, std::size_t first, std::size_t count) {
  Rows rows;
  rows.reserve(store.row_count());
  for_each_piece(store, [&](std::span<const double> values, std::size_t, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = values.subspan(i * store.columns() + first, count);
      rows.emplace_back(row.begin(), row.end());
    }
  });
  return rows;
}

Identified identify(const StudyFolder& folder, const CellResult& cell) {
  Identified identified{read_model(folder.root / find_median_seed(cell).model), {}, {}, {}};
  const Model& model = identified.model;
  Dataset dataset({folder.sweep(cell.sweep).root});
  const RowStore test = read_test_rows(model, dataset);
  std::int64_t outside = 0;
  const std::size_t inputs = model.inputs.size(), targets = model.targets.size();
  identified.inputs = read_columns(test, 0, inputs);
  identified.reference = read_columns(test, inputs, targets);
  identified.predicted = read_columns(predict_rows(model, test, &outside), 0, targets);
  return identified;
}

std::string make_title(const ColumnInfo& column) {
  return quote_figure_text(make_words(column.name) + " [" + column.unit + "]");
}

/// The two parameters that inputs are drawn over.
struct Ground {
  std::size_t x = 0, y = 1;
};

/// The ground of the paper's Figure 6: the rear axle's parameters where there are any.
Ground choose_ground(const std::vector<ColumnInfo>& parameters) {
  std::vector<std::size_t> rear;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (parameters[p].name.starts_with("rear_")) rear.push_back(p);
  }
  if (rear.size() >= 2) return {rear[0], rear[1]};
  return {0, std::min<std::size_t>(1, parameters.size() - 1)};
}

/// "set xrange ..." and three tics, to the ends of a parameter.
std::string make_range(const std::string& axis, const Rows& rows, std::size_t column) {
  double low = rows.front()[column], high = low;
  for (const auto& row : rows) {
    low = std::min(low, row[column]);
    high = std::max(high, row[column]);
  }
  const double width = high > low ? high - low : 1.0;  // gnuplot takes no empty range
  return "set " + axis + "range [" + format_number(low - 0.05 * width) + ":" +
         format_number(high + 0.05 * width) + "]\nset " + axis + "tics " + format_number(low) +
         ", " + format_number(0.5 * width) + "\n";
}

/// True place, identified place, input, by test cases.
Rows list_points(const Identified& data, const Ground& ground, std::size_t input) {
  Rows points;
  points.reserve(data.inputs.size());
  for (std::size_t i = 0; i < data.inputs.size(); ++i) {
    const auto &truth = data.reference[i], &found = data.predicted[i];
    points.push_back({truth[ground.x], truth[ground.y], found[ground.x], found[ground.y],
                      data.inputs[i][input]});
  }
  return points;
}

std::string make_state_axes(const Identified& data, const Ground& ground) {
  const auto& names = data.model.targets;
  return "set view 62,35,0.88,0.85\nset ticslevel 0.05\nset grid\nset tics font ',11'\n" +
         make_range("x", data.reference, ground.x) + make_range("y", data.reference, ground.y) +
         "set key at screen 0.5,0.985 center horizontal\nset format z '%.4g'\nset xlabel " +
         make_title(names[ground.x]) + " rotate parallel offset 0,-0.4\nset ylabel " +
         make_title(names[ground.y]) + " rotate parallel offset -2,0\n";
}

/// The first panel has the figure's only key.
std::string make_state_panel(const Identified& data, std::size_t input) {
  const std::string block = "$state" + std::to_string(input);
  const auto name = [input](const char* text) {
    return input == 0 ? "title " + quote_figure_text(text) : std::string("notitle");
  };
  return "set zlabel " + make_title(data.model.inputs[input]) + " rotate by 90 offset 0,0\nsplot " +
         block + " using 3:4:5 with points linetype 2 pointtype 2 pointsize 0.7 " +
         name("network") + ", " + block +
         " using 1:2:5 with points linetype 1 pointtype 6 pointsize 0.8 " + name("simulation") +
         "\nunset key\n";
}

StudyFigure draw_states(const Identified& data, const std::string& preload) {
  const Ground ground = choose_ground(data.model.targets);
  const std::size_t panels = data.model.inputs.size(), rows = (panels + 1) / 2;
  StudyFigure figure{{"states_" + preload, 1000, static_cast<int>(480 * rows), ""}, ""};
  std::string& text = figure.figure.commands;
  for (std::size_t c = 0; c < panels; ++c) {
    text += make_data("state" + std::to_string(c), list_points(data, ground, c));
  }
  text += "set multiplot layout " + std::to_string(rows) +
          ",2 margins 0.16,0.9,0.14,0.93 spacing 0.24,0.17\n" + make_state_axes(data, ground);
  for (std::size_t c = 0; c < panels; ++c) text += make_state_panel(data, c);
  text += "unset multiplot\n";
  figure.caption =
      "As Figure 6 of the paper. The states of the " + std::to_string(data.inputs.size()) +
      " test cases over " + make_words(data.model.targets[ground.x].name) + " and " +
      make_words(data.model.targets[ground.y].name) +
      ": circles at the true values, crosses at those that the network identifies from the states.";
  return figure;
}

/// Absolute percentage errors by test cases; NaN for none, which a logarithmic scale cannot show.
Rows list_percentage_errors(const Identified& data) {
  Rows errors;
  errors.reserve(data.reference.size());
  for (std::size_t i = 0; i < data.reference.size(); ++i) {
    std::vector<double> row;
    row.reserve(data.reference[i].size());
    for (std::size_t p = 0; p < data.reference[i].size(); ++p) {
      const double truth = data.reference[i][p];
      const double error = 100.0 * std::fabs((data.predicted[i][p] - truth) / truth);
      row.push_back(error > 0.0 ? error : std::nan(""));
    }
    errors.push_back(std::move(row));
  }
  return errors;
}

std::string make_box_axes(const std::vector<ColumnInfo>& parameters) {
  std::string tics;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    tics += (p == 0 ? "'" : ", '") + make_words(parameters[p].name) + "' " + std::to_string(p + 1);
  }
  return "set logscale y\nset format y '10^{%L}'\nset grid ytics\nset xtics (" + tics +
         ")\nset xrange [0.5:" + std::to_string(parameters.size()) +
         ".5]\nset ylabel 'absolute percentage error [%]'\n"
         "set style boxplot outliers pointtype 6\nset style fill solid 0.35 border\n"
         "set boxwidth 0.4\nset pointsize 0.4\nset key outside top center horizontal\n";
}

StudyFigure draw_boxes(const StudyRequest& request, const CellResult& cell, const Identified& data,
                       const std::string& preload) {
  const std::vector<ColumnInfo>& parameters = data.model.targets;
  Rows published;
  std::string boxes;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::string n = std::to_string(p + 1);
    boxes += "$errors using (" + n + "):" + n + " with boxplot linetype 1 notitle, ";
    published.push_back({static_cast<double>(p + 1), find_published(request, cell, p, kMape)});
  }
  const bool any = std::any_of(published.begin(), published.end(),
                               [](const auto& row) { return !std::isnan(row[1]); });
  StudyFigure figure{{"errors_" + preload, 900, 520, ""}, ""};
  figure.figure.commands =
      make_data("errors", list_percentage_errors(data)) + make_data("published", published) +
      make_box_axes(parameters) + "plot " + boxes +
      (any ? "$published using 1:2 with points linetype 2 pointtype 9 pointsize 1.4 title 'the "
             "paper: mean'\n"
           : "NaN notitle\n");
  figure.caption =
      "As Figure 7 of the paper. Absolute percentage errors of " + cell.key +
      " on its test cases: median, quartiles, whiskers to 1.5 times their distance, outliers. The "
      "scale is logarithmic" +
      (any ? "; triangles: the paper's MAPE." : ".");
  return figure;
}

StudyFigure draw_training(const CellResult& cell, const Model& model, const std::string& preload) {
  StudyFigure figure{{"training_" + preload, 900, 480, ""}, ""};
  Rows rows;
  rows.reserve(model.record.size());
  for (const EpochRecord& r : model.record) {
    rows.push_back({static_cast<double>(r.epoch), r.loss, r.validation});
  }
  figure.figure.commands =
      make_data("record", rows) +
      make_data("best", {{static_cast<double>(model.best_epoch), model.best_validation}}) +
      "set logscale y\nset format y '10^{%L}'\nset grid\nset xlabel 'epoch'\n"
      "set ylabel 'mean square error of normalized values [1]'\nset key top right\n"
      "plot $record using 1:2 with lines linetype 1 linewidth 2 title 'training cases', "
      "$record using 1:3 with lines linetype 2 linewidth 2 dashtype 2 title 'validation cases', "
      "$best using 1:2 with points linetype 2 pointtype 7 pointsize 1.2 title 'weights kept'\n";
  figure.caption = "How a training of " + cell.key + " went; it stopped by " +
                   std::string(get_name(model.stop)) + ".";
  return figure;
}

}  // namespace

std::vector<StudyFigure> make_study_figures(const StudyFolder& folder, const StudyRequest& request,
                                            const StudyResults& results, std::size_t preload) {
  const std::string& name = request.preloads[preload].name;
  const CellResult& main = find_main(request, results, preload);
  const Identified data = identify(folder, main);
  std::vector<StudyFigure> figures;
  figures.push_back(draw_states(data, name));
  figures.push_back(draw_boxes(request, main, data, name));
  for (StudyFigure& bars : make_bar_figures(request, results, preload)) {
    figures.push_back(std::move(bars));
  }
  figures.push_back(draw_training(main, data.model, name));
  return figures;
}

}  // namespace strut
