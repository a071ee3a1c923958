#include "jobs/compare.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "base/text/format_number.h"
#include "io/file/atomic_file.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "jobs/compare/check.h"
#include "jobs/compare/folder.h"
#include "jobs/compare/json.h"
#include "jobs/compare/report.h"
#include "jobs/compare/tables.h"

namespace strut {
namespace {

/// Whether the calibration converged and every run could be simulated with the calibrated model.
bool is_whole(const Comparison& comparison) {
  if (comparison.baseline.is_fitted && !comparison.baseline.fit.converged) return false;
  for (const RunComparison& run : comparison.runs) {
    if (!run.calibrated.evaluation.failure.empty()) return false;
  }
  return true;
}

void print_failures(const Comparison& comparison) {
  if (comparison.baseline.is_fitted && !comparison.baseline.fit.converged) {
    print_error(
        fmt::format("the calibration has not converged: its minimum is {} standard deviations away",
                    format_significant(comparison.baseline.fit.distance, 2)));
  }
  for (const RunComparison& run : comparison.runs) {
    for (const ModelComparison* model : {&run.nominal, &run.calibrated}) {
      const std::string& failure = model->evaluation.failure;
      if (!failure.empty()) print_error(failure);
    }
  }
}

int run_check(const Arguments& arguments, const CampaignData& data) {
  const std::vector<RecordingFinding> findings = check_campaign(data, find_threads(arguments));
  print_notes(data.notes);
  if (arguments.is_on("json")) {
    std::cout << format_json(make_check_json(data, findings)) << "\n";
  } else {
    for (const RecordingFinding& finding : findings) std::cout << finding.describe() << "\n";
    if (findings.empty()) {
      std::cout << fmt::format("{} runs: nothing looks wrong\n", data.run_count());
    }
  }
  if (findings.empty()) {
    suggest_next({"strut", "compare", arguments.only_operand(), "-o", "comparison"});
  }
  return findings.empty() ? kExitDone : kExitNegative;
}

}  // namespace

Arguments describe_compare() {
  Arguments arguments(
      "strut compare CAMPAIGN.toml -o DIR [OPTIONS]\n"
      "       strut compare CAMPAIGN.toml --check [OPTIONS]",
      "Compares measured with simulated runs of a campaign: with the nominal model, and with the\n"
      "model calibrated to the runs for fitting. Reports the residuals of every channel by time,\n"
      "frequency band and state, and whether the model is adequate. Writes DIR/compare.json, CSV\n"
      "tables, figures and report.html (docs/diagnosis.md).\n"
      "Before any fit, the recordings are checked: signs, factors, lags, swapped channels, "
      "clocks,\n"
      "sensors at their limits, copies. --check does only that; the exit code is then 1 if "
      "anything\n"
      "is found.",
      "  strut compare examples/campaigns/worn_damper.toml --check\n"
      "  strut compare examples/campaigns/worn_damper.toml -o comparison");
  arguments.add_operand(ArgumentValue::file("CAMPAIGN.toml", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::folder("DIR"), "output folder of the comparison");
  arguments.add_switch("check", "check the recordings, without a fit");
  arguments.add_option("threads", "N", "threads (default: all processors)");
  arguments.add_switch("force", "replace an existing comparison in DIR");
  arguments.add_switch("json", "print compare.json, or the findings of --check, instead of text");
  return arguments;
}

int run_compare(const Arguments& arguments) {
  if (arguments.is_on("check") && arguments.has("output")) {
    throw arguments.usage_error("--check writes no folder: give it or --output, not both");
  }
  CampaignData data = read_campaign_data(arguments.only_operand());
  if (arguments.is_on("check")) return run_check(arguments, data);
  const CompareFolder folder = find_compare_folder(arguments, data);
  print_notes(data.notes);
  const int threads = find_threads(arguments);
  print_detail(fmt::format("{} runs, {} threads", data.run_count(), threads));
  const std::size_t mistakes = check_before_fit(data, threads);
  const Comparison comparison = [&] {
    const Stage stage("calibration and comparison");
    const ProgressLine line(fmt::format("calibrating, then comparing {} runs", data.run_count()));
    return compare_campaign(data, threads);
  }();
  print_failures(comparison);
  print_notes(comparison.notes);
  const std::string json = format_json(make_compare_json(data, comparison)) + "\n";
  {
    const InterruptGuard guard;
    clear_page_folder(folder, folder.json());
    const std::vector<std::string> tables = write_compare_tables(folder, data, comparison);
    write_compare_report(folder, data, comparison, tables);
    write_text_file_inside(folder.root, folder.json(), json);
    print_detail(fmt::format("written: {}, {}", folder.json().string(), folder.report().string()));
  }
  if (arguments.is_on("json")) {
    std::cout << json;
  } else {
    for (const ReportTable& table : make_compare_tables(data, comparison)) {
      std::cout << make_text(table) << "\n";
    }
    std::cout << make_verdict_text(data, comparison) << "\n" << folder.report().string() << "\n";
  }
  if (mistakes > 0) {
    suggest_correction(mistakes, arguments.only_operand());
  } else {
    suggest_next({"strut", "diagnose", arguments.only_operand(), "-o", "diagnosis"},
                 comparison.is_adequate()
                     ? "it also finds errors smaller than the noise of one channel"
                     : "");
  }
  return is_whole(comparison) ? kExitDone : kExitNegative;
}

}  // namespace strut
