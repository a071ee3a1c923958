// The folder of a diagnosis.
#pragma once

#include <filesystem>

#include "diagnose/campaign/campaign_data.h"
#include "jobs/cli/arguments.h"
#include "report/content.h"
#include "report/page_file.h"

namespace strut {

inline constexpr char kExtendedModelFile[] = "extended.toml";
inline constexpr char kForceMapTable[] = "force_map";  // without ".csv"

struct DiagnoseFolder : PageFolder {
  std::filesystem::path verdict() const { return root / kDiagnosisContent.file; }
  std::filesystem::path extended_model() const { return root / kExtendedModelFile; }
};

/// The folder of --output, by find_output_folder() (jobs/cli/output_file.h).
DiagnoseFolder find_diagnose_folder(const Arguments& arguments, const CampaignData& data);

}  // namespace strut
