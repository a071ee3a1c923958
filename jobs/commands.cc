#include "jobs/commands.h"

#include "base/text/nearest_name.h"
#include "jobs/bench.h"
#include "jobs/cancel.h"
#include "jobs/compare.h"
#include "jobs/completion.h"
#include "jobs/design.h"
#include "jobs/diagnose.h"
#include "jobs/doctor.h"
#include "jobs/evaluate.h"
#include "jobs/export.h"
#include "jobs/identify.h"
#include "jobs/list.h"
#include "jobs/man_page.h"
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

namespace strut {

const std::vector<Command>& list_commands() {
  static const std::vector<Command> commands = {
      {"simulate", "run a car through a maneuver, or write its suspension's kinematics",
       &describe_simulate, &run_simulate},
      {"plan", "make the folder of a sweep: which cases, in which shards", &describe_plan,
       &run_plan},
      {"run", "simulate what a sweep still lacks", &describe_run, &run_run},
      {"resume", "the same, and try again what failed", &describe_resume, &run_resume},
      {"status", "how far a sweep has come", &describe_status, &run_status},
      {"submit", "a sweep as Slurm jobs, or in the background here", &describe_submit, &run_submit},
      {"cancel", "take back what submit queued", &describe_cancel, &run_cancel},
      {"doctor", "can this file system and scheduler keep what a sweep promises?", &describe_doctor,
       &run_doctor},
      {"verify", "check every byte of a sweep, simulate some of it again", &describe_verify,
       &run_verify},
      {"merge", "one HDF5 file of all shards", &describe_merge, &run_merge},
      {"train", "a network that identifies parameters, from a sweep's cases", &describe_train,
       &run_train},
      {"evaluate", "how well a trained network identifies them", &describe_evaluate, &run_evaluate},
      {"identify", "parameters with intervals, from measured data", &describe_identify,
       &run_identify},
      {"compare", "measured against simulated: what the simulation gets wrong", &describe_compare,
       &run_compare},
      {"diagnose", "name the cause, extend the model, measure the gain", &describe_diagnose,
       &run_diagnose},
      {"export", "a trained network as ONNX or C source", &describe_export, &run_export},
      {"design", "which instant, window and sensors identify a sweep's parameters best",
       &describe_design, &run_design},
      {"study", "a table of trainings beside published numbers, with figures and a report",
       &describe_study, &run_study},
      {"report", "one HTML file about a study, sweep, comparison, diagnosis or run",
       &describe_report, &run_report},
      {"list", "what can be set, recorded and switched on", &describe_list, &run_list},
      {"bench", "measure how fast this machine simulates, and how exactly", &describe_bench,
       &run_bench},
      {"completion", "what makes a shell complete these commands and their options",
       &describe_completion, &run_completion},
      {"man", "this program's manual page", &describe_man_page, &run_man_page},
  };
  return commands;
}

const Command& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : list_commands()) {
    if (name == command.name) return command;
    names.emplace_back(command.name);
  }
  throw InputError("unknown command '" + name + "'" + suggest_name(name, names) +
                   "; commands: " + join_names(names) + "; see strut --help");
}

const std::vector<ExitMeaning>& list_exit_meanings() {
  static const std::vector<ExitMeaning> meanings = {
      {"0", "done"},
      {"1", "ran, and the answer is no"},
      {"2", "the input is wrong"},
      {"3", "the environment failed; what was written is whole"},
      {"70", "a bug in strut; the message says what to report"},
      {"130, 143", "interrupted; what was written is whole"},
  };
  return meanings;
}

}  // namespace strut
