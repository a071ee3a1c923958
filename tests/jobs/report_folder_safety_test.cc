// Report folders that came from elsewhere: nothing in them is executed, no name leads out, nothing
// is written through a link.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::Outcome;
using test::read_text;
using test::run_program;
using test::TemporaryFolder;

constexpr char kRun[] =
    "simulate " STRUT_SOURCE_DIR "/examples/vehicles/paper_sedan.toml " STRUT_SOURCE_DIR
    "/examples/maneuvers/bump_20mps.toml --set duration=0.1 -o ";

/// A run's report, made once, to copy from.
fs::path copy_report(const TemporaryFolder& folder) {
  static const TemporaryFolder made;
  if (!fs::exists(made / "report/report.json")) {
    const Outcome outcome =
        run_program(kRun + (made / "run.csv").string() + " --report " + (made / "report").string());
    CAPTURE(outcome.messages);
    REQUIRE(outcome.code == 0);
  }
  fs::copy(made / "report", folder / "report", fs::copy_options::recursive);
  return folder / "report";
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

void replace(const fs::path& path, const std::string& from, const std::string& to) {
  std::string text = read_text(path);
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  write(path, text.replace(at, from.size(), to));
}

fs::path find_figure(const fs::path& report, const std::string& end) {
  for (const auto& entry : fs::directory_iterator(report / "figures")) {
    if (entry.path().extension() == end && entry.path().stem() != "motion") return entry.path();
  }
  FAIL("no figure " + end);
  return {};
}

TEST_CASE("A report is made again without running what its folder holds", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  const std::string touch = "system(\"touch " + (folder / "PWNED").string() + "\")\n";
  write(report / "figures/curves.gp", touch);
  write(report / "figures/.gnuplot", touch);
  fs::remove(report / "report.html");
  const Outcome outcome = run_program("report " + report.string());
  CHECK(outcome.code == 0);
  CHECK_FALSE(fs::exists(folder / "PWNED"));
  CHECK(fs::exists(report / "report.html"));
}

TEST_CASE("Names in a report's page that lead out of its folder are refused", "[io]") {
  for (const std::string name :
       {"../../outside/x", "/etc/passwd", "", ".", "a/b", "x\\u0000y", "..\\\\x"}) {
    CAPTURE(name);
    const TemporaryFolder folder;
    const fs::path report = copy_report(folder);
    const std::string figure = find_figure(report, ".csv").stem();
    replace(report / "report.json", "\"name\": \"" + figure + "\"", "\"name\": \"" + name + "\"");
    const std::string before = read_text(report / "report.html");
    const Outcome outcome = run_program("report " + report.string());
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("name of a figure must consist of letters, digits"));
    CHECK(read_text(report / "report.html") == before);
  }
}

TEST_CASE("Texts and charts of a report's folder cannot become scripts of its page", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  const std::string evil =
      "</script><script>document.title='PWNED'</script><img src=x onerror=alert(1)>";
  std::string quoted = evil;
  for (std::size_t at = 0; (at = quoted.find('"', at)) != std::string::npos; at += 2) {
    quoted.insert(at, "\\");
  }
  replace(report / "report.json", "\"title\": \"", "\"title\": \"" + quoted);
  const fs::path chart = find_figure(report, ".csv").replace_extension(".json");
  replace(chart, "{", "{\"evil\": \"" + quoted + "\", ");
  CHECK(run_program("report " + report.string()).code == 0);
  const std::string page = read_text(report / "report.html");
  CHECK_THAT(page, Contains("PWNED"));
  CHECK_THAT(page, !Contains("<script>document.title"));
  CHECK_THAT(page, !Contains("<img src=x"));
}

TEST_CASE("A page made of a report's folder asks for nothing beside itself", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  const fs::path chart = find_figure(report, ".csv").replace_extension(".json");
  replace(chart, "\"layout\": {",
          "\"layout\": {\"images\": [{\"source\": \"http://127.0.0.1:9/track.png\"}], ");
  CHECK(run_program("report " + report.string()).code == 0);
  // The browser refuses them by the page's own rule.
  CHECK_THAT(read_text(report / "report.html"),
             Contains("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';"));
}

TEST_CASE("A report removes no file of another's for what its report.json names", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  write(report / "thesis.csv", "mine");
  write(report / "figures/photo.svg", "mine");
  replace(report / "report.json", "\"tables\": [],\n  \"footer\"",
          "\"tables\": [\"thesis\"],\n  \"footer\"");
  const std::string run = kRun + (folder / "run.csv").string() + " --force --report ";
  CHECK(run_program(run + report.string()).code == 0);
  CHECK(read_text(report / "thesis.csv") == "mine");
  CHECK(read_text(report / "figures/photo.svg") == "mine");
  // Nor is a picture replaced that no report has left.
  fs::create_directories(folder / "mine/figures");
  write(folder / "mine/figures/curves.svg", "mine");
  CHECK(run_program(run + (folder / "mine").string()).code == 2);
  CHECK(read_text(folder / "mine/figures/curves.svg") == "mine");
}

TEST_CASE("A report's folder with a link for its figures keeps its page", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  fs::create_directory(folder / "elsewhere");
  fs::remove_all(report / "figures");
  fs::create_directory_symlink(folder / "elsewhere", report / "figures");
  const fs::path run = folder / "late.csv";
  CHECK(run_program(kRun + run.string() + " --report " + report.string()).code == 2);
  CHECK_FALSE(fs::exists(run));
  CHECK(fs::exists(report / "report.html"));
}

TEST_CASE("A figure that a page names twice is refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  const std::string figure = "{\"name\": \"" + find_figure(report, ".csv").stem().string() + "\"";
  replace(report / "report.json", figure, figure + ", \"caption\": \"\"}, " + figure);
  const Outcome outcome = run_program("report " + report.string());
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("named twice"));
}

TEST_CASE("A report's JSON that is nested deeply or not JSON is refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path report = copy_report(folder);
  const std::vector<std::string> texts = {
      std::string(200000, '['),
      std::string(200000, '{'),
      "{\"of\": " + std::string(100000, '[') + std::string(100000, ']') + "}",
      "",
      "nonsense",
      "{\"of\": 1}"};
  for (const std::string& text : texts) {
    CAPTURE(text.substr(0, 40));
    write(report / "report.json", text);
    const Outcome outcome = run_program("report " + report.string());
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("report.json"));
  }
}

TEST_CASE("A report writes through no link and waits for no pipe", "[io]") {
  const TemporaryFolder folder;
  const fs::path theirs = folder.write("theirs", "mine");
  fs::create_directory(folder / "elsewhere");
  for (const std::string name : {"report.html", "report.json", "figures"}) {
    CAPTURE(name);
    fs::remove_all(folder / "report");
    const fs::path report = copy_report(folder);
    const bool is_folder = fs::is_directory(report / name);
    fs::remove_all(report / name);
    fs::create_symlink(is_folder ? folder / "elsewhere" : theirs, report / name);
    const Outcome again = run_program("report " + report.string());
    CHECK(again.code == 2);
    CHECK_THAT(again.messages, Contains(name) && Contains("symbolic link"));
    const Outcome anew =
        run_program(kRun + (folder / "run.csv").string() + " --force --report " + report.string());
    // The page itself may be replaced, not what a link in its place leads to.
    CHECK(anew.code == (name == "report.html" ? 0 : 2));
    CHECK_FALSE((anew.code == 0 && fs::is_symlink(report / name)));
    CHECK(read_text(theirs) == "mine");
    CHECK(fs::is_empty(folder / "elsewhere"));
  }
  fs::remove_all(folder / "report");
  const fs::path report = copy_report(folder);
  fs::remove(report / "report.json");
  REQUIRE(::mkfifo((report / "report.json").c_str(), 0600) == 0);
  const Outcome outcome = test::run_shell("timeout 20 " STRUT_PROGRAM " report " + report.string());
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("a named pipe"));
}

}  // namespace
}  // namespace strut
