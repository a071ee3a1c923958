// Files of single commands: studies, reports, submissions.
#include "cluster/submission.h"
#include "cluster/task_record.h"
#include "report/page_file.h"
#include "study/request.h"
#include "tests/fuzz/format.h"

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;

void read_submission_file(const fs::path& path) {
  const fs::path submission = path.parent_path();
  const SweepFolder sweep{submission.parent_path().parent_path()};
  list_submissions(sweep);
  const Submission found = find_submission(sweep, submission.filename().string());
  for (const std::string& part : found.list_parts()) found.read_job(part);
  found.read_scheduler_states();
}

/// The files that a submission keeps beside it.
void read_beside_submission(const fs::path& path) {
  read_submission_file(path.parent_path() / "submission.toml");
}

void read_report(const fs::path& path) { write_page_again(PageFolder{path.parent_path()}); }

}  // namespace

std::vector<Format> list_command_formats() {
  const Dictionary toml = {true,
                           {"[", "]", "{", "}", "=", "\"", ",", "\n", "[[array]]\n",
                            "first = ", "end = ", "shards_a_task = ", "samples = ", "networks",
                            "[noise]\n", "preload = ", "\"../..\"", "\\u001b"},
                           {"a.", "[", "{a=", "a=["}};
  const Dictionary json = {true,
                           {"{", "}", "[", "]", "\"", ":", ",", "null", "true", "\\u0000",
                            "\\ud800", "\"name\": \"../../outside/x\"", "\"figures\": []",
                            "\"sections\": []", "<script>", "\"text_columns\": -1"},
                           {"[", "{\"a\":", "[[", "{\"\":["}};
  const Dictionary words = {true, {" ", "\n", "done", "begun", "host", "-1"}, {}};
  return {
      {"study",
       "studies/input.toml",
       {"studies/paper.toml", "studies/paper_quick.toml"},
       toml,
       [](const fs::path& path) { list_cells(read_study(path)); }},
      {"report", "report/report.json", {"report/report.json.seed"}, json, read_report},
      {"submission",
       "sweep/jobs/001/submission.toml",
       {"sweep/jobs/001/submission.toml.seed"},
       toml,
       read_submission_file},
      {"job",
       "sweep/jobs/001/array-0.job",
       {"sweep/jobs/001/array-0.job.seed"},
       words,
       read_beside_submission},
      {"over", "sweep/jobs/001/over", {"sweep/jobs/001/over.seed"}, words, read_beside_submission},
      {"task",
       "sweep/jobs/001/array-0/0",
       {"sweep/jobs/001/array-0/0.seed"},
       words,
       [](const fs::path& path) {
         judge_task(read_task_attempts(Folder(path.parent_path()), path.filename()), false);
       }},
  };
}

}  // namespace strut::fuzz
