#include "jobs/init.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

#include "base/error/check.h"
#include "base/text/quote_word.h"
#include "embedded/texts.h"
#include "io/file/atomic_file.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// An example and the name that it gets.
struct StarterFile {
  const char* name;
  const std::string_view* text;
};

const std::array<StarterFile, 4> kFiles = {{
    {"vehicle.toml", &embedded::paper_sedan_toml},
    {"tire.tir", &embedded::paper_sedan_tir},
    {"maneuver.toml", &embedded::bump_20mps_toml},
    {"sweep.toml", &embedded::stratified_2000_toml},
}};

/// The places of the examples beside each other, and those of the files.
constexpr std::array<std::array<std::string_view, 2>, 3> kPlaces = {{
    {"../tires/paper_sedan.tir", "tire.tir"},
    {"../vehicles/paper_sedan.toml", "vehicle.toml"},
    {"../maneuvers/bump_20mps.toml", "maneuver.toml"},
}};

std::string make_text(const StarterFile& file) {
  std::string text(*file.text);
  for (const auto& [from, to] : kPlaces) {
    const std::size_t at = text.find(from);
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  STRUT_CHECK(text.find("\"../") == std::string::npos, "an example names a file that init lacks");
  return text;
}

}  // namespace

Arguments describe_init() {
  Arguments arguments(
      "strut init DIR [OPTIONS]",
      "Writes commented files to begin with into DIR: a vehicle with its tire, a maneuver, and a\n"
      "sweep of them. They are those of the paper's sedan; replace its numbers by those of your "
      "car.\n"
      "`strut inspect RECORDING -o CAMPAIGN.toml` drafts a campaign of measured files.",
      "  strut init mycar\n"
      "  strut simulate mycar/vehicle.toml mycar/maneuver.toml -o run.csv --report run");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_switch("force", "replace files of these names that exist");
  return arguments;
}

int run_init(const Arguments& arguments) {
  const fs::path folder = fs::path(arguments.only_operand()).lexically_normal();
  check_output_folder("DIR", folder);
  make_folder(folder);
  for (const StarterFile& file : kFiles) {
    check_output_file("DIR", folder / file.name, {}, arguments.is_on("force"));
  }
  for (const StarterFile& file : kFiles) {
    write_text_file(folder / file.name, make_text(file));
    std::cout << (folder / file.name).string() << "\n";
  }
  suggest_next({"strut", "simulate", (folder / "vehicle.toml").string(),
                (folder / "maneuver.toml").string(), "-o", "run.csv", "--report", "run"},
               "the car crossing the bump, as a page; or strut plan " +
                   quote_if_needed((folder / "sweep.toml").string()) + " -o cars");
  return kExitDone;
}

}  // namespace strut
