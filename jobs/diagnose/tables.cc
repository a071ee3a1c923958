#include "jobs/diagnose/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/format_number.h"
#include "diagnose/baseline/sensor_findings.h"
#include "jobs/compare/tables.h"
#include "jobs/diagnose/force_map.h"
#include "model/effects/catalogue.h"

namespace strut {
namespace {

constexpr std::size_t kMaxOnTerminal = 4;  // runners-up

}  // namespace

std::string describe_interval(double value, double low, double high) {
  if (!std::isfinite(value)) return "";
  if (!std::isfinite(low) || !std::isfinite(high)) return format_significant(value) + " (open)";
  const double error = 0.5 * (high - low);
  return fmt::format("{} ({} to {})", format_to_error(value, error), format_to_error(low, error),
                     format_to_error(high, error));
}

namespace {

std::string describe_parameters(const Cause& cause) {
  if (cause.change == EffectChange::kRemoved) return "not there";
  std::string text;
  for (const CauseParameter& p : cause.parameters) {
    const std::string unit = p.unit.empty() || p.unit == "1" ? "" : " " + p.unit;
    text += fmt::format("{}{} = {}{}{}", text.empty() ? "" : "; ", p.key,
                        describe_interval(p.value, p.low, p.high), unit,
                        p.at_bound ? ", at a limit" : "");
  }
  return text;
}

std::string format_probability(double p) {
  return 0.0 < p && p < 0.0005 ? "< 0.001" : fmt::format("{:.3f}", p);
}

std::vector<std::string> make_cause_row(const Cause& cause, const std::string& role) {
  const bool is_rejected = role == "runner-up" || role == "not claimed";
  return {describe_effect(cause.effect, "", cause.change),
          cause.place,
          role,
          describe_parameters(cause) + (cause.converged || is_rejected ? "" : "; not converged"),
          format_probability(cause.probability),
          format_significant(cause.delta_chi2)};
}

std::vector<std::string> make_unknown_row(double probability, const std::string& role) {
  return {"none of the catalogue", "", role, "", format_probability(probability), ""};
}

/// Where several causes act, the rows of each end with the probability that none of the catalogue
/// stands there.
void add_positions(const std::vector<CausePosition>& positions, ReportTable& table) {
  const bool are_several = positions.size() > 1;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const CausePosition& p = positions[i];
    const std::string number = are_several ? fmt::format(" {}", i + 1) : "";
    const std::string other = are_several ? "instead of" + number : "not distinguished";
    table.rows.push_back(make_cause_row(p.get_cause(), "cause" + number));
    for (std::size_t k = 0; k < p.close; ++k) {
      if (k != p.chosen) table.rows.push_back(make_cause_row(p.candidates[k], other));
    }
    if (are_several) table.rows.push_back(make_unknown_row(p.unknown, other));
  }
}

/// Removes the column of places of a stand that has only one.
void drop_empty_place(ReportTable& table) {
  constexpr std::size_t kPlace = 1;
  for (const auto& row : table.rows) {
    if (!row[kPlace].empty()) return;
  }
  for (auto& row : table.rows) row.erase(row.begin() + kPlace);
  table.header.erase(table.header.begin() + kPlace);
  --table.text_columns;
}

std::vector<std::string> make_improvement_notes(const Improvement& improvement) {
  std::vector<std::string> notes;
  if (improvement.explained) {
    notes.push_back(
        fmt::format("Explained fraction of the excess over noise, all held-out runs: {:.1f} %",
                    100.0 * *improvement.explained));
  } else if (improvement.hold_out.fall >= 0.0) {
    notes.emplace_back(
        "No single channel exceeded its noise before; all readings together show the improvement.");
  } else {
    notes.emplace_back(
        "No single channel exceeded its noise before, and the readings do not decide.");
  }
  notes.push_back(fmt::format("Log-likelihood per held-out sample: {} -> {}",
                              format_significant(improvement.log_likelihood_before),
                              format_significant(improvement.log_likelihood_after)));
  return notes;
}

ReportTable make_secant_table(const std::vector<StrutSecant>& secants) {
  ReportTable table{"Secants of the strut's force over its motion, all effects included",
                    {"strut", "stiffness [N/m]", "damping [N s/m]"}};
  for (const StrutSecant& s : secants) {
    const GroupValue &k = s.stiffness, &c = s.damping;
    table.rows.push_back({s.place.empty() ? "strut" : s.place,
                          describe_interval(k.value, k.low, k.high),
                          describe_interval(c.value, c.low, c.high)});
  }
  return table;
}

/// "0.000102 (2.69 %)": rms, and relative to the measured spread.
std::string describe_error(const ChannelComparison* c) {
  if (c == nullptr) return "failed";
  return fmt::format("{} ({:.3g} %)", format_significant(c->rms), 100.0 * c->nrmse);
}

}  // namespace

std::string make_where_text(const Where& where) {
  std::string details;
  for (const std::string* detail : {&where.place, &where.time, &where.band}) {
    if (!detail->empty()) details += (details.empty() ? "" : ", ") + *detail;
  }
  std::string text;
  if (!where.channel.empty()) text += fmt::format(" in {}, run {}", where.channel, where.run);
  if (!details.empty()) text += fmt::format(" ({})", details);
  if (!where.depends_on.empty()) text += ", depending on " + where.depends_on;
  return text.empty()
             ? ""
             : fmt::format(
                   "The residual of the calibrated model in the runs for fitting is largest{}.",
                   text);
}

std::vector<std::string> describe_effects(const Verdict& verdict) {
  constexpr std::size_t kMax = 6;
  std::vector<std::string> lines, names;
  for (const CausePosition& p : verdict.positions) {
    for (const Cause& cause : p.list_close()) {
      const bool is_new = std::find(names.begin(), names.end(), cause.effect) == names.end();
      const EffectInfo* effect = find_effect(cause.effect);
      if (!is_new || effect == nullptr || lines.size() == kMax) continue;
      names.push_back(cause.effect);
      lines.push_back(fmt::format("{}: {}; {} (docs/effects.md#{})", effect->name,
                                  effect->description, effect->equation, effect->name));
    }
  }
  return lines;
}

std::vector<ReportTable> make_cause_tables(const Diagnosis& diagnosis, std::size_t max_runners_up) {
  const Verdict& verdict = diagnosis.verdict;
  ReportTable table{"Causes and their probabilities",
                    {"effect", "place", "role", "parameters (95 %)", "probability", "delta chi2"}};
  table.text_columns = 4;
  add_positions(verdict.positions, table);
  const std::vector<Cause> runners_up = verdict.list_runners_up();
  const std::size_t shown = std::min(max_runners_up, runners_up.size());
  for (std::size_t i = 0; i < shown; ++i) {
    table.rows.push_back(
        make_cause_row(runners_up[i], verdict.positions.empty() ? "not claimed" : "runner-up"));
  }
  if (shown < runners_up.size()) {
    table.notes.push_back(
        fmt::format("runners-up in verdict.json only: {}", runners_up.size() - shown));
  }
  if (table.rows.empty() && verdict.unknown_share == 0.0) return {};
  if (verdict.positions.size() < 2) {
    table.rows.push_back(make_unknown_row(verdict.unknown_share, ""));
  }
  drop_empty_place(table);
  return {std::move(table)};
}

ReportTable make_improvement_table(const CampaignData& data, const Diagnosis& diagnosis) {
  const bool is_extended = diagnosis.is_extended();
  ReportTable table{"Error on the held-out runs: rms, and relative to the measured spread",
                    {"run", "channel", "unit", "noise", "nominal", "calibrated"}};
  table.text_columns = 3;
  if (is_extended) table.header.emplace_back("extended");
  table.header.emplace_back("adequate");
  for (const DiagnosedRun& run : diagnosis.runs) {
    const CampaignRun& entry = data.campaign.runs[run.run];
    if (entry.use != RunUse::kHoldOut) continue;
    for (const MeasuredChannel& measured : data.channels(run.run)) {
      const ChannelInfo& info = data.info(measured.channel);
      const ChannelComparison* last = find_channel(run.after, measured.channel);
      std::vector<std::string> row = {
          entry.name,
          info.name,
          info.unit,
          last == nullptr ? "" : format_significant(last->adequacy.floor.sigma),
          describe_error(find_channel(run.nominal, measured.channel)),
          describe_error(find_channel(run.before, measured.channel))};
      if (is_extended) row.push_back(describe_error(last));
      row.emplace_back(last != nullptr && last->is_adequate() ? "yes" : "no");
      table.rows.push_back(std::move(row));
    }
  }
  if (is_extended) table.notes = make_improvement_notes(diagnosis.improvement);
  return table;
}

std::vector<ReportTable> make_parameter_tables(const Diagnosis& diagnosis) {
  if (diagnosis.parameters.empty()) return {};
  ReportTable table{"Parameters of the model, with 95 % intervals",
                    {"parameter", "unit", "nominal", "calibrated"}};
  table.text_columns = 2;
  if (diagnosis.is_extended()) table.header.emplace_back("extended");
  const auto describe = [](double value, double low, double high, bool at_bound) {
    return describe_interval(value, low, high) + (at_bound ? ", at a limit" : "");
  };
  bool differ = false;
  for (const ParameterChange& p : diagnosis.parameters) {
    std::vector<std::string> row = {
        p.name, p.unit, std::isfinite(p.nominal) ? format_number(p.nominal) : "",
        describe(p.before, p.before_low, p.before_high, p.before_at_bound)};
    if (diagnosis.is_extended()) {
      row.push_back(describe(p.after, p.after_low, p.after_high, p.after_at_bound) +
                    (p.differs ? " *" : ""));
    }
    differ = differ || p.differs;
    table.rows.push_back(std::move(row));
  }
  const std::string sensors = describe_sensor_findings(diagnosis.selection.extended.fit);
  if (!sensors.empty()) table.notes.push_back(sensors);
  if (differ) {
    table.notes.emplace_back(
        "*: differs between the effects that are not distinguished; the interval contains all");
  }
  if (diagnosis.selection.is_left) {
    table.notes.emplace_back(
        "The final model's intervals allow for a part of the unknown force that looks like one of "
        "these parameters.");
  }
  std::vector<ReportTable> tables = {std::move(table)};
  if (!diagnosis.secants.empty()) tables.push_back(make_secant_table(diagnosis.secants));
  return tables;
}

std::string make_diagnose_text(const CampaignData& data, const Diagnosis& diagnosis) {
  std::string text =
      fmt::format("[{}] {}\n", get_badge(diagnosis.verdict.kind), diagnosis.sentence);
  for (const std::string& line : describe_effects(diagnosis.verdict)) text += line + "\n";
  const std::string where = make_where_text(diagnosis.where);
  if (!where.empty()) text += where + "\n";
  for (const PriorConflict& c : diagnosis.conflicts) text += describe_conflict(data, c) + "\n";
  for (const ReportTable& table : make_cause_tables(diagnosis, kMaxOnTerminal)) {
    text += "\n" + make_text(table);
  }
  text += "\n" + make_text(make_improvement_table(data, diagnosis));
  for (const ReportTable& table : make_parameter_tables(diagnosis)) text += "\n" + make_text(table);
  if (!diagnosis.next_measurement.empty()) {
    text += fmt::format("\nNext measurement: {}\n", diagnosis.next_measurement);
  }
  return text;
}

std::vector<ModelCurves> list_model_curves(const Diagnosis& diagnosis, const DiagnosedRun& run) {
  std::vector<ModelCurves> models = {{"calibrated", kCalibratedColor, &run.before.evaluation}};
  if (diagnosis.is_extended())
    models.push_back({"extended", kExtendedColor, &run.after.evaluation});
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
