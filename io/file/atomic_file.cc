#include "io/file/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <optional>

#include "base/text/parse_number.h"
#include "io/file/process_identity.h"
#include "io/file/sha256.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporaryEnd = ".tmp";
constexpr std::size_t kMachineDigits = 8;

// A rename replaces a symbolic link itself; the user means the file behind it.
fs::path resolve_link(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path) : path;
}

Folder open_parent(const fs::path& target) {
  try {
    return Folder(target.parent_path());
  } catch (const InputError& e) {
    throw EnvironmentError(fmt::format("{}: {}: {}", target.string(), kNotWritten, e.what()));
  }
}

/// Returns the folder of `file`, which lies in or below `root`; nullopt if it is missing.
std::optional<Folder> find_folder_inside(const fs::path& root, const fs::path& file) {
  std::optional<Folder> folder(root);
  for (const fs::path& part : file.lexically_relative(root).parent_path()) {
    if (folder) folder = folder->find_folder(part.string());
  }
  return folder;
}

// Identifies this host, its boot and the namespace of process numbers: a process number and a start
// time are unique only within these.
std::string calc_machine(const ProcessIdentity& own) {
  const std::string text = fmt::format("{}\n{}\n{}", own.host, own.boot, own.name_space);
  return to_hex(calc_sha256(text)).substr(0, kMachineDigits);
}

// TARGET.MACHINE-PROCESS-START-NUMBER.tmp
std::string make_temporary_prefix(const std::string& target) {
  const ProcessIdentity own = find_own_identity();
  return fmt::format("{}.{}-{}-{}-", target, calc_machine(own), own.process, own.start);
}

std::optional<std::string> cut_last(std::string& text, char mark) {
  const auto at = text.rfind(mark);
  if (at == std::string::npos) return std::nullopt;
  std::string tail = text.substr(at + 1);
  text.resize(at);
  return tail;
}

bool is_number(const std::optional<std::string>& text) {
  return text && parse_number<std::uint64_t>(*text).has_value();
}

// Returns whether `name` is that of a temporary file whose process has ended.
bool is_abandoned(const std::string& name, const ProcessIdentity& own) {
  if (!name.ends_with(kTemporaryEnd)) return false;
  std::string rest = name.substr(0, name.size() - kTemporaryEnd.size());
  const auto number = cut_last(rest, '-'), start = cut_last(rest, '-'),
             process = cut_last(rest, '-'), machine = cut_last(rest, '.');
  if (!is_number(number) || !is_number(start) || !is_number(process)) return false;
  if (machine != calc_machine(own)) return false;
  ProcessIdentity maker = own;
  maker.process = *process;
  maker.start = *start;
  return check_liveness(maker, own) == Liveness::kDead;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target)
    : target_(resolve_link(target)),
      folder_(open_parent(target_)),
      name_(target_.filename().string()) {
  std::error_code ignored;
  if (fs::exists(target_, ignored) && !fs::is_regular_file(target_, ignored)) {
    throw EnvironmentError(
        fmt::format("{}: {}: not a regular file", target_.string(), kNotWritten));
  }
  remove_abandoned_files(folder_, name_ + ".");
  create();
}

AtomicFile::AtomicFile(const Folder& folder, const std::string& name)
    : target_(folder.path_of(name)), folder_(folder), name_(name) {
  check_regular(folder_.descriptor(), name_, target_);
  create();
}

void AtomicFile::create() {
  const std::string prefix = make_temporary_prefix(name_);
  for (int number = 0; !file_.is_open(); ++number) {
    temporary_name_ = fmt::format("{}{}{}", prefix, number, kTemporaryEnd);
    file_ = folder_.create_file(temporary_name_, O_WRONLY, target_);
  }
}

AtomicFile::~AtomicFile() {
  if (!committed_) folder_.try_remove(temporary_name_);
}

void AtomicFile::write(std::span<const std::byte> bytes) { write_all(file_.get(), bytes, target_); }

void AtomicFile::commit() {
  flush_file(file_.get(), target_);
  if (::renameat(folder_.descriptor(), temporary_name_.c_str(), folder_.descriptor(),
                 name_.c_str()) != 0) {
    throw file_failure(target_, kNotWritten, errno);
  }
  committed_ = true;
  folder_.flush(target_);
}

void remove_abandoned_files(const Folder& folder, const std::string& prefix) {
  const ProcessIdentity own = find_own_identity();
  try {
    for (const std::string& name : folder.list()) {
      if (name.starts_with(prefix) && is_abandoned(name, own)) folder.try_remove(name);
    }
  } catch (const EnvironmentError&) {
    // A folder may be writable but not readable.
  }
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw file_failure(path, kNotMade, error.value());
}

void write_text_file(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

void write_text_file(const Folder& folder, const std::string& name, const std::string& text) {
  AtomicFile file(folder, name);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

void write_text_file_inside(const fs::path& root, const fs::path& file, const std::string& text) {
  const std::optional<Folder> folder = find_folder_inside(root, file);
  if (!folder) throw file_failure(file, kNotWritten, ENOENT);
  write_text_file(*folder, file.filename().string(), text);
}

void remove_file_inside(const fs::path& root, const fs::path& file) {
  if (const auto folder = find_folder_inside(root, file)) folder->remove(file.filename().string());
}

}  // namespace strut
