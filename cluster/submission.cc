#include "cluster/submission.h"

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

constexpr std::int64_t kMost = std::int64_t{1} << 53;

constexpr const char* kJobs = "jobs";
constexpr const char* kSubmission = "submission.toml";
constexpr const char* kDigits = "0123456789";

/// "001", as make_next() names them.
std::string format_number(int number) {
  std::string name = std::to_string(number);
  return name.insert(0, name.size() < 3 ? 3 - name.size() : 0, '0');
}

bool is_submission_name(const std::string& name) {
  const auto number = parse_number<int>(name);
  return number && *number > 0 && name == format_number(*number);
}

/// The first of "001", "002", ... that is not there, made: of two who try, one gets it.
Folder make_next(const Folder& jobs) {
  for (int number = 1;; ++number) {
    const std::string name = format_number(number);
    if (jobs.make_new_folder(name)) return jobs.open_folder(name);
  }
}

void write_submission(const Submission& s, const Folder& folder) {
  std::string text = "dispatcher = " + quote_toml(s.dispatcher) +
                     "\nplace = " + quote_toml(s.place) + "\nuser = " + quote_toml(s.user) +
                     "\njob_prefix = " + quote_toml(s.job_prefix) +
                     "\nretries = " + (s.retries ? "true" : "false") +
                     "\ncollects = " + (s.collects ? "true" : "false") + "\n";
  for (const PackedArray& array : s.arrays) {
    text += "\n[[array]]\nfirst = " + std::to_string(array.shards.first) +
            "\nend = " + std::to_string(array.shards.end) +
            "\nshards_a_task = " + std::to_string(array.shards_a_task) + "\n";
  }
  write_text_file(folder, kSubmission, text);
}

/// A text that begins so and of which every character is one of `allowed`. Throws InputError.
std::string read_word(const Table& root, const std::string& key, const std::string& begin,
                      const std::string& allowed) {
  std::string word = root.text(key);
  constexpr std::size_t kMostBytes = 255;
  if (word.size() <= kMostBytes && word.starts_with(begin) &&
      word.find_first_not_of(allowed) == std::string::npos) {
    return word;
  }
  throw InputError(key + ": must " + (begin.empty() ? "" : "begin with " + begin + " and ") +
                   "hold at most " + std::to_string(kMostBytes) + " of " + allowed);
}

std::string read_dispatcher(const Table& root) {
  const std::vector<std::string> names = list_dispatchers();
  std::string name = root.text("dispatcher");
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  throw InputError("dispatcher: must be one of " + join_names(names));
}

Submission read_submission(const Folder& folder) {
  const fs::path file = folder.path_of(kSubmission);
  read_record_file(folder, kSubmission);  // is a regular file, and no large one
  Document document(file);
  const Table root = document.root();
  const std::string name = std::string(kDigits) + "abcdefghijklmnopqrstuvwxyz-";
  Submission s;
  s.folder = folder.path();
  s.dispatcher = read_dispatcher(root);
  s.place = read_word(root, "place", "", name + "ABCDEFGHIJKLMNOPQRSTUVWXYZ_.");
  s.user = read_word(root, "user", "", kDigits);
  s.job_prefix = read_word(root, "job_prefix", "strut-", name);
  s.retries = root.boolean_or("retries", false);
  s.collects = root.boolean_or("collects", false);
  const std::vector<Table> arrays = root.has("array") ? root.tables("array") : std::vector<Table>();
  std::int64_t tasks = 0;
  for (const Table& table : arrays) {
    const std::int64_t first = table.integer("first", 0, kMost);
    s.arrays.push_back({{first, table.integer("end", first + 1, kMost)},
                        table.integer("shards_a_task", 1, kMost)});
    tasks += std::min(s.arrays.back().tasks(), kMostTasks + 1);
    if (tasks > kMostTasks) {
      throw InputError("array: more than " + std::to_string(kMostTasks) + " tasks in all");
    }
  }
  document.check_all_read();
  return s;
}

/// The same, with the file and what to do about it in every message.
Submission read_submission_file(const Folder& folder) {
  try {
    return read_submission(folder);
  } catch (const InputError& e) {
    const std::string what = e.what(), file = folder.path_of(kSubmission).string();
    throw InputError((what.starts_with(file) ? "" : file + ": ") + what + kRecordRemedy);
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
  const std::string file = part + ".job";
  std::string job = read_record_file(open(), file).value_or("");
  job.erase(job.find_last_not_of('\n') + 1);
  return {part, job, job_name(part), make_job_mark(sweep(), job_name(part)), folder / file};
}

void Submission::write_job(const std::string& part, const std::string& job) const {
  write_text_file(open(), part + ".job", job + "\n");
}

void Submission::mark_cancelled() const { write_text_file(open(), "cancelled", ""); }

void Submission::take_back_cancelled() const { open().remove("cancelled"); }

void Submission::mark_over(const TaskWords& words) const {
  std::ostringstream text;
  for (const auto& [task, word] : words) {
    text << task.first << ' ' << task.second << ' ' << word << '\n';
  }
  write_text_file(open(), "over", text.str());
}

TaskWords Submission::read_words() const {
  TaskWords words;
  std::istringstream text(read_record_file(open(), "over").value_or(""));
  std::size_t array = 0;
  std::int64_t task = 0;
  for (std::string word; text >> array >> task >> word;) words[{array, task}] = word;
  return words;
}

std::string find_user() { return std::to_string(::getuid()); }

Submission make_submission(const SweepFolder& folder, Submission s) {
  const Folder made = make_next(Folder(folder.root).make_folder(kJobs));
  s.folder = made.path();
  std::ostringstream prefix;  // copies of a folder have the same plan and the same numbers
  prefix << s.job_prefix << '-' << std::hex << std::random_device()() << '-' << s.name();
  s.job_prefix = prefix.str();
  s.user = find_user();
  for (std::size_t i = 0; i < s.arrays.size(); ++i) made.make_new_folder(s.array_name(i));
  write_submission(s, made);
  return s;
}

Submission find_submission(const SweepFolder& folder, const std::string& name) {
  const auto jobs = Folder(folder.root).find_folder(kJobs);
  const auto place = jobs && is_submission_name(name) ? jobs->find_folder(name) : std::nullopt;
  if (!place || !place->has(kSubmission)) {
    throw InputError(folder.root.string() + ": holds no submission '" + name +
                     "'; `strut status` lists them");
  }
  return read_submission_file(*place);
}

std::vector<Submission> list_submissions(const SweepFolder& folder,
                                         std::vector<std::string>* faults) {
  std::vector<Submission> all;
  const auto read = [faults](const auto& some) {
    try {
      some();
    } catch (const InputError& e) {
      if (faults == nullptr) throw;
      faults->push_back(e.what());
    }
  };
  read([&] {
    const auto jobs = Folder(folder.root).find_folder(kJobs);
    if (!jobs) return;
    for (const std::string& name : jobs->list()) {
      if (!is_submission_name(name)) continue;
      read([&] {
        const Folder place = jobs->open_folder(name);
        // Killed before it was written: nothing of it was queued.
        if (place.has(kSubmission)) all.push_back(read_submission_file(place));
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
