#include "tests/faults/replay.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>

#include "tests/support/temporary_folder.h"

namespace strut::test {

namespace {

namespace fs = std::filesystem;

// The states in which one of the first `done` operations, a write that no flush of its file
// followed, never reached the disk.
std::vector<std::size_t> list_unflushed_writes(const std::vector<Operation>& operations,
                                               std::size_t done) {
  std::vector<std::size_t> writes;
  std::set<std::uint64_t> flushed;
  for (std::size_t i = done; i-- > 0;) {
    const Operation& operation = operations[i];
    if (operation.call == FileCall::kSync) flushed.insert(operation.file);
    if (operation.call == FileCall::kWrite && !flushed.contains(operation.file)) {
      writes.push_back(i);
    }
  }
  return writes;
}

}  // namespace

std::vector<Operation> read_recording(const fs::path& log) {
  const std::string text = read_text(log);
  std::vector<Operation> operations;
  for (std::size_t at = 0; at < text.size();) {
    RecordHeader header{};
    if (text.size() - at < sizeof header) throw std::runtime_error("a torn recording");
    std::memcpy(&header, text.data() + at, sizeof header);
    at += sizeof header;
    const auto take = [&](std::size_t size) {
      at += size;
      return text.substr(at - size, size);
    };
    Operation operation{header.call, take(header.path_size), "", "", header.file, header.offset};
    operation.other = take(header.other_size);
    operation.data = take(header.data_size);
    operations.push_back(operation);
  }
  return operations;
}

FolderState::FolderState(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files_[add_file(entry.path().lexically_relative(folder).generic_string())] =
        read_text(entry.path());
  }
}

int FolderState::add_file(const std::string& path) {
  files_[next_];
  names_[path] = next_;
  return next_++;
}

int FolderState::find_file(const Operation& operation) {
  const auto known = by_inode_.find(operation.file);
  if (known != by_inode_.end()) return known->second;
  const auto named = names_.find(operation.path);
  const int file = named != names_.end() ? named->second : add_file(operation.path);
  by_inode_[operation.file] = file;
  return file;
}

void FolderState::apply(const Operation& operation) {
  const std::string& path = operation.path;
  switch (operation.call) {
    case FileCall::kOpen:
      if (!names_.contains(path)) add_file(path);
      by_inode_[operation.file] = names_.at(path);
      if (operation.offset == 1) files_[names_.at(path)].clear();
      break;
    case FileCall::kWrite: {
      std::string& content = files_[find_file(operation)];
      content.resize(
          std::max<std::size_t>(content.size(), operation.offset + operation.data.size()));
      content.replace(operation.offset, operation.data.size(), operation.data);
      break;
    }
    case FileCall::kTruncate:
      files_[find_file(operation)].resize(operation.offset);
      break;
    case FileCall::kRename:
      names_[operation.other] = names_.at(path);
      names_.erase(path);
      break;
    case FileCall::kLink:
      names_[operation.other] = names_.at(path);
      break;
    case FileCall::kUnlink:
      names_.erase(path);
      break;
    case FileCall::kSync:
    case FileCall::kSyncFolder:
    case FileCall::kMakeFolder:
      break;
  }
}

void FolderState::write(const fs::path& folder) const {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_directory()) fs::remove(entry.path());
  }
  for (const auto& [path, file] : names_) {
    fs::create_directories((folder / path).parent_path());
    std::ofstream(folder / path, std::ios::binary) << files_.at(file);
  }
}

std::size_t FolderState::calc_fingerprint() const {
  std::string text;
  for (const auto& [path, file] : names_) {
    const std::string& content = files_.at(file);
    text += path + '\n' + std::to_string(content.size()) + '\n' + content;
  }
  return std::hash<std::string>()(text);
}

int for_each_crash_state(
    const FolderState& before, const std::vector<Operation>& operations, const CrashStates& kinds,
    const std::function<void(const FolderState&, std::size_t, const std::string&)>& check) {
  int states = 0;
  std::set<std::size_t> seen;
  const auto check_one = [&](const FolderState& state, std::size_t done, const std::string& what) {
    if (kinds.distinct && !seen.insert(state.calc_fingerprint()).second) return;
    check(state, done, "after " + std::to_string(done) + " operations" + what);
    ++states;
  };
  const auto check_dropped = [&](std::size_t done) {
    for (const std::size_t dropped : list_unflushed_writes(operations, done)) {
      FolderState state = before;
      for (std::size_t i = 0; i < done; ++i) {
        if (i != dropped) state.apply(operations[i]);
      }
      check_one(state, done, " without " + std::to_string(dropped));
    }
  };
  const auto check_torn = [&](const FolderState& state, std::size_t done) {
    Operation torn = operations[done];
    for (const std::size_t size : {std::size_t{1}, torn.data.size() / 2, torn.data.size() - 1}) {
      FolderState next = state;
      torn.data = operations[done].data.substr(0, size);
      next.apply(torn);
      check_one(next, done, " and " + std::to_string(size) + " bytes");
    }
  };
  FolderState state = before;
  for (std::size_t done = 0; done <= operations.size(); ++done) {
    if (done > 0) state.apply(operations[done - 1]);
    check_one(state, done, "");
    if (kinds.dropped) check_dropped(done);
    const bool writes = done < operations.size() && operations[done].call == FileCall::kWrite;
    if (kinds.torn && writes && !operations[done].data.empty()) check_torn(state, done);
  }
  return states;
}

}  // namespace strut::test
