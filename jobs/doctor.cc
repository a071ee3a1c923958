#include "jobs/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>

#include "cluster/slurm.h"
#include "io/format/json.h"
#include "jobs/case/plan_estimate.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/standard_output.h"
#include "jobs/doctor/file_checks.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// The needs of the missing shards of a planned sweep; none for any other folder.
SpaceNeeds calc_needs(const fs::path& root) {
  const SweepFolder folder{root};
  if (!fs::exists(folder.plan())) return {};
  const Plan plan = open_sweep_folder(folder);
  const std::int64_t present = static_cast<std::int64_t>(list_shards(folder).size());
  const double missing =
      1.0 - static_cast<double>(present) / static_cast<double>(plan.shard_count());
  return {missing * static_cast<double>(plan.case_count()) * calc_row_bytes(plan.make_schema()),
          plan.shard_count() - present};
}

/// Nodes with the same widest instruction set compute the same bits.
Finding compare_nodes(const std::vector<NodeInstructionSets>& nodes) {
  std::set<std::string> widest;
  std::string text;
  for (const NodeInstructionSets& node : nodes) {
    const std::string first = node.sets.substr(0, node.sets.find(' '));
    widest.insert(first);
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", node.name, first);
  }
  if (nodes.empty()) {
    return {"instruction sets of the nodes", Health::kWarning, "no node answered",
            "try again when a node is idle"};
  }
  const bool alike = widest.size() == 1;
  return {"instruction sets of the nodes", alike ? Health::kGood : Health::kWarning, text,
          alike ? "the same bits on all of them"
                : "results differ by rounding; use --constraint to select equal nodes"};
}

std::string list_isas() {
  std::vector<std::string> names;
  for (const Kernel& kernel : list_kernels()) names.emplace_back(kernel.isa);
  return fmt::format("{}", fmt::join(names, " "));
}

/// The scheduler of --to; by default the one found on this machine.
std::string choose_dispatcher(const Arguments& arguments) {
  if (!arguments.has("to")) return find_dispatcher();
  return list_dispatchers()[static_cast<std::size_t>(arguments.choice_or("to", 0))];
}

Findings examine(const Arguments& arguments, const fs::path& root) {
  const ProgressLine line("testing the file system and the scheduler");
  Findings findings = check_file_system(root, calc_needs(root));
  findings.push_back({"instruction sets here", Health::kGood, list_isas(), ""});
  const auto dispatcher = make_dispatcher(choose_dispatcher(arguments));
  Resources resources;
  if (arguments.has("partition")) resources.partition = arguments.text("partition");
  for (Finding& f : dispatcher->examine(resources, root)) findings.push_back(std::move(f));
  if (!arguments.is_on("nodes")) return findings;
  try {
    findings.push_back(compare_nodes(dispatcher->list_node_instruction_sets(resources)));
  } catch (const std::runtime_error& e) {
    findings.push_back({"instruction sets of the nodes", Health::kWarning, e.what(), "try again"});
  }
  return findings;
}

Json make_json(const Findings& findings) {
  Json list = Json::array();
  for (const Finding& f : findings) {
    list.push_back(Json{{"check", f.check},
                        {"health", get_name(f.health)},
                        {"found", f.found},
                        {"meaning", f.meaning}});
  }
  return Json{{"checks", list}};
}

void print_text(const Findings& findings) {
  for (const Finding& f : findings) {
    const std::string health = get_name(f.health);
    f.health == Health::kBad ? print_styled(health, Style::kRed) : void(std::cout << health);
    std::cout << fmt::format("{:{}}{}: {}{}{}\n", "", 9 - health.size(), f.check, f.found,
                             f.meaning.empty() ? "" : "; ", f.meaning);
  }
}

void suggest_next_step(const Arguments& arguments, bool holds) {
  const std::string root = arguments.only_operand();
  if (!holds) {
    suggest_again(arguments, "once the bad findings above are fixed");
  } else if (!fs::exists(SweepFolder{root}.plan())) {
    suggest_next({"strut", "plan", "SWEEP.toml", "-o", root});
  } else if (choose_dispatcher(arguments) == SlurmDispatcher::kName) {
    suggest_next({"strut", "submit", root, "--to", SlurmDispatcher::kName});
  } else {
    suggest_next({"strut", "run", root});
  }
}

}  // namespace

Arguments describe_doctor() {
  Arguments arguments(
      "strut doctor DIR [OPTIONS]",
      "Tests what a sweep in DIR (a planned sweep, or a folder for sweeps) relies on: the file "
      "system,\n"
      "the scheduler and, with --nodes, the processors of its nodes, by a job of about a second "
      "each.\n"
      "Reports which promises hold. The exit code is 1 if one does not.",
      "  strut doctor cars\n  strut doctor cars --to slurm --partition short --nodes");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("to", ArgumentValue::one_of(list_dispatchers()),
                       "scheduler (default: slurm if available)");
  arguments.add_option("partition", "P", "partition of the cluster (default: the site's)");
  arguments.add_switch("nodes", "ask every idle node for its instruction sets");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_doctor(const Arguments& arguments) {
  const fs::path root = arguments.only_operand(", a folder");
  if (!fs::is_directory(root))
    throw InputError(root.string() + ": must be a folder, of a sweep or for one");
  const Findings findings = examine(arguments, fs::canonical(root));
  if (arguments.is_on("json")) {
    std::cout << format_json(make_json(findings)) << "\n";
  } else {
    print_text(findings);
  }
  const bool holds = std::none_of(findings.begin(), findings.end(),
                                  [](const Finding& f) { return f.health == Health::kBad; });
  suggest_next_step(arguments, holds);
  return holds ? kExitDone : kExitNegative;
}

}  // namespace strut
