// The noise section of a study: what it asks for, and its numbers against other commands and laws.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "base/text/format_number.h"
#include "io/table/csv.h"
#include "tests/jobs/study_program.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::drop_seconds;
using test::JsonTree;
using test::NoiseStudyFiles;
using test::Outcome;
using test::read_folder;
using test::run_program;
using test::StudyProgram;
namespace fs = std::filesystem;

constexpr int kFits = 12;
constexpr double kScales[] = {0.1, 1.0};
const std::vector<std::string> kParameters = {"front_stiffness", "rear_stiffness"};

/// A study that has run, made once; tests that change it take a copy.
const StudyProgram<NoiseStudyFiles>& get_study() {
  static const StudyProgram<NoiseStudyFiles> files;
  static const StudyProgram<NoiseStudyFiles>& made = test::require_run(files);
  return made;
}

/// `noise.scales` by scale.
const JsonTree& find_scale(const JsonTree& results, double scale) {
  for (const auto& [none, point] : results.get_child("noise.scales")) {
    if (point.get<double>("scale") == scale) return point;
  }
  throw std::runtime_error("no such scale");
}

CsvTable read_fits(double scale) {
  return read_csv(get_study() / ("made/noise/fits_" + format_number(scale) + ".csv"));
}

double calc_rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<double> list_errors(const CsvTable& fits, const std::string& parameter) {
  std::vector<double> errors = fits.column(parameter + "_fit").values;
  const std::vector<double>& truth = fits.column(parameter).values;
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= truth[i];
  return errors;
}

TEST_CASE("Networks with noise err as evaluate says", "[io][slow]") {
  const fs::path root = get_study() / "made";
  const JsonTree results = test::read_results(root);
  struct Kind {
    std::string name, sweep, key;
  };
  const Kind kinds[] = {{"free_length", "free_length_90", "snapshot.free_length"},
                        {"trimmed", "trimmed_90", "snapshot.trimmed"},
                        {"window", "trimmed_window", "window"}};
  for (const double scale : kScales) {
    for (const Kind& kind : kinds) {
      const std::string model =
          (root / "models" / ("noise_" + kind.name + "_" + format_number(scale) + ".h5")).string();
      const JsonTree evaluated =
          test::parse_json(run_program("evaluate " + model + " " +
                                       (root / "sweeps" / kind.sweep).string() + " --json")
                               .out);
      for (const std::string& p : kParameters) {
        CHECK(find_scale(results, scale)
                  .get<double>("parameters." + p + "." + kind.key + ".network") ==
              evaluated.get<double>("parameters." + p + ".RMSE"));
      }
    }
  }
}

TEST_CASE("Bounds of snapshots are those of strut design and proportional to the noise",
          "[io][slow]") {
  const fs::path root = get_study() / "made";
  const JsonTree results = test::read_results(root);
  for (const std::string preload : {"free_length", "trimmed"}) {
    const CsvTable bounds = read_csv(root / "noise" / ("bounds_" + preload + ".csv"));
    REQUIRE(bounds.row_count() == kFits);
    std::string at;
    for (const std::string& p : kParameters) {
      at += (at.empty() ? "" : ",") + p + "=" + format_number(bounds.column(p).values[3]);
    }
    const JsonTree design =
        test::parse_json(run_program("design " + (root / "base" / (preload + "_90.toml")).string() +
                                     " --at " + at + " --json")
                             .out);
    for (const std::string& p : kParameters) {
      const double percent = design.get<double>("snapshot.parameters." + p + ".percent");
      const double bound = bounds.column(p + "_bound").values[3];
      CHECK(bound == Approx(0.01 * percent * bounds.column(p).values[3]).epsilon(1e-9));
      const double rms = calc_rms(bounds.column(p + "_bound").values);
      for (const double scale : kScales) {
        CHECK(find_scale(results, scale)
                  .get<double>("parameters." + p + ".snapshot." + preload + ".bound") ==
              Approx(scale * rms));
      }
    }
  }
}

TEST_CASE("Bounds of windows are nearly proportional to the noise", "[property][slow]") {
  const CsvTable weak = read_fits(0.1), real = read_fits(1.0);
  CHECK(weak.column("case").values == real.column("case").values);
  for (const std::string& p : kParameters) {
    CHECK(weak.column(p).values == real.column(p).values);
    for (std::size_t i = 0; i < kFits; ++i) {
      // Priors of hit time, speed and biases weigh more beside more noise: 2e-3 here.
      const double ratio =
          real.column(p + "_bound").values[i] / weak.column(p + "_bound").values[i];
      CHECK(ratio == Approx(10.0).epsilon(0.01));
      CHECK(ratio < 10.0);
    }
  }
}

TEST_CASE("Fits of a study err by their bounds", "[statistical][slow]") {
  const JsonTree results = test::read_results(get_study() / "made");
  for (const double scale : kScales) {
    const CsvTable fits = read_fits(scale);
    REQUIRE(fits.row_count() == kFits);
    const JsonTree& point = find_scale(results, scale);
    double sum = 0.0, chi2 = 0.0, bias = 0.0;
    for (const std::string& p : kParameters) {
      const std::vector<double> errors = list_errors(fits, p);
      const std::vector<double>& bounds = fits.column(p + "_bound").values;
      for (std::size_t i = 0; i < kFits; ++i) {
        const double z = errors[i] / bounds[i];
        sum += z * z;
        bias += z;
      }
      const JsonTree& window = point.get_child("parameters." + p + ".window");
      CHECK(window.get<double>("fit") == Approx(calc_rms(errors)).epsilon(1e-12));
      CHECK(window.get<double>("bound") == Approx(calc_rms(bounds)).epsilon(1e-12));
    }
    for (const double value : fits.column("chi2_per_degree").values) chi2 += value / kFits;
    // 24 squares of standard normal numbers, correlated in pairs at worst: 24 +- 4 sqrt(96).
    CHECK(sum > 4.0);
    CHECK(sum < 64.0);
    CHECK(std::abs(bias) < 4.0 * std::sqrt(48.0));
    // 251 times, two channels, 12 records.
    CHECK(chi2 == Approx(1.0).margin(4.0 * std::sqrt(2.0 / (502.0 * kFits))));
    CHECK(point.get<double>("chi2_per_degree") == Approx(chi2).epsilon(1e-12));
    CHECK(point.get<int>("converged") == kFits);
  }
}

TEST_CASE("The spread is the standard deviation of an axis' levels", "[io][slow]") {
  const JsonTree results = test::read_results(get_study() / "made");
  // Ten levels 500 apart: 500 sqrt(99 / 12).
  CHECK(results.get<double>("noise.grid_spread.front_stiffness") ==
        Approx(500.0 * std::sqrt(8.25)).epsilon(1e-12));
}

TEST_CASE("A window tells more than a snapshot with the same preload", "[property][slow]") {
  const JsonTree results = test::read_results(get_study() / "made");
  for (const double scale : kScales) {
    for (const std::string& p : kParameters) {
      const JsonTree& errors = find_scale(results, scale).get_child("parameters." + p);
      CHECK(errors.get<double>("window.bound") < errors.get<double>("snapshot.trimmed.bound"));
    }
  }
}

TEST_CASE("noise.csv has a line for every number of the noise section", "[io][slow]") {
  const fs::path root = get_study() / "made";
  const JsonTree results = test::read_results(root);
  std::ifstream stream(root / "noise.csv");
  std::string line;
  std::getline(stream, line);
  CHECK(line == "scale,parameter,unit,preload,measurement,quantity,value");
  int numbers = 0;
  while (std::getline(stream, line)) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string part; std::getline(parts, part, ',');) cells.push_back(part);
    REQUIRE(cells.size() == 7);
    const JsonTree& errors =
        find_scale(results, std::stod(cells[0])).get_child("parameters." + cells[1]);
    std::string value;
    if (cells[4] == "grid") {
      value = results.get<std::string>("noise.grid_spread." + cells[1]);
    } else {
      const std::string key = cells[4] == "snapshot" ? "snapshot." + cells[3] : cells[4];
      value = errors.get<std::string>(key + "." + cells[5]);
    }
    CHECK(cells[6] == value);
    ++numbers;
  }
  CHECK(numbers == 2 * 2 * (2 + 2 + 3 + 1));
}

TEST_CASE("A report of a study with noise computes nothing and repeats its bytes", "[io][slow]") {
  const fs::path root = get_study().copy("reported");
  const auto before = read_folder(root);
  for (const char* name : {"results.json", "noise.csv", "report.html", "figures/noise.json"}) {
    REQUIRE(fs::remove(root / name));
  }
  std::ofstream(root / "results.json") << "{\"noise\": ";  // as a full disk leaves it
  CHECK(run_program("report " + root.string()).code == 0);
  CHECK(read_folder(root) == before);
  CHECK_THAT(before.at("report.html"), Contains("Sensor noise") && Contains("imu_rate_y"));
}

TEST_CASE("Bounds and fits that are lost or damaged are computed anew, others kept", "[io][slow]") {
  const fs::path root = get_study().copy("lost");
  const auto before = read_folder(root);
  fs::remove(root / "noise/fits_1.csv");
  const Outcome none = run_program("report " + root.string());
  CHECK(none.code == 2);
  CHECK_THAT(none.messages, Contains("fits_1.csv"));
  const Outcome again = get_study().run("--threads 1", "lost");
  CHECK(again.code == 0);
  CHECK_THAT(again.messages, Contains("0 networks trained"));
  CHECK(drop_seconds(root) == drop_seconds(get_study() / "made"));
  CHECK(test::read_text(root / "noise/fits_0.1.csv") == before.at("noise/fits_0.1.csv"));
  std::ofstream(root / "noise/bounds_trimmed.csv") << "case,front_stiffness\n1,nonsense\n";
  const Outcome damaged = run_program("report " + root.string());
  CHECK(damaged.code == 2);
  CHECK_THAT(damaged.messages, Contains("bounds_trimmed.csv: no column"));
  const Outcome mended = get_study().run("", "lost");
  CHECK(mended.code == 0);
  CHECK_THAT(mended.messages, Contains("bounds_trimmed.csv: computed anew"));
  CHECK(test::read_text(root / "noise/bounds_trimmed.csv") ==
        before.at("noise/bounds_trimmed.csv"));
}

TEST_CASE("Bounds of other cases are computed anew", "[io][slow]") {
  const fs::path root = get_study().copy("other"), file = root / "noise/bounds_trimmed.csv";
  const std::string before = test::read_text(file);
  const std::size_t units = before.find('\n') + 1, row = before.find('\n', units) + 1;
  const std::size_t end = before.find(',', row);
  std::ofstream(file) << before.substr(0, row) + "9999" + before.substr(end);
  const Outcome again = get_study().run("", "other");
  CHECK(again.code == 0);
  CHECK_THAT(again.messages,
             Contains("bounds_trimmed.csv: computed anew: it belonged to other cases"));
  CHECK(test::read_text(file) == before);
}

TEST_CASE("A study that is stopped among its fits goes on to the same numbers", "[io][slow]") {
  const fs::path root = get_study().copy("stopped");
  fs::remove(root / "noise/fits_0.1.csv");
  fs::remove(root / "noise/fits_1.csv");
  fs::remove(root / "results.json");
  const Outcome stopped = test::run_shell(
      "bash -c '" STRUT_PROGRAM " study " + (get_study() / "study.toml").string() + " -o " +
      root.string() + " --threads 1 & while [ ! -f " + (root / "noise/fits_0.1.csv").string() +
      " ]; do sleep 0.01; done; kill -TERM $!; wait $!'");
  CHECK(stopped.code == 143);
  CHECK_FALSE(fs::exists(root / "results.json"));
  CHECK_FALSE(fs::exists(root / "noise/fits_1.csv"));
  CHECK(get_study().run("--threads 1", "stopped").code == 0);
  CHECK(drop_seconds(root) == drop_seconds(get_study() / "made"));
}

TEST_CASE("A study keeps a copy of its windows' sweep", "[io][slow]") {
  const StudyProgram<NoiseStudyFiles> files;
  const fs::path root = files / "made";
  fs::copy(get_study() / "made", root, fs::copy_options::recursive);
  CHECK(files.run().code == 0);  // the same sweep in another folder
  std::string text = test::kWindows;
  text.replace(text.find("20.5"), 4, "20.4");
  files.write_sweep("windows.toml", text);
  const Outcome changed = files.run();
  CHECK(changed.code == 2);
  CHECK_THAT(changed.messages, Contains("noise.window_sweep.grid[3]: was speed"));
  fs::remove(files / "windows.toml");
  CHECK(run_program("report " + root.string()).code == 0);
}

TEST_CASE("A fault in a noise section is refused before a folder is made", "[io]") {
  const StudyProgram<NoiseStudyFiles> files;
  const Outcome outcome = files.run_file(files.change("[0.3, 1.3]", "[0.3, 3.0]"), "never");
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("study2.toml") && Contains("must begin before it ends"));
  CHECK_FALSE(fs::exists(files / "never"));
}

}  // namespace
}  // namespace strut
