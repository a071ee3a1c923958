#include "jobs/identify/window.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "identify/window.h"
#include "jobs/identify/columns.h"
#include "jobs/identify/result.h"
#include "jobs/identify/wear.h"

namespace strut {

int identify_by_window(const Arguments& arguments, const TrainedModel& model,
                       const std::vector<std::filesystem::path>& files) {
  if (files.empty())
    throw arguments.usage_error("MEASURED: missing; name a history with the model's channels");
  for (const char* option : {"set", "event-time", "noise"}) {
    if (!arguments.has(option)) continue;
    throw InputError(fmt::format(
        "--{}: for snapshots only; this model takes a window of a time history", option));
  }
  const ColumnMap map = read_columns_option(arguments, model.window->channels);
  const Identifier identifier(model);
  const auto identify = [&](const std::vector<std::filesystem::path>& records) {
    std::vector<IdentifiedRow> rows;
    rows.reserve(records.size());
    for (const std::filesystem::path& file : records) {
      rows.push_back(identify_record(model, identifier, read_record(*model.window, file, map),
                                     arguments.is_on("extrapolate")));
      rows.back().source = file.string();
    }
    return rows;
  };
  return show_identified(arguments, identify(files), identify(list_before(arguments)));
}

}  // namespace strut
