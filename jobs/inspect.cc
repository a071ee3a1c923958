#include "jobs/inspect.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <set>

#include "base/text/nearest_name.h"
#include "io/file/atomic_file.h"
#include "io/format/json.h"
#include "io/store/measurement.h"
#include "jobs/cli/command.h"
#include "jobs/cli/lists.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/inspect/campaign_text.h"
#include "jobs/inspect/table.h"

namespace strut {

namespace fs = std::filesystem;

namespace {

/// The files of --hold-out, which are among those inspected and leave some of them.
std::set<fs::path> read_held_out(const Arguments& arguments) {
  if (!arguments.has("hold-out")) return {};
  if (!arguments.has("output")) throw arguments.usage_error("--hold-out is for the campaign of -o");
  const auto list_whole = [](const std::vector<std::string>& names) {
    std::set<fs::path> paths;
    for (const std::string& name : names) paths.insert(fs::weakly_canonical(name));
    return paths;
  };
  const std::vector<std::string> names = split_list(arguments.text("hold-out"));
  if (names.empty()) throw arguments.usage_error("--hold-out: empty; allowed: files");
  const std::set<fs::path> files = list_whole(arguments.positional());
  std::set<fs::path> held_out = list_whole(names);
  for (const fs::path& path : held_out) {
    if (files.count(path) > 0) continue;
    throw arguments.usage_error("--hold-out: " + path.filename().string() +
                                " is not among the files");
  }
  if (held_out.size() == files.size()) {
    throw arguments.usage_error("--hold-out: no file is left for fitting");
  }
  return held_out;
}

}  // namespace

Arguments describe_inspect() {
  Arguments arguments(
      "strut inspect FILE... [OPTIONS]",
      "Shows what measured files hold: format, columns with their units and statistics, rate and\n"
      "gaps of the clock, and what is odd. Reads CSV and other text of any dialect, HDF5 and\n"
      "MATLAB. With --model and -o, writes a campaign to begin with: each channel of the model "
      "with\n"
      "the column whose name and unit fit, the last file held out, or those of --hold-out.",
      "  strut inspect drive.csv\n"
      "  strut inspect run1.csv run2.csv --model rig.toml -o campaign.toml");
  arguments.add_operands(ArgumentValue::file("FILE", {"csv", "txt", "h5", "hdf5", "mat"}));
  arguments.add_option("model", ArgumentValue::file("MODEL", {"toml"}),
                       "file of the vehicle or rig, for the campaign");
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"toml"}), "campaign to write");
  arguments.add_option("hold-out",
                       ArgumentValue::file("FILES", {"csv", "txt", "h5", "hdf5", "mat"}),
                       "files that the campaign holds out, with commas between them");
  arguments.add_switch("force", "replace an existing FILE");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_inspect(const Arguments& arguments) {
  const std::vector<std::string>& names = arguments.positional();
  if (names.empty()) throw arguments.usage_error("FILE: missing; name a measured file");
  if (arguments.has("model") != arguments.has("output")) {
    throw arguments.usage_error("--model and -o belong together: the campaign is for that model");
  }
  const std::set<fs::path> held_out = read_held_out(arguments);
  fs::path output;
  if (arguments.has("output")) {
    std::vector<std::string> inputs = names;
    inputs.push_back(arguments.text("model"));
    output = find_output_file(arguments, inputs);
  }
  std::vector<InspectedFile> files;
  files.reserve(names.size());
  for (const std::string& name : names) {
    files.push_back({name, summarize_table(*open_table_file(name, MeasuredPart::kHistory))});
  }
  Json json = Json::array();
  for (const InspectedFile& file : files) {
    if (arguments.is_on("json")) {
      json.push_back(make_inspect_json(file));
    } else {
      std::cout << make_text(make_inspect_table(file)) << "\n";
    }
  }
  if (arguments.is_on("json")) std::cout << format_json(json) << "\n";
  if (output.empty()) {
    suggest_next(
        {"strut", "inspect", names.front(), "--model", "MODEL.toml", "-o", "campaign.toml"},
        "writes a campaign to begin with");
    return kExitDone;
  }
  const BegunCampaign campaign =
      begin_campaign(files, arguments.text("model"), fs::absolute(output).parent_path(), held_out);
  write_text_file(output, campaign.text);
  if (!campaign.unassigned.empty()) {
    print_note(fmt::format("no channel was found for {}: assign what you need in {}",
                           join_names(campaign.unassigned), output.string()));
  }
  suggest_next({"strut", "compare", output.string(), "--check"}, "after a look at the file");
  return kExitDone;
}

}  // namespace strut
