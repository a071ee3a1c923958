// A study's results as JSON and CSV.
#include <cmath>

#include "base/text/format_number.h"
#include "jobs/study/results.h"

namespace strut {
namespace {

Json list_hidden(const StudyRequest& request, const CellResult& cell) {
  Json hidden = Json::array();
  for (const int size : request.networks[cell.cell.network].hidden) hidden.push(size);
  return hidden;
}

Json list_channels(const StudyRequest& request, const CellResult& cell) {
  return Json::texts(request.inputs[cell.cell.inputs].channels);
}

Json make_spreads(const StudyRequest& request, const CellResult& cell) {
  Json parameters = Json::object();
  for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
    Json metrics = Json::object();
    for (std::size_t m = 0; m < kMetrics.size(); ++m) {
      const Spread& spread = cell.spread[p][m];
      Json values = Json::object();
      values.set("median", spread.median).set("low", spread.low).set("high", spread.high);
      const double published = find_published(request, cell, p, m);
      if (!std::isnan(published)) {
        values.set("published", published);
        if (m != kR2) values.set("ratio", spread.median / published);
      }
      metrics.set(kMetrics[m].name, values);
    }
    parameters.set(cell.parameters[p].name, metrics);
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
        metrics.set(metric.name, seed.metrics[p].*metric.value);
      }
      parameters.set(cell.parameters[p].name, metrics);
    }
    Json training = Json::object();
    training.set("seed", seed.seed)
        .set("model", seed.model)
        .set("samples", static_cast<long>(seed.tested))
        .set("epochs", seed.epochs)
        .set("stopped_by", get_name(seed.stop))
        .set("best_validation", seed.best_validation)
        .set("seconds", seed.seconds)
        .set("parameters", parameters);
    trainings.push(training);
  }
  return trainings;
}

Json make_summaries(const StudyRequest& request, const StudyResults& results) {
  Json summaries = Json::array();
  for (const StudySummary& s : summarize(request, results)) {
    Json json = Json::object();
    json.set("preload", s.preload)
        .set("errors", static_cast<long>(s.errors))
        .set("errors_held", static_cast<long>(s.errors_held))
        .set("smallest_ratio", s.smallest_ratio)
        .set("median_ratio", s.median_ratio)
        .set("largest_ratio", s.largest_ratio)
        .set("largest_ratio_at", s.largest_at)
        .set("R2", static_cast<long>(s.gaps))
        .set("R2_held", static_cast<long>(s.gaps_held))
        .set("smallest_R2_gap", s.smallest_gap)
        .set("median_R2_gap", s.median_gap)
        .set("largest_R2_gap", s.largest_gap)
        .set("largest_R2_gap_at", s.largest_gap_at);
    summaries.push(json);
  }
  return summaries;
}

}  // namespace

Json make_json(const StudyRequest& request, const StudyResults& results) {
  Json sweeps = Json::object();
  for (const SweepFacts& sweep : results.sweeps) {
    sweeps.set(sweep.name, Json::object()
                               .set("plan_hash", sweep.plan_hash)
                               .set("cases", static_cast<long>(sweep.cases))
                               .set("failed", static_cast<long>(sweep.failed))
                               .set("offset", sweep.offset));
  }
  Json cells = Json::array();
  for (const CellResult& cell : results.cells) {
    Json json = Json::object();
    json.set("key", cell.key)
        .set("preload", request.preloads[cell.cell.preload].name)
        .set("best_instant", cell.cell.best_instant)
        .set("offset", cell.offset)
        .set("sweep", cell.sweep)
        .set("samples", static_cast<long>(request.samples[cell.cell.samples]))
        .set("network", request.networks[cell.cell.network].name)
        .set("hidden", list_hidden(request, cell))
        .set("inputs", list_channels(request, cell))
        .set("parameters", make_spreads(request, cell))
        .set("trainings", make_trainings(cell));
    cells.push(json);
  }
  Json json = Json::object();
  json.set("title", request.title)
      .set("published", request.published.source)
      .set("seeds", request.seeds)
      .set("summary", make_summaries(request, results))
      .set("sweeps", sweeps)
      .set("cells", cells);
  if (results.noise) json.set("noise", make_json(*results.noise));
  return json;
}

std::string make_csv(const StudyRequest& request, const StudyResults& results) {
  std::string text =
      "preload,offset_m,network,samples,inputs,parameter,metric,unit,seeds,median,low,high,"
      "published,ratio\n";
  for (const CellResult& cell : results.cells) {
    const std::string place = request.preloads[cell.cell.preload].name + "," +
                              format_number(cell.offset) + "," +
                              request.networks[cell.cell.network].name + "," +
                              std::to_string(request.samples[cell.cell.samples]) + "," +
                              request.inputs[cell.cell.inputs].name + ",";
    for (std::size_t p = 0; p < cell.parameters.size(); ++p) {
      for (std::size_t m = 0; m < kMetrics.size(); ++m) {
        const Spread& s = cell.spread[p][m];
        const double published = find_published(request, cell, p, m);
        text += place + cell.parameters[p].name + "," + kMetrics[m].name + "," +
                get_unit(cell.parameters[p], m) + "," + std::to_string(cell.seeds.size()) + "," +
                format_number(s.median) + "," + format_number(s.low) + "," + format_number(s.high);
        text += "," + (std::isnan(published) ? "" : format_number(published)) + ",";
        if (!std::isnan(published) && m != kR2) text += format_number(s.median / published);
        text += "\n";
      }
    }
  }
  return text;
}

}  // namespace strut
