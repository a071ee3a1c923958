#include "jobs/identify/fit_report.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "jobs/cli/messages.h"

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

IdentifiedParameter make_estimate(const FitResult& fit, std::size_t i) {
  IdentifiedParameter p;
  p.name = fit.unknowns[i].name;
  p.unit = fit.unknowns[i].unit;
  p.value = fit.values[i];
  const bool known = fit.uncertainty.identifiable[i];
  p.half_width = known ? kNormal95 * fit.uncertainty.sigma[i] : kInfinity;
  p.in_range = known && !fit.at_bound[i];
  return p;
}

std::string format_short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

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
    Json bounds = Json::array();
    bounds.push_back(p.value - p.half_width);
    bounds.push_back(p.value + p.half_width);
    Json json = Json::object();
    json["file"] = get_run_name(fit, runs, i);
    json["name"] = p.name;
    json["value"] = p.value;
    json["ci95"] = bounds;
    json["unit"] = p.unit;
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

void tell_quality(const FitResult& fit) {
  print_note("chi2 per degree of freedom " + format_short(fit.chi2_per_degree()) + " (" +
             std::to_string(fit.degrees) + " degrees), " + std::to_string(fit.iterations) +
             " iterations, " + std::to_string(fit.simulations) + " simulations");
  if (fit.outside > 0) {
    print_note(std::to_string(fit.outside) +
               " readings left aside: before the maneuver or after its duration for some possible "
               "hit time");
  }
  if (!fit.converged) {
    print_error("not converged: the minimum is some " + format_short(fit.distance) +
                " standard deviations away; either the model does not fit at all, or it needs a "
                "nearer start (--set, --prior)");
  } else if (fit.at_kink) {
    print_note("ends at a kink of chi2, where a contact event passes a reading, some " +
               format_short(fit.distance) + " standard deviations from the minimum");
  }
}

/// Whether the noise is what it is said to be.
void tell_noise(const FitResult& fit, const std::vector<MeasuredRun>& runs) {
  if (fit.is_quiet()) {
    print_note(
        "the residuals are smaller than the noise, which seems to be smaller than assumed "
        "(--noise); the intervals are too wide");
  }
  if (fit.is_adequate()) return;
  print_note(
      "the residuals are larger than the noise: the model lacks something or the noise is "
      "larger (--noise); the intervals are too narrow");
  for (const ChannelFit& c : fit.channels) {
    print_note("  " + get_file_name(runs, c) + ": " + get_channel_name(c) + ": chi2 " +
               format_short(calc_chi2_per_reading(c)) +
               " per reading, neighboring residuals correlate by " +
               format_short(c.neighbor_correlation));
  }
}

void tell_open(const FitResult& fit) {
  for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
    if (!fit.at_bound[i]) continue;
    const std::string beyond =
        fit.unknowns[i].prior.informs() ? ", beyond what --prior says of it" : "";
    print_error(fit.unknowns[i].name + " = " + format_number(fit.values[i]) + " " +
                fit.unknowns[i].unit + ": held by its bound" + beyond);
  }
  for (const NullDirection& d : fit.uncertainty.null_directions) {
    print_error("not identifiable: " + describe_direction(d, fit.unknowns) +
                (std::isfinite(d.sigma)
                     ? ", known to " + format_short(100.0 * d.sigma) + " % (1 sigma) only"
                     : ", which moves no reading"));
  }
}

}  // namespace

IdentifiedRow make_fit_row(const FitResult& fit, std::size_t parameter_count) {
  IdentifiedRow row;
  row.parameters.reserve(parameter_count);
  for (std::size_t i = 0; i < parameter_count; ++i) row.parameters.push_back(make_estimate(fit, i));
  return row;
}

Json make_fit_json(const FitResult& fit, const std::vector<MeasuredRun>& runs,
                   std::size_t parameter_count) {
  Json json = make_identified_json({make_fit_row(fit, parameter_count)});
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

void print_fit(const FitResult& fit, const std::vector<MeasuredRun>& runs,
               std::size_t parameter_count) {
  IdentifiedRow table;
  table.parameters.reserve(fit.unknowns.size());
  for (std::size_t i = 0; i < fit.unknowns.size(); ++i) {
    IdentifiedParameter p = make_estimate(fit, i);
    p.in_range = true;  // a fit has no range trained on; what is amiss is told below
    if (i >= parameter_count && runs.size() > 1) p.name += " of " + get_run_name(fit, runs, i);
    table.parameters.push_back(std::move(p));
  }
  print_identified({table});
  tell_quality(fit);
  tell_noise(fit, runs);
  tell_open(fit);
}

}  // namespace strut
