// The folder of a comparison.
#pragma once

#include <filesystem>

#include "diagnose/campaign/campaign_data.h"
#include "jobs/cli/arguments.h"
#include "report/content.h"
#include "report/page_file.h"

namespace strut {

struct CompareFolder : PageFolder {
  std::filesystem::path json() const { return root / kComparisonContent.file; }
};

/// The folder of --output, by find_output_folder() (jobs/cli/output_file.h).
CompareFolder find_compare_folder(const Arguments& arguments, const CampaignData& data);

}  // namespace strut
