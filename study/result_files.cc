#include "study/result_files.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/format_number.h"
#include "io/file/atomic_file.h"
#include "study/noise/result_files.h"
#include "study/summary.h"

namespace strut {
namespace {

Json list_hidden(const StudyRequest& request, const CellResult& cell) {
  Json hidden = Json::array();
  for (const int size : request.networks[cell.cell.network].hidden) hidden.push_back(size);
  return hidden;
}

Json list_channels(const StudyRequest& request, const CellResult& cell) {
  return Json(request.inputs[cell.cell.inputs].channels);
}

Json make_spreads(const StudyRequest& request, const CellResult& cell) {
  Json parameters = Json::object();
  for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
    Json metrics = Json::object();
    for (std::size_t m = 0; m < kMetrics.size(); ++m) {
      const Spread& spread = cell.spread[p][m];
      Json values = Json::object();
      values["median"] = spread.median;
      values["low"] = spread.low;
      values["high"] = spread.high;
      const double published = find_published(request, cell, p, m);
      if (!std::isnan(published)) {
        values["published"] = published;
        if (m != kR2) values["ratio"] = spread.median / published;
      }
      metrics[kMetrics[m].name] = values;
    }
    parameters[cell.parameters[p].name] = metrics;
  }
  return parameters;
}

Json make_trainings(const CellResult& cell) {
  Json trainings = Json::array();
  for (const SeedResult& seed : cell.seeds) {
    Json parameters = Json::object();
    for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
      Json metrics = Json::object();
      for (const MetricInfo& metric : kMetrics) {
        metrics[metric.name] = seed.metrics[p].*metric.value;
      }
      parameters[cell.parameters[p].name] = metrics;
    }
    Json training = Json::object();
    training["seed"] = seed.seed;
    training["model"] = seed.model;
    training["samples"] = seed.tested;
    training["epochs"] = seed.epochs;
    training["stopped_by"] = get_name(seed.stop);
    training["best_validation"] = seed.best_validation;
    training["seconds"] = seed.seconds;
    training["parameters"] = parameters;
    trainings.push_back(training);
  }
  return trainings;
}

Json make_summaries(const StudyRequest& request, const StudyResults& results) {
  Json summaries = Json::array();
  for (const StudySummary& s : summarize(request, results)) {
    Json json = Json::object();
    json["preload"] = s.preload;
    json["errors"] = s.errors;
    json["errors_held"] = s.errors_held;
    json["smallest_ratio"] = s.smallest_ratio;
    json["median_ratio"] = s.median_ratio;
    json["largest_ratio"] = s.largest_ratio;
    json["largest_ratio_at"] = s.largest_at;
    json["R2"] = s.gaps;
    json["R2_held"] = s.gaps_held;
    json["smallest_R2_gap"] = s.smallest_gap;
    json["median_R2_gap"] = s.median_gap;
    json["largest_R2_gap"] = s.largest_gap;
    json["largest_R2_gap_at"] = s.largest_gap_at;
    summaries.push_back(json);
  }
  return summaries;
}

/// The cells of a row from the parameter on; `published` is NaN where there is none.
std::string make_row(const CellResult& cell, std::size_t p, std::size_t m, double published) {
  const Spread& s = cell.spread[p][m];
  const bool known = !std::isnan(published);
  return fmt::format("{},{},{},{},{},{},{},{},{}", cell.parameters[p].name, kMetrics[m].name,
                     get_unit(cell.parameters[p], m), cell.seeds.size(), format_number(s.median),
                     format_number(s.low), format_number(s.high),
                     known ? format_number(published) : "",
                     known && m != kR2 ? format_number(s.median / published) : "");
}

}  // namespace

Json make_json(const StudyRequest& request, const StudyResults& results) {
  Json sweeps = Json::object();
  for (const SweepFacts& sweep : results.sweeps) {
    sweeps[sweep.name] = Json{{"plan_hash", sweep.plan_hash},
                              {"cases", sweep.cases},
                              {"failed", sweep.failed},
                              {"offset", sweep.offset}};
  }
  Json cells = Json::array();
  for (const CellResult& cell : results.cells) {
    Json json = Json::object();
    json["key"] = cell.key;
    json["preload"] = request.preloads[cell.cell.preload].name;
    json["best_instant"] = cell.cell.best_instant;
    json["offset"] = cell.offset;
    json["sweep"] = cell.sweep;
    json["samples"] = request.samples[cell.cell.samples];
    json["network"] = request.networks[cell.cell.network].name;
    json["hidden"] = list_hidden(request, cell);
    json["inputs"] = list_channels(request, cell);
    json["parameters"] = make_spreads(request, cell);
    json["trainings"] = make_trainings(cell);
    cells.push_back(json);
  }
  Json json = Json::object();
  json["title"] = request.title;
  json["published"] = request.published.source;
  json["seeds"] = request.seeds;
  json["summary"] = make_summaries(request, results);
  json["sweeps"] = sweeps;
  json["cells"] = cells;
  if (results.noise) json["noise"] = make_json(*results.noise);
  return json;
}

std::string make_csv(const StudyRequest& request, const StudyResults& results) {
  std::string text =
      "preload,offset_m,network,samples,inputs,parameter,metric,unit,seeds,median,low,high,"
      "published,ratio\n";
  for (const CellResult& cell : results.cells) {
    const std::string start =
        fmt::format("{},{},{},{},{}", request.preloads[cell.cell.preload].name,
                    format_number(cell.offset), request.networks[cell.cell.network].name,
                    request.samples[cell.cell.samples], request.inputs[cell.cell.inputs].name);
    for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
      for (std::size_t m = 0; m < kMetrics.size(); ++m) {
        text += start + "," + make_row(cell, p, m, find_published(request, cell, p, m)) + "\n";
      }
    }
  }
  return text;
}

void write_result_files(const StudyFolder& folder, const StudyRequest& request,
                        const StudyResults& results) {
  write_text_file_inside(folder.root, folder.results(),
                         format_json(make_json(request, results)) + "\n");
  write_text_file_inside(folder.root, folder.tables(), make_csv(request, results));
  if (!results.noise) return;
  write_text_file_inside(folder.root, folder.noise_table(), make_csv(*results.noise));
}

}  // namespace strut
