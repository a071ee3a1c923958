// A small study that the program itself runs.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <regex>
#include <string>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/study_files.h"

namespace strut::test {

namespace fs = std::filesystem;

/// The files of a study, and the program that runs it.
template <class Files>
class StudyProgram : public Files {
 public:
  Outcome run_file(const std::string& study, const std::string& folder,
                   const std::string& options = "") const {
    return run_program("study " + study + " -o " + (*this / folder).string() + " " + options);
  }
  Outcome run(const std::string& options = "", const std::string& folder = "made") const {
    return run_file((*this / "study.toml").string(), folder, options);
  }

  /// A copy of "made", anew.
  fs::path copy(const std::string& folder) const {
    fs::path root = *this / folder;
    fs::remove_all(root);
    fs::copy(*this / "made", root, fs::copy_options::recursive);
    return root;
  }
};

/// Runs the study into "made"; for a study that is made once, of which tests take copies.
template <class Files>
const StudyProgram<Files>& require_run(const StudyProgram<Files>& files) {
  const Outcome outcome = files.run("--threads 2");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  return files;
}

inline std::map<std::string, std::string> read_folder(const fs::path& root) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(root).string()] = test::read_text(entry.path());
    }
  }
  return files;
}

inline JsonTree read_results(const fs::path& root) {
  return test::parse_json(test::read_text(root / "results.json"));
}

/// results.json without what a clock says.
inline std::string drop_seconds(const fs::path& root) {
  return std::regex_replace(test::read_text(root / "results.json"),
                            std::regex("\"(fit_)?seconds\": [-+.e0-9]+"), "");
}

}  // namespace strut::test
