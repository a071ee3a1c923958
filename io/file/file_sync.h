// File calls that complete or throw, for files that must survive a crash.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/error/input_error.h"

namespace strut {

/// Failures as messages name them.
inline constexpr char kNotRead[] = "cannot be read";
inline constexpr char kNotWritten[] = "cannot be written";
inline constexpr char kNotMade[] = "cannot be made";
inline constexpr char kNotFlushed[] = "cannot be flushed to the disk";

/// Makes the error "PATH: WHAT: the system's text for `error_number`".
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

/// open(2) with O_CLOEXEC, repeated if a signal interrupts it. If the result is not open, errno
/// holds the reason.
FileDescriptor open_file(const std::filesystem::path& path, int flags);

/// Throws InputError if `descriptor` does not belong to a regular file: a pipe or device in its
/// place could block forever or never end. The message names `path`.
void check_regular(int descriptor, const std::filesystem::path& path);
/// Checks the file `name` in an open directory likewise; a missing file passes.
void check_regular(int directory, const std::string& name, const std::filesystem::path& path);

/// Opens a regular file for reading without ever waiting for another process; follows links. Throws
/// InputError if the file is missing or not regular, EnvironmentError if it cannot be read.
FileDescriptor open_regular_file(const std::filesystem::path& path);

/// Reads a whole regular file; nullopt if there is no such file. Throws InputError if it is not a
/// regular file, EnvironmentError if it cannot be read.
std::optional<std::string> read_if_present(const std::filesystem::path& path);

/// Reads an open file from its position to its end; nullopt if another host removed or replaced the
/// file meanwhile. Throws an EnvironmentError that names `path`.
std::optional<std::string> read_rest(int descriptor, const std::filesystem::path& path);

/// write(2), repeated if a signal interrupts it. Returns the bytes written, or -1 with errno.
/// Beyond a limit on file size it returns -1 with EFBIG: SIGXFSZ is blocked in the calling thread
/// meanwhile and does not end the process, whatever its disposition.
std::ptrdiff_t write_once(int descriptor, std::span<const std::byte> bytes);

/// Writes all of `bytes`. Throws an EnvironmentError that names `target`.
void write_all(int descriptor, std::span<const std::byte> bytes,
               const std::filesystem::path& target);

/// fsync(2), without effect on file systems that do not support it. Throws an EnvironmentError that
/// names `target`.
void flush_file(int descriptor, const std::filesystem::path& target);

}  // namespace strut
