#include "jobs/study/tables.h"

#include <fmt/format.h>

#include "io/format/toml_document.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

std::string round(double value) { return format_cell("{:.2g}", value); }

std::string round_spread(const Spread& s, TableDetail detail) {
  std::string median = round(s.median);
  if (detail == TableDetail::kMedian || s.low == s.high) return median;
  return fmt::format("{}\n{} .. {}", median, round(s.low), round(s.high));
}

/// 1 - R2; its smallest value is that of the largest R2.
Spread calc_gap(const Spread& r2) { return {1.0 - r2.median, 1.0 - r2.high, 1.0 - r2.low}; }

/// The metrics in the tables, in the paper's order.
constexpr std::size_t kShown[] = {kMae, kMape, kRmse};

std::vector<std::string> make_header(const std::string& first, bool published) {
  std::vector<std::string> header = {first, "parameter", "unit"};
  for (const std::size_t m : kShown) {
    header.push_back(kMetrics[m].name + std::string(m == kMape ? " %" : ""));
    if (!published) continue;
    header.emplace_back("paper");
    header.emplace_back("ratio");
  }
  header.emplace_back("1 - R2");
  if (published) header.emplace_back("paper");
  return header;
}

void add_rows(const StudyRequest& request, const CellResult& cell, const std::string& label,
              TableDetail detail, ReportTable& table) {
  const bool published = !request.published.cells.empty();
  for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
    std::vector<std::string> row = {p == 0 ? label : "", cell.parameters[p].name,
                                    cell.parameters[p].unit};
    for (const std::size_t m : kShown) {
      const Spread& spread = cell.spread[p][m];
      row.push_back(round_spread(spread, detail));
      if (!published) continue;
      row.push_back(format_cell("{:.6g}", find_published(request, cell, p, m)));
      row.push_back(round(spread.median / find_published(request, cell, p, m)));
    }
    row.push_back(round_spread(calc_gap(cell.spread[p][kR2]), detail));
    if (published)
      row.push_back(format_cell("{:.1g}", 1.0 - find_published(request, cell, p, kR2)));
    table.rows.push_back(row);
  }
}

std::string list_sizes(const StudyNetwork& network) {
  return fmt::format("{} ({})", network.name, fmt::join(network.hidden, ", "));
}

/// ", beside Table 2 of the paper" where the cell has published numbers; else empty.
std::string name_published(const StudyRequest& request, const std::string& key) {
  const auto found = request.published.cells.find(key);
  if (found == request.published.cells.end() || found->second.table.empty()) return "";
  return fmt::format(", beside {} of the paper", found->second.table);
}

std::string describe_seeds(const StudyRequest& request) {
  return request.seeds == 1 ? "one training each"
                            : fmt::format("medians over {} trainings", request.seeds);
}

ReportTable make_network_table(const StudyRequest& request, const StudyResults& results,
                               std::size_t preload, std::size_t samples, TableDetail detail) {
  ReportTable table;
  table.text_columns = 3;
  table.header = make_header("network", !request.published.cells.empty());
  for (const CellResult& cell : results.cells) {
    const StudyCell& c = cell.cell;
    const bool here = c.preload == preload && c.samples == samples &&
                      c.inputs == request.main_inputs && !c.best_instant;
    if (!here) continue;
    if (table.caption.empty()) {
      table.caption =
          fmt::format("{} cases, preload {}{}; {}", format_count(request.samples[samples]),
                      request.preloads[preload].name, name_published(request, cell.key),
                      describe_seeds(request));
    }
    add_rows(request, cell, list_sizes(request.networks[c.network]), detail, table);
  }
  return table;
}

ReportTable make_input_table(const StudyRequest& request, const StudyResults& results,
                             std::size_t preload, TableDetail detail) {
  ReportTable table;
  table.text_columns = 3;
  table.header = make_header("inputs", !request.published.cells.empty());
  std::string published;
  for (const CellResult& cell : results.cells) {
    const StudyCell& c = cell.cell;
    const bool here = c.preload == preload && c.samples == request.main_samples &&
                      c.network == request.main_network;
    if (!here) continue;
    add_rows(request, cell, describe_inputs(request, cell), detail, table);
    if (c.inputs != request.main_inputs) published = name_published(request, cell.key);
  }
  table.caption = fmt::format(
      "Inputs and instants, preload {}, {}, {} cases{}; {}", request.preloads[preload].name,
      list_sizes(request.networks[request.main_network]),
      format_count(request.samples[request.main_samples]), published, describe_seeds(request));
  return table;
}

}  // namespace

std::string describe_inputs(const StudyRequest& request, const CellResult& cell) {
  std::string text = request.inputs[cell.cell.inputs].name + " inputs";
  if (cell.cell.best_instant) {
    text += fmt::format(", snapshot at {:.4g} m", cell.offset);
  }
  return text;
}

std::string describe_summary(const StudySummary& s) {
  std::string line = s.preload + ": ";
  if (s.errors > 0) {
    line += fmt::format(
        "{} of {} errors at most a tenth of the published ones (ratio {} at best, {} in the "
        "median, "
        "{} at worst: {}); ",
        s.errors_held, s.errors, round(s.smallest_ratio), round(s.median_ratio),
        round(s.largest_ratio), s.largest_at);
  }
  return line + fmt::format("{} of {} with 1 - R2 at most 1e-4 (worst {}: {})", s.gaps_held, s.gaps,
                            round(s.largest_gap), s.largest_gap_at);
}

std::vector<ReportTable> make_study_tables(const StudyRequest& request, const StudyResults& results,
                                           std::size_t preload, TableDetail detail) {
  std::vector<ReportTable> tables;
  for (std::size_t s = 0; s < request.samples.size(); ++s) {
    tables.push_back(make_network_table(request, results, preload, s, detail));
  }
  if (request.inputs.size() > 1 || request.preloads[preload].has_best) {
    tables.push_back(make_input_table(request, results, preload, detail));
  }
  return tables;
}

}  // namespace strut
