#include "cluster/submission.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "cluster/record_file.h"
#include "io/file/atomic_file.h"
#include "io/format/toml_document.h"
#include "io/format/toml_text.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxShards = std::int64_t{1} << 53;

constexpr const char* kJobs = "jobs";
constexpr const char* kSubmission = "submission.toml";
constexpr const char* kJobEnd = ".job";
constexpr const char* kDigits = "0123456789";

/// Returns the name of the folder of a submission: "001".
std::string format_number(int number) { return fmt::format("{:03}", number); }

bool is_submission_name(const std::string& name) {
  const auto number = parse_number<int>(name);
  return number && *number > 0 && name == format_number(*number);
}

/// Makes the first of "001", "002", ... that does not exist; of two processes only one gets a name.
Folder make_next(const Folder& jobs) {
  for (int number = 1;; ++number) {
    const std::string name = format_number(number);
    if (jobs.make_new_folder(name)) return jobs.open_folder(name);
  }
}

void write_submission(const Submission& s, const Folder& folder) {
  std::string text = fmt::format(
      "dispatcher = {}\nplace = {}\nuser = {}\njob_prefix = {}\nretries = {}\ncollects = {}\n",
      quote_toml(s.dispatcher), quote_toml(s.cluster_name), quote_toml(s.user),
      quote_toml(s.job_prefix), s.retries, s.collects);
  for (const PackedArray& array : s.arrays) {
    text += fmt::format("\n[[array]]\nfirst = {}\nend = {}\nshards_a_task = {}\n",
                        array.shards.first, array.shards.end, array.shards_per_task);
  }
  write_text_file(folder, kSubmission, text);
}

/// Reads a text that starts with `prefix` and consists of characters of `allowed`. Throws
/// InputError.
std::string read_word(const Table& root, const std::string& key, const std::string& prefix,
                      const std::string& allowed) {
  std::string word = root.text(key);
  constexpr std::size_t kMaxWordBytes = 255;
  if (word.size() <= kMaxWordBytes && word.starts_with(prefix) &&
      word.find_first_not_of(allowed) == std::string::npos) {
    return word;
  }
  const std::string start = prefix.empty() ? "" : fmt::format("start with {} and ", prefix);
  throw InputError(
      fmt::format("{}: must {}hold at most {} of {}", key, start, kMaxWordBytes, allowed));
}

std::string read_dispatcher(const Table& root) {
  const std::vector<std::string> names = list_dispatchers();
  std::string name = root.text("dispatcher");
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  throw InputError(fmt::format("dispatcher: must be one of {}", join_names(names)));
}

Submission read_submission(const Folder& folder) {
  const fs::path file = folder.path_of(kSubmission);
  read_record_file(folder, kSubmission);  // refuses links and large files
  Document document(file);
  const Table root = document.root();
  const std::string name = std::string(kDigits) + "abcdefghijklmnopqrstuvwxyz-";
  Submission s;
  s.folder = folder.path();
  s.dispatcher = read_dispatcher(root);
  s.cluster_name = read_word(root, "place", "", name + "ABCDEFGHIJKLMNOPQRSTUVWXYZ_.");
  s.user = read_word(root, "user", "", kDigits);
  s.job_prefix = read_word(root, "job_prefix", "strut-", name);
  s.retries = root.boolean_or("retries", false);
  s.collects = root.boolean_or("collects", false);
  const std::vector<Table> arrays = root.has("array") ? root.tables("array") : std::vector<Table>();
  std::int64_t tasks = 0;
  for (const Table& table : arrays) {
    const std::int64_t first = table.integer("first", 0, kMaxShards);
    s.arrays.push_back({{first, table.integer("end", first + 1, kMaxShards)},
                        table.integer("shards_a_task", 1, kMaxShards)});
    tasks += std::min(s.arrays.back().tasks(), kMaxTasks + 1);
    if (tasks > kMaxTasks) {
      throw InputError(fmt::format("array: more than {} tasks in all arrays", kMaxTasks));
    }
  }
  document.check_all_read();
  return s;
}

/// As read_submission, with the file and the remedy in every message.
Submission read_submission_file(const Folder& folder) {
  try {
    return read_submission(folder);
  } catch (const InputError& e) {
    const std::string what = e.what(), file = folder.path_of(kSubmission).string();
    const std::string location = what.starts_with(file) ? "" : file + ": ";
    throw InputError(fmt::format("{}{}; {}", location, what, kRecordRemedy));
  }
}

}  // namespace

std::vector<std::string> Submission::list_parts() const {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < arrays.size(); ++i) parts.push_back(array_name(i));
  if (retries) parts.emplace_back(kRetry);
  if (collects) parts.emplace_back(kCollect);
  return parts;
}

Folder Submission::open() const { return Folder(sweep()).open_folder(kJobs).open_folder(name()); }

JobRecord Submission::read_job(const std::string& part) const {
  const std::string file = part + kJobEnd;
  std::string job = read_record_file(open(), file).value_or("");
  job.erase(job.find_last_not_of('\n') + 1);
  return {part, job, job_name(part), make_job_mark(sweep(), job_name(part)), folder / file};
}

void Submission::write_job(const std::string& part, const std::string& job) const {
  write_text_file(open(), part + kJobEnd, job + "\n");
}

void Submission::mark_cancelled() const { write_text_file(open(), kCancelled, ""); }

void Submission::unmark_cancelled() const { open().remove(kCancelled); }

void Submission::mark_finished(const SchedulerStates& states) const {
  std::string text;
  for (const auto& [task, state] : states) {
    text += fmt::format("{} {} {}\n", task.first, task.second, state);
  }
  write_text_file(open(), kOver, text);
}

SchedulerStates Submission::read_scheduler_states() const {
  SchedulerStates states;
  std::istringstream text(read_record_file(open(), kOver).value_or(""));
  std::size_t array = 0;
  std::int64_t task = 0;
  for (std::string state; text >> array >> task >> state;) states[{array, task}] = state;
  return states;
}

std::string find_user() { return std::to_string(::getuid()); }

Submission make_submission(const SweepFolder& folder, Submission s) {
  const Folder made = make_next(Folder(folder.root).make_folder(kJobs));
  s.folder = made.path();
  // Random, since copies of a folder have the same plan and the same numbers.
  s.job_prefix = fmt::format("{}-{:x}-{}", s.job_prefix, std::random_device()(), s.name());
  s.user = find_user();
  for (std::size_t i = 0; i < s.arrays.size(); ++i) made.make_new_folder(s.array_name(i));
  write_submission(s, made);
  return s;
}

Submission find_submission(const SweepFolder& folder, const std::string& name) {
  const auto jobs = Folder(folder.root).find_folder(kJobs);
  const auto found = jobs && is_submission_name(name) ? jobs->find_folder(name) : std::nullopt;
  if (!found || !found->has(kSubmission)) {
    throw InputError(fmt::format("{}: holds no submission '{}'; `strut status` lists them",
                                 folder.root.string(), name));
  }
  return read_submission_file(*found);
}

std::vector<Submission> list_submissions(const SweepFolder& folder,
                                         std::vector<std::string>* faults) {
  std::vector<Submission> all;
  const auto collect_faults = [faults](const auto& read) {
    try {
      read();
    } catch (const InputError& e) {
      if (faults == nullptr) throw;
      faults->push_back(e.what());
    }
  };
  collect_faults([&] {
    const auto jobs = Folder(folder.root).find_folder(kJobs);
    if (!jobs) return;
    for (const std::string& name : jobs->list()) {
      if (!is_submission_name(name)) continue;
      collect_faults([&] {
        const Folder found = jobs->open_folder(name);
        // A submit that was killed before it wrote the file queued nothing.
        if (found.has(kSubmission)) all.push_back(read_submission_file(found));
      });
    }
  });
  std::sort(all.begin(), all.end(), [](const Submission& a, const Submission& b) {
    const std::string x = a.name(), y = b.name();
    return x.size() != y.size() ? x.size() < y.size() : x < y;
  });
  return all;
}

}  // namespace strut
