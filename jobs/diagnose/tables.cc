#include "jobs/diagnose/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/diagnose/force_map.h"

namespace strut {
namespace {

constexpr std::size_t kMaxOnTerminal = 4;  // runners-up

std::string describe_interval(double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "open";
  return format_short(low) + " to " + format_short(high);
}

std::string describe_parameters(const Cause& cause) {
  if (cause.change == EffectChange::kRemoved) return "not there";
  std::string text;
  for (const CauseParameter& p : cause.parameters) {
    const std::string unit = p.unit.empty() || p.unit == "1" ? "" : " " + p.unit;
    text += fmt::format("{}{} = {}{} ({})", text.empty() ? "" : "; ", p.key, format_short(p.value),
                        unit, describe_interval(p.low, p.high));
  }
  return text;
}

std::vector<std::string> make_cause_row(const Cause& cause, const std::string& role) {
  return {describe_effect(cause.effect, "", cause.change),
          cause.place,
          role,
          describe_parameters(cause) +
              (cause.converged || role == "runner-up" ? "" : "; not converged"),
          fmt::format("{:.3f}", cause.probability),
          fmt::format("{:.1f}", cause.delta_chi2)};
}

std::string describe_likelihood(const Improvement& improvement) {
  return fmt::format("Log-likelihood per held-out sample: {} -> {}",
                     format_short(improvement.log_likelihood_before),
                     format_short(improvement.log_likelihood_after));
}

std::string describe_explained(const Improvement& improvement) {
  if (improvement.explained) {
    return fmt::format("Explained fraction of the excess over noise: {:.1f} %",
                       100.0 * *improvement.explained);
  }
  return "No single channel exceeded its noise before: only the likelihood shows the improvement.";
}

}  // namespace

std::string make_where_text(const Where& where) {
  std::string details;
  for (const std::string* detail : {&where.place, &where.time, &where.band}) {
    if (!detail->empty()) details += (details.empty() ? "" : ", ") + *detail;
  }
  std::string text;
  if (!where.channel.empty()) text += " in " + where.channel;
  if (!details.empty()) text += fmt::format(" ({})", details);
  if (!where.depends_on.empty()) text += ", depending on " + where.depends_on;
  return text.empty() ? "" : fmt::format("The residual of the baseline is largest{}.", text);
}

std::vector<ReportTable> make_cause_tables(const Diagnosis& diagnosis, std::size_t max_runners_up) {
  ReportTable table{"Causes and their probabilities",
                    {"effect", "place", "", "parameters (95 %)", "probability", "delta chi2"}};
  table.text_columns = 4;
  for (const Cause& cause : diagnosis.causes) table.rows.push_back(make_cause_row(cause, "cause"));
  for (const Cause& cause : diagnosis.group) {
    if (is_in(diagnosis.causes, cause)) continue;
    table.rows.push_back(make_cause_row(cause, "not distinguished"));
  }
  const std::size_t shown = std::min(max_runners_up, diagnosis.runners_up.size());
  for (std::size_t i = 0; i < shown; ++i) {
    table.rows.push_back(make_cause_row(diagnosis.runners_up[i], "runner-up"));
  }
  if (shown < diagnosis.runners_up.size()) {
    table.notes.push_back(
        fmt::format("{} more runners-up are in verdict.json", diagnosis.runners_up.size() - shown));
  }
  if (table.rows.empty() && diagnosis.unknown_share == 0.0) return {};
  table.rows.push_back(
      {"none of the catalogue", "", "", "", fmt::format("{:.3f}", diagnosis.unknown_share), ""});
  return {std::move(table)};
}

ReportTable make_improvement_table(const Diagnosis& diagnosis) {
  const Improvement& improvement = diagnosis.improvement;
  ReportTable table{
      "Error on the held-out runs: rms, and relative to the measured spread",
      {"channel", "unit", "baseline", "extended", "noise", "baseline, rel.", "extended, rel."}};
  table.text_columns = 2;
  for (const ChannelImprovement& c : improvement.channels) {
    table.rows.push_back({c.channel, c.unit, format_short(c.rms_before), format_short(c.rms_after),
                          format_short(c.noise_floor), format_percent(c.nrmse_before),
                          format_percent(c.nrmse_after)});
  }
  if (diagnosis.is_extended()) {
    table.notes.push_back(describe_explained(improvement));
    table.notes.push_back(describe_likelihood(improvement));
  }
  return table;
}

std::vector<ReportTable> make_parameter_tables(const Diagnosis& diagnosis) {
  if (diagnosis.parameters.empty()) return {};
  ReportTable table{"Parameters of the model, with 95 % intervals",
                    {"parameter", "unit", "baseline", "95 %", "extended", "95 %"}};
  table.text_columns = 2;
  const auto describe = [](double value, double low, double high) {
    return std::isfinite(value) ? describe_interval(low, high) : "";
  };
  for (const ParameterChange& p : diagnosis.parameters) {
    table.rows.push_back({p.name, p.unit, format_short(p.before),
                          describe(p.before, p.before_low, p.before_high), format_short(p.after),
                          describe(p.after, p.after_low, p.after_high)});
  }
  return {std::move(table)};
}

std::string make_diagnose_text(const Diagnosis& diagnosis) {
  std::string text = diagnosis.sentence + "\n";
  const std::string where = make_where_text(diagnosis.where);
  if (!where.empty()) text += where + "\n";
  for (const ReportTable& table : make_cause_tables(diagnosis, kMaxOnTerminal)) {
    text += "\n" + make_text(table);
  }
  text += "\n" + make_text(make_improvement_table(diagnosis));
  if (!diagnosis.next_measurement.empty()) {
    text += fmt::format("\nNext measurement: {}\n", diagnosis.next_measurement);
  }
  return text;
}

std::vector<ModelCurves> list_model_curves(const Diagnosis& diagnosis, const DiagnosedRun& run) {
  std::vector<ModelCurves> models = {{"baseline", 5, &run.before}};
  if (diagnosis.is_extended()) models.push_back({"extended", 2, &run.after});
  return models;
}

std::vector<std::string> write_diagnose_tables(const DiagnoseFolder& folder,
                                               const CampaignData& data,
                                               const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const DiagnosedRun& run : diagnosis.runs) {
    names.push_back(make_run_name(data, run.run));
    write_csv(folder.make(), names.back() + ".csv",
              make_curve_columns(data, run.run, list_model_curves(diagnosis, run)));
  }
  if (!diagnosis.force) return names;
  names.emplace_back(kForceMapTable);
  write_csv(folder.make(), names.back() + ".csv",
            make_force_map_columns(*diagnosis.force, diagnosis.selection.extended));
  return names;
}

}  // namespace strut
