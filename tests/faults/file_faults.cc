// For LD_PRELOAD: writes down, or makes fail, what a program does to the files of one folder.
//
//   STRUT_FAULT_FOLDER=/absolute/folder    nothing outside it is touched
//   STRUT_RECORD=LOG                       append every changing call to LOG (recording.h)
//   STRUT_FAULT=KIND:N:ERRNO[:MODE]        the N-th call of a kind fails with that errno
//       KIND: open write fsync link rename unlink read
//       MODE: once (default), forever (that call and all later ones), short (a write takes only
//       half of its data, all later writes fail), flip (a read succeeds with its first byte
//       changed)
//   STRUT_FAULT_FIRED=FILE                 made when the fault happened
//   STRUT_NO_WALL_CLOCK=1                  reading the wall clock ends the program by SIGABRT
//   STRUT_CLOCK_SHIFT=SECONDS              the wall clock is off by so much
//   STRUT_DELAY=MILLISECONDS               opening, stat and renaming answer so much later, as on a
//                                          file system on a network; many at once
//
// Not seen: calls that libc makes inside itself for stdio's buffers, mmap, copy_file_range,
// sendfile.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <mutex>
#include <string>

#include "tests/faults/recording.h"

namespace {

using strut::test::FileCall;
using strut::test::RecordHeader;

std::string get_variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

struct Fault {
  std::string kind, mode;
  long at = 0;
  int error_number = 0;
};

Fault read_fault() {
  Fault fault;
  char kind[16] = "", mode[16] = "once";
  const std::string text = get_variable("STRUT_FAULT");
  const int fields =
      std::sscanf(text.c_str(), "%15[^:]:%ld:%d:%15s", kind, &fault.at, &fault.error_number, mode);
  if (!text.empty() && fields < 3) std::abort();
  fault.kind = kind;
  fault.mode = mode;
  return fault;
}

struct Settings {
  std::string folder = get_variable("STRUT_FAULT_FOLDER");
  std::string log = get_variable("STRUT_RECORD");
  std::string fired = get_variable("STRUT_FAULT_FIRED");
  bool no_wall_clock = !get_variable("STRUT_NO_WALL_CLOCK").empty();
  long clock_shift = std::atol(get_variable("STRUT_CLOCK_SHIFT").c_str());
  double delay = std::atof(get_variable("STRUT_DELAY").c_str());
  Fault fault = read_fault();
};

const Settings& get_settings() {
  static const Settings settings;
  return settings;
}

// Held across a call and its record, so that the order of records is that of the effects.
std::recursive_mutex& get_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

template <typename Function>
Function* find_next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// "" outside the folder; "." for the folder itself.
std::string get_relative(const std::string& path) {
  const std::string& folder = get_settings().folder;
  if (folder.empty() || path.compare(0, folder.size(), folder) != 0) return "";
  if (path.size() == folder.size()) return ".";
  return path[folder.size()] == '/' ? path.substr(folder.size() + 1) : "";
}

std::string read_descriptor_path(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path);
  return size > 0 ? std::string(path, static_cast<std::size_t>(size)) : "";
}

std::string find_path(int folder, const char* path) {
  if (path == nullptr) return "";
  if (path[0] == '/') return get_relative(path);
  char here[4096] = "";
  if (folder == AT_FDCWD && ::getcwd(here, sizeof here) == nullptr) return "";
  return get_relative((folder == AT_FDCWD ? here : read_descriptor_path(folder)) + "/" + path);
}

std::string find_path(int descriptor) {
  if (get_settings().folder.empty()) return "";
  return get_relative(read_descriptor_path(descriptor));
}

// Not while a mutex is held.
void wait_for(const std::string& path) {
  const double delay = get_settings().delay;
  if (!(delay > 0.0) || path.empty()) return;
  const int error_number = errno;
  const auto nanoseconds = static_cast<long>(1e6 * delay);
  const timespec time{nanoseconds / 1000000000, nanoseconds % 1000000000};
  ::nanosleep(&time, nullptr);
  errno = error_number;
}

void write_whole(const std::string& path, const std::string& text) {
  const long file = ::syscall(SYS_openat, AT_FDCWD, path.c_str(),
                              O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const long written = ::syscall(SYS_write, file, text.data(), text.size());
  ::syscall(SYS_close, file);
  if (written != static_cast<long>(text.size())) std::abort();
}

void record(FileCall call, const std::string& path, const std::string& other, std::uint64_t file,
            std::uint64_t offset, const std::string& data) {
  if (get_settings().log.empty()) return;
  const int error_number = errno;
  const RecordHeader header{call,
                            static_cast<std::uint32_t>(path.size()),
                            static_cast<std::uint32_t>(other.size()),
                            static_cast<std::uint32_t>(data.size()),
                            file,
                            offset};
  std::string text(reinterpret_cast<const char*>(&header), sizeof header);
  write_whole(get_settings().log, text + path + other + data);
  errno = error_number;
}

// True once the fault is due; errno is set then.
bool fails(const char* kind) {
  const Fault& fault = get_settings().fault;
  if (fault.kind != kind) return false;
  static long count = 0;
  ++count;
  const bool later = count > fault.at && (fault.mode == "forever" || fault.mode == "short");
  if (count != fault.at && !later) return false;
  if (count == fault.at) write_whole(get_settings().fired, kind);
  errno = fault.error_number;
  return true;
}

// Number of the `size` bytes that the fault lets through; -1: the call fails.
ssize_t limit_write(std::size_t size) {
  static bool is_first = true;
  if (!fails("write")) return static_cast<ssize_t>(size);
  const bool is_short = get_settings().fault.mode == "short" && is_first;
  is_first = false;
  return is_short ? static_cast<ssize_t>(size / 2) : -1;
}

std::uint64_t get_inode(int descriptor) {
  struct stat status {};
  ::fstat(descriptor, &status);
  return status.st_ino;
}

void record_open(int descriptor, const std::string& path, int flags) {
  const bool changes = (flags & (O_CREAT | O_TRUNC)) != 0;
  if (descriptor < 0 || path.empty() || !changes) return;
  record(FileCall::kOpen, path, "", get_inode(descriptor), (flags & O_TRUNC) != 0 ? 1 : 0, "");
}

int open_at(int folder, const char* name, int flags, mode_t mode) {
  const std::string path = find_path(folder, name);
  wait_for(path);
  const std::lock_guard lock(get_mutex());
  if (!path.empty() && fails("open")) return -1;
  static const auto next = find_next<int(int, const char*, int, ...)>("openat");
  const int descriptor = next(folder, name, flags, mode);
  record_open(descriptor, path, flags);
  return descriptor;
}

// `text`: the data; `at` -1: at the descriptor's own place.
template <typename Write>
ssize_t write_at(int descriptor, const std::string& text, off_t at, const Write& write) {
  const std::lock_guard lock(get_mutex());
  const std::string path = find_path(descriptor);
  if (path.empty()) return write(text.size());
  const ssize_t limit = limit_write(text.size());
  if (limit < 0) return -1;
  const ssize_t written = write(static_cast<std::size_t>(limit));
  if (written > 0) {
    const off_t offset = at >= 0 ? at : ::lseek(descriptor, 0, SEEK_CUR) - written;
    record(FileCall::kWrite, path, "", get_inode(descriptor), static_cast<std::uint64_t>(offset),
           text.substr(0, static_cast<std::size_t>(written)));
  }
  return written;
}

template <typename Read>
ssize_t read_at(int descriptor, void* buffer, const Read& read) {
  const std::lock_guard lock(get_mutex());
  const bool is_due = !find_path(descriptor).empty() && fails("read");
  const bool is_flip = get_settings().fault.mode == "flip";
  if (is_due && !is_flip) return -1;
  const ssize_t count = read();
  if (is_due && count > 0) static_cast<unsigned char*>(buffer)[0] ^= 1;
  return count;
}

template <typename Truncate>
int truncate_to(int descriptor, off_t size, const Truncate& truncate) {
  const std::lock_guard lock(get_mutex());
  const std::string path = find_path(descriptor);
  const int result = truncate();
  if (result == 0 && !path.empty()) {
    record(FileCall::kTruncate, path, "", get_inode(descriptor), static_cast<std::uint64_t>(size),
           "");
  }
  return result;
}

template <typename Sync>
int sync_file(int descriptor, const Sync& sync) {
  const std::lock_guard lock(get_mutex());
  const std::string path = find_path(descriptor);
  if (path.empty()) return sync();
  if (fails("fsync")) return -1;
  const int result = sync();
  struct stat status {};
  ::fstat(descriptor, &status);
  const FileCall call = S_ISDIR(status.st_mode) ? FileCall::kSyncFolder : FileCall::kSync;
  if (result == 0) record(call, path, "", status.st_ino, 0, "");
  return result;
}

// A call on one or two names that is recorded where it succeeds.
template <typename Change>
int change_name(const char* kind, FileCall call, const std::string& path, const std::string& other,
                const Change& change) {
  if (std::string(kind) == "rename") wait_for(path);
  const std::lock_guard lock(get_mutex());
  const bool is_ours = !path.empty() || !other.empty();
  if (is_ours && fails(kind)) return -1;
  const int result = change();
  if (is_ours && result == 0) record(call, path, other, 0, 0, "");
  return result;
}

std::string join(const iovec* parts, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text.append(static_cast<const char*>(parts[i].iov_base), parts[i].iov_len);
  }
  return text;
}

template <typename Open>
FILE* open_stream(const char* name, const char* mode, const Open& open) {
  const std::string path = find_path(AT_FDCWD, name);
  wait_for(path);
  const std::lock_guard lock(get_mutex());
  if (!path.empty() && fails("open")) return nullptr;
  FILE* stream = open();
  const int flags = mode[0] == 'w' ? O_CREAT | O_TRUNC : mode[0] == 'a' ? O_CREAT : 0;
  if (stream != nullptr) record_open(::fileno(stream), path, flags);
  return stream;
}

int make_unique(char* name, int descriptor) {
  const std::lock_guard lock(get_mutex());
  record_open(descriptor, find_path(AT_FDCWD, name), O_CREAT);
  return descriptor;
}

mode_t get_mode(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(arguments, int)) : 0;
}

// As the settings have it.
timespec read_wall_clock(clockid_t clock) {
  if (get_settings().no_wall_clock) std::abort();
  timespec now{};
  ::syscall(SYS_clock_gettime, clock, &now);
  now.tv_sec += get_settings().clock_shift;
  return now;
}

}  // namespace

extern "C" {

#define STRUT_OPEN(NAME)                            \
  int NAME(const char* path, int flags, ...) {      \
    va_list arguments;                              \
    va_start(arguments, flags);                     \
    const mode_t mode = get_mode(flags, arguments); \
    va_end(arguments);                              \
    return open_at(AT_FDCWD, path, flags, mode);    \
  }
STRUT_OPEN(open)
STRUT_OPEN(open64)

#define STRUT_OPENAT(NAME)                                 \
  int NAME(int folder, const char* path, int flags, ...) { \
    va_list arguments;                                     \
    va_start(arguments, flags);                            \
    const mode_t mode = get_mode(flags, arguments);        \
    va_end(arguments);                                     \
    return open_at(folder, path, flags, mode);             \
  }
STRUT_OPENAT(openat)
STRUT_OPENAT(openat64)

int creat(const char* path, mode_t mode) {
  return open_at(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}

#define STRUT_FOPEN(NAME)                                                       \
  FILE* NAME(const char* path, const char* mode) {                              \
    static const auto next = find_next<FILE*(const char*, const char*)>(#NAME); \
    return open_stream(path, mode, [&] { return next(path, mode); });           \
  }
STRUT_FOPEN(fopen)
STRUT_FOPEN(fopen64)

int mkstemp(char* name) {
  static const auto next = find_next<int(char*)>("mkstemp");
  return make_unique(name, next(name));
}

int mkstemp64(char* name) { return mkstemp(name); }

ssize_t write(int descriptor, const void* data, size_t size) {
  const std::string text(static_cast<const char*>(data), size);
  return write_at(descriptor, text, -1,
                  [&](size_t limit) { return ::syscall(SYS_write, descriptor, data, limit); });
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  const std::string text = join(parts, count);
  return write_at(descriptor, text, -1, [&](size_t limit) {
    return ::syscall(SYS_write, descriptor, text.data(), limit);
  });
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  const std::string text(static_cast<const char*>(data), size);
  return write_at(descriptor, text, offset, [&](size_t limit) {
    return ::syscall(SYS_pwrite64, descriptor, data, limit, offset);
  });
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
  return pwrite(descriptor, data, size, offset);
}

ssize_t read(int descriptor, void* buffer, size_t size) {
  return read_at(descriptor, buffer, [&] { return ::syscall(SYS_read, descriptor, buffer, size); });
}

ssize_t pread(int descriptor, void* buffer, size_t size, off_t offset) {
  return read_at(descriptor, buffer,
                 [&] { return ::syscall(SYS_pread64, descriptor, buffer, size, offset); });
}

ssize_t pread64(int descriptor, void* buffer, size_t size, off64_t offset) {
  return pread(descriptor, buffer, size, offset);
}

int ftruncate(int descriptor, off_t size) noexcept {
  return truncate_to(descriptor, size,
                     [&] { return static_cast<int>(::syscall(SYS_ftruncate, descriptor, size)); });
}

int ftruncate64(int descriptor, off64_t size) noexcept { return ftruncate(descriptor, size); }

int fsync(int descriptor) {
  return sync_file(descriptor, [&] { return static_cast<int>(::syscall(SYS_fsync, descriptor)); });
}

int fdatasync(int descriptor) {
  return sync_file(descriptor,
                   [&] { return static_cast<int>(::syscall(SYS_fdatasync, descriptor)); });
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
  return change_name(
      "rename", FileCall::kRename, find_path(from_folder, from), find_path(to_folder, to), [&] {
        return static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
      });
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  return renameat2(from_folder, from, to_folder, to, 0);
}

int rename(const char* from, const char* to) noexcept {
  return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  return change_name(
      "link", FileCall::kLink, find_path(from_folder, from), find_path(to_folder, to), [&] {
        return static_cast<int>(::syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
      });
}

int link(const char* from, const char* to) noexcept {
  return linkat(AT_FDCWD, from, AT_FDCWD, to, 0);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  return change_name("unlink", FileCall::kUnlink, find_path(folder, path), "", [&] {
    return static_cast<int>(::syscall(SYS_unlinkat, folder, path, flags));
  });
}

int unlink(const char* path) noexcept { return unlinkat(AT_FDCWD, path, 0); }

int remove(const char* path) noexcept {
  const int result = unlinkat(AT_FDCWD, path, 0);
  return result != 0 && errno == EISDIR ? ::rmdir(path) : result;
}

int mkdirat(int folder, const char* path, mode_t mode) noexcept {
  return change_name("mkdir", FileCall::kMakeFolder, find_path(folder, path), "",
                     [&] { return static_cast<int>(::syscall(SYS_mkdirat, folder, path, mode)); });
}

int mkdir(const char* path, mode_t mode) noexcept { return mkdirat(AT_FDCWD, path, mode); }

#define STRUT_STAT(NAME, STRUCT)                                                 \
  int NAME(const char* path, struct STRUCT* status) noexcept {                   \
    wait_for(find_path(AT_FDCWD, path));                                         \
    static const auto next = find_next<int(const char*, struct STRUCT*)>(#NAME); \
    return next(path, status);                                                   \
  }
STRUT_STAT(stat, stat)
STRUT_STAT(stat64, stat64)
STRUT_STAT(lstat, stat)
STRUT_STAT(lstat64, stat64)

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE) {
    return static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  }
  *time = read_wall_clock(clock);
  return 0;
}

time_t time(time_t* result) noexcept {
  const time_t now = read_wall_clock(CLOCK_REALTIME).tv_sec;
  if (result != nullptr) *result = now;
  return now;
}

int gettimeofday(timeval* result, void*) noexcept {
  const timespec now = read_wall_clock(CLOCK_REALTIME);
  result->tv_sec = now.tv_sec;
  result->tv_usec = now.tv_nsec / 1000;
  return 0;
}

}  // extern "C"
