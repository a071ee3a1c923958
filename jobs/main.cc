// The program `strut`: a table of commands, and the one place where exceptions become exit codes.

#include <sundials/sundials_version.h>

#include <exception>
#include <iostream>

#include "io/hdf5.h"
#include "io/nearest_name.h"
#include "jobs/bench.h"
#include "jobs/build_info.h"
#include "jobs/cancel.h"
#include "jobs/command.h"
#include "jobs/compare.h"
#include "jobs/design.h"
#include "jobs/diagnose.h"
#include "jobs/doctor.h"
#include "jobs/evaluate.h"
#include "jobs/export.h"
#include "jobs/identify.h"
#include "jobs/interrupt.h"
#include "jobs/merge.h"
#include "jobs/plan.h"
#include "jobs/report.h"
#include "jobs/run.h"
#include "jobs/simulate.h"
#include "jobs/status.h"
#include "jobs/study.h"
#include "jobs/submit.h"
#include "jobs/train.h"
#include "jobs/verify.h"
#include "model/kernel/simulation.h"

namespace {

using strut::Command;

constexpr Command kCommands[] = {
    {"simulate", "run a car through a maneuver, or write its suspension's kinematics",
     &strut::run_simulate},
    {"plan", "make the folder of a sweep: which cases, in which shards", &strut::run_plan},
    {"run", "simulate what a sweep still lacks", &strut::run_run},
    {"resume", "the same, and try again what failed", &strut::run_resume},
    {"status", "how far a sweep has come", &strut::run_status},
    {"submit", "a sweep as Slurm jobs, or in the background here", &strut::run_submit},
    {"cancel", "take back what submit queued", &strut::run_cancel},
    {"doctor", "can this file system and scheduler keep what a sweep promises?",
     &strut::run_doctor},
    {"verify", "check every byte of a sweep, simulate some of it again", &strut::run_verify},
    {"merge", "one HDF5 file of all shards, copied or virtual", &strut::run_merge},
    {"train", "a network that identifies parameters, from a sweep's cases", &strut::run_train},
    {"evaluate", "how well a trained network identifies them", &strut::run_evaluate},
    {"identify", "parameters with intervals, from measured data", &strut::run_identify},
    {"compare", "measured against simulated: what the simulation gets wrong", &strut::run_compare},
    {"diagnose", "name the cause, extend the model, measure the gain", &strut::run_diagnose},
    {"export", "a trained network as ONNX or C source", &strut::run_export},
    {"design", "which instant, window and sensors identify a sweep's parameters best",
     &strut::run_design},
    {"study", "a table of trainings beside published numbers, with figures and a report",
     &strut::run_study},
    {"report", "one HTML file about a study or a sweep", &strut::run_report},
    {"bench", "measure how fast this machine simulates, and how exactly", &strut::run_bench},
};

void print_help() {
  std::cout << "Usage: strut COMMAND [ARGUMENTS]\n\nCommands:\n";
  for (const Command& command : kCommands) {
    const std::string name = command.name;
    std::cout << "  " << name << std::string(12 - name.size(), ' ') << command.purpose << "\n";
  }
  std::cout << "\n`strut COMMAND --help` explains a command; `strut --version` says what this is.\n"
               "\nExit codes: 0 done; 1 ran, and the answer is no; 2 the input is wrong; 3 the\n"
               "environment failed; 130, 143 interrupted.\n";
}

void print_version() {
  const strut::BuildInfo& build = strut::get_build_info();
  std::cout << "strut " << build.version << " (" << build.commit
            << ")\ncompiler: " << build.compiler << ", " << build.build_type
            << "\ninstruction sets:";
  for (const strut::Kernel& kernel : strut::list_kernels()) {
    std::cout << ' ' << kernel.isa << " (" << kernel.lanes << " lanes)";
  }
  char sundials[32] = "";
  SUNDIALSGetVersion(sundials, sizeof sundials);
  std::cout << "\nHDF5: " << strut::hdf5_version() << "\nSUNDIALS: " << sundials << "\n";
}

int run(const std::vector<std::string>& arguments) {
  const std::string first = arguments.empty() ? "" : arguments.front();
  if (first == "--help" || first == "-h" || first == "help") {
    print_help();
    return strut::kExitDone;
  }
  if (first == "--version") {
    print_version();
    return strut::kExitDone;
  }
  std::vector<std::string> names;
  for (const Command& command : kCommands) {
    if (first == command.name) return command.run({arguments.begin() + 1, arguments.end()});
    names.push_back(command.name);
  }
  throw strut::InputError((first.empty() ? "no command" : "unknown command '" + first + "'") +
                          strut::suggest_name(first, names) +
                          "; commands: " + strut::join_names(names) + "; see strut --help");
}

int run_and_flush(const std::vector<std::string>& arguments) {
  const int code = run(arguments);
  std::cout.flush();
  if (!std::cout) throw strut::EnvironmentError("standard output: cannot be written");
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  strut::end_on_interrupt();
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    return run_and_flush(arguments);
  } catch (const strut::InputError& e) {
    std::cerr << "strut: " << e.what() << "\n";
    return strut::kExitInput;
  } catch (const std::exception& e) {
    std::cerr << "strut: " << e.what() << "\n";
    return strut::kExitEnvironment;
  }
}
