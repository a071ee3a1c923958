// The kinds of folders that a report can be made of.
#pragma once

#include <filesystem>

namespace strut {

/// A kind of folder, recognized by a file that only this kind has.
struct FolderContent {
  const char* name;
  const char* file;
};

inline constexpr FolderContent kStudyContent{"study", "study.toml"};
inline constexpr FolderContent kSweepContent{"sweep", "plan.h5"};
inline constexpr FolderContent kDiagnosisContent{"diagnosis", "verdict.json"};
inline constexpr FolderContent kComparisonContent{"comparison", "compare.json"};
inline constexpr FolderContent kBenchContent{"benchmark", "bench.json"};
/// Recognized last: the three above also have a report.json.
inline constexpr FolderContent kRunContent{"simulated run", "report.json"};

inline constexpr const FolderContent* kFolderContents[] = {&kStudyContent,     &kSweepContent,
                                                           &kDiagnosisContent, &kComparisonContent,
                                                           &kBenchContent,     &kRunContent};

/// The kind of a folder; nullptr where `strut report` cannot report on it.
const FolderContent* find_content(const std::filesystem::path& folder);

}  // namespace strut
