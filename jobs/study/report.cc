#include "jobs/study/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "io/file/atomic_file.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/unsealed.h"
#include "jobs/study/figures.h"
#include "jobs/study/noise_report.h"
#include "jobs/study/tables.h"
#include "report/figures.h"
#include "study/result_files.h"
#include "study/summary.h"
#include "study/trainings.h"
#include "sweep/folder.h"

namespace strut {
namespace {

std::string round(double value) { return format_cell("{:.2g}", value); }

ReportSection make_summary_section(const StudyRequest& request, const StudyResults& results) {
  ReportSection section;
  section.heading = "Result";
  ReportTable table;
  table.caption =
      "Medians over seeds against the aim: errors at most a tenth of the published ones, 1 - R2 at "
      "most 1e-4";
  table.header = {"preload",  "what",   "largest at", "within the aim",
                  "smallest", "median", "largest"};
  table.text_columns = 3;
  for (const StudySummary& s : summarize(request, results)) {
    const auto count = [](std::size_t held, std::size_t all) {
      return fmt::format("{} of {}", held, all);
    };
    if (s.errors > 0) {
      table.rows.push_back({s.preload, "ratio", s.largest_at, count(s.errors_held, s.errors),
                            round(s.smallest_ratio), round(s.median_ratio),
                            round(s.largest_ratio)});
    }
    table.rows.push_back({s.preload, "1 - R2", s.largest_gap_at, count(s.gaps_held, s.gaps),
                          round(s.smallest_gap), round(s.median_gap), round(s.largest_gap)});
  }
  table.notes = {
      "Ratio: our median over the published number, for every published error, at the sweep's own "
      "instant."};
  section.tables.push_back(table);
  return section;
}

std::string describe_grid(const SweepRequest& sweep) {
  std::string text;
  for (const Axis& axis : sweep.grid.axes()) {
    text += fmt::format("{}{} {} to {}", text.empty() ? "" : ", ", axis.name,
                        format_number(axis.from), format_number(axis.last()));
    if (sweep.sample.method == SampleMethod::kGrid) {
      text += fmt::format(" in {} levels", axis.count);
    }
  }
  return text;
}

std::string describe_seeds(const StudyRequest& request) {
  if (request.seeds == 1) return "Every setting is trained once.";
  return fmt::format(
      "Every setting is trained {} times, each with its own split and start weights; the tables "
      "give the median, with the smallest and the largest value below it.",
      request.seeds);
}

ReportSection make_method(const StudyFolder& folder, const StudyRequest& request) {
  const SweepRequest sweep = read_request(folder.base().request());
  ReportSection section;
  section.heading = "Method";
  section.paragraphs = {
      fmt::format("Cars with combinations of worn springs and dampers from a grid ({}) were "
                  "simulated over a "
                  "bump: {}. A network sees one snapshot of the body's motion, taken as the rear "
                  "wheels pass "
                  "the bump, and identifies the springs and dampers of the car from it.",
                  describe_grid(sweep), sweep.base.vehicle.name),
      "Preload free_length: the springs keep the free length of the new car, so worn springs sag "
      "and the height at rest depends on their stiffness. Preload trimmed: every car stands at the "
      "same height, and only its motion depends on the stiffness.",
      fmt::format(
          "Networks are trained by Levenberg-Marquardt. {:.4g} % of the cases train, {:.4g} % "
          "validate, the others test. A training keeps the weights of its best validation; the "
          "errors below are those of its test cases, which were not used in training. {}",
          100.0 * request.split.train, 100.0 * request.split.validate, describe_seeds(request)),
      "ME is the largest absolute error, MAE the mean absolute error, MAPE the mean absolute "
      "percentage error, RMSE the root mean square error, R2 the coefficient of determination."};
  section.paragraphs.insert(section.paragraphs.end(), request.notes.begin(), request.notes.end());
  return section;
}

ReportSection make_preload_section(const StudyFolder& folder, const StudyRequest& request,
                                   const StudyResults& results, std::size_t preload,
                                   const FigureDrawer& drawer) {
  ReportSection section;
  section.heading = "Preload " + request.preloads[preload].name;
  section.tables = make_study_tables(request, results, preload, TableDetail::kSpread);
  drawer.draw_all(make_study_charts(folder, request, results, preload), section);
  return section;
}

ReportSection make_published_section(const StudyRequest& request) {
  ReportSection section{"Published numbers", {request.published.source}};
  section.paragraphs.insert(section.paragraphs.end(), request.published.remarks.begin(),
                            request.published.remarks.end());
  return section;
}

ReportTable make_sweep_table(const StudyResults& results) {
  ReportTable table{
      "Sweeps", {"sweep", "plan", "cases", "failed", "snapshot offset [m]"}, {}, {}, 2};
  for (const SweepFacts& sweep : results.sweeps) {
    table.rows.push_back({sweep.name, sweep.plan_hash, std::to_string(sweep.cases),
                          std::to_string(sweep.failed), format_number(sweep.offset)});
  }
  return table;
}

ReportTable make_option_table(const StudyRequest& request) {
  const LevenbergMarquardtOptions& o = request.options;
  ReportTable table{"Training", {"setting", "value"}, {}, {}, 2};
  table.rows = {{"seeds", fmt::format("1 to {}", request.seeds)},
                {"damping rule", kDampingRules.at(static_cast<std::size_t>(o.rule))},
                {"max epochs", std::to_string(o.epochs)},
                {"epochs without a new validation minimum", std::to_string(o.max_failures)},
                {"goal: loss of normalized values", format_number(o.goal)},
                {"fraction of training cases", format_number(request.split.train)},
                {"fraction of validation cases", format_number(request.split.validate)}};
  for (const StudyInputs& inputs : request.inputs) {
    table.rows.push_back({fmt::format("inputs '{}'", inputs.name), join_names(inputs.channels)});
  }
  return table;
}

/// "goal", "goal, validation failures": the stop reasons of a cell's trainings, each once.
std::string list_stops(const CellResult& cell) {
  std::vector<std::string> names;
  for (const SeedResult& seed : cell.seeds) {
    const std::string name = get_name(seed.stop);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return join_names(names);
}

/// Durations and stop reasons of the trainings.
ReportTable make_time_table(const StudyRequest& request, const StudyResults& results) {
  ReportTable table{"Trainings", {"preload", "cell", "stopped by", "epochs", "s each"}, {}, {}, 3};
  for (const CellResult& cell : results.cells) {
    std::vector<double> epochs, seconds;
    for (const SeedResult& seed : cell.seeds) {
      epochs.push_back(seed.epochs);
      seconds.push_back(seed.seconds);
    }
    const Spread e = calc_spread(epochs);
    table.rows.push_back({request.preloads[cell.cell.preload].name,
                          cell.key + (cell.cell.best_instant ? ", best instant" : ""),
                          list_stops(cell),
                          fmt::format("{} .. {}", format_number(e.low), format_number(e.high)),
                          round(calc_spread(seconds).median)});
  }
  return table;
}

ReportSection make_settings(const StudyRequest& request, const StudyResults& results) {
  ReportSection section{"Settings", {}};
  section.tables = {make_option_table(request), make_sweep_table(results),
                    make_time_table(request, results)};
  return section;
}

ReportSection make_limits() {
  return {
      "Limits",
      {"Training, validation and test cases come from one simulation: the errors measure how well "
       "a network inverts that simulation, not how well a real car is identified.",
       "Sensors are exact except where noise is stated. `strut design` computes the Cramer-Rao "
       "bound, the accuracy that noise leaves at an instant.",
       "Every parameter is known to lie within its grid; speed, bump and load are known exactly. "
       "Beyond the grid a network extrapolates."}};
}

void note_unsealed_files(const StudyFolder& folder, const StudyRequest& request) {
  for (const auto& [name, cell] : list_study_sweeps(request)) {
    note_unsealed(folder.sweep(name).plan(), kPlanSeal);
  }
  if (request.noise) note_unsealed(get_window_sweep(folder, request).plan(), kPlanSeal);
  for (const TableTraining& training : list_study_trainings(folder, request)) {
    note_unsealed(folder.model(training.name), kModelSeal);
  }
}

std::vector<KeyNumber> make_key_numbers(const StudySummary& s) {
  std::vector<KeyNumber> numbers;
  if (s.errors > 0) {
    numbers.push_back({fmt::format("{} of {}", s.errors_held, s.errors),
                       "errors at most a tenth of the published ones, " + s.preload});
    numbers.push_back(
        {fmt::format("{:.2g}", s.median_ratio), "of the published error, in the median"});
  }
  numbers.push_back({fmt::format("{} of {}", s.gaps_held, s.gaps), "with 1 - R2 at most 1e-4"});
  return numbers;
}

}  // namespace

StudyResults write_study_output(const StudyFolder& folder, const StudyRequest& request) {
  StudyResults results = read_results(folder, request);
  note_unsealed_files(folder, request);
  write_result_files(folder, request, results);
  const FigureDrawer drawer(Folder(folder.root));
  ReportPage page;
  page.title = request.title;
  const std::vector<StudySummary> summaries = summarize(request, results);
  for (const StudySummary& s : summaries) page.lead.push_back(describe_summary(s));
  if (!summaries.empty()) page.key_numbers = make_key_numbers(summaries.front());
  page.sections = {make_summary_section(request, results), make_method(folder, request)};
  for (std::size_t p = 0; p < request.preloads.size(); ++p) {
    page.sections.push_back(make_preload_section(folder, request, results, p, drawer));
  }
  if (const auto& noise = results.noise) {
    page.lead.push_back(describe_noise_result(*noise));
    page.sections.push_back(make_noise_section(*noise, drawer));
  }
  if (!request.published.source.empty()) page.sections.push_back(make_published_section(request));
  page.sections.push_back(make_settings(request, results));
  page.sections.push_back(make_limits());
  page.footer = make_report_footer();
  write_text_file_inside(folder.root, folder.report(), make_html(page));
  return results;
}

}  // namespace strut
