// The parts of a study: requests made from others, trainings side by side, pages and figures.
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>

#include "io/format/toml_text.h"
#include "report/html.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_sweep.h"
#include "train/training_table.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("Values of a TOML file are set wherever its layout has them", "[io]") {
  const TemporaryFolder folder;
  struct Layout {
    const char *text, *key, *literal, *result;
  };
  const Layout layouts[] = {
      {"a = 1 # one\nb = 2\n", "a", "-0.25", "a = -0.25 # one\nb = 2\n"},
      {"a = \"x\"\n", "b", "3", "b = 3\na = \"x\"\n"},
      {"[t]\na = [1, 2] # c\n", "t.a", "\"all\"", "[t]\na = \"all\" # c\n"},
      {"[t] # c\na = 1\n", "t.b", "true", "[t] # c\nb = true\na = 1\n"},
      {"t = { a = 1 }\n", "t.b", "2", "t = { b = 2, a = 1 }\n"},
      {"[t]\nu = { a = 1, b = 2 }\n", "t.u.b", "5", "[t]\nu = { a = 1, b = 5 }\n"},
      {"a = 1\n", "t.b", "2", "a = 1\n\n[t]\nb = 2\n"},
      {"t = { s = \"\xce\xb1\", a = 2 }\n", "t.a", "3", "t = { s = \"\xce\xb1\", a = 3 }\n"},
      {"[t]\na = 1\n[u]\na = 2\n", "t.a", "[4, 5]", "[t]\na = [4, 5]\n[u]\na = 2\n"},
  };
  for (const Layout& layout : layouts) {
    const fs::path file = folder.write("a.toml", layout.text);
    CHECK(set_toml_values(file, {{layout.key, layout.literal}}) == layout.result);
  }
}

TEST_CASE("Setting a TOML value where it cannot stand is refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path dotted = folder.write("a.toml", "t.a = 1\n[u]\nb = 2\n");
  // The table made by a dotted key has no heading; its line would land elsewhere.
  CHECK_THROWS_AS(set_toml_values(dotted, {{"t.c", "3"}}), InputError);
  CHECK_THROWS_AS(set_toml_values(dotted, {{"u.b", "]"}}), InputError);
  CHECK_THROWS_AS(set_toml_values(folder / "none.toml", {{"a", "1"}}), InputError);
}

std::vector<TableTraining> make_trainings(const fs::path& data) {
  std::vector<TableTraining> trainings;
  for (std::uint64_t i = 0; i < 6; ++i) {
    TableTraining t;
    t.name = "t" + std::to_string(i);
    t.data = data;
    t.cases = 27;
    t.request.rows.inputs = {"body_position_z", "pitch_rate"};
    t.request.hidden = {2 + static_cast<int>(i % 3)};
    t.request.seed = t.request.split.seed = 1 + i;
    t.request.options.epochs = 5;
    trainings.push_back(t);
  }
  return trainings;
}

TrainingTableSummary run_table(const std::vector<TableTraining>& trainings, const fs::path& folder,
                               int threads, bool halted = false) {
  fs::create_directories(folder);
  TrainingTableProgress progress;
  std::atomic<bool> halt{halted};
  return run_training_table(trainings, {folder, threads, {}}, progress, halt);
}

TEST_CASE("Trainings side by side give what each gives alone", "[io][property]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  const auto trainings = make_trainings(sweep.folder().root);
  CHECK(run_table(trainings, folder / "one", 1).trained == 6);
  CHECK(run_table(trainings, folder / "three", 3).trained == 6);
  for (const TableTraining& t : trainings) {
    const TrainedModel one = read_trained_model(folder / "one" / (t.name + ".h5"));
    Dataset dataset({t.data});
    Training alone(dataset, t.request);
    while (alone.step()) continue;
    CHECK(read_trained_model(folder / "three" / (t.name + ".h5")).weights == one.weights);
    CHECK(one.weights == alone.make_model().weights);
  }
}

TEST_CASE("A table of trainings keeps what is the same and nothing else", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  auto trainings = make_trainings(sweep.folder().root);
  const fs::path models = folder / "models";
  run_table(trainings, models, 2);
  CHECK(run_table(trainings, models, 2).kept == 6);
  trainings[0].request.options.epochs = 6;
  trainings[1].request.options.goal = 1e-3;
  trainings[2].request.rows.samples = 20;
  trainings[3].request.split.train = 0.6;
  trainings[4].request.rows.inputs = {"body_position_z", "body_acceleration_z"};
  const TrainingTableSummary summary = run_table(trainings, models, 2);
  CHECK(summary.trained == 5);
  CHECK(summary.kept == 1);
  CHECK(summary.notes.size() == 5);
  CHECK(run_table(trainings, models, 2).kept == 6);
}

TEST_CASE("A table names the training that cannot be", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  auto trainings = make_trainings(sweep.folder().root);
  trainings[4].request.hidden = {50};
  CHECK_THROWS_WITH(run_table(trainings, folder / "models", 1), Catch::StartsWith("t4: "));
}

TEST_CASE("A table of trainings that is halted writes nothing half", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const TemporaryFolder folder;
  const TrainingTableSummary summary =
      run_table(make_trainings(sweep.folder().root), folder / "models", 2, true);
  CHECK(summary.stopped);
  CHECK(summary.trained == 0);
  CHECK(fs::is_empty(folder / "models"));
}

TEST_CASE("Texts of a page cannot become its markup", "[unit]") {
  CHECK(escape_html("a < b & \"c\" > d") == "a &lt; b &amp; &quot;c&quot; &gt; d");
  ReportPage page;
  page.title = "<script>";
  page.sections = {{"<b>", {"<i>"}, {{"<u>", {"<h>"}, {{"<td>"}}}}, {}}};
  const std::string html = make_html(page);
  for (const char* tag : {"<script>", "<b>", "<i>", "<u>", "<h>"}) {
    CHECK_THAT(html, !Contains(tag));
  }
}

TEST_CASE("A terminal's table is as wide as its widest cells", "[unit]") {
  const ReportTable table{"Caption", {"name", "value"}, {{"a", "1.25"}, {"longer", "3"}}, {}, 1};
  CHECK(make_text(table) == "Caption\nname    value\na        1.25\nlonger      3\n");
}

}  // namespace
}  // namespace strut
