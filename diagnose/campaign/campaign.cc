#include "diagnose/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "base/error/input_error.h"
#include "base/names/name_table.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "io/format/toml_document.h"
#include "model_files/file_kind.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

constexpr std::array<Named<ColumnRole>, 2> kRoles = {
    {{ColumnRole::kInput, "input"}, {ColumnRole::kOutput, "output"}}};
static_assert(names_all(kRoles, ColumnRole::kOutput));
constexpr std::array<Named<RunUse>, 2> kUses = {
    {{RunUse::kFit, "fit"}, {RunUse::kHoldOut, "hold_out"}}};
static_assert(names_all(kUses, RunUse::kHoldOut));
constexpr char kTime[] = "time";

/// Keys by which a run changes its maneuver.
const std::vector<std::string> kManeuverKeys = {"speed",       "drive_torque", "bump_distance",
                                                "bump_height", "bump_length",  kHitTimeName};

const ChannelInfo& find_channel_info(const Table& columns, const ModelInfo& model,
                                     const std::string& channel) {
  const int found = find_channel(model, channel);
  if (found >= 0) return model.channels[static_cast<std::size_t>(found)];
  std::vector<std::string> names;
  for (const ChannelInfo& info : model.channels) names.push_back(info.name);
  const std::string nearest = suggest_name(channel, names);
  throw columns.error(channel,
                      "is not a channel of this model" +
                          (nearest.empty() ? "; channels: " + join_names(names) : nearest));
}

ColumnRole read_role(const Table& table, const ModelInfo& model, const std::string& channel) {
  const InputDerivative sensor = find_input_derivative(model, channel);
  const bool drives = sensor.input >= 0 && sensor.derivative == 0;
  const auto role =
      static_cast<ColumnRole>(table.choice_or("role", drives ? 0 : 1, list_names(kRoles)));
  if (role == ColumnRole::kInput && sensor.input < 0) {
    std::vector<std::string> names;
    for (const ChannelInfo& c : model.channels) {
      if (find_input_derivative(model, c.name).input >= 0) names.push_back(c.name);
    }
    throw table.error("role", fmt::format("'{}' is not an input of this model; inputs: {}", channel,
                                          names.empty() ? "none, a car is driven by its maneuver"
                                                        : join_names(names)));
  }
  if (role == ColumnRole::kOutput && drives) {
    throw table.error("role",
                      fmt::format("'{}' is an input of the model; must be \"input\"", channel));
  }
  return role;
}

/// "[mean, sigma]"
Prior read_prior(const Table& table, const std::string& key) {
  const std::vector<double> numbers = table.numbers(key);
  if (numbers.size() != 2 || !(numbers[1] > 0.0)) {
    throw table.error(key, "must be [mean, sigma], sigma > 0");
  }
  return {numbers[0], numbers[1]};
}

/// Reads a number, which is known exactly (sigma 0), or [mean, sigma].
Prior read_known(const Table& table, const std::string& key) {
  try {
    return {table.number(key), 0.0};
  } catch (const InputError&) {
    return read_prior(table, key);
  }
}

/// Reads the gain, bias and smoothing of an input. The gain of an actuator's command and the bias
/// of a derivative are unknown unless the campaign gives them.
void read_input(const Table& table, const ModelInfo& model, CampaignColumn& c) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  c.input = find_input_derivative(model, c.channel);
  if (model.inputs[static_cast<std::size_t>(c.input.input)].is_command) c.gain.sigma = kUnknown;
  if (c.input.derivative > 0) c.bias.sigma = kUnknown;
  if (table.has("gain")) c.gain = read_known(table, "gain");
  if (table.has("bias")) c.bias = read_known(table, "bias");
  if (table.has("smooth")) c.smooth = table.number("smooth", at_least(0.0, "s"));
}

CampaignColumn read_column(const Table& columns, const std::string& channel,
                           const ModelInfo& model) {
  CampaignColumn c;
  static_cast<MappedColumn&>(c) =
      read_mapped_column(columns, channel, find_channel_info(columns, model, channel).unit);
  const Table table = columns.table(channel);
  if (channel == kTime) return c;
  c.clock = table.text_or("clock", "");
  c.delay = table.number_or("delay", 0.0);
  c.role = read_role(table, model, channel);
  c.optional = table.boolean_or("optional", false);
  if (c.role == ColumnRole::kInput) read_input(table, model, c);
  if (table.has("noise")) c.noise = table.number("noise", above(0.0, c.si));
  return c;
}

void read_columns(const Table& root, Campaign& campaign) {
  const Table columns = root.table("columns");
  bool any_output = false;
  for (const std::string& channel : columns.keys()) {
    CampaignColumn c = read_column(columns, channel, *campaign.info);
    any_output = any_output || (channel != kTime && c.role == ColumnRole::kOutput);
    (channel == kTime ? campaign.time : campaign.columns.emplace_back()) = std::move(c);
  }
  if (campaign.time.channel.empty()) throw columns.error(kTime, "is missing");
  if (!any_output) throw columns.error("no channel to compare; every column is an input");
}

/// Frees the parameters of the effects that are on, beside those that the campaign lists.
void free_effects(const Campaign& campaign, CampaignFit& fit) {
  for (const EffectAtPlace& effect : campaign.effects.on) {
    for (std::string& name : list_parameter_names(effect, *campaign.info)) {
      const bool is_listed = std::find(fit.free.begin(), fit.free.end(), name) != fit.free.end();
      if (!is_listed) fit.free.push_back(std::move(name));
    }
  }
}

void read_fit(const Table& root, const Campaign& campaign, CampaignFit& fit) {
  const auto table = root.find_table("fit");
  if (table && table->has("free")) fit.free = table->texts("free");
  free_effects(campaign, fit);
  if (!table) return;
  if (const auto fix = table->find_table("fix")) {
    for (const std::string& name : fix->keys()) fit.fix.emplace_back(name, fix->number(name));
  }
  if (const auto prior = table->find_table("prior")) {
    for (const std::string& name : prior->keys()) {
      if (std::find(fit.free.begin(), fit.free.end(), name) == fit.free.end()) {
        throw prior->error(name, fmt::format("is not free; free: {}{}", join_names(fit.free),
                                             suggest_name(name, fit.free)));
      }
      fit.prior.emplace_back(name, read_prior(*prior, name));
    }
  }
  for (const auto& [name, value] : fit.fix) {
    if (std::find(fit.free.begin(), fit.free.end(), name) != fit.free.end()) {
      throw table->error("fix",
                         fmt::format("'{}' is also in free; must be in one of the two", name));
    }
  }
}

void read_noise(const Table& root, CampaignNoise& noise) {
  const auto table = root.find_table("noise");
  if (!table) return;
  noise.sensor.gain = table->number_or("gain", noise.sensor.gain, at_least(0.0, "1"));
  noise.sensor.skew = table->number_or("skew", noise.sensor.skew, at_least(0.0, "s"));
}

CampaignRun read_run(const Table& table, const Campaign& campaign) {
  CampaignRun run;
  run.name = table.text("file");
  run.file = table.file("file");
  run.use = static_cast<RunUse>(table.choice("use", list_names(kUses)));
  if (!campaign.info->is_driven_by_inputs()) {
    run.maneuver = table.file("maneuver");
    for (const std::string& key : kManeuverKeys) {
      if (table.has(key)) run.known[key] = read_known(table, key);
    }
  }
  if (table.has("window")) {
    const std::vector<double> window = table.numbers("window");
    if (window.size() != 2 || !(window[0] < window[1])) {
      throw table.error("window", "must be [from, to] in s, from < to");
    }
    run.window = {window[0], window[1]};
  }
  return run;
}

void read_runs(const Table& root, Campaign& campaign) {
  for (const Table& table : root.tables("run")) {
    campaign.runs.push_back(read_run(table, campaign));
    const auto same = [&](const CampaignRun& r) {
      return r.file == campaign.runs.back().file && r.window == campaign.runs.back().window;
    };
    if (std::count_if(campaign.runs.begin(), campaign.runs.end(), same) > 1) {
      throw table.error("file", "is listed twice; a run is for fitting or held out, not both");
    }
  }
  for (const RunUse use : {RunUse::kFit, RunUse::kHoldOut}) {
    if (campaign.count(use) > 0) continue;
    throw root.error("run",
                     use == RunUse::kFit
                         ? "every run is held out; at least one must have use = \"fit\""
                         : "every run is for fitting, so nothing distinguishes a better model "
                           "from a more flexible one; at least one must have use = "
                           "\"hold_out\"");
  }
}

}  // namespace

const char* get_name(RunUse use) { return find_name(kUses, use); }

std::size_t Campaign::count(RunUse use) const {
  return static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(), [use](const CampaignRun& run) { return run.use == use; }));
}

std::vector<std::filesystem::path> Campaign::list_files() const {
  std::vector<std::filesystem::path> files = {path, model};
  for (const CampaignRun& run : runs) {
    files.push_back(run.file);
    if (!info->is_driven_by_inputs()) files.push_back(run.maneuver);
  }
  return files;
}

Campaign read_campaign(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = open_root(document, kCampaignFile);
  Campaign campaign;
  campaign.path = path;
  campaign.model = root.file("model");
  campaign.info = &read_model_info(campaign.model);
  read_columns(root, campaign);
  campaign.effects = read_campaign_effects(root, *campaign.info);
  read_fit(root, campaign, campaign.fit);
  read_noise(root, campaign.noise);
  read_runs(root, campaign);
  document.check_all_read();
  return campaign;
}

}  // namespace strut
