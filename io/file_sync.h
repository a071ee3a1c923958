// Plain file calls that finish what they start or throw: for files that must survive a crash.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "io/input_error.h"

namespace strut {

/// "PATH: WHAT: " and what the system calls `error_number`.
EnvironmentError file_failure(const std::filesystem::path& path, const std::string& what,
                              int error_number);

/// An open file, closed by the destructor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  ~FileDescriptor();
  FileDescriptor(FileDescriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

/// open(2) with O_CLOEXEC, and again where a signal interrupted it; not open: errno says why.
FileDescriptor open_file(const std::filesystem::path& path, int flags);

/// All that a file holds, in one piece; none: there is no such file. Throws EnvironmentError.
std::optional<std::string> read_if_present(const std::filesystem::path& path);

/// One write(2), and again where a signal interrupted it: bytes written, or -1 with errno. Beyond a
/// limit of file size it is -1 with EFBIG: the signal SIGXFSZ is held back from the calling thread
/// meanwhile and does not end the process, whatever the program does with it elsewhere.
std::ptrdiff_t write_once(int descriptor, std::span<const std::byte> bytes);

/// All of `bytes`. Throws an EnvironmentError that names `target`.
void write_all(int descriptor, std::span<const std::byte> bytes,
               const std::filesystem::path& target);

/// fsync(2). Throws an EnvironmentError that names `target`, except where the file system has no
/// such thing.
void flush_file(int descriptor, const std::filesystem::path& target);

/// Makes the names in the folder of `target` survive a power cut, as flush_file does a content.
void flush_folder_of(const std::filesystem::path& target);

/// A new file PREFIX.NUMBER, with the first number that is free, on the way to its target, the name
/// it is for. All failures are EnvironmentError and name the target.
class TemporaryFile {
 public:
  TemporaryFile(const std::filesystem::path& prefix, const std::filesystem::path& target);
  /// Removes the temporary name.
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(const std::string& text);
  /// Flushes to the disk, and reads from there: throws where that is not `bytes`.
  void flush_and_compare(std::span<const std::byte> bytes);

  /// Gives the file, with all that was written, the target's name unless a file has that name
  /// already; false: one has. By
  /// link(2), which never replaces and which NFS does once; by renameat2(RENAME_NOREPLACE) where
  /// the file system knows no links.
  bool name_new();
  /// Gives the file the target's name, replacing what has it.
  void name_over();

 private:
  void hand_over() const;
  bool has_target_name() const;
  bool move_new();

  std::filesystem::path target_;
  std::filesystem::path path_;
  FileDescriptor file_;
  bool moved_ = false;  // the temporary name is gone already
};

}  // namespace strut
