#include "jobs/identify/columns.h"

#include "model/model.h"

namespace strut {
namespace {

/// The channels of every kind of model.
std::vector<std::string> list_channel_names() {
  std::vector<std::string> names;
  for (const ModelInfo* model : list_models()) {
    for (const ChannelInfo& channel : model->channels) names.push_back(channel.name);
  }
  return names;
}

}  // namespace

void add_columns_option(Arguments& arguments) {
  arguments.add_option("columns", ArgumentValue::file("CAMPAIGN.toml", {"toml"}),
                       "take names, units, signs and offsets of the columns from the [columns] of\n"
                       "this campaign, and the windows of the runs that it lists");
}

ColumnMap read_columns_option(const Arguments& arguments, const std::vector<ColumnInfo>& channels) {
  if (!arguments.has("columns")) return {};
  std::vector<ColumnInfo> all = {{"time", "s", ""}};
  all.insert(all.end(), channels.begin(), channels.end());
  return read_column_map(arguments.text("columns"), all, list_channel_names());
}

}  // namespace strut
