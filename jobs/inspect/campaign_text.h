// A campaign to begin with, from measured files and a model.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "io/table/summary.h"

namespace strut {

struct InspectedFile {
  std::filesystem::path path;
  TableSummary table;
};

struct BegunCampaign {
  std::string text;
  std::vector<std::string> unassigned;  // columns of the first file that no channel got
};

/// Begins a campaign that will stand in `folder`: the columns of the first file that match channels
/// of the model (jobs/inspect/match_columns.h) with their units, those that do not as comments, and
/// the files of `held_out` (canonical paths) held out, the last one where there are none; one file
/// is divided into two windows. Throws InputError where the file has no clock, or the model's file
/// cannot be read.
BegunCampaign begin_campaign(const std::vector<InspectedFile>& files,
                             const std::filesystem::path& model,
                             const std::filesystem::path& folder,
                             const std::set<std::filesystem::path>& held_out = {});

}  // namespace strut
