#include "jobs/bench.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>

#include "base/text/quote_word.h"
#include "jobs/bench/find_example.h"
#include "jobs/bench/measure.h"
#include "jobs/bench/page.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"

namespace strut {
namespace {

/// The example sweep to be measured. If it is not found: an error if `must` is true, otherwise a
/// note and an empty path.
std::filesystem::path find_sweep(bool must) {
  const char* const name = "sweeps/paper_fast.toml";
  try {
    return find_example(name);
  } catch (const InputError&) {
    if (must) throw;
  }
  print_note(fmt::format(
      "examples/{}: not found above the program or the working directory; no sweep is measured",
      name));
  return {};
}

std::filesystem::path find_scratch(const Arguments& arguments) {
  if (!arguments.has("scratch")) return std::filesystem::temp_directory_path();
  std::filesystem::path scratch = arguments.text("scratch");
  std::error_code ignored;
  if (!std::filesystem::is_directory(scratch, ignored)) {
    throw InputError(fmt::format("--scratch = {}: must be a folder", scratch.string()));
  }
  if (::access(scratch.c_str(), W_OK) != 0) {
    throw EnvironmentError(
        fmt::format("--scratch = {}: {}", scratch.string(), std::strerror(errno)));
  }
  return scratch;
}

BenchRequest read_request(const Arguments& arguments) {
  const auto& files = arguments.positional();
  if (!files.empty() && files.size() != 2) {
    throw arguments.usage_error(
        fmt::format("{} files; expected VEHICLE and MANEUVER, or none", files.size()));
  }
  BenchRequest request;
  const bool is_named = !files.empty();
  request.source.vehicle =
      is_named ? std::filesystem::path(files[0]) : find_example("vehicles/paper_sedan.toml");
  request.source.maneuver =
      is_named ? std::filesystem::path(files[1]) : find_example("maneuvers/bump_20mps.toml");
  request.kernel = &find_kernel(arguments);
  request.quick = arguments.is_on("quick");
  request.sweep = find_sweep(!is_named);
  request.scratch = find_scratch(arguments);
  return request;
}

/// The shell command line of the same measurement.
std::string name_again(const Arguments& arguments) {
  std::string line = "strut bench";
  for (const std::string& file : arguments.positional()) line += " " + quote_if_needed(file);
  if (arguments.has("isa")) line += " --isa " + quote_if_needed(arguments.text("isa"));
  if (arguments.is_on("quick")) line += " --quick";
  return line;
}

void suggest_next_step(const Arguments& arguments) {
  const std::string again = name_again(arguments);
  if (arguments.has("baseline")) {
    suggest_next_line(again + " --json > new.json",
                      "a baseline for later measurements; docs/performance.md");
  } else if (arguments.is_on("json")) {
    suggest_next_line(again + " --baseline OLD.json", "with this output saved to OLD.json");
  } else {
    suggest_next_line(again + " --json > old.json", "then the same with --baseline old.json");
  }
}

}  // namespace

Arguments describe_bench() {
  Arguments arguments(
      "strut bench [VEHICLE MANEUVER] [OPTIONS]",
      "Measures how many runs per second this machine simulates, on one core and on all, and the\n"
      "accuracy. Default files: examples/vehicles/paper_sedan.toml and\n"
      "examples/maneuvers/bump_20mps.toml; springs and dampers vary over the ranges of the paper. "
      "Then\n"
      "runs a sweep of examples/sweeps/paper_fast.toml, if found, from plan to shards.",
      "  strut bench --json > old.json\n  strut bench --baseline old.json");
  arguments.add_operand(ArgumentValue::file("VEHICLE", {"toml"}));
  arguments.add_operand(ArgumentValue::file("MANEUVER", {"toml"}));
  arguments.add_switch("json", "print JSON instead of a table");
  arguments.add_option("baseline", ArgumentValue::file("FILE", {"json"}),
                       "print each figure relative to this output of --json");
  arguments.add_option("isa", isa_value(),
                       "instruction set, one that --version lists (default: widest)");
  arguments.add_option("scratch", ArgumentValue::folder("DIR"),
                       "folder for the temporary files of the sweep (default: the system's)");
  arguments.add_option("report", ArgumentValue::folder("DIR"),
                       "also write a page to DIR: speed over error, beside other simulators");
  arguments.add_switch("quick", "a tenth of the time, less precise figures");
  return arguments;
}

int run_bench(const Arguments& arguments) {
  const BenchRequest request = read_request(arguments);
  if (arguments.has("report")) check_bench_page(arguments.text("report"));
  std::optional<Baseline> baseline;
  if (arguments.has("baseline")) baseline = read_baseline(arguments.text("baseline"));

  // Before the threads of OpenMP exist: a signal to one of them would end the program amid a sweep.
  InterruptWatcher watcher;
  const BenchResult result = run_benchmark(request, watcher.halt());
  if (watcher.signal() != 0) {
    print_error("interrupted");
    suggest_again(arguments, "starts over");
    return 128 + watcher.signal();
  }
  const std::vector<FigureRatio> ratios =
      baseline ? compare(result, *baseline) : std::vector<FigureRatio>{};
  arguments.is_on("json") ? print_json(std::cout, result, ratios)
                          : print_table(std::cout, result, ratios);
  if (arguments.has("report")) {
    write_bench_page(arguments.text("report"), result, ratios);
    suggest_page((std::filesystem::path(arguments.text("report")) / "report.html").string());
  } else {
    suggest_next_step(arguments);
  }
  return kExitDone;
}

}  // namespace strut
