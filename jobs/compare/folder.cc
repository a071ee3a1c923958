#include "jobs/compare/folder.h"

#include "jobs/cli/output_file.h"
#include "jobs/compare/curves.h"

namespace strut {

CompareFolder find_compare_folder(const Arguments& arguments, const CampaignData& data) {
  std::vector<std::string> files = list_run_tables(data);
  files.emplace_back("channels.csv");
  return {{find_output_folder(arguments, kComparisonContent, files, data.campaign.list_files())}};
}

}  // namespace strut
