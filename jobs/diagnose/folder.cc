#include "jobs/diagnose/folder.h"

#include "jobs/cli/output_file.h"
#include "jobs/compare/curves.h"

namespace strut {

DiagnoseFolder find_diagnose_folder(const Arguments& arguments, const CampaignData& data) {
  std::vector<std::string> files = list_run_tables(data);
  files.insert(files.end(), {std::string(kForceMapTable) + ".csv", kExtendedModelFile});
  return {{find_output_folder(arguments, kDiagnosisContent, files, data.campaign.list_files())}};
}

}  // namespace strut
