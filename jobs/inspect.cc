#include "jobs/inspect.h"

#include <filesystem>
#include <iostream>

#include "io/file/atomic_file.h"
#include "io/format/json.h"
#include "io/store/measurement.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/inspect/campaign_text.h"
#include "jobs/inspect/table.h"

namespace strut {

namespace fs = std::filesystem;

Arguments describe_inspect() {
  Arguments arguments(
      "strut inspect FILE... [OPTIONS]",
      "Shows what measured files hold: format, columns with their units and statistics, rate and\n"
      "gaps of the clock, and what is odd. Reads CSV and other text of any dialect, HDF5 and\n"
      "MATLAB. With --model and -o, writes a campaign to begin with: each channel of the model "
      "with\n"
      "the column whose name and unit fit, the last file held out.",
      "  strut inspect drive.csv\n"
      "  strut inspect run1.csv run2.csv --model rig.toml -o campaign.toml");
  arguments.add_operands(ArgumentValue::file("FILE", {"csv", "txt", "h5", "hdf5", "mat"}));
  arguments.add_option("model", ArgumentValue::file("MODEL", {"toml"}),
                       "file of the vehicle or rig, for the campaign");
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"toml"}), "campaign to write");
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
  write_text_file(output, make_campaign_text(files, arguments.text("model"),
                                             fs::absolute(output).parent_path()));
  suggest_next({"strut", "compare", output.string(), "--check"}, "after a look at the file");
  return kExitDone;
}

}  // namespace strut
