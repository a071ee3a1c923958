// The report of a sweep: what it counts and draws is what the shards hold.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "io/store/dataset.h"
#include "tests/jobs/check_page.h"
#include "tests/jobs/program_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using test::ProgramSweep;
using test::run_sweep_command;

/// A line of a chart's table; no comma stands in a name here.
struct Point {
  std::string panel, series, category;
  std::map<std::string, double> values;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cell.erase(std::remove(cell.begin(), cell.end(), '"'), cell.end());
    cells.push_back(cell);
  }
  return cells;
}

std::vector<Point> read_chart(const fs::path& sweep, const std::string& name) {
  std::istringstream table(test::read_text(sweep / "figures" / (name + ".csv")));
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> header = split(line);
  std::vector<Point> points;
  while (std::getline(table, line)) {
    const std::vector<std::string> cells = split(line);
    Point point;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (header[c] == "panel") point.panel = cells[c];
      if (header[c] == "series") point.series = cells[c];
      if (header[c] == "category") point.category = cells[c];
      if (c >= 2 && header[c] != "category" && !cells[c].empty()) {
        point.values[header[c]] = std::stod(cells[c]);
      }
    }
    points.push_back(std::move(point));
  }
  return points;
}

/// Cases of a series, summed over each panel of the coverage.
std::set<double> sum_panels(const std::vector<Point>& points, const std::string& series) {
  std::map<std::string, double> sums;
  for (const Point& point : points) {
    if (point.series == series) sums[point.panel] += point.values.at("y");
  }
  std::set<double> values;
  for (const auto& [panel, sum] : sums) values.insert(sum);
  return values;
}

test::JsonTree read_status(const fs::path& sweep) {
  return test::parse_json(run_sweep_command("status", sweep, "--json").out);
}

TEST_CASE("A sweep's report counts every case in each panel, and failures by their reasons",
          "[io]") {
  const ProgramSweep planned(test::make_failing_sweep(), 1);
  const fs::path sweep = planned / "whole";
  // As a shell completes it.
  const auto outcome = run_sweep_command("report", sweep.string() + "/");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const auto status = read_status(sweep);
  const auto failed = status.get<double>("failed");
  REQUIRE(failed > 0.0);
  const auto coverage = read_chart(sweep, "coverage");
  CHECK(sum_panels(coverage, "simulated") == std::set<double>{24.0});
  CHECK(sum_panels(coverage, "failed") == std::set<double>{failed});

  std::map<std::string, double> told, drawn;
  for (const auto& [reason, count] : status.get_child("failures")) {
    told[reason] = count.get_value<double>();
  }
  for (const Point& point : read_chart(sweep, "failures")) {
    drawn[point.category] = point.values.at("y");
  }
  CHECK(drawn == told);

  const std::string page = test::read_text(sweep / "report.html");
  CHECK_THAT(page, Contains("<title>Sweep whole</title>") && !Contains("Not complete") &&
                       Contains(fmt::format(">complete, {:.0f} failed<", failed)));
  // Coverage, failures, two channels; no car at the middle of this grid, so no sensitivities.
  test::check_page((sweep / "report.html").string(), 4);
  CHECK_THAT(page, Contains("Could not be calculated"));
}

TEST_CASE("A report's bands are quantiles of the cases on each level", "[io]") {
  const ProgramSweep planned(test::make_coarse_sweep(7));
  const fs::path sweep = planned / "whole";
  REQUIRE(run_sweep_command("report", sweep).code == 0);
  // Coverage, two channels, bounds and sensitivities.
  test::check_page((sweep / "report.html").string(), 5);

  Dataset dataset({sweep});
  const ShardRows rows = dataset.read(0, dataset.row_count());
  const std::size_t columns = dataset.schema().parameters.size();
  std::map<double, std::vector<double>> levels;  // front stiffness -> heights
  for (std::size_t i = 0; i < rows.size(); ++i) {
    levels[rows.parameters[i * columns]].push_back(
        rows.snapshot[i * dataset.schema().snapshot.size()]);
  }
  REQUIRE(levels.size() == 4);
  std::size_t medians = 0, bands = 0;
  for (const Point& point : read_chart(sweep, "channel_body_position_z")) {
    if (point.panel.find("over front stiffness") == std::string::npos) continue;
    REQUIRE(levels.count(point.values.at("x")) == 1);
    const auto& heights = levels[point.values.at("x")];
    const auto count_below = [&heights](double height) {
      return std::count_if(heights.begin(), heights.end(), [&](double h) { return h < height; });
    };
    if (point.series == "median") {
      ++medians;
      CHECK(count_below(point.values.at("y")) == 6);  // among 12
    } else {
      ++bands;
      CHECK(count_below(point.values.at("low")) == 1);
      CHECK(count_below(point.values.at("high")) == 10);
    }
  }
  CHECK(medians == levels.size());
  CHECK(bands == levels.size());
}

TEST_CASE("A report's histories are quantiles of the cases at each instant", "[io]") {
  const ProgramSweep planned(
      test::make_coarse_sweep(7, "history = { rate = 50, channels = [\"pitch_angle\"] }"));
  const fs::path sweep = planned / "whole";
  REQUIRE(run_sweep_command("report", sweep).code == 0);
  Dataset dataset({sweep}, {.histories = true});
  const ShardRows rows = dataset.read(0, dataset.row_count());
  const ShardSchema& schema = dataset.schema();
  std::size_t medians = 0;
  for (const Point& point : read_chart(sweep, "histories")) {
    const auto sample =
        static_cast<std::size_t>(std::lround(point.values.at("x") / schema.history_interval));
    const auto check = [&](const char* value, double fraction) {
      std::size_t below = 0, up_to = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double recorded = rows.history[0][i * schema.history_samples + sample];
        below += recorded < point.values.at(value) ? 1 : 0;
        up_to += recorded <= point.values.at(value) ? 1 : 0;
      }
      const double wanted = fraction * static_cast<double>(rows.size() - 1);
      CHECK(static_cast<double>(below) <= wanted + 0.5);
      CHECK(static_cast<double>(up_to) >= wanted - 0.5);
    };
    if (point.series == "median") {
      check("y", 0.5);
      ++medians;
    } else {
      check("low", 0.05);
      check("high", 0.95);
    }
  }
  CHECK(medians == schema.history_samples);
}

TEST_CASE("The report of a part of a sweep says so, and counts what is there", "[io]") {
  const ProgramSweep planned(test::make_coarse_sweep(10));
  const fs::path sweep = planned.copy("part");
  REQUIRE(run_sweep_command("run", sweep, "--shards 0:2").code == 0);
  REQUIRE(run_sweep_command("report", sweep).code == 0);
  CHECK_THAT(test::read_text(sweep / "report.html"),
             Contains("Not complete") && Contains("strut run " + sweep.string()));
  CHECK(sum_panels(read_chart(sweep, "coverage"), "simulated") == std::set<double>{20.0});
}

}  // namespace
}  // namespace strut
