#include "jobs/inspect/campaign_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "identify/wear.h"
#include "io/format/toml_text.h"
#include "io/table/units.h"
#include "jobs/inspect/match_columns.h"
#include "model_files/model_tables.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

std::string quote_path(const fs::path& path, const fs::path& folder) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  const fs::path relative = whole.lexically_relative(fs::absolute(folder).lexically_normal());
  return quote_toml((relative.empty() ? whole : relative).string());
}

/// `, unit = "mm"`: where only the name tells the unit. What the file says is read from there.
std::string write_unit(const ColumnSummary& column, const std::string& si) {
  const std::string& unit = column.unit.empty() ? column.guessed_unit : column.unit;
  if (unit.empty() || unit == si || !column.unit.empty()) return "";
  return fmt::format(", unit = {}", quote_toml(unit));
}

/// `si`: in which a column without a unit is read; "": not said.
std::string write_comment(const ColumnSummary& column, const std::string& si = "") {
  std::string text = column.unit.empty() ? "" : "in " + column.unit;
  if (column.unit.empty() && column.guessed_unit.empty() && !si.empty()) {
    text = "no unit in the file: read in " + si;
  }
  for (const std::string& remark : column.remarks) text += (text.empty() ? "" : "; ") + remark;
  return text.empty() ? "" : "   # " + text;
}

/// The recorded channels that drive the rig: each input, or its lowest recorded derivative.
std::set<std::string> list_driving(const ModelInfo& model,
                                   const std::vector<ColumnMatch>& matches) {
  std::set<std::string> driving;
  for (const InputInfo& input : model.inputs) {
    std::vector<std::string> names = {input.name};
    for (const int derivative : {input.rate, input.second_rate}) {
      if (derivative < 0) continue;
      names.push_back(model.channels[static_cast<std::size_t>(derivative)].name);
    }
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return std::any_of(matches.begin(), matches.end(),
                         [&](const ColumnMatch& match) { return match.channel == name; });
    });
    if (found != names.end()) driving.insert(*found);
  }
  return driving;
}

struct ColumnLine {
  std::string channel, definition, comment;
};

ColumnLine write_column(const ModelInfo& model, const ColumnMatch& match, const TableSummary& table,
                        int main_clock, bool is_driving) {
  const ColumnSummary& column = table.columns[match.column];
  const auto channel = static_cast<std::size_t>(find_channel(model, match.channel));
  std::string text = fmt::format("column = {}{}", quote_toml(column.name),
                                 write_unit(column, model.channels[channel].unit));
  if (is_driving) text += ", role = \"input\"";
  if (column.clock >= 0 && column.clock != main_clock) {
    text += fmt::format(", clock = {}",
                        quote_toml(table.columns[static_cast<std::size_t>(column.clock)].name));
  }
  return {match.channel, "{ " + text + " }",
          write_comment(column, model.channels[channel].unit) +
              (match.is_sure ? "" : "   # a guess: check it")};
}

/// Adds the columns that match no channel to `unassigned`.
std::string write_columns(const ModelInfo& model, const TableSummary& table,
                          std::vector<std::string>& unassigned) {
  const std::vector<ColumnMatch> matches = match_columns(model, table);
  // The fastest clock of the matched columns; the others move to it.
  int clock = -1;
  const auto get_interval = [&](int at) {
    return table.columns[static_cast<std::size_t>(at)].times.interval;
  };
  for (const ColumnMatch& match : matches) {
    const int own = table.columns[match.column].clock;
    if (own >= 0 && (clock < 0 || get_interval(own) < get_interval(clock))) clock = own;
  }
  if (clock < 0) {
    const auto any = std::find_if(table.columns.begin(), table.columns.end(),
                                  [](const ColumnSummary& column) { return column.is_clock; });
    if (any != table.columns.end()) clock = static_cast<int>(any - table.columns.begin());
  }
  const std::set<std::string> driving = list_driving(model, matches);
  std::vector<ColumnLine> lines;
  if (clock >= 0) {
    const ColumnSummary& column = table.columns[static_cast<std::size_t>(clock)];
    lines.push_back(
        {"time",
         fmt::format("{{ column = {}{} }}", quote_toml(column.name), write_unit(column, "s")),
         write_comment(column)});
  }
  for (const ColumnMatch& match : matches) {
    if (match.channel == "time") continue;
    lines.push_back(write_column(model, match, table, clock, driving.count(match.channel) > 0));
  }
  std::size_t width = 0;
  for (const ColumnLine& line : lines) width = std::max(width, line.channel.size());
  std::string text;
  for (const ColumnLine& line : lines) {
    text += fmt::format("{:<{}} = {}{}\n", line.channel, width, line.definition, line.comment);
  }
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const ColumnSummary& column = table.columns[k];
    const bool is_used = static_cast<int>(k) == clock ||
                         std::any_of(matches.begin(), matches.end(),
                                     [&](const ColumnMatch& match) { return match.column == k; });
    if (is_used || column.is_clock) continue;
    if (column.fault.empty()) unassigned.push_back(column.name);
    text += fmt::format("# CHANNEL = {{ column = {} }}{}\n", quote_toml(column.name),
                        column.fault.empty() ? write_comment(column) : "   # text");
  }
  std::vector<std::string> names;
  for (const ChannelInfo& channel : model.channels) names.push_back(channel.name);
  const char* how = unassigned.empty() ? "" : "# CHANNEL: the channel that this column measures\n";
  return text + how + "# channels: " + join_names(names) + "\n";
}

/// Parameters to fit: a car's wearing rates, or a rig's masses, stiffness and damping.
std::vector<std::string> list_free(const ModelTables& tables) {
  if (tables.model->has(kHasCar)) return list_wear_parameters(WearLocations::kByAxle);
  std::vector<std::string> names;
  for (const ListedParameter& listed : tables.parameters) {
    const std::string& name = listed.parameter->name;
    const bool is_property =
        name.ends_with("mass") || name.ends_with("stiffness") || name.ends_with("damping");
    if (!listed.parameter->is_effect && is_property && listed.value.value_or(0.0) > 0.0) {
      names.push_back(name);
    }
  }
  return names;
}

/// A mass sets the scale of all forces, which recorded motion alone does not show.
std::string write_prior(const ModelTables& tables) {
  constexpr double kSpread = 0.1;
  if (tables.model->has(kHasCar)) return "";
  for (const ListedParameter& listed : tables.parameters) {
    const std::string& name = listed.parameter->name;
    if (name != "mass" && name != "sprung_mass") continue;
    const double value = listed.value.value_or(0.0);
    if (!(value > 0.0)) return "";
    return fmt::format(
        "prior = {{ {} = [{}, {}] }}   # kg, standard deviation: weigh it, unless a force is "
        "recorded\n",
        name, format_number(value), format_significant(kSpread * value, 2));
  }
  return "";
}

std::string write_run(const std::string& file, const char* use, const ModelInfo& model,
                      const std::string& more = "") {
  std::string text = fmt::format("\n[[run]]\nfile = {}\nuse  = \"{}\"\n{}", file, use, more);
  if (!model.is_driven_by_inputs()) {
    text += "maneuver = \"MANEUVER.toml\"   # speed and bump of this run\n";
  }
  return text;
}

std::string write_runs(const std::vector<InspectedFile>& files, const ModelInfo& model,
                       const fs::path& folder, const std::set<fs::path>& held_out) {
  std::string text;
  if (files.size() > 1) {
    for (const InspectedFile& file : files) {
      const bool is_held_out = held_out.empty()
                                   ? &file == &files.back()
                                   : held_out.count(fs::weakly_canonical(file.path)) > 0;
      text += write_run(quote_path(file.path, folder), is_held_out ? "hold_out" : "fit", model);
    }
    return text;
  }
  const std::vector<ColumnSummary>& columns = files.front().table.columns;
  const auto clock = std::find_if(columns.begin(), columns.end(),
                                  [](const ColumnSummary& column) { return column.is_clock; });
  const ClockSummary& times = clock->times;
  const double middle = times.first + 0.6 * (times.last - times.first);
  const std::string file = quote_path(files.front().path, folder);
  const auto window = [](double from, double to) {
    return fmt::format("window = [{}, {}]   # s, on the file's clock\n", format_number(from),
                       format_number(to));
  };
  return write_run(file, "fit", model, window(times.first, middle)) +
         write_run(file, "hold_out", model, window(middle, times.last));
}

}  // namespace

BegunCampaign begin_campaign(const std::vector<InspectedFile>& files, const fs::path& model,
                             const fs::path& folder, const std::set<fs::path>& held_out) {
  const ModelTables tables = make_model_tables(model.string());
  const TableSummary& first = files.front().table;
  const bool has_clock = std::any_of(first.columns.begin(), first.columns.end(),
                                     [](const ColumnSummary& column) { return column.is_clock; });
  if (!has_clock) {
    throw InputError(files.front().path.string() +
                     ": no column is a time that ascends from row to row");
  }
  std::string free;
  for (const std::string& name : list_free(tables)) {
    free += (free.empty() ? "" : ", ") + quote_toml(name);
  }
  BegunCampaign campaign;
  const std::string columns = write_columns(*tables.model, first, campaign.unassigned);
  campaign.text =
      fmt::format(
          "# Begun by strut inspect; check it with strut compare CAMPAIGN.toml --check.\n"
          "# Keys: docs/diagnosis.md.\n\nmodel = {}\n\n"
          "[columns]   # channel = the file's column; sign = -1 or unit = \"mm\" correct it\n{}\n"
          "[fit]\nfree = [{}]\n{}",
          quote_path(model, folder), columns, free, write_prior(tables)) +
      write_runs(files, *tables.model, folder, held_out);
  return campaign;
}

}  // namespace strut
