// Input made to break the program: every command refuses it at once, with a short message that a
// terminal may show.
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>

#include "base/error/input_error.h"
#include "base/text/shorten.h"
#include "base/text/utf8.h"
#include "io/format/json.h"
#include "io/format/tir.h"
#include "io/format/toml_document.h"
#include "io/table/csv.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/small_disk.h"
#include "tests/support/sweep_text.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::run_shell;
using test::TemporaryFolder;

const std::string kSedan = STRUT_SOURCE_DIR "/examples/vehicles/paper_sedan.toml";
const std::string kBump = STRUT_SOURCE_DIR "/examples/maneuvers/bump_20mps.toml";

std::string repeat(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

double measure_seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Neither controls but newlines, nor much of anything.
void check_shown(const std::string& messages) {
  CHECK(messages.size() < 10000);
  CHECK(escape_controls(messages) == messages);
}

TEST_CASE("TOML of endless depth or words is refused with its line, by every command", "[io]") {
  const TemporaryFolder folder;
  const std::pair<const char*, std::string> texts[] = {
      {"dotted key too long", "\n" + repeat("a.", 50000) + "a = 1\n"},
      {"dotted key too long", "\n[" + repeat("a.", 50000) + "a]\n"},
      {"dotted key too long", "\n" + repeat("'b.b' . ", 20000) + "a = 1\n"},
      {"nested too deep", "\na = " + repeat("[", 50000)},
      {"nested too deep", "\na = " + repeat("{a=", 50000)},
      {"nested too deep", "\na = " + repeat("[[{a.a=", 20000)},
      {"key or value too long", "\n" + repeat("a", 257) + " = 1\n"},
      {"key or value too long", "\na = " + repeat("1", 100000) + "\n"},
      {"text too long", "\na = '" + repeat("a", 4097) + "'\n"},
      {"text too long", "\n\"" + repeat("a", 100000) + "\" = 1\n"}};
  const std::string file = folder / "deep.toml", out = " -o " + std::string(folder / "out");
  for (const auto& [what, text] : texts) {
    folder.write("deep.toml", text);
    CHECK_THROWS_WITH(Document(file), Contains("deep.toml:2: ") && Contains(what));
    for (const std::string& command :
         {"plan " + file + out, "simulate " + kSedan + " " + file + out + ".csv",
          "simulate " + file + " " + kBump + out + ".csv", "compare " + file + out,
          "diagnose " + file + out, "study " + file + out, "design " + file,
          "identify " + file + " " + file + " --maneuver " + file}) {
      INFO(command);
      const Outcome outcome = run_program(command);
      CHECK(outcome.code == 2);
      CHECK_THAT(outcome.messages, Contains("deep.toml:2: ") && Contains(what));
    }
  }
}

TEST_CASE("A file of another format in place of TOML is named as what it is", "[io]") {
  const TemporaryFolder folder;
  const auto refuse = [&](const char* name, const std::string& text, const char* told) {
    CHECK_THROWS_WITH(Document(folder.write(name, text)), Contains(name) && Contains(told));
  };
  refuse("run.h5", "\x89HDF\r\n\x1a\n", "an HDF5 file; must be a TOML file");
  refuse("run.mat", "MATLAB 5.0 MAT-file", "a MATLAB file");
  refuse("run.html", "<!DOCTYPE html>", "a page or XML file");
  refuse("new.mat", "MATLAB 7.3 MAT-file", "a MATLAB file");
  refuse("run.json", "\xef\xbb\xbf{\"a\": 1}", "a JSON file");
  refuse("000000.h5", "strut shard seal\n", "a file that strut seals");
  refuse("run.csv", "time,force\n0,1\n", "run.csv:1: not valid TOML");
  refuse("run.csv", "time,force\n0,1\n", "is it a table of data?");
}

TEST_CASE("Brackets and dots in strings, comments and numbers are not nesting", "[io]") {
  const TemporaryFolder folder;
  const std::string many = repeat("[.", 100);
  const std::string text = "# " + many + "\nx = \"" + many + "\\\"" + many + "\" # " + many +
                           "\ny = \"\"\"\n" + many + "\"\"" + many + "\\\"\"\"\"\"\"\nz = '''\n" +
                           many + "'''''\nw = '" + many + "'\nu = [" + repeat("1.5,\n", 100) +
                           "]\n\"" + many + "\" = {a = [[1.5]]}\n";
  const Document document(folder.write("flat.toml", text));
  CHECK(document.root().text("x") == many + "\"" + many);
  CHECK(document.root().text("z") == many + "''");
  CHECK(document.root().text("w") == many);
  CHECK(document.root().numbers("u").size() == 100);
  std::string deepest = "a = 1";
  for (int level = 0; level < 31; ++level) deepest = "a = {" + deepest + "}";
  CHECK_NOTHROW(Document(folder.write("deep.toml", deepest)));
}

TEST_CASE("Files larger than any real one are refused", "[io]") {
  const TemporaryFolder folder;
  const std::string toml = folder.write("large.toml", repeat("# 345678901234567\n", 1 << 20));
  CHECK_THROWS_WITH(Document(toml), Contains("at most 16777216 are allowed"));
  const std::string tir = folder.write("large.tir", repeat("$ 345678\n", 1 << 19));
  CHECK_THROWS_WITH(read_tir(tir), Contains("at most 4194304 are allowed"));
  const std::string line = folder.write("line.csv", "time," + repeat("x", 2 << 20) + "\n1,2\n");
  CHECK_THROWS_WITH(read_csv(line), Contains("line.csv:1: more than 1048576 bytes in one line"));
  const std::string columns = folder.write("columns.csv", repeat("a,", 20000) + "b\n");
  CHECK_THROWS_WITH(read_csv(columns), Contains("columns.csv:1: 20001 columns; at most 16384"));
}

TEST_CASE("The longest line of a CSV file that is allowed is read", "[io]") {
  const TemporaryFolder folder;
  const std::string cell = "0.5" + std::string((1 << 20) - 5, '0');
  const CsvTable table = read_csv(folder.write("long.csv", "a\n" + cell + "\r\n" + cell + "\n2"));
  CHECK(table.columns.front().values == std::vector<double>{0.5, 0.5, 2.0});
}

TEST_CASE("Many keys take time in proportion", "[io]") {
  const TemporaryFolder folder;
  std::string tir = "[MODEL]\n", toml;
  for (int i = 0; i < 40000; ++i) tir += "K" + std::to_string(i) + " = 1\n";
  for (int i = 0; i < 100000; ++i) toml += "k" + std::to_string(i) + " = 1\n";
  CHECK(measure_seconds([&] { CHECK(parse_tir(tir, "x.tir").entries.size() == 40000); }) < 2.0);
  CHECK_THROWS_WITH(parse_tir(tir + "K7 = 2\n", "x.tir"), Contains("already given in line 9"));

  const std::string file = folder.write("many.toml", toml);
  Document document(file);
  document.root().has("k0");
  std::string message;
  CHECK(measure_seconds([&] {
          try {
            document.check_all_read();
          } catch (const InputError& e) {
            message = e.what();
          }
        }) < 2.0);
  CHECK_THAT(message, Contains("unknown key 'k1'; did you mean 'k0'?") &&
                          Contains("and 99979 more unknown keys"));
}

TEST_CASE("Control characters and bytes that are not UTF-8 are shown as numbers", "[unit]") {
  CHECK(escape_controls("plain \xc3\xa9 text\n\t\x7e") == "plain \xc3\xa9 text\n\t\x7e");
  CHECK(escape_controls("\x1b[31m\r\x7f") == "\\x1b[31m\\x0d\\x7f");
  CHECK(escape_controls(std::string(1, '\0')) == "\\x00");
  CHECK(escape_controls("\xc2\x9b"
                        "31m") == "\\xc2\\x9b31m");  // C1
  CHECK(escape_controls("\x9b"
                        "31m\xff") == "\\x9b31m\\xff");  // no UTF-8
  CHECK(escape_controls("a\xe2\x80\xae"
                        "b") ==
        "a\\xe2\\x80\\xae"
        "b");  // right to left override
  const std::string hostile = "\x1b]0;x\x07\x7f\xc2\x85\xe2\x80\xa8\xff";
  const std::string json = format_json(Json{{"name", hostile}});
  CHECK(escape_controls(json) == json);
  CHECK(test::parse_json(json).get<std::string>("name") ==
        "\x1b]0;x\x07\x7f\xc2\x85\xe2\x80\xa8\xef\xbf\xbd");
}

TEST_CASE("A long text keeps its ends", "[unit]") {
  CHECK(shorten("short") == "short");
  CHECK(shorten("0123456789", 9) == "012...789");
  CHECK(shorten("0123456789", 3) == "...");
  const std::string accents = repeat("\xc3\xa9", 100);
  for (std::size_t bytes = 3; bytes < 40; ++bytes) {
    const std::string cut = shorten(accents, bytes);
    CHECK(cut.size() <= bytes);
    CHECK(make_valid_utf8(cut) == cut);
  }
}

TEST_CASE("Messages show no escape sequence of a file and are short", "[io]") {
  const TemporaryFolder folder;
  const std::string long_text = repeat("x", 1000000), escape = "\x1b]0;x\x07\x1b[31m";
  const std::string toml[] = {"vehicle = \"\\u001b[31m\\u009b2J\"\n",
                              "vehicle = \"" + kSedan + "\"\nmaneuver = \"" + kBump +
                                  "\"\n\"\\u001b[2J\" = 1\n[grid]\n" +
                                  "\"\\u001b]0;x\\u0007\" = { from = 1, to = 2, step = 1 }\n",
                              "vehicle = \"" + long_text + "\"\n",
                              long_text + " = 1\n",
                              "a = " + long_text,
                              "vehicle = \"" + escape + "\"\n",
                              "[" + long_text + "]\n[" + long_text + "]\n"};
  for (const std::string& text : toml) {
    const Outcome outcome = run_program("plan " + folder.write("a.toml", text).string() + " -o " +
                                        std::string(folder / "out"));
    CHECK(outcome.code == 2);
    check_shown(outcome.messages);
  }
  const std::string csv[] = {
      "time," + escape + "\n0,1\n",
      "time," + repeat("y", 500000) + "," + repeat("y", 500000) + "\n0,1,2\n",
      "time,imu_rate_y,imu_acceleration_z\n0," + escape + ",0\n",
      "time,imu_rate_y,imu_acceleration_z\n0," + repeat("z", 500000) + ",0\n"};
  for (const std::string& text : csv) {
    const Outcome outcome = run_program(
        "identify " + kSedan + " " + folder.write("a.csv", text).string() + " --maneuver " + kBump);
    CHECK(outcome.code == 2);
    check_shown(outcome.messages);
  }
  const std::string tir = folder.write("a.tir", "[MODEL]\n'" + escape + long_text + "\n");
  CHECK_THROWS_WITH(read_tir(tir), Contains("xxx...xxx"));
  // The names of files and words of the command line, too.
  const Outcome named =
      run_shell(STRUT_PROGRAM " plan \"$(printf 'a\\033[31mb\\n\\233.toml')\" -o x");
  CHECK(named.code == 2);
  check_shown(named.messages);
  CHECK_THAT(named.messages, Contains("\\x1b[31mb"));
}

TEST_CASE("Standard output shows no escape sequence of a file, and JSON stays JSON", "[io]") {
  const TemporaryFolder folder;
  const std::string model = folder / "m\x1b[31m\xc2\x9b.h5", sweep = folder / "cars\x1b[2J";
  folder.write("sweep.toml", test::make_sweep_text({{"count  = \"all\"", "count = 20"}}));
  const std::string plan = "plan " + std::string(folder / "sweep.toml") + " -o ";
  REQUIRE(run_program(plan + "'" + sweep + "'").code == 0);
  REQUIRE(run_program("run -q '" + sweep + "'").code == 0);
  const Outcome trained =
      run_program("train --allow-few --epochs 1 --hidden 2 '" + sweep + "' -o '" + model + "'");
  REQUIRE(trained.code == 0);
  CHECK_THAT(trained.out, Contains("m\\x1b[31m\\xc2\\x9b.h5"));
  check_shown(trained.out + trained.messages);
  for (const std::string& json :
       {run_program("train --force --json --allow-few --epochs 1 --hidden 2 '" + sweep + "' -o '" +
                    model + "'")
            .out,
        run_program("merge --json '" + sweep + "' -o '" + model + "2'").out}) {
    check_shown(json);
    CHECK_THAT(test::parse_json(json).get<std::string>("file"), Contains("\x1b[31m\xc2\x9b"));
  }
  for (const char* command : {"status", "verify", "doctor", "merge -o x.h5 --partial"}) {
    const Outcome outcome = run_program(std::string(command) + " '" + sweep + "'");
    check_shown(outcome.out + outcome.messages);
  }
  std::filesystem::remove("x.h5");
}

TEST_CASE("What would not finish is refused at once", "[io]") {
  const TemporaryFolder folder;
  const auto plan = [&](const test::Replacements& replacements) {
    folder.write("sweep.toml", test::make_sweep_text(replacements));
    Outcome outcome;
    const std::string command =
        "plan " + std::string(folder / "sweep.toml") + " -o " + std::string(folder / "cars");
    CHECK(measure_seconds([&] { outcome = run_shell("timeout 20 " STRUT_PROGRAM " " + command); }) <
          10.0);
    CHECK(outcome.code == 2);
    CHECK_FALSE(std::filesystem::exists(folder / "cars"));
    return outcome.messages;
  };
  CHECK_THAT(plan({{"step    = 1e-3", "step = 1e-9"}}),
             Contains("integrate.step = 1e-09: a run of 3 s would take 3e+09 steps"));
  CHECK_THAT(plan({{"to = 35500, step = -500", "to = 35500, count = 3000000000000"}}),
             Contains("shards; at most 10000000 are allowed"));
  CHECK_THAT(plan({{"strata = 10", "strata = 1000000000"}}), Contains("must lie in [1, 100000]"));
  for (const std::string& command : {"simulate " + kSedan + " " + kBump + " --step 1e-9",
                                     std::string("simulate ") + STRUT_SOURCE_DIR
                                         "/examples/rigs/quarter_car.toml " STRUT_SOURCE_DIR
                                         "/examples/rigs/maneuvers/bump.toml --step 1e-9"}) {
    const Outcome outcome = run_shell("timeout 20 " STRUT_PROGRAM " " + command + " -o " +
                                      std::string(folder / "run.csv"));
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("--step = 1e-09 s: a run of 3 s would take 3e+09 steps"));
  }
}

TEST_CASE("A plan of 10^9 cases is planned, one of 10^8 shards is refused wherever it comes from",
          "[io]") {
  const TemporaryFolder folder;
  const std::string text = test::make_grid_text(
      "front_stiffness = { from = 40000, to = 30000, count = 100000 }\n"
      "rear_stiffness = { from = 40000, to = 30000, count = 10000 }");
  const Plan plan(read_request(folder.write("sweep.toml", text)));
  CHECK(plan.case_count() == 1'000'000'000);
  std::string small = text;
  small.replace(small.find("cases = 512"), 11, "cases = 10");
  const SweepRequest request = read_request(folder.write("small.toml", small));
  CHECK_THROWS_WITH(Plan(request), Contains("1000000000 cases in shards of 10 make 100000000"));
}

TEST_CASE("A limit of file size fails every output as a full disk does", "[io]") {
  const TemporaryFolder folder;
  const std::string run = folder / "run";
  for (const std::string& command : {"simulate " + kSedan + " " + kBump + " -o " + run + ".csv",
                                     "simulate " + kSedan + " " + kBump + " -o " + run + ".h5",
                                     "simulate --kinematics " + kSedan + " -o " + run + ".csv"}) {
    const Outcome outcome =
        run_shell("ulimit -f 1; " STRUT_PROGRAM " " + command);  // a block of 512 or 1024 bytes
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.messages, Contains(": cannot be written: File too large"));
    CHECK(folder.file_count() == 0);
  }
}

TEST_CASE("A full disk is reported by the system's reason alone", "[io]") {
  const TemporaryFolder folder;
  const std::string cars = folder / "cars";
  REQUIRE(
      run_program("plan -q " STRUT_SOURCE_DIR "/examples/api/small_sweep.toml -o " + cars).code ==
      0);
  REQUIRE(run_program("run -q " + cars).code == 0);
  const test::SmallDisk disk(folder / "disk", 1);
  if (!disk.is_mounted()) {
    WARN("skipped: only root can mount a small disk");
    return;
  }
  const std::string file = folder / "disk/out";
  REQUIRE(run_shell("head -c 2000000 /dev/zero > " + std::string(folder / "disk/fill")).code == 1);
  for (const std::string& command :
       {"merge " + cars + " -o " + file + ".h5",
        "train --allow-few --hidden 3 --epochs 1 " + cars + " -o " + file + ".h5",
        "simulate " + kSedan + " " + kBump + " -o " + file + ".h5",
        "simulate " + kSedan + " " + kBump + " -o " + file + ".csv"}) {
    INFO(command);
    const Outcome outcome = run_program(command);
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.messages, Contains(": cannot be written: No space left on device\n") &&
                                     !Contains("errno") && !Contains("chunk"));
    const auto left = std::filesystem::directory_iterator(folder / "disk");
    CHECK(std::distance(begin(left), end(left)) == 1);
  }
}

TEST_CASE("Threads that cannot be started are the environment's failure", "[io]") {
  const TemporaryFolder folder;
  const std::string cars = folder / "cars";
  REQUIRE(
      run_program("plan -q " STRUT_SOURCE_DIR "/examples/api/small_sweep.toml -o " + cars).code ==
      0);
  if (run_shell("setpriv --reuid=65534 --clear-groups true").code != 0) {
    WARN("skipped: only root can run the program as another user, whose threads are limited");
    return;
  }
  std::filesystem::copy_file(STRUT_PROGRAM, folder / "strut");
  REQUIRE(run_shell("chown -R 65534 " + std::string(folder / "")).code == 0);
  for (const char* limit : {"4", "20"}) {
    const Outcome outcome =
        run_shell("setpriv --reuid=65534 --clear-groups bash -c 'ulimit -u " + std::string(limit) +
                  "; exec " + std::string(folder / "strut") + " run " + cars + " --threads 64'");
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.messages, Contains("Resource temporarily unavailable") &&
                                     Contains("ulimit -u") && !Contains("libgomp"));
  }
}

TEST_CASE("Links in a circle, long names and closed folders are named with their reason", "[io]") {
  const TemporaryFolder folder;
  const std::string loop = folder / "a", name(300, 'n');
  std::filesystem::create_symlink(folder / "b", folder / "a");
  std::filesystem::create_symlink(folder / "a", folder / "b");
  const auto list_commands = [&](const std::string& path) {
    return std::vector<std::string>{
        "plan " + path + " -o x",
        "run " + path,
        "status " + path,
        "train " + path + " -o x.h5",
        "report " + path,
        "identify " + path + " " + path,
        "evaluate " + path + " " + path,
        "simulate " + path + " " + kBump + " -o x.csv",
        "simulate " + kSedan + " " + kBump + " -o " + path + ".csv/x.csv",
        "compare " + path + " -o x"};
  };
  for (const std::string& path : {loop + "/x", std::string(folder / name)}) {
    for (const std::string& command : list_commands(path)) {
      INFO(command);
      const Outcome outcome = run_program(command);
      CHECK((outcome.code == 2 || outcome.code == 3));
      CHECK_THAT(outcome.messages, Contains(path) && !Contains("filesystem error"));
    }
  }
  if (run_shell("setpriv --reuid=65534 --clear-groups true").code != 0) {
    WARN("skipped: only root can run the program as a user who may not read");
    return;
  }
  std::filesystem::copy_file(STRUT_PROGRAM, folder / "strut");
  REQUIRE(
      run_shell("cd " + std::string(folder / "") + " && chmod 755 . && mkdir -m 700 closed").code ==
      0);
  for (const std::string& command : list_commands(folder / "closed/x")) {
    const Outcome outcome = run_shell("setpriv --reuid=65534 --clear-groups " +
                                      std::string(folder / "strut") + " " + command);
    INFO(command << "\n" << outcome.messages);
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.messages, Contains(folder / "closed/x") && Contains("Permission denied") &&
                                     !Contains("filesystem error"));
  }
}

}  // namespace
}  // namespace strut
