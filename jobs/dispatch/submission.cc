#include "jobs/dispatch/submission.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <sstream>
#include <system_error>

#include "io/atomic_file.h"
#include "io/config.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMost = std::int64_t{1} << 53;

fs::path find_jobs(const SweepFolder& folder) { return folder.root / "jobs"; }

/// The first of "001", "002", ... that is not there, made: of two who try, one gets it.
fs::path make_next(const fs::path& jobs) {
  std::error_code error;
  fs::create_directories(jobs, error);
  for (int number = 1; !error; ++number) {
    std::string name = std::to_string(number);
    name.insert(0, name.size() < 3 ? 3 - name.size() : 0, '0');
    if (fs::create_directory(jobs / name, error)) return jobs / name;
  }
  throw EnvironmentError(jobs.string() + ": cannot be made: " + error.message());
}

void write_submission(const Submission& s) {
  std::string text = "dispatcher = \"" + s.dispatcher + "\"\nplace = \"" + s.place +
                     "\"\nuser = \"" + s.user + "\"\njob_prefix = \"" + s.job_prefix +
                     "\"\nretries = " + (s.retries ? "true" : "false") +
                     "\ncollects = " + (s.collects ? "true" : "false") + "\n";
  for (const PackedArray& array : s.arrays) {
    text += "\n[[array]]\nfirst = " + std::to_string(array.shards.first) +
            "\nend = " + std::to_string(array.shards.end) +
            "\nshards_a_task = " + std::to_string(array.shards_a_task) + "\n";
  }
  write_text_file(s.folder / "submission.toml", text);
}

Submission read_submission(const fs::path& folder) {
  Document document(folder / "submission.toml");
  const Table root = document.root();
  Submission s;
  s.folder = folder;
  s.dispatcher = root.text("dispatcher");
  s.place = root.text("place");
  s.user = root.text("user");
  s.job_prefix = root.text("job_prefix");
  s.retries = root.boolean_or("retries", false);
  s.collects = root.boolean_or("collects", false);
  const std::vector<Table> arrays = root.has("array") ? root.tables("array") : std::vector<Table>();
  for (const Table& table : arrays) {
    const std::int64_t first = table.integer("first", 0, kMost);
    s.arrays.push_back({{first, table.integer("end", first + 1, kMost)},
                        table.integer("shards_a_task", 1, kMost)});
  }
  document.check_all_read();
  return s;
}

}  // namespace

std::vector<std::string> Submission::list_parts() const {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < arrays.size(); ++i) parts.push_back(array_name(i));
  if (retries) parts.emplace_back(kRetry);
  if (collects) parts.emplace_back(kCollect);
  return parts;
}

std::string Submission::read_job(const std::string& part) const {
  const fs::path file = folder / (part + ".job");
  if (!fs::exists(file)) return "";
  std::string job = read_text_file(file);
  job.erase(job.find_last_not_of('\n') + 1);
  return job;
}

void Submission::write_job(const std::string& part, const std::string& job) const {
  write_text_file(folder / (part + ".job"), job + "\n");
}

void Submission::mark_cancelled() const { write_text_file(folder / "cancelled", ""); }

void Submission::take_back_cancelled() const { fs::remove(folder / "cancelled"); }

void Submission::mark_over(const TaskWords& words) const {
  std::ostringstream text;
  for (const auto& [task, word] : words) {
    text << task.first << ' ' << task.second << ' ' << word << '\n';
  }
  write_text_file(folder / "over", text.str());
}

TaskWords Submission::read_words() const {
  TaskWords words;
  std::istringstream text(is_over() ? read_text_file(folder / "over") : "");
  std::size_t array = 0;
  std::int64_t task = 0;
  for (std::string word; text >> array >> task >> word;) words[{array, task}] = word;
  return words;
}

std::string find_user() { return std::to_string(::getuid()); }

Submission make_submission(const SweepFolder& folder, Submission s) {
  s.folder = make_next(find_jobs(folder));
  std::ostringstream prefix;  // copies of a folder have the same plan and the same numbers
  prefix << s.job_prefix << '-' << std::hex << std::random_device()() << '-' << s.name();
  s.job_prefix = prefix.str();
  s.user = find_user();
  for (std::size_t i = 0; i < s.arrays.size(); ++i) fs::create_directory(s.tasks(i));
  write_submission(s);
  return s;
}

Submission find_submission(const SweepFolder& folder, const std::string& name) {
  const fs::path place = find_jobs(folder) / name;
  if (name.find('/') != std::string::npos || !fs::exists(place / "submission.toml")) {
    throw InputError(folder.root.string() + ": holds no submission '" + name +
                     "'; `strut status` lists them");
  }
  return read_submission(place);
}

std::vector<Submission> list_submissions(const SweepFolder& folder,
                                         std::vector<std::string>* faults) {
  std::vector<Submission> all;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(find_jobs(folder), error)) {
    // Killed before it was written: nothing of it was queued.
    if (!fs::exists(entry.path() / "submission.toml")) continue;
    try {
      all.push_back(read_submission(entry.path()));
    } catch (const InputError& e) {
      if (faults == nullptr) throw;
      faults->push_back(e.what());
    }
  }
  std::sort(all.begin(), all.end(), [](const Submission& a, const Submission& b) {
    const std::string x = a.name(), y = b.name();
    return x.size() != y.size() ? x.size() < y.size() : x < y;
  });
  return all;
}

}  // namespace strut
