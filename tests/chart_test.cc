// Charts in their three forms, pages that show them, and a car in motion.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "io/atomic_file.h"
#include "jobs/report/chart_csv.h"
#include "jobs/report/figures.h"
#include "jobs/report/gnuplot.h"
#include "jobs/report/plotly.h"
#include "tests/check_page.h"
#include "tests/parse_json.h"
#include "tests/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const double kNan = std::nan("");

/// A chart with a series of every kind but those of three dimensions, and names that need care.
Chart make_plain_chart() {
  Chart chart{"plain", {}, 2};
  chart.caption = "Every <kind>";
  chart.panels = {
      {{"x [m]"},
       {"y's \"label\" [N]"},
       {{"line", SeriesKind::kLine, 1, {0.0, 1.0, 2.0}, {0.1, kNan, -2e-9}},
        {"dashed", SeriesKind::kDashedLine, kInk, {0.0, 2.0}, {1.0, 2.0}},
        {"band", SeriesKind::kBand, 6, {0.0, 1.0}, {}, {0.0, 0.1}, {1.0, 1.1}}},
       "Title </script>"},
      {{"", false, {"a", "b's"}, {0.5, 2.5}},
       {"log", true},
       {{"bars", SeriesKind::kBars, 3, {1.0, 2.0}, {10.0, 20.0}, {5.0, 15.0}, {20.0, 30.0}},
        {"line", SeriesKind::kPoints, 1, {1.0, 2.0}, {12.0, 2.0}}}},
      {{"", false, {"one"}},
       {"boxes", true},
       {{"", SeriesKind::kBoxes, 1, {1.0, 1.0, 1.0, 1.0}, {1.0, 2.0, 3.0, 400.0}}}},
      {{"nothing"}, {""}, {{"empty", SeriesKind::kLinePoints, 2}}},
      {{"x"}, {"no logarithm", true}, {{"zero", SeriesKind::kBars, 4, {1.0, 2.0}, {0.0, 0.0}}}}};
  return chart;
}

Chart make_deep_chart() {
  ChartSeries points{"points", SeriesKind::kPoints3d, 2, {1.0, 2.0, 3.0}, {4.0, 5.0, 7.0}};
  points.z = {0.1, 0.2, 0.4};
  points.marker = Marker::kCross;
  return {"deep", {{{"a"}, {"b"}, {points}, "deep", {"c"}}}};
}

TEST_CASE("Every series of a chart becomes a trace with its numbers", "[unit]") {
  const auto json = test::parse_json(make_plotly(make_plain_chart()).dump());
  const auto& data = json.get_child("data");
  REQUIRE(data.size() == 8);
  auto trace = data.begin();
  CHECK(trace->second.get<std::string>("yaxis") == "y");
  auto y = trace->second.get_child("y").begin();
  CHECK((y++)->second.data() == "0.1");
  CHECK((y++)->second.data() == "null");  // a gap
  CHECK(std::stod((y++)->second.data()) == -2e-9);
  std::advance(trace, 3);
  CHECK(trace->second.get<std::string>("type") == "bar");
  CHECK(trace->second.get<std::string>("xaxis") == "x2");
  CHECK(trace->second.get_child("error_y.array").begin()->second.data() == "10");
  CHECK(trace->second.get_child("error_y.arrayminus").begin()->second.data() == "5");
  ++trace;
  CHECK(trace->second.get<std::string>("name") == "line");
  CHECK(trace->second.get<std::string>("showlegend") == "false");  // it is there already
  CHECK(json.get<std::string>("layout.yaxis2.type") == "log");
  CHECK(json.get<std::string>("three_d") == "false");
}

TEST_CASE("Panels of a chart lie inside it and apart from each other", "[unit]") {
  Chart chart = make_plain_chart();
  chart.width = 620;
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    const PanelPlace a = calc_place(chart, p);
    CHECK(0.0 < a.left);
    CHECK(a.left < a.right);
    CHECK(a.right < 1.0);
    CHECK(0.0 < a.bottom);
    CHECK(a.bottom < a.top);
    CHECK(a.top < 1.0);
    for (std::size_t q = 0; q < p; ++q) {
      const PanelPlace b = calc_place(chart, q);
      CHECK((b.right < a.left || a.right < b.left || a.top < b.bottom || b.top < a.bottom));
    }
  }
}

TEST_CASE("A chart's numbers read back from its table", "[unit]") {
  std::istringstream table(make_chart_csv(make_plain_chart()));
  std::string line;
  std::getline(table, line);
  CHECK(line == "panel,series,x,y,low,high");
  std::vector<std::string> lines;
  while (std::getline(table, line)) lines.push_back(line);
  REQUIRE(lines.size() == 3 + 2 + 2 + 2 + 2 + 4 + 2);
  const std::string panel = "\"Title </script>: y's \"\"label\"\" [N] over x [m]\"";
  CHECK(lines[0] == panel + ",\"line\",0,0.1,,");
  CHECK(lines[1] == panel + ",\"line\",1,,,");
  CHECK(lines[2] == panel + ",\"line\",2,-2e-09,,");
  CHECK(lines[6] == panel + ",\"band\",1,,0.1,1.1");
}

TEST_CASE("gnuplot draws every kind of series", "[io]") {
  if (!has_gnuplot()) {
    WARN("gnuplot is not there; not checked");
    return;
  }
  const TemporaryFolder folder;
  for (const Chart& chart : {make_plain_chart(), make_deep_chart()}) {
    write_text_file(folder / (chart.name + ".gp"), make_gnuplot(chart));
    draw_picture(folder / "", chart.name);
    const std::string picture = test::read_text(folder / (chart.name + ".svg"));
    CHECK_THAT(picture, Contains("</svg>"));
    for (const ChartSeries* entry : chart.list_legend()) {
      CHECK_THAT(picture, Contains(">" + entry->name + "<"));
    }
  }
}

TEST_CASE("A picture that gnuplot cannot draw is told with gnuplot's words", "[io]") {
  if (!has_gnuplot()) {
    WARN("gnuplot is not there; not checked");
    return;
  }
  const TemporaryFolder folder;
  write_text_file(folder / "broken.gp", "set terminal svg\nplot nonsense(\n");
  CHECK_THROWS_WITH(draw_picture(folder / "", "broken"), Contains("broken.gp"));
  CHECK_FALSE(fs::exists(folder / "broken.svg"));
  CHECK(folder.file_count() == 1);
}

TEST_CASE("A page shows charts of all kinds, flat and deep, and fetches nothing", "[io]") {
  const TemporaryFolder folder;
  const FigureDrawer drawer(folder / "figures");
  ReportSection section{"Charts </section>"};
  drawer.draw_all({make_plain_chart(), make_deep_chart()}, section);
  const ReportPage page{"Charts", {"Two of them."}, {section}, make_report_footer()};
  const std::string text = make_html(page);
  write_text_file(folder / "page.html", text);
  test::check_page(folder / "page.html", 2);
  CHECK_THAT(text, Contains("Every &lt;kind&gt;") && Contains("Title \\u003c/script>"));
  CHECK_THAT(text,
             Contains("href=\"figures/plain.csv\"") && Contains("Permission is hereby granted"));
  for (const char* name : {"plain.csv", "deep.csv", "plain.json", "deep.gp"}) {
    CHECK(fs::exists(folder / ("figures/" + std::string(name))));
  }
}

TEST_CASE("The button of a chart saves its numbers", "[io]") {
  const TemporaryFolder folder;
  const FigureDrawer drawer(folder / "figures");
  ReportSection section{"Charts"};
  Chart chart = make_plain_chart();
  chart.panels.resize(2);
  chart.panels[0].title = "";  // its tag is no end of the script below
  drawer.draw_all({chart}, section);
  std::string text = make_html({"Charts", {}, {section}, ""});
  // A page that complains where its function says anything else.
  text.insert(text.rfind("</body>"), R"(<script>
const wanted = ["panel,series,x,y,z,below,above", '"y\'s ""label"" [N] over x [m]","line",0,0.1,,,',
                '"y\'s ""label"" [N] over x [m]","line",1,,,,'];
const last = ['"log over ","bars",2,20,,5,10', '"log over ","line",1,12,,,', '"log over ","line",2,2,,,', ""];
const lines = makeCsv()" + make_plotly(chart).dump() +
                                         R"().split("\n");
if (JSON.stringify(lines.slice(0, 3)) !== JSON.stringify(wanted)) console.error(lines.slice(0, 3));
if (JSON.stringify(lines.slice(-4)) !== JSON.stringify(last)) console.error(lines.slice(-4));
</script>
)");
  write_text_file(folder / "page.html", text);
  test::check_page(folder / "page.html", 1);
}

TEST_CASE("A page without charts carries no library", "[unit]") {
  const std::string text = make_html({"Words", {"Only words."}, {{"One"}}, "footer"});
  CHECK_THAT(text, !Contains("<script") && !Contains("plotly"));
  CHECK(text.size() < 10000);
}

TEST_CASE("A simulated run's report shows the car in motion beside its curves", "[io]") {
  const TemporaryFolder folder;
  const std::string out = folder / "report";
  const test::Outcome run = test::run_program(
      "simulate examples/vehicles/paper_sedan.toml examples/maneuvers/bump_20mps.toml -o " +
      std::string(folder / "run.csv") + " --report " + out);
  REQUIRE(run.code == 0);
  test::check_page(out + "/report.html", 1);

  const auto scene = test::parse_json(test::read_text(out + "/figures/motion.json"));
  const auto list = [&](const char* key) {
    std::vector<double> values;
    for (const auto& [name, value] : scene.get_child(key))
      values.push_back(std::stod(value.data()));
    return values;
  };
  // Table 1 of the paper has the distances in millimeters.
  CHECK(list("front.wheel")[0] - list("rear.wheel")[0] ==
        Approx(0.7209 + 2.0791).margin(test::tolerance(1e-4)));
  // The car starts with its torque on, which lifts the nose by a few millimeters; wheels stay.
  const double wheel =
      std::stod(scene.get_child("wheel_height").front().second.front().second.data());
  CHECK(wheel == Approx(scene.get<double>("nominal_height") + list("front.wheel")[1])
                     .margin(test::tolerance(2e-3)));
  CHECK(list("time").size() == list("height").size());

  const std::string before = test::read_text(out + "/report.html");
  fs::remove(out + "/report.html");
  CHECK(test::run_program("report " + out).code == 0);
  CHECK(test::read_text(out + "/report.html") == before);
}

}  // namespace
}  // namespace strut
