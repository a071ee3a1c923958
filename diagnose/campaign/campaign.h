// A campaign: which measured files belong to which model, what their columns are, what the model
// may adjust, and which runs are kept apart to judge it. Keys: docs/diagnosis.md.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "estimate/unknown.h"
#include "model/info/model_info.h"

namespace strut {

enum class ColumnRole { kInput, kOutput };

/// One channel of the model and the column that holds it:
/// value = sign * (scale * SI(column)) + offset, in the channel's SI unit.
struct CampaignColumn {
  std::string channel, column;
  std::string unit;  // of the file; "": SI
  std::string si;    // of the channel
  double sign = 1.0, scale = 1.0, offset = 0.0;
  std::optional<double> noise;  // 1 sigma in the channel's SI unit; nothing: estimated
  ColumnRole role = ColumnRole::kOutput;
  bool optional = false;  // a file may lack it
  /// Of an input: what it is to be multiplied by; sigma 0: exactly, infinite: nothing is known.
  Prior gain{1.0, 0.0};
  /// s, half width of the local cubics that smooth an input; nothing: as its noise allows.
  std::optional<double> smooth;
  bool has_sign = false;  // the campaign says it
};

enum class RunUse { kFit, kHoldOut };
/// "fit", "hold_out"
const char* get_name(RunUse use);

struct CampaignRun {
  std::filesystem::path file;
  std::string name;  // as the campaign writes it
  RunUse use = RunUse::kFit;
  std::filesystem::path maneuver;  // of a model that no recorded input drives
  /// What is known of this run alone: parameters of the maneuver, "hit_time" [s]; sigma 0: exactly.
  std::map<std::string, Prior> known;
  std::optional<std::pair<double, double>> window;  // s on the file's clock
};

/// What the baseline may adjust before anything is blamed on the model.
struct CampaignFit {
  std::vector<std::string> free;
  std::vector<std::pair<std::string, double>> fix;
  std::vector<std::pair<std::string, Prior>> prior;
};

struct Campaign {
  std::filesystem::path path, model;
  const ModelInfo* info = nullptr;  // of the model
  CampaignColumn time;
  std::vector<CampaignColumn> columns;  // without time
  CampaignFit fit;
  std::vector<CampaignRun> runs;

  std::size_t count(RunUse use) const;
  /// The campaign's own, and what it names: model, runs, maneuvers.
  std::vector<std::filesystem::path> list_files() const;
};

/// Reads the campaign and looks that its files are there. Throws InputError with file, line, key,
/// value and what is allowed; for unknown keys with the nearest known one; where no run is for
/// fitting, or none held out.
Campaign read_campaign(const std::filesystem::path& path);

}  // namespace strut
