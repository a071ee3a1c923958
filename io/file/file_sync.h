// Plain file calls that finish what they start or throw: for files that must survive a crash.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/error/input_error.h"

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

/// Throws InputError where `descriptor` is not of a regular file: a pipe or device in its place
/// could block for ever or never end. `path` stands in the message.
void check_regular(int descriptor, const std::filesystem::path& path);
/// The same of the file `name` in an open directory; a missing one passes.
void check_regular(int directory, const std::string& name, const std::filesystem::path& path);

/// open_file that never waits for another process and takes regular files alone; links are
/// followed. Throws InputError where the file is missing or not regular, EnvironmentError where it
/// cannot be read.
FileDescriptor open_regular_file(const std::filesystem::path& path);

/// All that a regular file holds, in one piece; nullopt where there is no such file. Throws
/// InputError where it is not a regular file, EnvironmentError where it cannot be read.
std::optional<std::string> read_if_present(const std::filesystem::path& path);

/// What an open file holds from its position on; nullopt where another host removed or replaced
/// the file meanwhile. Throws an EnvironmentError that names `path`.
std::optional<std::string> read_rest(int descriptor, const std::filesystem::path& path);

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

}  // namespace strut
