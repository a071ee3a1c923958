#include "base/error/input_error.h"
#include "diagnose/decide/diagnosis.h"
#include "io/file/read_text_file.h"
#include "io/format/toml_document.h"
#include "model_files/read_effects.h"
#include "model_files/read_fitted.h"
#include "model_files/read_force_maps.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Whether a shared unknown is a parameter of the model's file: neither of an effect nor of the
/// maneuver.
bool is_of_model(const CampaignData& data, const Unknown& u) {
  if (u.kind != UnknownKind::kParameter) return false;
  const Parameter& parameter = find_parameter(data.model(), u.name);
  return !parameter.is_effect && !parameter.is_maneuver;
}

/// The text of a car's model file with the path of its tire file relative to `folder`.
std::string rewrite_tire_path(const std::string& text, const fs::path& model,
                              const fs::path& folder) {
  const Document document(model);
  const fs::path tire = document.root().table("tire").file("file");
  std::error_code error;
  const fs::path from_folder = fs::relative(fs::absolute(tire), fs::absolute(folder), error);
  const fs::path from_model =
      fs::relative(fs::absolute(tire), fs::absolute(model).parent_path(), error);
  if (error) return text;
  std::string changed = text;
  for (const std::string& old : {from_model.generic_string(), tire.generic_string()}) {
    const std::size_t at = changed.find("\"" + old + "\"");
    if (at == std::string::npos) continue;
    changed.replace(at, old.size() + 2, "\"" + from_folder.generic_string() + "\"");
    return changed;
  }
  return changed;
}

}  // namespace

std::string make_extended_model(const CampaignData& data, const Diagnosis& diagnosis,
                                const fs::path& folder) {
  const SharedValues shared = diagnosis.selection.extended.shared();
  FittedValues fitted;
  // The campaign's fixed values are part of the fitted model.
  for (const auto& [name, value] : data.campaign.fit.fix) fitted.emplace_back(name, value);
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    if (is_of_model(data, shared.unknowns[i])) {
      fitted.emplace_back(shared.unknowns[i].name, shared.values[i]);
    }
  }
  std::string text = read_text_file(data.campaign.model);
  if (data.model().has(kHasCar)) text = rewrite_tire_path(text, data.campaign.model, folder);
  const ModelInfo& model = data.model();
  text = replace_effects(replace_fitted(text, fitted), list_effects_on(data, shared), model);
  return diagnosis.force ? replace_force_maps(text, list_force_maps_on(data, shared), model) : text;
}

}  // namespace strut
