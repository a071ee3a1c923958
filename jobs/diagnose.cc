#include "jobs/diagnose.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <mutex>
#include <system_error>

#include "base/error/input_error.h"
#include "io/file/atomic_file.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "jobs/compare/check.h"
#include "jobs/diagnose/folder.h"
#include "jobs/diagnose/json.h"
#include "jobs/diagnose/report.h"
#include "jobs/diagnose/tables.h"

namespace strut {
namespace {

Diagnosis diagnose(const CampaignData& data, int threads) {
  std::mutex mutex;
  std::string doing = "starting";
  const Stage stage("diagnosis");
  const ProgressLine line([&, start = now()] {
    const std::lock_guard lock(mutex);
    return fmt::format("diagnose: {}, {}", doing, format_duration(now() - start));
  });
  DiagnoseOptions options;
  options.threads = threads;
  options.progress = [&](const std::string& what) {
    print_detail(what);
    const std::lock_guard lock(mutex);
    doing = what;
  };
  return diagnose_campaign(data, options);
}

/// Writes the extended model, or removes that of an earlier diagnosis where there is none.
void write_extended_model(const DiagnoseFolder& folder, const CampaignData& data,
                          const Diagnosis& diagnosis) {
  if (diagnosis.is_extended()) {
    write_text_file_inside(folder.root, folder.extended_model(),
                           make_extended_model(data, diagnosis, folder.root));
  } else {
    remove_file_inside(folder.root, folder.extended_model());
  }
}

/// Suggests a sweep of the extended car, the page, or more measurements.
void suggest_next_step(const Arguments& arguments, const DiagnoseFolder& folder,
                       const CampaignData& data, const Diagnosis& diagnosis) {
  if (diagnosis.is_extended() && !data.has_inputs()) {
    suggest_next({"strut", "plan", "SWEEP.toml", "-o", "cars"},
                 fmt::format("with vehicle = \"{}\"", folder.extended_model().string()));
  } else if (diagnosis.is_extended() || diagnosis.verdict.kind == VerdictKind::kAdequate ||
             diagnosis.next_measurement.empty()) {
    suggest_page(folder.report().string());
  } else {
    suggest_again(arguments, "with one more run: " + diagnosis.next_measurement);
  }
}

}  // namespace

Arguments describe_diagnose() {
  Arguments arguments(
      "strut diagnose CAMPAIGN.toml -o DIR [OPTIONS]",
      "Finds the causes of a model's errors: calibrates the model to the runs for fitting, tries\n"
      "every effect of the catalogue at every place, and validates on the held-out runs. Reports\n"
      "probabilities, causes that the runs cannot distinguish, the improvement by the extended\n"
      "model, and the next measurement. Writes DIR/verdict.json, extended.toml (the model with\n"
      "its causes), CSV curves, figures and report.html (docs/diagnosis.md). Ends with code 1 if\n"
      "a held-out run cannot be simulated, or the calibration has not converged and no cause is\n"
      "confirmed.",
      "  strut diagnose examples/campaigns/worn_damper.toml -o diagnosis");
  arguments.add_operand(ArgumentValue::file("CAMPAIGN.toml", {"toml"}));
  arguments.add_option("output,o", ArgumentValue::folder("DIR"), "output folder of the diagnosis");
  arguments.add_option("threads", "N", "threads (default: all processors)");
  arguments.add_switch("force", "replace an existing diagnosis in DIR");
  arguments.add_switch("json", "print verdict.json instead of text");
  return arguments;
}

int run_diagnose(const Arguments& arguments) {
  CampaignData data = read_campaign_data(arguments.only_operand());
  const DiagnoseFolder folder = find_diagnose_folder(arguments, data);
  print_notes(data.notes);
  const std::size_t mistakes = check_before_fit(data, find_threads(arguments));
  const Diagnosis diagnosis = [&] {
    try {
      return diagnose(data, find_threads(arguments));
    } catch (const InputError&) {
      if (mistakes > 0) suggest_correction(mistakes, arguments.only_operand());
      throw;
    }
  }();
  print_notes(diagnosis.notes);
  const std::string json = format_json(make_verdict_json(data, diagnosis)) + "\n";
  {
    const InterruptGuard guard;
    clear_page_folder(folder, folder.verdict());
    write_extended_model(folder, data, diagnosis);
    const std::vector<std::string> tables = write_diagnose_tables(folder, data, diagnosis);
    write_diagnose_report(folder, data, diagnosis, tables);
    write_text_file_inside(folder.root, folder.verdict(), json);
    print_detail(
        fmt::format("written: {}, {}", folder.verdict().string(), folder.report().string()));
  }
  if (arguments.is_on("json")) {
    std::cout << json;
  } else {
    std::cout << make_diagnose_text(data, diagnosis) << "\n" << folder.report().string() << "\n";
  }
  if (mistakes > 0) {
    suggest_correction(mistakes, arguments.only_operand());
  } else {
    suggest_next_step(arguments, folder, data, diagnosis);
  }
  return diagnosis.is_whole ? kExitDone : kExitNegative;
}

}  // namespace strut
