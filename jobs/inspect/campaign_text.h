// A campaign to begin with, from measured files and a model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/table/summary.h"

namespace strut {

struct InspectedFile {
  std::filesystem::path path;
  TableSummary table;
};

/// Returns the text of a campaign that will stand in `folder`: the columns of the first file that
/// match channels of the model (jobs/inspect/match_columns.h) with their units, those that do not
/// as comments, the last file held out; one file is divided into two windows. Throws InputError
/// where the file has no clock, or the model's file cannot be read.
std::string make_campaign_text(const std::vector<InspectedFile>& files,
                               const std::filesystem::path& model,
                               const std::filesystem::path& folder);

}  // namespace strut
