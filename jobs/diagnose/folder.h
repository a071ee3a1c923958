// The folder of a diagnosis.
#pragma once

#include <filesystem>

#include "diagnose/campaign/campaign_data.h"
#include "jobs/cli/arguments.h"
#include "report/content.h"
#include "report/page_file.h"

namespace strut {

struct DiagnoseFolder : PageFolder {
  std::filesystem::path verdict() const { return root / kDiagnosisContent.file; }
  std::filesystem::path extended_model() const { return root / "extended.toml"; }
};

/// The folder of --output, as find_output_folder() (jobs/cli/output_file.h) gives it.
DiagnoseFolder find_diagnose_folder(const Arguments& arguments, const CampaignData& data);

}  // namespace strut
