// Every state in which a crash can leave a folder, rebuilt from a recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/faults/recording.h"

namespace strut::test {

struct Operation {
  FileCall call{};
  std::string path, other, data;
  std::uint64_t file = 0, offset = 0;
};

std::vector<Operation> read_recording(const std::filesystem::path& log);

/// The files of a folder, by their paths relative to it; folders are made as needed.
class FolderState {
 public:
  FolderState() = default;
  /// Copies what is there.
  explicit FolderState(const std::filesystem::path& folder);

  void apply(const Operation& operation);
  /// Makes `folder` hold this, and nothing else.
  void write(const std::filesystem::path& folder) const;

  /// The same for the same files.
  std::size_t calc_fingerprint() const;

  bool has(const std::string& path) const { return names_.contains(path); }
  const std::string& content(const std::string& path) const { return files_.at(names_.at(path)); }
  const std::map<std::string, int>& names() const { return names_; }

 private:
  int add_file(const std::string& path);
  int find_file(const Operation& operation);

  std::map<int, std::string> files_;
  std::map<std::string, int> names_;
  std::map<std::uint64_t, int> by_inode_;
  int next_ = 0;
};

struct CrashStates {
  bool torn = true;       // the last write also done in part
  bool dropped = true;    // also without any one write that was not yet flushed
  bool distinct = false;  // each state of the files once, however many ways lead to it
};

/// Calls `check(state, done, what)` for the state after each number `done` of operations, and for
/// what else `kinds` asks for. Returns the number of states.
int for_each_crash_state(
    const FolderState& before, const std::vector<Operation>& operations, const CrashStates& kinds,
    const std::function<void(const FolderState&, std::size_t, const std::string&)>& check);

}  // namespace strut::test
