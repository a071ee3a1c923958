// The folder of a comparison.
#pragma once

#include <filesystem>

#include "diagnose/campaign_data.h"
#include "jobs/arguments.h"
#include "jobs/report/content.h"
#include "jobs/report/page_file.h"

namespace strut {

struct CompareFolder : PageFolder {
  std::filesystem::path json() const { return root / kComparisonContent.file; }
};

/// The folder of --output, as find_output_folder() (jobs/output_file.h) gives it.
CompareFolder find_compare_folder(const Arguments& arguments, const CampaignData& data);

}  // namespace strut
