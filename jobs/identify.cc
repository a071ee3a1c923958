#include "jobs/identify.h"

#include <filesystem>

#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/unsealed.h"
#include "jobs/identify/columns.h"
#include "jobs/identify/fit.h"
#include "jobs/identify/plate.h"
#include "jobs/identify/result.h"
#include "jobs/identify/snapshot.h"
#include "jobs/identify/wear.h"
#include "jobs/identify/window.h"
#include "train/model/model_file.h"

namespace strut {

namespace fs = std::filesystem;

Arguments describe_identify() {
  Arguments arguments(
      "strut identify MODEL MEASURED... [OPTIONS]\n"
      "       strut identify VEHICLE.toml MEASURED... --maneuver MANEUVER.toml [OPTIONS]\n"
      "       strut identify RIG.toml MEASURED [OPTIONS]",
      "Identifies the parameters of a car from measured data, each with its 95 % interval.\n"
      "  snapshot  MODEL is a network of `strut train`, MEASURED tables with a column for each of\n"
      "            its inputs, one snapshot a row.\n"
      "  window    MODEL is one of `strut train --window`, MEASURED histories with a column "
      "`time`\n"
      "            and one for each of its channels.\n"
      "  fit       The simulation of VEHICLE is fitted to histories with a column `time` [s] from\n"
      "            the start of the maneuver, and the --channels.\n"
      "  plate     RIG.toml is a quarter car, MEASURED one record of a suspension tester's wheel "
      "plate\n"
      "            with the columns `time`, `road_position` (of the plate) and `tire_force`.\n"
      "MEASURED are CSV or other text, HDF5 or MATLAB files. Columns have the names of the "
      "channels,\n"
      "or --columns says which they are; units are SI unless the files or --columns say "
      "otherwise.\n"
      "Outside of the range that a network was trained on the value is `-`. The exit code is then\n"
      "1, as it is where a fit has not converged, or leaves a parameter undetermined or at a "
      "bound.",
      "  strut identify model.h5 measured.csv\n"
      "  strut identify model.h5 drive.csv --event-time 0.632 --noise pitch_angle=2e-4 --json\n"
      "  strut identify model.h5 --set body_position_z=0.55 --set body_velocity_z=0.02 \\\n"
      "      --set body_acceleration_z=-0.3 --set pitch_angle=0.008\n"
      "  strut identify vehicle.toml drive.csv --maneuver bump.toml --window 0.3:2\n"
      "  strut identify vehicle.toml drive.csv --maneuver bump.toml --limit 25 \\\n"
      "      --nuisance body_payload_mass=75,75 --before last_year.csv");
  arguments.add_operand(ArgumentValue::file("MODEL|VEHICLE.toml", {"h5", "toml"}));
  arguments.add_operands(ArgumentValue::file("MEASURED", {"csv", "txt", "h5", "hdf5", "mat"}));
  add_columns_option(arguments);
  add_snapshot_options(arguments);
  add_fit_options(arguments);
  add_wear_options(arguments);
  add_result_options(arguments);
  return arguments;
}

int run_identify(const Arguments& arguments) {
  const auto& names = arguments.positional();
  if (names.empty())
    throw arguments.usage_error(
        "MODEL: missing; name a model of `strut train`, or a VEHICLE.toml to fit");
  const std::vector<fs::path> files(names.begin() + 1, names.end());
  if (is_plate_test(arguments, names.front())) {
    return identify_by_plate(arguments, names.front(), files);
  }
  if (fs::path(names.front()).extension() == ".toml") {
    return identify_by_fit(arguments, names.front(), files);
  }
  refuse_fit_options(arguments);
  const TrainedModel model = load_model(names.front());
  return model.window ? identify_by_window(arguments, model, files)
                      : identify_by_snapshot(arguments, model, files);
}

}  // namespace strut
