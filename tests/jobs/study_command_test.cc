// strut study and strut report as a user meets them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <sstream>

#include "base/text/format_number.h"
#include "study/folder.h"
#include "study/request.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/check_page.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/jobs/study_program.h"
#include "train/model/model_file.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::drop_seconds;
using test::JsonTree;
using test::Outcome;
using test::read_folder;
using test::read_results;
using test::run_program;
using test::run_shell;
using test::StudyFiles;
using test::StudyProgram;
namespace fs = std::filesystem;

/// A study that has run, made once; tests that change it take a copy.
const StudyProgram<StudyFiles>& get_study() {
  static const StudyProgram<StudyFiles> files;
  static const StudyProgram<StudyFiles>& made = test::require_run(files);
  return made;
}

TEST_CASE("A study's numbers are those that evaluate gives of its models", "[io][slow]") {
  const fs::path root = get_study() / "made";
  const JsonTree results = read_results(root);
  // Two preloads: two networks x two counts, the other inputs; the best instant with both inputs.
  CHECK(results.get_child("cells").size() == 2 * 5 + 2);
  for (const auto& [no_key, cell] : results.get_child("cells")) {
    const std::string sweep = (root / "sweeps" / cell.get<std::string>("sweep")).string();
    std::map<std::string, std::vector<double>> maes;
    for (const auto& [none, training] : cell.get_child("trainings")) {
      const std::string model = (root / training.get<std::string>("model")).string();
      const JsonTree evaluated =
          test::parse_json(run_program("evaluate " + model + " " + sweep + " --json").out);
      CHECK(evaluated.get_child("parameters") == training.get_child("parameters"));
      CHECK(evaluated.get<int>("samples") == training.get<int>("samples"));
      for (const auto& [name, metrics] : training.get_child("parameters")) {
        maes[name].push_back(metrics.get<double>("MAE"));
      }
    }
    for (const auto& [name, values] : maes) {
      REQUIRE(values.size() == 2);
      const JsonTree& mae = cell.get_child("parameters." + name + ".MAE");
      CHECK(mae.get<double>("median") == Approx(0.5 * (values[0] + values[1])).epsilon(1e-14));
      CHECK(mae.get<double>("low") == std::min(values[0], values[1]));
      CHECK(mae.get<double>("high") == std::max(values[0], values[1]));
    }
  }
}

TEST_CASE("A study's ratios are of its medians over the published numbers", "[io][slow]") {
  const JsonTree results = read_results(get_study() / "made");
  int compared = 0;
  for (const auto& [no_key, cell] : results.get_child("cells")) {
    if (cell.get<std::string>("key") != "small_90_four") continue;
    if (cell.get<bool>("best_instant")) {  // published numbers are of the sweep's own instant
      CHECK(cell.get_child("parameters.front_stiffness.MAPE").count("published") == 0);
      continue;
    }
    const JsonTree& mape = cell.get_child("parameters.front_stiffness.MAPE");
    CHECK(mape.get<double>("published") == 0.3);
    CHECK(mape.get<double>("ratio") == Approx(mape.get<double>("median") / 0.3).epsilon(1e-14));
    CHECK(cell.get_child("parameters.rear_stiffness.MAPE").count("published") == 0);
    ++compared;
  }
  CHECK(compared == 2);
  for (const auto& [no_key, summary] : results.get_child("summary")) {
    CHECK(summary.get<int>("errors") == 4);
    CHECK(summary.get<int>("errors_held") <= 3);  // nobody reaches a tenth of 0.001 N/m
    CHECK(summary.get<std::string>("largest_ratio_at") == "small_90_two rear_stiffness MAE");
    CHECK(summary.get<int>("R2") == 10);
  }
}

TEST_CASE("tables.csv has a line for every number of results.json", "[io][slow]") {
  const fs::path root = get_study() / "made";
  std::istringstream stream(test::read_text(root / "tables.csv"));
  std::map<std::string, std::string> medians;
  std::string line;
  std::getline(stream, line);
  CHECK(line ==
        "preload,offset_m,network,samples,inputs,parameter,metric,unit,seeds,median,low,high,"
        "published,ratio");
  while (std::getline(stream, line)) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string part; std::getline(parts, part, ',');) cells.push_back(part);
    REQUIRE(cells.size() >= 12);
    medians[cells[0] + cells[1] + cells[2] + "_" + cells[3] + "_" + cells[4] + cells[5] +
            cells[6]] = cells[9];
  }
  std::size_t numbers = 0;
  const JsonTree results = read_results(root);
  for (const auto& [no_key, cell] : results.get_child("cells")) {
    for (const auto& [parameter, metrics] : cell.get_child("parameters")) {
      for (const auto& [metric, spread] : metrics) {
        const std::string key = cell.get<std::string>("preload") +
                                format_number(cell.get<double>("offset")) +
                                cell.get<std::string>("key") + parameter + metric;
        CHECK(std::stod(medians.at(key)) == spread.get<double>("median"));
        ++numbers;
      }
    }
  }
  CHECK(numbers == medians.size());
  CHECK(numbers == 12 * 2 * 5);
}

TEST_CASE("Each preload and instant has a plan of its own", "[io][slow]") {
  const JsonTree sweeps = read_results(get_study() / "made").get_child("sweeps");
  std::map<std::string, int> hashes;
  for (const auto& [name, sweep] : sweeps) ++hashes[sweep.get<std::string>("plan_hash")];
  CHECK(sweeps.size() == 5);
  CHECK(hashes.size() == 5);
  CHECK(sweeps.get<double>("trimmed_90_best.offset") == -0.5);
  CHECK(sweeps.get<double>("trimmed_90.offset") == 0.0);
  CHECK(sweeps.get<int>("free_length_70.cases") == 70);
  const auto read = [&](const std::string& name) {
    return test::read_text(get_study() / ("made/sweeps/" + name + "/request/paper_sedan_" +
                                          name.substr(0, name.find("_90")) + ".toml"));
  };
  CHECK_THAT(read("trimmed_90"), Contains("preload = \"trimmed\""));
  CHECK_THAT(read("free_length_90"), Contains("preload = \"free_length\""));
}

TEST_CASE("A study that is done does nothing twice and repeats its bytes", "[io][slow]") {
  const fs::path root = get_study() / "made";
  const auto before = read_folder(root);
  const Outcome again = get_study().run("--threads 1");
  CHECK(again.code == 0);
  CHECK_THAT(again.messages, Contains("0 networks trained") && Contains("24 were there already"));
  CHECK(test::check_hint(again.messages) ==
        std::vector<std::string>{"xdg-open", (root / "report.html").string()});
  CHECK(read_folder(root) == before);
  CHECK(run_program("report " + root.string()).code == 0);
  CHECK(read_folder(root) == before);
}

TEST_CASE("A study that was interrupted goes on to the same results", "[io][slow]") {
  const auto& files = get_study();
  // SIGTERM as soon as three models are there.
  const std::string folder = (files / "stopped").string();
  const Outcome stopped = run_shell(
      "bash -c '" STRUT_PROGRAM " study " + (files / "study.toml").string() + " -o " + folder +
      " --threads 1 & while [ $(ls " + folder +
      "/models 2>/dev/null | wc -l) -lt 3 ]; do sleep 0.002; done; kill -TERM $!; wait $!'");
  CHECK(stopped.code == 143);
  CHECK_THAT(stopped.messages, Contains("the same command continues"));
  CHECK(test::check_hint(stopped.messages)[1] == "study");
  CHECK_FALSE(fs::exists(files / "stopped/results.json"));
  const Outcome resumed = files.run("--threads 1", "stopped");
  CHECK(resumed.code == 0);
  CHECK_THAT(resumed.messages, !Contains(", 0 were there already"));
  CHECK(drop_seconds(files / "stopped") == drop_seconds(files / "made"));
}

TEST_CASE("A model of other options or a damaged one is trained anew", "[io][slow]") {
  const auto& files = get_study();
  const fs::path root = files.copy("copy"), models = root / "models";
  const fs::path other = models / "trimmed_small_70_four_seed1.h5",
                 damaged = models / "trimmed_small_70_four_seed2.h5";
  const std::string before = test::read_text(other);
  fs::copy_file(models / "trimmed_small_70_four_seed2.h5", other,
                fs::copy_options::overwrite_existing);
  std::ofstream(damaged) << "no model";
  const Outcome outcome = files.run("", "copy");
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.messages,
             Contains(" 2 networks trained in") && Contains(", 22 were there already"));
  CHECK_THAT(outcome.messages, Contains("seed1.h5: trained anew") && Contains("seed = 2, not 1"));
  CHECK_THAT(outcome.messages, Contains("seed2.h5: trained anew"));
  CHECK(drop_seconds(root) == drop_seconds(files / "made"));
}

TEST_CASE("A folder of another study or of none is refused", "[io][slow]") {
  const auto& files = get_study();
  const auto before = read_folder(files / "made");
  const Outcome other = files.run_file(files.change("epochs = 12", "epochs = 13"), "made");
  CHECK(other.code == 2);
  CHECK_THAT(other.messages, Contains("already holds a different study") &&
                                 Contains("training.epochs: was 12, is 13"));
  CHECK(read_folder(files / "made") == before);
  fs::create_directory(files / "full");
  std::ofstream(files / "full" / "letter.txt") << "dear";
  const Outcome full = files.run("", "full");
  CHECK(full.code == 2);
  CHECK_THAT(full.messages, Contains("letter.txt"));
  const Outcome none = run_program("report " + (files / "full").string());
  CHECK(none.code == 2);
  CHECK_THAT(none.messages, Contains("nothing to report on") && Contains("study.toml"));
}

TEST_CASE("A study makes no sweep where a link inside its folder leads", "[io]") {
  const StudyProgram<StudyFiles> files;
  const StudyRequest request = read_study(files / "study.toml");
  const StudyFolder folder = make_study_folder(files / "made", request);
  const std::string sweep = make_sweep_name(request, list_cells(request).front());
  fs::create_directory(files / "elsewhere");
  fs::create_directory_symlink(files / "elsewhere", folder.sweep(sweep).root);
  const Outcome outcome = files.run();
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains(sweep + ": a symbolic link"));
  CHECK(fs::is_empty(files / "elsewhere"));
}

TEST_CASE("A fault in a study file is refused before a folder is made", "[io]") {
  const StudyProgram<StudyFiles> files;
  const Outcome outcome = files.run_file(files.change("seeds   = 2", "seads = 2"), "never");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("study2.toml") && Contains("did you mean 'seeds'"));
  CHECK_FALSE(fs::exists(files / "never"));
}

TEST_CASE("A study's report is one well-formed page that needs no other file", "[io][slow]") {
  const auto& files = get_study();
  const fs::path page = files / "made/report.html";
  test::check_page(page.string(), 10);  // five charts for each preload
  const std::string text = test::read_text(page);
  CHECK_THAT(text, Contains("Small &lt;study&gt;") && !Contains("Small <study>"));
  CHECK_THAT(text, Contains("A remark.") && Contains("Somebody"));
  const JsonTree results = read_results(files / "made");
  for (const auto& [name, sweep] : results.get_child("sweeps")) {
    CHECK_THAT(text, Contains(sweep.get<std::string>("plan_hash")));
  }
}

TEST_CASE("A sweep's report tells its cases, layers and snapshots", "[io][slow]") {
  const auto& files = get_study();
  const fs::path root = files / "sweep_copy";
  fs::remove_all(root);
  fs::copy(files / "made/sweeps/trimmed_90", root, fs::copy_options::recursive);
  REQUIRE(run_program("report " + root.string()).code == 0);
  // Four channels, the coverage, bounds and sensitivities.
  test::check_page((root / "report.html").string(), 7);
  const std::string text = test::read_text(root / "report.html");
  CHECK_THAT(text, Contains("90 of 90 cases") && Contains("No case failed.") &&
                       Contains("Strata by front_stiffness") && Contains("body_velocity_z"));
  CHECK(run_program("verify " + root.string()).code == 0);
}

}  // namespace
}  // namespace strut
