#include "jobs/identify/fit_report.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/format_number.h"
#include "jobs/cli/messages.h"
#include "jobs/identify/result.h"

namespace strut {
namespace {

const std::string& get_run_name(const FitResult& fit, const std::vector<MeasuredRun>& runs,
                                std::size_t i) {
  static const std::string kEvery = "all";
  const int run = fit.unknowns[i].run;
  return run == kEveryRun ? kEvery : runs[static_cast<std::size_t>(run)].name;
}

Json make_nuisances_json(const FitResult& fit, const std::vector<MeasuredRun>& runs,
                         std::size_t first) {
  Json list = Json::array();
  for (std::size_t i = first; i < fit.unknowns.size(); ++i) {
    const IdentifiedParameter p = make_estimate(fit, i);
    Json json = Json::object();
    json["file"] = get_run_name(fit, runs, i);
    json["name"] = p.name;
    add_estimate_json(p, json);
    list.push_back(json);
  }
  return list;
}

const std::string& get_file_name(const std::vector<MeasuredRun>& runs, const ChannelFit& c) {
  return runs[static_cast<std::size_t>(c.run)].name;
}

const std::string& get_channel_name(const ChannelFit& c) {
  return list_car_channels()[static_cast<std::size_t>(c.channel)].name;
}

double calc_chi2_per_reading(const ChannelFit& c) { return c.chi2 / static_cast<double>(c.count); }

Json make_channels_json(const FitResult& fit, const std::vector<MeasuredRun>& runs) {
  Json list = Json::array();
  for (const ChannelFit& c : fit.channels) {
    Json json = Json::object();
    json["file"] = get_file_name(runs, c);
    json["channel"] = get_channel_name(c);
    json["readings"] = c.count;
    json["chi2_per_reading"] = calc_chi2_per_reading(c);
    json["neighbor_correlation"] = c.neighbor_correlation;
    list.push_back(json);
  }
  return list;
}

Json make_directions_json(const FitResult& fit) {
  Json list = Json::array();
  for (const NullDirection& d : fit.uncertainty.null_directions) {
    Json json = Json::object();
    json["combination"] = describe_direction(d, fit.unknowns);
    json["sigma_percent"] = 100.0 * d.sigma;
    list.push_back(json);
  }
  return list;
}

Json make_correlation_json(const FitResult& fit, std::size_t count) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < count; ++j) row.push_back(fit.uncertainty.calc_correlation(i, j));
    rows.push_back(row);
  }
  return rows;
}

void report_quality(const FitResult& fit) {
  print_note(
      fmt::format("chi2 per degree of freedom {:.3g} ({} degrees), {} iterations, {} simulations",
                  fit.chi2_per_degree(), fit.degrees, fit.iterations, fit.simulations));
  if (fit.outside > 0) {
    print_note(
        fmt::format("{} readings left aside: before the maneuver or after its duration for "
                    "some possible hit time",
                    fit.outside));
  }
  if (!fit.converged) {
    print_error(fmt::format(
        "not converged: the minimum is about {:.3g} standard deviations away; either the model "
        "does not fit at all, or it needs start values nearer to the solution (--set, --prior)",
        fit.distance));
  } else if (fit.at_kink) {
    print_note(
        fmt::format("ends at a kink of chi2, where a contact event passes a reading, about "
                    "{:.3g} standard deviations from the minimum",
                    fit.distance));
  }
}

/// Reports where the residuals contradict the assumed noise.
void report_noise(const FitResult& fit, const std::vector<MeasuredRun>& runs) {
  if (fit.is_quiet()) {
    print_note(
        "the residuals are smaller than the noise, which seems to be smaller than assumed "
        "(--noise); the intervals are too wide");
  }
  if (fit.is_adequate()) return;
  print_note(
      "the residuals are larger than the noise: the model lacks an effect, or the noise is larger "
      "than assumed (--noise); the intervals are too narrow");
  for (const ChannelFit& c : fit.channels) {
    print_note(
        fmt::format("  {}: {}: chi2 {:.3g} per reading, neighboring residuals correlate by {:.3g}",
                    get_file_name(runs, c), get_channel_name(c), calc_chi2_per_reading(c),
                    c.neighbor_correlation));
  }
}

/// Reports unknowns at their bounds and combinations that the readings do not determine.
void report_undetermined(const FitResult& fit) {
  for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
    if (!fit.at_bound[i]) continue;
    const Unknown& unknown = fit.unknowns[i];
    print_error(fmt::format("{} = {} {}: held by its bound{}", unknown.name,
                            format_number(fit.values[i]), unknown.unit,
                            unknown.prior.informs() ? ", outside of its --prior" : ""));
  }
  for (const NullDirection& d : fit.uncertainty.null_directions) {
    const std::string accuracy =
        std::isfinite(d.sigma) ? fmt::format("known to {:.3g} % (1 sigma) only", 100.0 * d.sigma)
                               : "which moves no reading";
    print_error(
        fmt::format("not identifiable: {}, {}", describe_direction(d, fit.unknowns), accuracy));
  }
}

}  // namespace

Json make_fit_json(const Fit& all, const IdentifiedRow& row) {
  const auto& [runs, fit, parameter_count] = all;
  Json json = make_identified_json({row});
  json["converged"] = fit.converged;
  json["distance"] = fit.distance;
  json["at_kink"] = fit.at_kink;
  json["chi2_per_dof"] = fit.chi2_per_degree();
  json["dof"] = fit.degrees;
  json["adequate"] = fit.is_adequate();
  json["nuisances"] = make_nuisances_json(fit, runs, parameter_count);
  json["channels"] = make_channels_json(fit, runs);
  json["not_identifiable"] = make_directions_json(fit);
  json["correlation"] = make_correlation_json(fit, parameter_count);
  json["iterations"] = fit.iterations;
  json["simulations"] = fit.simulations;
  json["left_aside"] = fit.outside;
  return json;
}

void report_fit(const Fit& fit) {
  report_quality(fit.result);
  report_noise(fit.result, fit.runs);
  report_undetermined(fit.result);
}

void print_fit(const Fit& fit, const IdentifiedRow& row) {
  IdentifiedRow table = row;
  for (std::size_t i = row.parameters.size(); i < fit.result.unknowns.size(); ++i) {
    table.parameters.push_back(make_estimate(fit.result, i));
    if (fit.runs.size() > 1)
      table.parameters.back().name += fmt::format(" of {}", get_run_name(fit.result, fit.runs, i));
  }
  for (IdentifiedParameter& p : table.parameters) p.in_range = true;  // reasons: report_fit
  print_identified({table});
  report_fit(fit);
}

}  // namespace strut
