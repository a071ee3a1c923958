// The report of a diagnosis: report.html and its figures.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "jobs/diagnose/folder.h"

namespace strut {

/// `tables`: names of the tables beside the page. Throws EnvironmentError.
void write_diagnose_report(const DiagnoseFolder& folder, const CampaignData& data,
                           const Diagnosis& diagnosis, const std::vector<std::string>& tables);

}  // namespace strut
