// A campaign: a model, its measured files with the meaning of their columns, the parameters that
// the baseline may adjust, and the held-out runs. Keys: docs/diagnosis.md.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/campaign/campaign_effects.h"
#include "estimate/sensor_error.h"
#include "estimate/unknown.h"
#include "io/store/column_map.h"
#include "model/info/model_info.h"

namespace strut {

enum class ColumnRole { kInput, kOutput };

/// One channel of the model and the column of the files that holds it.
struct CampaignColumn : MappedColumn {
  std::optional<double> noise;  // standard deviation in the channel's SI unit; null: estimated
  ColumnRole role = ColumnRole::kOutput;
  bool optional = false;  // a file may lack it
  InputDerivative input;  // the input that it gives, or whose time derivative
  /// Factor on an input. sigma 0: known exactly; infinite: unknown.
  Prior gain{1.0, 0.0};
  /// Bias of an input's sensor in a run, in the channel's SI unit, as `gain`. That of a derivative
  /// is unknown by default, since it adds up.
  Prior bias{0.0, 0.0};
  /// Half width of the local cubics that smooth an input [s]; null: chosen by its noise.
  std::optional<double> smooth;
  double delay = 0.0;  // s, of the readings against the clock
  std::string clock;   // column of its own times; "": the campaign's `time`
};

enum class RunUse { kFit, kHoldOut };
/// "fit", "hold_out"
const char* get_name(RunUse use);

struct CampaignRun {
  std::filesystem::path file;
  std::string name;  // as in the campaign
  RunUse use = RunUse::kFit;
  std::filesystem::path maneuver;  // for models that no recorded input drives
  /// Priors for this run alone: parameters of the maneuver, kHitTimeName [s]. sigma 0: known
  /// exactly.
  std::map<std::string, Prior> known;
  std::optional<std::pair<double, double>> window;  // on the file's clock [s]
};

/// Errors of a recording's sensors beyond white noise, by default those of a good sensor.
struct CampaignNoise {
  SensorTolerance sensor{1e-3, 2e-5};
};

/// The parameters that the baseline may adjust, fixes, and has priors for.
struct CampaignFit {
  std::vector<std::string> free;
  std::vector<std::pair<std::string, double>> fix;
  std::vector<std::pair<std::string, Prior>> prior;
};

struct Campaign {
  std::filesystem::path path, model;
  const ModelInfo* info = nullptr;  // the model's
  CampaignColumn time;
  std::vector<CampaignColumn> columns;  // without time
  CampaignEffects effects;
  CampaignFit fit;  // with the parameters of the effects that are on
  CampaignNoise noise;
  std::vector<CampaignRun> runs;

  std::size_t count(RunUse use) const;
  /// The campaign's file and the files it names: model, runs, maneuvers.
  std::vector<std::filesystem::path> list_files() const;
};

/// Reads the campaign and checks that its files exist. Throws InputError with file, line, key,
/// value and the allowed range; for unknown keys with the nearest known one; where there is no run
/// for fitting, or no held-out run.
Campaign read_campaign(const std::filesystem::path& path);

}  // namespace strut
