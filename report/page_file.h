// A page stored as data beside its figures, so that it can be regenerated.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/folder.h"
#include "report/content.h"
#include "report/html.h"

namespace strut {

/// The folder of a report: report.html, the page as report.json, the figures of FigureDrawer,
/// tables as CSV.
struct PageFolder {
  std::filesystem::path root;

  /// Opens the folder, and makes it if it is missing.
  Folder make() const {
    make_folder(root);
    return Folder(root);
  }
  std::filesystem::path report() const { return root / "report.html"; }
  std::filesystem::path page() const { return root / "report.json"; }
  std::filesystem::path figures() const { return root / "figures"; }
  std::filesystem::path table(const std::string& name) const { return root / (name + ".csv"); }
};

/// Throws InputError, which names the option, if a page and `files` beside it would replace
/// anything in the folder but an earlier page of the same content and its files.
void check_page_folder(const std::string& option, const PageFolder& folder,
                       const FolderContent& content,
                       const std::vector<std::filesystem::path>& files);

/// Makes the folder and removes an earlier page: first `marker`, the file by which the folder is
/// recognized, so that an interrupted replacement is not taken for complete; then the page with the
/// tables and figures that its report.json names. All other files stay. Throws EnvironmentError.
void clear_page_folder(const PageFolder& folder, const std::filesystem::path& marker);

/// Writes report.json and report.html.
void write_page(const PageFolder& folder, const ReportPage& page);

/// Writes report.html from report.json and the figures beside it. They are untrusted: nothing in
/// the folder is executed, and no name leads out of it. Throws InputError where a file is missing,
/// too large, nested too deeply, a link, or not as strut writes it.
void write_page_again(const PageFolder& folder);

}  // namespace strut
