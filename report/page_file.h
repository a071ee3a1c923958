// A page kept beside its figures, so that it can be made again from data alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/folder.h"
#include "report/content.h"
#include "report/html.h"

namespace strut {

/// A folder of one report: report.html, the page as report.json, figures as FigureDrawer
/// writes them, tables as CSV.
struct PageFolder {
  std::filesystem::path root;

  /// The folder, made where it is missing.
  Folder make() const {
    make_folder(root);
    return Folder(root);
  }
  std::filesystem::path report() const { return root / "report.html"; }
  std::filesystem::path page() const { return root / "report.json"; }
  std::filesystem::path figures() const { return root / "figures"; }
  std::filesystem::path table(const std::string& name) const { return root / (name + ".csv"); }
};

/// Refuses a folder in which a page, and `files` beside it, would replace anything but an earlier
/// page of that content and its files: throws InputError, which names the option.
void check_page_folder(const std::string& option, const PageFolder& folder,
                       const FolderContent& content,
                       const std::vector<std::filesystem::path>& files);

/// Makes the folder, and removes what an earlier command left in it: `marker` first, by which the
/// folder is told to hold it, so that what is half replaced is not taken for whole; then the page
/// with the tables and figures that its report.json names. Whatever else is in the folder stays.
/// Throws EnvironmentError.
void clear_page_folder(const PageFolder& folder, const std::filesystem::path& marker);

/// Writes report.json and report.html.
void write_page(const PageFolder& folder, const ReportPage& page);

/// Writes report.html from report.json and the figures beside it, which are data from anywhere:
/// nothing in the folder is executed, and no name leads out of it. Throws InputError where a file
/// is missing, too large, nested too deeply, a link, or not as strut writes it.
void write_page_again(const PageFolder& folder);

}  // namespace strut
