// What a measured file holds, for the terminal and as JSON.
#pragma once

#include "io/format/json.h"
#include "jobs/inspect/campaign_text.h"
#include "report/html.h"

namespace strut {

ReportTable make_inspect_table(const InspectedFile& file);
Json make_inspect_json(const InspectedFile& file);

}  // namespace strut
