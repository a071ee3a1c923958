#include "jobs/commands.h"

#include <fmt/format.h>

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
#include "jobs/init.h"
#include "jobs/inspect.h"
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

namespace {

/// Commands that print the table itself get it passed in: they are below it.
int list(const Arguments& arguments) { return run_list(arguments, list_commands()); }
int complete(const Arguments& arguments) { return run_completion(arguments, list_commands()); }
int print_manual(const Arguments& arguments) { return run_man_page(arguments, list_commands()); }

}  // namespace

const CommandTable& list_commands() {
  static const CommandTable commands = {
      {"init", "write a commented vehicle, maneuver and sweep to begin with", &describe_init,
       &run_init},
      {"simulate", "drive a car through a maneuver, or write its suspension kinematics",
       &describe_simulate, &run_simulate},
      {"plan", "create the folder of a sweep: its cases, divided into shards", &describe_plan,
       &run_plan},
      {"run", "simulate the missing cases of a sweep", &describe_run, &run_run},
      {"resume", "the same, and retry failed cases", &describe_resume, &run_resume},
      {"status", "show the progress of a sweep", &describe_status, &run_status},
      {"submit", "queue a sweep as Slurm jobs, or as background jobs on this machine",
       &describe_submit, &run_submit},
      {"cancel", "cancel queued jobs", &describe_cancel, &run_cancel},
      {"doctor", "check whether a sweep can rely on this file system and scheduler",
       &describe_doctor, &run_doctor},
      {"verify", "check every byte of a sweep, and simulate some of its cases again",
       &describe_verify, &run_verify},
      {"merge", "write all shards into one HDF5 file", &describe_merge, &run_merge},
      {"train", "train a network that identifies parameters on a sweep's cases", &describe_train,
       &run_train},
      {"evaluate", "measure how accurately a trained network identifies parameters",
       &describe_evaluate, &run_evaluate},
      {"identify", "identify parameters, with intervals, from measured data", &describe_identify,
       &run_identify},
      {"inspect", "show what a measured file holds, and write a campaign to begin with",
       &describe_inspect, &run_inspect},
      {"compare", "compare measured runs with simulations: residuals and their significance",
       &describe_compare, &run_compare},
      {"diagnose", "name the cause of a misfit, extend the model, measure the improvement",
       &describe_diagnose, &run_diagnose},
      {"export", "write a trained network as ONNX or C source", &describe_export, &run_export},
      {"design", "find the instant, window and sensors that identify parameters best",
       &describe_design, &run_design},
      {"study", "run a table of trainings beside published numbers, with figures and a report",
       &describe_study, &run_study},
      {"report", "write one HTML page about a study, sweep, comparison, diagnosis or run",
       &describe_report, &run_report},
      {"list", "list the parameters, channels and effects of a model, or the commands",
       &describe_list, &list},
      {"bench", "measure the speed and accuracy of simulations on this machine", &describe_bench,
       &run_bench},
      {"completion", "print a completion script for bash, zsh or fish", &describe_completion,
       &complete},
      {"man", "print the manual page", &describe_man_page, &print_manual},
  };
  return commands;
}

const Command& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : list_commands()) {
    if (name == command.name) return command;
    names.emplace_back(command.name);
  }
  throw InputError(fmt::format("unknown command '{}'{}; commands: {}; see strut --help", name,
                               suggest_name(name, names), join_names(names)));
}

}  // namespace strut
