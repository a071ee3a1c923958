#include "jobs/status.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>

#include "cluster/follow.h"
#include "io/format/json.h"
#include "jobs/cli/command.h"
#include "jobs/cli/failures.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/standard_output.h"
#include "jobs/cli/terminal.h"
#include "sweep/status.h"

namespace strut {
namespace {

/// A submission and its progress.
struct Followed {
  Submission submission;
  SubmissionState state;
};

struct Submissions {
  std::vector<Followed> followed;
  std::vector<std::string> faults;  // records that cannot be read
};

Submissions follow_all(const SweepFolder& folder) {
  Submissions all;
  for (Submission& s : list_submissions(folder, &all.faults)) {
    try {
      SubmissionState state = follow(s);
      all.followed.push_back({std::move(s), std::move(state)});
    } catch (const InputError& e) {  // a damaged task record
      all.faults.emplace_back(e.what());
    }
  }
  return all;
}

Json make_json(const Followed& followed) {
  const SubmissionState& state = followed.state;
  Json ended = Json::object(), waits = Json::object();
  for (const auto& [fate, tasks] : state.fates) {
    ended[get_name(fate)] = tasks;
  }
  for (const auto& [reason, tasks] : state.reasons) waits[reason] = tasks;
  return Json{{"submission", followed.submission.name()},
              {"to", followed.submission.dispatcher},
              {"state", get_name(state.queue)},
              {"why_unknown", state.why_unknown},
              {"cancelled", followed.submission.is_cancelled()},
              {"pending", state.pending},
              {"running", state.running},
              {"waiting_for", waits},
              {"ended", ended},
              {"restarts", state.restarts}};
}

/// "001 on slurm: 3 running, 20 pending (Resources); ended: 7 done, 1 timeout"
std::string describe(const Followed& followed) {
  const SubmissionState& state = followed.state;
  const Submission& submission = followed.submission;
  std::string text = fmt::format("{} on {}: ", submission.name(), submission.dispatcher);
  if (state.queue == QueueState::kUnknown) {
    return text + fmt::format("unknown ({})", state.why_unknown);
  }
  text += fmt::format("{} running, {} pending", format_count(state.running),
                      format_count(state.pending));
  std::vector<std::string> reasons, ended;
  for (const auto& [reason, tasks] : state.reasons) reasons.push_back(reason);
  for (const auto& [fate, tasks] : state.fates) {
    ended.push_back(fmt::format("{} {}", format_count(tasks), get_name(fate)));
  }
  if (!reasons.empty()) text += fmt::format(" ({})", fmt::join(reasons, ", "));
  if (submission.is_cancelled()) text += ", cancelled";
  if (!ended.empty()) text += fmt::format("; ended: {}", fmt::join(ended, ", "));
  return text;
}

Json make_first_failures(const Plan& plan, const SweepStatus& status) {
  Json first = Json::object();
  for (const auto& [reason, count] : status.failures) {
    if (count.first_case < 0) continue;
    Json parameters = Json::object();
    for (const auto& [name, value] : list_values(plan, count.first_case)) parameters[name] = value;
    first[reason] =
        Json{{"case", count.first_case}, {"parameters", parameters}, {"why", count.first_reason}};
  }
  return first;
}

Json make_json(const Plan& plan, const SweepStatus& status, const Submissions& submissions) {
  Json jobs = Json::array();
  for (const Followed& followed : submissions.followed) jobs.push_back(make_json(followed));
  Json failures = Json::object(), faults = Json::array(), runners = Json::array();
  for (const auto& [reason, count] : status.failures) failures[reason] = count.cases;
  for (const std::string& fault : status.faults) faults.push_back(fault);
  for (const std::string& fault : submissions.faults) faults.push_back(fault);
  for (const ClaimInfo& claim : status.claims) {
    runners.push_back(Json{{"unit", claim.unit}, {"runner", claim.runner}});
  }
  Json json = Json::object();
  json["cases"] = status.cases;
  json["done"] = status.done;
  json["failed"] = status.failed;
  json["running"] = status.running;
  json["simulated"] = status.simulated;
  json["left"] = status.left;
  json["rate_per_s"] = status.rate > 0.0 ? Json(status.rate) : Json();
  json["seconds_left"] = status.seconds_left;
  json["complete"] = status.complete();
  json["failures"] = failures;
  json["first_failures"] = make_first_failures(plan, status);
  json["shards"] = status.shards_present;
  json["shards_planned"] = status.shards;
  json["bytes"] = status.bytes;
  json["duplicates"] = status.duplicates;
  json["data_digest"] = status.digest.text();
  json["claims"] = runners;
  json["submissions"] = jobs;
  json["faults"] = faults;
  return json;
}

void print_text(const Plan& plan, const SweepStatus& status, const Submissions& submissions) {
  const auto line = [](const char* name, const std::string& value) {
    std::cout << fmt::format("{:<10}{}\n", name, value);
  };
  line("cases", format_count(status.cases));
  line("done", format_count(status.done));
  line("failed", format_count(status.failed));
  for (const auto& [reason, count] : status.failures) {
    std::cout << describe_failures(plan, reason, count) << '\n';
  }
  std::string running = format_count(status.running);
  if (status.running > 0) {
    running += fmt::format(", {} of them simulated", format_count(status.simulated));
  }
  line("running", running);
  line("left", format_count(status.left));
  if (status.rate > 0.0) {
    line("rate", fmt::format("{}/s, {} to go", format_count(std::llround(status.rate)),
                             format_duration(status.seconds_left)));
  }
  line("shards",
       fmt::format("{} of {}, {}", format_count(status.shards_present), format_count(status.shards),
                   format_bytes(static_cast<double>(status.bytes))));
  if (status.duplicates > 0) line("made twice", format_count(status.duplicates) + " shards");
  for (const Followed& followed : submissions.followed) line("submitted", describe(followed));
  for (const std::string& fault : status.faults) print_error(fault);
  for (const std::string& fault : submissions.faults) print_error(fault);
}

/// Whether a runner works on the sweep, or a task waits to.
bool is_under_way(const SweepStatus& status, const Submissions& submissions) {
  if (!status.claims.empty()) return true;
  for (const Followed& followed : submissions.followed) {
    if (followed.state.running + followed.state.pending > 0) return true;
  }
  return false;
}

void suggest_next_step(const Arguments& arguments, const std::string& root,
                       const SweepStatus& status, const Submissions& submissions) {
  if (!status.faults.empty()) {
    suggest_next({"strut", "verify", root, "--quarantine"}, "moves damaged files aside");
  } else if (!submissions.faults.empty()) {
    suggest_again(arguments, "once the files named above are moved away");
  } else if (!status.complete() && is_under_way(status, submissions)) {
    suggest_next({"strut", "status", root, "--watch"});
  } else if (!status.complete()) {
    suggest_next({"strut", "run", root});
  } else if (status.untried > 0) {
    suggest_next({"strut", "resume", root}, "retries failed cases with smaller steps");
  } else if (status.failed > 0) {
    suggest_next_after_failures(root, status.failed);
  } else {
    suggest_next({"strut", "verify", root});
  }
}

}  // namespace

Arguments describe_status() {
  Arguments arguments("strut status DIR [OPTIONS]",
                      "Shows the progress of the sweep in DIR, from its files, and the state of "
                      "its submissions, from\n"
                      "the scheduler; `strut verify` checks every byte. The exit code is 1 if "
                      "cases failed or files\n"
                      "cannot be read.",
                      "  strut status cars --watch\n  strut status cars --json");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_switch("json", "print JSON");
  arguments.add_switch("watch", "print again every second until the sweep is complete");
  return arguments;
}

int run_status(const Arguments& arguments) {
  const OpenSweep sweep = open_sweep(arguments);
  const bool on_terminal = is_live_terminal(STDOUT_FILENO);
  constexpr int kAskEvery = 10;  // [s], so as not to burden the scheduler
  Submissions submissions;
  for (int look = 0;; ++look) {
    const SweepStatus status = read_status(sweep.folder, sweep.plan);
    if (look % kAskEvery == 0) submissions = follow_all(sweep.folder);
    if (arguments.is_on("watch") && on_terminal) print_control("\033[H\033[J");
    if (arguments.is_on("json")) {
      std::cout << format_json(make_json(sweep.plan, status, submissions)) << std::endl;
    } else {
      print_text(sweep.plan, status, submissions);
      std::cout << std::flush;
    }
    if (!arguments.is_on("watch") || status.complete()) {
      suggest_next_step(arguments, sweep.folder.root.string(), status, submissions);
      const bool is_readable = status.faults.empty() && submissions.faults.empty();
      return is_readable && status.failed == 0 ? kExitDone : kExitNegative;
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

}  // namespace strut
