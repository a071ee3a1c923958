#include "jobs/compare/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/math/normal.h"
#include "diagnose/baseline/sensor_findings.h"
#include "io/table/csv.h"
#include "jobs/compare/curves.h"

namespace strut {
namespace {

ReportTable make_parameter_table(const Comparison& comparison) {
  ReportTable table{"Parameters", {"parameter", "unit", "nominal", "calibrated", "95 %"}};
  table.text_columns = 2;
  const Baseline& baseline = comparison.baseline;
  for (std::size_t i = 0; i < baseline.shared_count(); ++i) {
    const Unknown& u = baseline.calibrated.unknowns[i];
    if (is_sensor_tolerance(u)) continue;
    table.rows.push_back(
        {u.name, u.unit, format_short(baseline.nominal.values[i]),
         format_short(baseline.calibrated.values[i]) + (baseline.fit.at_bound[i] ? " (bound)" : ""),
         "+/- " + format_short(1.96 * baseline.calc_sigma(i))});
  }
  const std::string sensors = describe_sensor_findings(baseline.fit);
  if (!sensors.empty()) table.notes.push_back(sensors);
  for (const std::string& combination : comparison.not_identifiable) {
    table.notes.push_back("Not identifiable from these runs: " + combination);
  }
  return table;
}

std::string describe_error(const ChannelComparison* c) {
  return c == nullptr ? "failed" : format_percent(c->nrmse);
}

ReportTable make_channel_table(const CampaignData& data, const Comparison& comparison) {
  ReportTable table{
      "Residuals: rms relative to the measured channel's standard deviation",
      {"run", "use", "channel", "nominal", "calibrated", "rms", "noise", "rms/noise", "adequate"}};
  table.text_columns = 3;
  for (const RunComparison& run : comparison.runs) {
    for (const MeasuredChannel& measured : data.channels(run.run)) {
      const ChannelComparison* before = find_channel(run.nominal, measured.channel);
      const ChannelComparison* after = find_channel(run.calibrated, measured.channel);
      const CampaignRun& entry = data.campaign.runs[run.run];
      const ChannelInfo& info = data.info(measured.channel);
      std::vector<std::string> row = {entry.name, get_name(entry.use), info.name,
                                      describe_error(before), describe_error(after)};
      if (after != nullptr) {
        row.insert(row.end(), {format_short(after->rms) + " " + info.unit,
                               format_short(after->adequacy.floor.sigma),
                               format_short(after->adequacy.calc_times_noise()),
                               after->is_adequate() ? "yes" : "no"});
      } else {
        row.insert(row.end(), {"", "", "", ""});
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

CsvColumn make_column(const std::string& name, const std::string& unit) { return {name, unit, {}}; }

/// One row per run, channel and model; runs and channels by their numbers in compare.json.
std::vector<CsvColumn> make_channel_columns(const Comparison& comparison) {
  std::vector<CsvColumn> columns = {make_column("run", "1"),
                                    make_column("channel", "1"),
                                    make_column("calibrated", "1"),
                                    make_column("count", "1"),
                                    make_column("rms", ""),
                                    make_column("nrmse", "1"),
                                    make_column("noise", ""),
                                    make_column("chi2_per_reading", "1"),
                                    make_column("neighbor_correlation", "1")};
  for (const RunComparison& run : comparison.runs) {
    for (const ModelComparison* model : {&run.nominal, &run.calibrated}) {
      for (std::size_t k = 0; k < model->channels.size(); ++k) {
        const ChannelComparison& c = model->channels[k];
        const double row[] = {static_cast<double>(run.run + 1),
                              static_cast<double>(k + 1),
                              model == &run.calibrated ? 1.0 : 0.0,
                              static_cast<double>(c.count),
                              c.rms,
                              c.nrmse,
                              c.sigma,
                              c.chi2_per_reading,
                              c.neighbor_correlation};
        for (std::size_t i = 0; i < columns.size(); ++i) columns[i].values.push_back(row[i]);
      }
    }
  }
  return columns;
}

std::vector<CsvColumn> make_run_columns(const CampaignData& data, const RunComparison& run) {
  std::vector<CsvColumn> columns = make_curve_columns(data, run.run, list_model_curves(run));
  if (!run.balance) return columns;
  columns.push_back({"balance_deflection", "m", run.balance->deflection});
  columns.push_back({"balance_velocity", "m/s", run.balance->velocity});
  columns.push_back({"balance_force", "N", run.balance->force});
  columns.push_back({"balance_residual", "N", run.balance->residual});
  return columns;
}

ReportTable make_window_table(const CampaignData& data, const RunComparison& run) {
  ReportTable table{"By time, calibrated: rms relative to the channel's standard deviation",
                    {"channel"}};
  for (const TimeWindow& window : run.windows) {
    table.header.push_back(window.name + "\n" + format_short(window.from) + " s");
  }
  for (const ChannelComparison& c : run.calibrated.channels) {
    std::vector<std::string> row = {data.info(c.channel).name};
    for (const WindowResidual& w : c.windows) {
      row.push_back(w.count > 0 ? format_percent(w.nrmse) : "");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable make_band_table(const CampaignData& data, const RunComparison& run) {
  ReportTable table{"By frequency, calibrated: rms of residual, of measurement, of noise",
                    {"channel"}};
  for (const FrequencyBand& band : kBands) table.header.push_back(describe(band));
  for (const ChannelComparison& c : run.calibrated.channels) {
    std::vector<std::string> row = {
        fmt::format("{} [{}]", data.info(c.channel).name, data.info(c.channel).unit)};
    for (const BandResidual& b : c.bands) {
      row.push_back(fmt::format("{}\n{}\n{}", format_short(b.residual_rms),
                                format_short(b.measured_rms), format_short(b.noise_rms)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// "38000 +/- 120 N/m"
std::string format_interval(double value, double sigma, const std::string& unit) {
  return fmt::format("{} +/- {} {}", format_short(value), format_short(kNormal95 * sigma), unit);
}

ReportTable make_balance_table(const BodyBalance& b) {
  ReportTable table{"Body balance, without the road", {"", "value"}};
  table.rows = {{"residual", format_short(b.rms) + " N"},
                {"relative to the strut's force", format_percent(b.nrmse)},
                {"noise alone", format_short(b.noise_rms) + " N"},
                {"stiffness", format_interval(b.stiffness, b.stiffness_sigma, "N/m")},
                {"damping", format_interval(b.damping, b.damping_sigma, "N s/m")}};
  for (const StateResidual& state : b.states) {
    table.rows.push_back({"explained by " + state.state, format_percent(state.explained)});
  }
  for (const KinematicResidual& k : b.kinematics) {
    table.rows.push_back(
        {k.channel + " against that of the position",
         fmt::format("gain {}, residual {} m/s^2", format_short(k.gain), format_short(k.rms))});
  }
  return table;
}

ReportTable make_balance_table(const CarBalance& b) {
  ReportTable table{"Body balance, without the road", {"", "value"}};
  table.rows = {{"residual over noise", format_short(std::sqrt(b.chi2_per_reading))}};
  for (const BalanceParameter& p : b.parameters) {
    table.rows.push_back({p.name, format_interval(p.value, p.sigma, p.unit)});
  }
  return table;
}

}  // namespace

const ChannelComparison* find_channel(const ModelComparison& model, int channel) {
  for (const ChannelComparison& c : model.channels) {
    if (c.channel == channel) return &c;
  }
  return nullptr;
}

std::vector<ModelCurves> list_model_curves(const RunComparison& run) {
  return {{"nominal", kNominalColor, &run.nominal.evaluation},
          {"calibrated", kCalibratedColor, &run.calibrated.evaluation}};
}

std::string make_verdict_text(const CampaignData& data, const Comparison& comparison) {
  if (comparison.is_adequate()) {
    return "Adequate: the calibrated model agrees with every channel within its noise.";
  }
  const Misfit& worst = *find_worst(comparison.misfits);
  if (!worst.failure.empty()) return "Not adequate: " + describe_misfit(data, worst) + ".";
  return fmt::format(
      "Not adequate: the residual of the calibrated model is {} of {} in {}, {:.3g} times its "
      "noise.",
      format_percent(worst.nrmse), data.info(worst.channel).name, name_run(data, worst.run),
      worst.times_noise);
}

std::vector<ReportTable> make_compare_tables(const CampaignData& data,
                                             const Comparison& comparison) {
  std::vector<ReportTable> tables;
  if (comparison.baseline.is_fitted) tables.push_back(make_parameter_table(comparison));
  tables.push_back(make_channel_table(data, comparison));
  return tables;
}

std::vector<ReportTable> make_run_tables(const CampaignData& data, const RunComparison& run) {
  std::vector<ReportTable> tables = {make_window_table(data, run), make_band_table(data, run)};
  if (run.balance) tables.push_back(make_balance_table(*run.balance));
  if (run.car_balance) tables.push_back(make_balance_table(*run.car_balance));
  return tables;
}

std::vector<std::string> write_compare_tables(const CompareFolder& folder, const CampaignData& data,
                                              const Comparison& comparison) {
  std::vector<std::string> names = {"channels"};
  write_csv(folder.make(), names.front() + ".csv", make_channel_columns(comparison));
  for (const RunComparison& run : comparison.runs) {
    names.push_back(make_run_name(data, run.run));
    write_csv(folder.make(), names.back() + ".csv", make_run_columns(data, run));
  }
  return names;
}

}  // namespace strut
