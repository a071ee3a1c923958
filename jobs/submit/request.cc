#include "jobs/submit/request.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/nearest_name.h"
#include "cluster/local.h"
#include "cluster/packing.h"
#include "cluster/scripts.h"
#include "cluster/slurm.h"
#include "cluster/slurm_options.h"
#include "io/file/read_text_file.h"
#include "jobs/cli/open_sweep.h"

namespace strut {
namespace {

constexpr double kTaskMinutes = 10.0;

/// The wall clock of --time [s]; 0 without it.
double read_time(const Arguments& arguments) {
  if (!arguments.has("time")) return 0.0;
  const std::string text = arguments.text("time");
  const auto seconds = parse_slurm_time(text);
  if (!seconds || *seconds <= 0.0 || !std::isfinite(*seconds)) {
    throw InputError(
        fmt::format("--time = {}: must be minutes, HH:MM:SS or D-HH:MM:SS, and positive", text));
  }
  return *seconds;
}

Resources read_resources(const Arguments& arguments, const Dispatcher& dispatcher) {
  Resources resources;
  resources.partition = arguments.text_or("partition", "");
  resources.account = arguments.text_or("account", "");
  resources.constraint = arguments.text_or("constraint", "");
  resources.memory = arguments.text_or("memory", "");
  resources.extra = arguments.list("option");
  resources.is_shared = arguments.is_on("shared");
  const bool is_local =
      dispatcher.name() == LocalDispatcher::kName && arguments.text("to") != kToList;
  resources.threads = is_local || arguments.has("threads") ? find_threads(arguments) : 1;
  resources.seconds = read_time(arguments);
  return resources;
}

}  // namespace

std::vector<std::string> list_targets() {
  std::vector<std::string> targets = list_dispatchers();
  targets.emplace_back(kToList);
  return targets;
}

std::unique_ptr<Dispatcher> read_dispatcher(const Arguments& arguments) {
  const std::vector<std::string> names = list_targets();
  if (!arguments.has("to")) {
    throw InputError("--to: missing; must be one of " + join_names(names));
  }
  const std::string& name = names[static_cast<std::size_t>(arguments.choice_or("to", 0))];
  return make_dispatcher(name == kToList ? LocalDispatcher::kName : name);
}

SubmitRequest read_submit_request(const Arguments& arguments, const Dispatcher& dispatcher) {
  SubmitRequest request;
  request.resources = read_resources(arguments, dispatcher);
  if (dispatcher.name() == SlurmDispatcher::kName) slurm::check_words(request.resources);
  request.scratch = arguments.text_or("scratch", "");
  if (arguments.has("scratch")) check_scratch(request.scratch);
  if (arguments.has("prologue")) request.prologue = read_text_file(arguments.text("prologue"));
  request.max_tasks = arguments.integer_or("tasks", kMaxTasks, 1, kMaxTasks);
  request.task_seconds = 60.0 * arguments.number_or("minutes", kTaskMinutes, above(0.0, "min"));
  request.at_once = arguments.integer_or("at-once", 0, 1, SiteLimits().tasks);
  request.retries = arguments.is_on("retry");
  request.merges = arguments.is_on("merge");
  request.ignores_unknown = arguments.is_on("again");
  return request;
}

}  // namespace strut
