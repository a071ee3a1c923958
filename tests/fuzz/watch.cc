#include "tests/fuzz/watch.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "base/error/input_error.h"
#include "tests/fuzz/hdf5_tree.h"

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Shared memory of a worker and the process that watches it.
struct Shared {
  std::atomic<std::uint64_t> number{0};  // number of the current input
  std::atomic<std::uint64_t> executions{0}, accepted{0}, refused{0};
  char finding[1024] = {};
};

constexpr int kFindingCode = 77;

Shared* share() {
  void* const memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  return new (memory) Shared();
}

std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::uint64_t calc_name_key(const std::string& name) {
  std::uint64_t key = 0;
  for (const char c : name) key = key * 257 + static_cast<unsigned char>(c);
  return key;
}

/// Processor time [s], resident bytes and state of a process.
struct Usage {
  double seconds = 0.0;
  std::uint64_t bytes = 0;
  char state = '?';
};

Usage read_usage(pid_t process) {
  const std::string stat = read_file("/proc/" + std::to_string(process) + "/stat");
  Usage usage;
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return usage;
  std::istringstream words(stat.substr(name_end + 1));
  std::vector<std::string> fields;
  for (std::string word; words >> word;) fields.push_back(word);
  constexpr std::size_t kState = 0, kUser = 11, kSystem = 12, kResident = 21;  // proc(5), from 3
  if (fields.size() <= kResident) return usage;
  const auto ticks = static_cast<double>(std::stoull(fields[kUser]) + std::stoull(fields[kSystem]));
  usage.seconds = ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
  usage.bytes =
      std::stoull(fields[kResident]) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  usage.state = fields[kState].front();
  return usage;
}

/// Runs the inputs from `first` on in a process of its own.
[[noreturn]] void work_through(const Format& format, const fs::path& work, const Campaign& campaign,
                               const std::vector<std::string>& seeds, std::uint64_t first,
                               std::uint64_t end, Clock::time_point deadline, Shared& shared) {
  const int messages =
      ::open((work / "messages").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  ::dup2(messages, STDOUT_FILENO);
  ::dup2(messages, STDERR_FILENO);
  const rlimit none = {0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ::setenv("PATH", "/nonexistent", 1);  // no file may make a reader run a program
  for (std::uint64_t number = first; number != end && Clock::now() < deadline; ++number) {
    const Input input = make_input(format, seeds, campaign.seed, number);
    write_input(work / format.file, input);
    shared.number = number;
    std::optional<std::string> refused;
    const std::string finding = judge(format, work, &refused);
    if (!finding.empty()) {
      std::snprintf(shared.finding, sizeof shared.finding, "%s", finding.c_str());
      ::_exit(kFindingCode);
    }
    ++(refused ? shared.refused : shared.accepted);
    ++shared.executions;
  }
  ::_exit(0);
}

/// Returns the part of a sanitizer's report that two runs with the same fault share.
std::string summarize_messages(const fs::path& messages) {
  std::istringstream text(read_file(messages));
  std::string error, frame;
  for (std::string line; std::getline(text, line);) {
    const std::size_t runtime = line.find("runtime error: ");
    if (runtime != std::string::npos && error.empty()) error = line;
    if (line.rfind("SUMMARY: ", 0) == 0 && error.empty()) error = line;
    // The first frame of strut below those of the sanitizer and the libraries.
    const std::size_t in = line.find(" in strut::");
    if (in != std::string::npos && frame.empty()) frame = line.substr(in);
  }
  return (error + frame).substr(0, 600);
}

std::string describe_end(int status, const fs::path& work, const Shared& shared) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kFindingCode) return shared.finding;
  std::string summary = summarize_messages(work / "messages");
  if (!summary.empty()) return summary;
  if (WIFSIGNALED(status)) return std::string("ended by signal ") + ::strsignal(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

/// Waits for a worker. Returns how it failed at input `shared.number`; nullopt if it completed.
std::optional<std::string> watch(pid_t worker, const fs::path& work, const Campaign& campaign,
                                 const Shared& shared) {
  using Seconds = std::chrono::duration<double>;
  constexpr Seconds kBlocked{5.0};
  std::uint64_t number = ~std::uint64_t{0};
  Usage before;
  Clock::time_point moved = Clock::now();
  for (;;) {
    int status = 0;
    if (::waitpid(worker, &status, WNOHANG) == worker) {
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return std::nullopt;
      return describe_end(status, work, shared);
    }
    const Usage now = read_usage(worker);
    std::string what;
    if (shared.number != number) {
      number = shared.number;
      before = now;
      moved = Clock::now();
    } else if (now.seconds - before.seconds > campaign.max_seconds) {
      what = "takes too long";
    } else if (now.bytes > campaign.max_bytes) {
      what = "takes too much memory";
    } else if (now.state == 'S' && now.seconds == before.seconds &&
               Clock::now() - moved > kBlocked) {
      what = "blocks";
    }
    if (!what.empty()) {
      ::kill(worker, SIGKILL);
      ::waitpid(worker, &status, 0);
      return what;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Returns a text that is equal for findings of one kind: without numbers, addresses and the paths
/// that exceptions of the standard library name in brackets.
std::string make_signature(const std::string& what) {
  std::string signature;
  for (const char c : what.substr(0, what.find('['))) {
    if (std::isdigit(static_cast<unsigned char>(c)) == 0) signature += c;
  }
  return signature.substr(0, 200);
}

void keep_finding(const Format& format, const fs::path& work, const Campaign& campaign,
                  const std::vector<std::string>& seeds, const std::string& what,
                  std::uint64_t number, Tally& tally) {
  const Input input = make_input(format, seeds, campaign.seed, number);
  const std::string told = input.kind == Kind::kFile ? what : what + " (no regular file)";
  for (Finding& known : tally.findings) {
    if (make_signature(known.what) != make_signature(told)) continue;
    ++known.count;
    return;
  }
  fs::create_directories(campaign.findings);
  const std::string name =
      format.name + "-" + std::to_string(campaign.seed) + "-" + std::to_string(number);
  Finding finding{number, told, 1, campaign.findings / (name + format.file.extension().string())};
  write_input(finding.file, input);
  std::error_code ignored;
  fs::copy_file(work / "messages", campaign.findings / (name + ".messages"),
                fs::copy_options::overwrite_existing, ignored);
  std::printf("finding: %s, seed %llu, number %llu: %s\n  %s\n", format.name.c_str(),
              static_cast<unsigned long long>(campaign.seed),
              static_cast<unsigned long long>(number), told.c_str(), finding.file.c_str());
  std::fflush(stdout);
  tally.findings.push_back(std::move(finding));
}

}  // namespace

Input make_input(const Format& format, const std::vector<std::string>& seeds, std::uint64_t seed,
                 std::uint64_t number) {
  constexpr std::size_t kRarely = 2000;
  Random random({seed, calc_name_key(format.name), number});
  if (random.one_in(kRarely)) return {static_cast<Kind>(1 + random.below(4)), ""};
  const Changes changes = format.changes;
  if (changes == Changes::kContent || (changes == Changes::kBytesAndContent && random.one_in(2))) {
    return {Kind::kFile, rewrite_hdf5(random.pick(seeds), random)};
  }
  std::string content = mutate(seeds, format.dictionary, random);
  if (changes == Changes::kSealedBytes) content = seal_again(seeds.front(), std::move(content));
  return {Kind::kFile, std::move(content)};
}

void write_input(const fs::path& path, const Input& input) {
  fs::remove_all(path);
  switch (input.kind) {
    case Kind::kFile:
      std::ofstream(path, std::ios::binary) << input.content;
      return;
    case Kind::kFifo:
      if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no FIFO can be made");
      return;
    case Kind::kFolder:
      fs::create_directory(path);
      return;
    case Kind::kDanglingLink:
      fs::create_symlink("nothing", path);
      return;
    case Kind::kZeroDevice:
      fs::create_symlink("/dev/zero", path);
  }
}

Input read_input(const fs::path& path) {
  if (fs::is_symlink(path)) {
    return {fs::exists(path) ? Kind::kZeroDevice : Kind::kDanglingLink, ""};
  }
  if (fs::is_fifo(path)) return {Kind::kFifo, ""};
  if (fs::is_directory(path)) return {Kind::kFolder, ""};
  return {Kind::kFile, read_file(path)};
}

std::vector<std::string> read_seeds(const Format& format, const fs::path& work) {
  std::vector<std::string> seeds;
  for (const fs::path& seed : format.seeds) seeds.push_back(read_file(work / seed));
  for (const std::string& seed : seeds) {
    if (seed.empty()) throw std::runtime_error(format.name + ": a seed is missing");
  }
  return seeds;
}

std::string judge(const Format& format, const fs::path& work, std::optional<std::string>* refused) {
  constexpr std::size_t kMaxMessage = 16384;
  std::string message;
  try {
    format.read(work / format.file);
    return "";
  } catch (const InputError& e) {
    message = e.what();
  } catch (const EnvironmentError& e) {
    message = e.what();
  } catch (const std::exception& e) {
    return "another exception: " + std::string(e.what()).substr(0, 500);
  }
  if (message.size() > kMaxMessage)
    return "a message of " + std::to_string(message.size()) + " bytes";
  if (refused != nullptr) *refused = message;
  return "";
}

Tally run_campaign(const Format& format, const fs::path& work, const Campaign& campaign) {
  const std::vector<std::string> seeds = read_seeds(format, work);
  const auto deadline =
      campaign.time.count() > 0.0
          ? Clock::now() + std::chrono::duration_cast<Clock::duration>(campaign.time)
          : Clock::time_point::max();
  const std::uint64_t end =
      campaign.executions > 0 ? campaign.first + campaign.executions : ~std::uint64_t{0};
  Shared& shared = *share();
  Tally tally;
  const Input sound = read_input(work / format.file);
  for (std::uint64_t first = campaign.first; first != end && Clock::now() < deadline;) {
    shared.number = first;
    const pid_t worker = ::fork();
    if (worker < 0) throw std::runtime_error("no process can be made");
    if (worker == 0) work_through(format, work, campaign, seeds, first, end, deadline, shared);
    const auto what = watch(worker, work, campaign, shared);
    if (!what) break;
    ++shared.executions;
    keep_finding(format, work, campaign, seeds, *what, shared.number, tally);
    first = shared.number + 1;
  }
  write_input(work / format.file, sound);  // other formats read it as well
  tally.executions = shared.executions;
  tally.accepted = shared.accepted;
  tally.refused = shared.refused;
  ::munmap(&shared, sizeof shared);
  return tally;
}

}  // namespace strut::fuzz
