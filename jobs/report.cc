#include "jobs/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "base/text/nearest_name.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"
#include "jobs/report/sweep.h"
#include "jobs/study/report.h"
#include "report/content.h"
#include "report/page_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Writes the page of a study and returns its path; so do the functions below.
fs::path report_study(const fs::path& root) {
  const StudyFolder folder{root.lexically_normal()};
  write_study_output(folder, open_study_folder(folder));
  return folder.report();
}

fs::path report_sweep(const fs::path& root) {
  const SweepFolder folder{root.lexically_normal()};
  write_sweep_report(folder);
  return folder.root / "report.html";
}

/// For folders that contain their page as data: writes it again.
fs::path report_page(const fs::path& root) {
  const PageFolder folder{root.lexically_normal()};
  write_page_again(folder);
  return folder.report();
}

const FolderContent& require_content(const fs::path& root) {
  if (const FolderContent* found = find_content(root)) return *found;
  std::vector<std::string> names;
  for (const FolderContent* content : kFolderContents) {
    names.push_back(fmt::format("a {} ({})", content->name, content->file));
  }
  throw InputError(fmt::format("{}: nothing to report on; must be the folder of {}", root.string(),
                               join_names(names)));
}

fs::path report(const FolderContent& content, const fs::path& root) {
  if (&content == &kStudyContent) return report_study(root);
  if (&content == &kSweepContent) return report_sweep(root);
  return report_page(root);
}

}  // namespace

Arguments describe_report() {
  Arguments arguments("strut report DIR",
                      "Writes DIR/report.html, a self-contained page about the study, sweep, "
                      "comparison, diagnosis,\n"
                      "simulated run or benchmark in DIR, from existing data: no network is "
                      "trained, and no case\n"
                      "simulated but the few runs for the sensitivities of a sweep. DIR/figures "
                      "contains the numbers of\n"
                      "the charts as CSV.",
                      "  strut report study\n  strut report cars\n  strut report diagnosis");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  return arguments;
}

int run_report(const Arguments& arguments) {
  const fs::path root = arguments.only_operand(", a folder");
  const FolderContent& content = require_content(root);
  const fs::path page = [&] {
    const ProgressLine line(fmt::format("writing the report of a {}", content.name));
    return report(content, root);
  }();
  std::cout << page.string() << "\n";
  suggest_page(page.string());
  return kExitDone;
}

}  // namespace strut
