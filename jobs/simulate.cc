#include "jobs/simulate.h"

#include <fmt/format.h>

#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/simulate/car.h"
#include "jobs/simulate/kinematics.h"
#include "jobs/simulate/options.h"
#include "jobs/simulate/rig.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

int run_kinematics(const SimulateOptions& options) {
  if (options.output.extension() != ".csv") {
    throw InputError(
        fmt::format("--output = {}: the name must end in .csv", options.output.string()));
  }
  check_output_file("output", options.output, list_files_read({options.source.vehicle}),
                    options.force);
  write_kinematics(options.source, options.output);
  print_note(options.output.string() + ": front and rear left corner, -100 to +100 mm");
  suggest_next(
      {"strut", "simulate", options.source.vehicle.string(), "MANEUVER.toml", "-o", "run.csv"});
  return kExitDone;
}

}  // namespace

Arguments describe_simulate() {
  Arguments arguments(
      "strut simulate VEHICLE MANEUVER -o FILE [OPTIONS]\n"
      "       strut simulate --kinematics VEHICLE -o FILE.csv",
      "Drives a car, or a rig, through a maneuver. Writes all channels over time, with units, to "
      "FILE\n"
      "(.csv or .h5) and prints the snapshot of a car: the motion of its body when the rear wheels "
      "are\n"
      "on the bump. With --kinematics: camber, toe, wheel center, caster, spring, damper and track "
      "of\n"
      "the left corners over a wheel travel of -100 to +100 mm.",
      "  strut simulate examples/vehicles/paper_sedan.toml examples/maneuvers/bump_20mps.toml \\\n"
      "      --set front_stiffness=38000 -o run.h5\n"
      "  strut simulate --kinematics examples/vehicles/paper_sedan.toml -o curves.csv");
  arguments.add_operand(ArgumentValue::file("VEHICLE", {"toml"}));
  arguments.add_operand(ArgumentValue::file("MANEUVER", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"csv", "h5", "hdf5"}),
                       "file to write: .csv, .h5 or .hdf5");
  arguments.add_option(
      "integrator", ArgumentValue::one_of(list_names(kIntegrators)),
      "rk4 (default); abm4: Adams-Bashforth-Moulton; cvode: SUNDIALS, tolerance 1e-12");
  arguments.add_option(
      "step", "S",
      "step of rk4 and abm4 [s], in (0, 0.02] (default 0.001, or what the effects need)");
  arguments.add_option(
      "coarse-step", "S",
      "longer step [s], from --step to 0.02, away from the bump (default: --step)");
  arguments.add_option("closure", ArgumentValue::one_of(list_names(kClosures)),
                       "newton (default): closes the loops in every step; table: corner kinematics "
                       "tabulated over their coordinate");
  arguments.add_option("spin", ArgumentValue::one_of(list_names(kSpins)),
                       "wheel spin: exponential (default), stable at any speed; or explicit");
  arguments.add_switch("no-events", "do not end steps at events (lift-off, kinks)");
  arguments.add_option("rate", "HZ", "samples per second in FILE [Hz] (default 1000)");
  arguments.add_list(
      "set", ArgumentValue::setting(),
      "set a parameter, e.g. front_stiffness=38000 or speed=72km/h; may be repeated");
  arguments.add_option("channels", "A,B", "channels in FILE, beside the time (default: all)");
  arguments.add_option(
      "report", ArgumentValue::folder("DIR"),
      "also write DIR/report.html: the car crossing the bump, and its curves; of a rig its curves");
  arguments.add_option("beside", ArgumentValue::file("RUN", {}),
                       "draw another run over this one in the report: a file of simulate, or a "
                       "recording with its channels' names");
  arguments.add_switch("force", "replace FILE if it exists");
  arguments.add_switch("json", "print the snapshot as JSON");
  arguments.add_switch("kinematics", "write the suspension's kinematics instead of a run");
  return arguments;
}

int run_simulate(const Arguments& arguments) {
  const SimulateOptions options = read_simulate_options(arguments);
  if (options.kinematics) return run_kinematics(options);
  print_detail(fmt::format("integrator {}", options.integrator_name()));
  if (read_model_info(options.source.vehicle).is_driven_by_inputs()) {
    refuse_options(arguments, {"coarse-step", "closure", "spin", "beside"},
                   options.source.vehicle.string() + " is a rig; allowed for cars");
    return run_rig(arguments, options);
  }
  return run_car(arguments, options);
}

}  // namespace strut
