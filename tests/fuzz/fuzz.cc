// Runs strut's readers on mutants of valid files: see README.md.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "tests/fuzz/format.h"
#include "tests/fuzz/watch.h"

#if defined(__SANITIZE_ADDRESS__)
// Called by the address sanitizer. The fuzzer has its own memory limit; a single allocation beyond
// it is a finding, even if its pages are never used.
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
const char* __asan_default_options() {
  return "detect_leaks=0:max_allocation_size_mb=1024:quarantine_size_mb=32";
}
#endif

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Usage: strut_fuzz [FORMAT...] [--seconds S | --executions N] [--seed S] [--findings DIR]\n"
    "       strut_fuzz FORMAT --replay FILE\n"
    "       strut_fuzz FORMAT --number N [--seed S] --keep FILE\n"
    "\n"
    "Divides the time (by default 60 s) or the executions over the formats, by default all. Ends\n"
    "with code 1 where there is a finding. --replay reads one input again; --keep writes one\n"
    "without reading it.\n"
    "\n"
    "Formats:";

struct Options {
  std::vector<std::string> formats;
  double seconds = 0.0;
  std::uint64_t executions = 0, seed = 1, number = 0;
  fs::path findings = "findings", replay, keep;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      options.formats.push_back(word);
      continue;
    }
    if (++i == argc) throw std::invalid_argument(word + " needs a value");
    const std::string value = argv[i];
    if (word == "--seconds") {
      options.seconds = std::stod(value);
    } else if (word == "--executions") {
      options.executions = std::stoull(value);
    } else if (word == "--seed") {
      options.seed = std::stoull(value);
    } else if (word == "--number") {
      options.number = std::stoull(value);
    } else if (word == "--findings") {
      options.findings = value;
    } else if (word == "--replay") {
      options.replay = value;
    } else if (word == "--keep") {
      options.keep = value;
    } else {
      throw std::invalid_argument("unknown option " + word);
    }
  }
  if (options.executions == 0 && options.seconds == 0.0) options.seconds = 60.0;
  return options;
}

std::vector<Format> choose_formats(const std::vector<std::string>& names) {
  std::vector<Format> chosen;
  for (Format& format : list_formats()) {
    const bool named = std::find(names.begin(), names.end(), format.name) != names.end();
    if (names.empty() ? !format.only_by_name : named) chosen.push_back(std::move(format));
  }
  if (!names.empty() && chosen.size() != names.size())
    throw std::invalid_argument("unknown format");
  return chosen;
}

class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (fs::temp_directory_path() / "strut_fuzz_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
    make_work_folder(path_);
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

int replay(const Format& format, const fs::path& file, const fs::path& work) {
  write_input(work / format.file, read_input(file));
  std::optional<std::string> refused;
  const std::string finding = judge(format, work, &refused);
  std::cout << (!finding.empty() ? "finding: " + finding
                : refused        ? "refused: " + *refused
                                 : "accepted")
            << "\n";
  return finding.empty() ? 0 : 1;
}

int fuzz(const std::vector<Format>& formats, const Options& options, const fs::path& work) {
  const std::uint64_t count = formats.size();
  Campaign campaign;
  campaign.seed = options.seed;
  campaign.findings = options.findings;
  campaign.executions = (options.executions + count - 1) / count;
  campaign.time = std::chrono::duration<double>(options.seconds / static_cast<double>(count));
  std::printf("%-14s %10s %10s %10s %8s\n", "format", "executions", "accepted", "refused",
              "findings");
  Tally total;
  for (const Format& format : formats) {
    const Tally tally = run_campaign(format, work, campaign);
    std::uint64_t hits = 0;
    for (const Finding& finding : tally.findings) hits += finding.count;
    std::printf("%-14s %10llu %10llu %10llu %8zu  (%llu inputs)\n", format.name.c_str(),
                static_cast<unsigned long long>(tally.executions),
                static_cast<unsigned long long>(tally.accepted),
                static_cast<unsigned long long>(tally.refused), tally.findings.size(),
                static_cast<unsigned long long>(hits));
    std::fflush(stdout);
    total.executions += tally.executions;
    total.accepted += tally.accepted;
    total.refused += tally.refused;
    total.findings.insert(total.findings.end(), tally.findings.begin(), tally.findings.end());
  }
  std::printf("%-14s %10llu %10llu %10llu %8zu\n", "all",
              static_cast<unsigned long long>(total.executions),
              static_cast<unsigned long long>(total.accepted),
              static_cast<unsigned long long>(total.refused), total.findings.size());
  return total.findings.empty() ? 0 : 1;
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const std::vector<Format> formats = choose_formats(options.formats);
  const bool single = !options.replay.empty() || !options.keep.empty();
  if (single && formats.size() != 1) throw std::invalid_argument("name one format");
  const WorkFolder work;
  if (!options.replay.empty()) return replay(formats.front(), options.replay, work.path());
  if (!options.keep.empty()) {
    const auto seeds = read_seeds(formats.front(), work.path());
    write_input(options.keep, make_input(formats.front(), seeds, options.seed, options.number));
    return 0;
  }
  return fuzz(formats, options, work.path());
}

}  // namespace
}  // namespace strut::fuzz

int main(int argc, char** argv) {
  try {
    return strut::fuzz::run(argc, argv);
  } catch (const std::invalid_argument& e) {
    std::cerr << "strut_fuzz: " << e.what() << "\n" << strut::fuzz::kUsage;
    for (const auto& format : strut::fuzz::list_formats()) std::cerr << " " << format.name;
    std::cerr << "\n";
    return 2;
  } catch (const std::exception& e) {
    std::cerr << "strut_fuzz: " << e.what() << "\n";
    return 3;
  }
}
