// The report of a comparison: report.html and its figures.
#pragma once

#include <string>
#include <vector>

#include "diagnose/compare/compare.h"
#include "jobs/compare/folder.h"

namespace strut {

/// `tables`: names of the tables beside the page. Throws EnvironmentError.
void write_compare_report(const CompareFolder& folder, const CampaignData& data,
                          const Comparison& comparison, const std::vector<std::string>& tables);

}  // namespace strut
