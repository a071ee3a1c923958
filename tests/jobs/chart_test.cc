// Charts in their three forms, pages that show them, and a car in motion.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

#include "io/file/atomic_file.h"
#include "jobs/simulate/motion.h"
#include "report/chart_csv.h"
#include "report/figures.h"
#include "report/plotly.h"
#include "tests/jobs/check_page.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/tolerance.h"

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

/// Points that a scale of values colors.
Chart make_valued_chart() {
  ChartSeries points{"points", SeriesKind::kPoints, 2, {1.0, 2.0, 3.0}, {4.0, 5.0, 7.0}};
  points.value = {0.1, 0.2, 0.4};
  points.marker = Marker::kCross;
  return {"valued", {{{"a"}, {"b"}, {points}, "valued", "c [m]"}}};
}

std::string add_script(std::string page, const std::string& script) {
  return page.insert(page.rfind("</body>"), "<script>" + script + "</script>\n");
}

/// Complains of a picture of the car that its motion denies; y of a picture points down. check_page
/// counts the paragraph as a motion, which is drawn when the script has come to its end.
constexpr const char* kCheckMotion = R"(</script><p class="motion"></p><script>
const waiting = setInterval(() => {
  const root = document.querySelector("div.motion[data-motion]");
  if (!root) return;
  clearInterval(waiting);
  const scene = JSON.parse(root.querySelector("script").textContent);
  const findScale = (at) => at.querySelector("select[aria-label^='how much']");
  const [slider, scale] = [root.querySelector("input"), findScale(root)];
  const expect = (holds, ...words) => holds || console.error(slider.value, scale.value, ...words);
  const isNear = (a, b, width) => Math.abs(a - b) < width;
  const readPoints = (shape) => shape.getAttribute("points").trim().split(" ").map((p) => p.split(",").map(Number));
  // Center and radius of a tire, which is flat where it stands on the road.
  const readWheel = (rim) => {
    const points = readPoints(rim), xs = points.map(([x]) => x), ys = points.map(([, y]) => y);
    const radius = 0.5 * (Math.max(...xs) - Math.min(...xs));
    return [0.5 * (Math.max(...xs) + Math.min(...xs)), Math.min(...ys) + radius, radius];
  };
  const isDashed = (shape) => shape.hasAttribute("stroke-dasharray");
  const read = (at = root) => {
    const side = at.querySelector("svg");
    const rims = [...side.querySelectorAll(".rim")];
    const [road, ...springs] = [...side.querySelectorAll("polyline")];
    return {wheels: rims.map(readWheel), dashed: [road, ...rims].map(isDashed), road: readPoints(road),
            springs: springs.map(readPoints), body: readPoints(side.querySelector("polygon"))};
  };
  const show = (frame, times) => {
    scale.value = times;
    scale.dispatchEvent(new Event("change"));
    slider.value = frame;
    slider.dispatchEvent(new Event("input"));
    return read();
  };
  const measure = (spring) => Math.hypot(...spring.at(-1).map((value, axis) => value - spring[0][axis]));

  const first = read(), start = Number(slider.value);
  expect(first.wheels.length === 4 && first.springs.length === 4, "shapes");
  expect(JSON.stringify(first.dashed) === "[false,true,false,true,false]", "left wheels are beyond", first.dashed);
  expect(scene.time[start] >= scene.snapshot_time && scene.time[start - 1] < scene.snapshot_time, "instant");
  // As many frames as there are samples, a thousand a second.
  expect(scene.time[start] - scene.time[start - 1] < 1.001e-3, "frames are dense about the bump");
  // The snapshot is taken with the rear wheels on the bump's top: within a frame, 20 mm of way.
  const top = first.road.reduce((a, b) => b[1] < a[1] ? b : a);
  const rear = Math.min(...first.wheels.map(([x]) => x));
  expect(isNear(rear, top[0], 0.025), "rear wheels are on the bump", rear, top);
  const findRoad = (x) => {
    const i = first.road.findIndex(([at]) => at > x);
    const [[x0, y0], [x1, y1]] = [first.road[i - 1], first.road[i]];
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
  };
  for (const rim of root.querySelectorAll("svg:not(.axle) .rim")) {
    for (const [x, y] of readPoints(rim)) expect(y < findRoad(x) + 2e-3, "tires do not sink into the road", x, y);
  }
  for (const [x, y, r] of first.wheels) {
    const ground = isNear(x, rear, 0.01) ? top[1] : 0;
    expect(y + r > ground && y + r < ground + 0.05, "tires are pressed onto the road", x, y + r, ground);
  }
  const views = [...root.querySelectorAll("svg.axle")];
  const [ahead, behind] = views.map((view) => [...view.querySelectorAll("rect")].map((rect) => Number(rect.getAttribute("x"))));
  expect(isNear(ahead[0] - ahead[1], 2 * scene.front.half_track, 1e-6), "left is right from the front", ahead);
  expect(isNear(behind[1] - behind[0], 2 * scene.rear.half_track, 1e-6), "left is left from behind", behind);
  // A link keeps its length as far as the wheel moves straight up.
  for (const [view, axle] of [[views[0], scene.front], [views[1], scene.rear]]) {
    const read = (shape, name) => Number(shape.getAttribute(name));
    const links = [...view.querySelectorAll("line")].filter((shape) => shape.getAttribute("stroke-width") === "0.018");
    expect(links.length === 2 * axle.links.length && links.length > 0, "links", links.length);
    links.forEach((shape, i) => {
      const [inner, outer] = axle.links[i % axle.links.length];
      const drawn = Math.hypot(read(shape, "x2") - read(shape, "x1"), read(shape, "y2") - read(shape, "y1"));
      expect(isNear(drawn, Math.hypot(outer[1] - inner[1], outer[2] - inner[2]), 0.02), "length of a link", i, drawn);
    });
  }

  const down = scene.pitch.indexOf(Math.max(...scene.pitch));
  expect(scene.pitch[down] > 0.005, "pitch");
  const dive = show(down, 1).body;
  const slope = (dive.at(-1)[1] - dive[0][1]) / (dive.at(-1)[0] - dive[0][0]);
  expect(isNear(slope, Math.tan(scene.pitch[down]), 1e-4), "nose down", slope, scene.pitch[down]);

  // Enlarged about the first instant; lines are drawn to a tenth of a millimeter.
  const enlarge = (values, times) => values[0] + times * (values[down] - values[0]);
  for (const times of [1, 3, 10]) {
    const shown = show(down, times);
    for (let corner = 0; corner < 4; ++corner) {
      const axle = corner < 2 ? scene.front : scene.rear;
      const length = Math.hypot(axle.lower[0] - axle.upper[0], axle.lower[1] - axle.upper[1]);
      expect(isNear(shown.wheels[corner][1], -enlarge(scene.wheel_height[corner], times), 2e-4), "wheel", corner);
      expect(isNear(measure(shown.springs[corner]), length - enlarge(scene.deflection[corner], times), 3e-4), "spring", corner);
    }
  }

  // A travel that enlarged would be longer than the spring: it stays below its mount.
  const deep = document.createElement("div");
  const text = document.createElement("script");
  text.type = "application/json";
  const far = scene.deflection.map((values) => values.map((value, frame) => value + (frame === start ? 0.2 : 0)));
  text.textContent = JSON.stringify({...scene, deflection: far});
  deep.append(text);
  new MotionView(deep);
  const choice = findScale(deep);
  choice.value = 10;
  choice.dispatchEvent(new Event("change"));
  for (const spring of read(deep).springs) expect(spring[0][1] < spring.at(-1)[1], "springs hang below their mounts");

  document.querySelector("p.motion").dataset.motion = "drawn";
}, 50);
)";

TEST_CASE("Every series of a chart becomes a trace with its numbers", "[unit]") {
  const auto json = test::parse_json(format_json(make_plotly(make_plain_chart())));
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
  CHECK(trace->second.get_child("error_y.array").begin()->second.data() == "10.0");
  CHECK(trace->second.get_child("error_y.arrayminus").begin()->second.data() == "5.0");
  ++trace;
  CHECK(trace->second.get<std::string>("name") == "line");
  CHECK(trace->second.get<std::string>("showlegend") == "false");  // it is there already
  CHECK(json.get<std::string>("layout.yaxis2.type") == "log");
}

TEST_CASE("Points with values are colored by a scale beside their panel", "[unit]") {
  const auto json = test::parse_json(format_json(make_plotly(make_valued_chart())));
  const auto& trace = json.get_child("data").front().second;
  CHECK(trace.get_child("marker.color").back().second.data() == "0.4");
  const auto& bar = trace.get_child("marker.colorbar");
  CHECK(bar.get<std::string>("title.text") == "c [m]");
  CHECK(bar.get<double>("x") == calc_place(make_valued_chart(), 0).right);
  CHECK_THAT(make_chart_csv(make_valued_chart()), Contains("panel,series,x,y,value\n"));
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
  CHECK(line == "panel,series,category,x,y,low,high");
  std::vector<std::string> lines;
  while (std::getline(table, line)) lines.push_back(line);
  REQUIRE(lines.size() == 3 + 2 + 2 + 2 + 2 + 4 + 2);
  const std::string panel = "\"Title </script>: y's \"\"label\"\" [N] over x [m]\"";
  CHECK(lines[0] == panel + ",\"line\",\"\",0,0.1,,");
  CHECK(lines[1] == panel + ",\"line\",\"\",1,,,");
  CHECK(lines[2] == panel + ",\"line\",\"\",2,-2e-09,,");
  CHECK(lines[6] == panel + ",\"band\",\"\",1,,0.1,1.1");
  CHECK(lines[8] == "\"log\",\"bars\",\"b's\",2,20,15,30");
}

TEST_CASE("A curve of few points keeps its peaks and its gaps", "[unit]") {
  std::vector<double> x, y;
  for (int i = 0; i < 10000; ++i) {
    x.push_back(0.01 * i);
    y.push_back(std::sin(0.001 * i));
  }
  y[4321] = 7.0;
  y[8642] = -7.0;
  y[5000] = kNan;
  const ChartSeries curve = make_curve("c", SeriesKind::kLine, 1, x, y, 500);
  CHECK(curve.x.size() == curve.y.size());
  CHECK(curve.x.size() > 400);
  CHECK(curve.x.size() <= 501);  // and the gap
  CHECK(std::is_sorted(curve.x.begin(), curve.x.end()));
  std::map<double, double> points;
  for (std::size_t i = 0; i < curve.x.size(); ++i) points[curve.x[i]] = curve.y[i];
  CHECK(points.at(x[4321]) == 7.0);
  CHECK(points.at(x[8642]) == -7.0);
  CHECK(std::isnan(points.at(x[5000])));
  for (const auto& [place, value] : points) {
    CHECK((std::isnan(value) || value == y[static_cast<std::size_t>(std::lround(place / 0.01))]));
  }
  const ChartSeries whole = make_curve("c", SeriesKind::kLine, 1, {0, 1, 2}, {3, 5, 4}, 500);
  CHECK(whole.y == std::vector<double>{3, 5, 4});
}

TEST_CASE("A page shows charts of all kinds and fetches nothing", "[io]") {
  const TemporaryFolder folder;
  const FigureDrawer drawer(Folder(folder / ""));
  ReportSection section{"Charts </section>"};
  drawer.draw_all({make_plain_chart(), make_valued_chart()}, section);
  const ReportPage page{"Charts", {"Two of them."}, {section}, make_report_footer()};
  const std::string text = make_html(page);
  write_text_file(folder / "page.html", text);
  test::check_page(folder / "page.html", 2);
  CHECK_THAT(text, Contains("Every &lt;kind&gt;") && Contains("Title \\u003c/script>"));
  CHECK_THAT(text,
             Contains("href=\"figures/plain.csv\"") && Contains("Permission is hereby granted"));
  for (const char* name : {"plain.csv", "valued.csv", "plain.json", "valued.json"}) {
    CHECK(fs::exists(folder / ("figures/" + std::string(name))));
  }
}

TEST_CASE("The button of a chart saves its numbers", "[io]") {
  const TemporaryFolder folder;
  const FigureDrawer drawer(Folder(folder / ""));
  ReportSection section{"Charts"};
  Chart chart = make_plain_chart();
  chart.panels.resize(2);
  chart.panels[0].title = "";  // its tag is no end of the script below
  drawer.draw_all({chart}, section);
  std::string text = make_html({"Charts", {}, {section}, ""});
  // A page that complains where its function says anything else.
  text = add_script(text, R"(
const wanted = ["panel,series,category,x,y,value,below,above",
                '"y\'s ""label"" [N] over x [m]","line","",0,0.1,,,', '"y\'s ""label"" [N] over x [m]","line","",1,,,,'];
const last = ['"log","bars","b\'s",2,20,,5,10', '"log","line","a",1,12,,,', '"log","line","b\'s",2,2,,,', ""];
const lines = makeCsv()" + format_json(make_plotly(chart)) +
                              R"().split("\n");
if (JSON.stringify(lines.slice(0, 3)) !== JSON.stringify(wanted)) console.error(lines.slice(0, 3));
if (JSON.stringify(lines.slice(-4)) !== JSON.stringify(last)) console.error(lines.slice(-4));
)");
  write_text_file(folder / "page.html", text);
  test::check_page(folder / "page.html", 1);
}

TEST_CASE("A page without charts carries no library", "[unit]") {
  const std::string text = make_html({"Words", {"Only words."}, {{"One"}}, "footer"});
  CHECK_THAT(text, !Contains("<script") && !Contains("plotly"));
  CHECK(text.size() < 10000);
}

std::string make_simulate_command(const std::string& maneuver, const fs::path& run,
                                  const fs::path& report) {
  return "simulate examples/vehicles/paper_sedan.toml examples/maneuvers/" + maneuver +
         ".toml -o " + run.string() + " --report " + report.string();
}

TEST_CASE("A simulated run's report shows the car in motion beside its curves", "[io]") {
  const TemporaryFolder folder;
  const std::string out = folder / "report";
  const test::Outcome run =
      test::run_program(make_simulate_command("bump_20mps", folder / "run.csv", out));
  REQUIRE(run.code == 0);

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

  write_text_file(folder / "page.html", add_script(before, kCheckMotion));
  test::check_page(folder / "page.html", 1);
}

TEST_CASE("A cambered wheel is drawn at the height at which it is simulated", "[io]") {
  const TemporaryFolder folder;
  const std::string out = folder / "report";
  // Without torque a wheel hardly leaves nominal trim; an upright one would stand 1.6 mm higher.
  const test::Outcome run =
      test::run_program(make_simulate_command("bump_20mps", folder / "run.csv", out) +
                        " --set drive_torque=0 --set front_static_camber=0.09");
  REQUIRE(run.code == 0);
  const auto scene = test::parse_json(test::read_text(out + "/figures/motion.json"));
  const auto get_first = [](const auto& tree) { return tree.front().second; };
  const double simulated = std::stod(get_first(get_first(scene.get_child("wheel_height"))).data()) -
                           scene.get<double>("nominal_height");
  const double drawn = std::stod(std::next(scene.get_child("front.wheel").begin())->second.data());
  CHECK(drawn == Approx(simulated).margin(test::tolerance(3e-4)));
}

TEST_CASE("A run beside its report is no part of it", "[io]") {
  const TemporaryFolder folder;
  const std::string simulate = make_simulate_command("one_sided", folder / "run.csv", folder / "");
  REQUIRE(test::run_program(simulate).code == 0);
  CHECK_THAT(test::read_text(folder / "report.html"),
             Contains("over a bump of 50 mm under the left wheels."));
  const auto scene = test::parse_json(test::read_text(folder / "figures/motion.json"));
  CHECK(scene.get_child("road").front().second.size() > 10);  // under the left wheels
  CHECK(scene.get_child("road").back().second.empty());
  CHECK_THAT(test::read_text(folder / "figures/curves.csv"),
             Contains("\"height [m] over time [s]\""));
  const std::string run = test::read_text(folder / "run.csv");
  fs::remove(folder / "figures/motion.json");
  folder.write("figures/motion.svg", "<svg/>\n");

  REQUIRE(test::run_program(simulate + " --force").code == 0);
  CHECK(test::read_text(folder / "run.csv") == run);
  CHECK(test::read_text(folder / "figures/motion.svg") == "<svg/>\n");
  CHECK(fs::exists(folder / "figures/motion.json"));

  const test::Outcome among = test::run_program(
      make_simulate_command("one_sided", folder / "figures/curves.csv", folder / ""));
  CHECK(among.code == 2);
  CHECK_THAT(among.messages, Contains("among the figures of --report"));
}

TEST_CASE("Another run is drawn over a simulated one", "[io]") {
  const TemporaryFolder folder;
  const std::string simulate =
      make_simulate_command("three_bumps", folder / "worn.csv", folder / "worn") +
      " --set front_damping=900 --set speed=36km/h --beside ";
  folder.write("measured.csv",
               "time [ms],body_position_z [mm],pitch_angle [deg]\n0,540,0.1\n500,545,0.2\n"
               "1000,550,0.3\n");
  REQUIRE(test::run_program(simulate + (folder / "measured.csv").string()).code == 0);
  const std::string figures = folder / "worn/figures/";
  const auto other = test::parse_json(test::read_text(figures + "motion.json")).get_child("other");
  CHECK(other.get<std::string>("name") == "measured.csv");
  CHECK(std::stod(other.get_child("height").front().second.data()) == Approx(0.54));
  CHECK(other.get_child("height").back().second.data() == "null");  // the record ends at 1 s
  CHECK(other.get_child("wheel_height").front().second.data() == "null");
  CHECK_THAT(test::read_text(figures + "curves.csv"), Contains("\"measured.csv\""));
  const std::string page = test::read_text(folder / "worn/report.html");
  CHECK_THAT(page, Contains("Changed by --set") && Contains(">front_damping</td>") &&
                       Contains("three_bumps, front_damping = 900, speed = 36 km/h"));
  CHECK_THAT(page,
             Contains("weighted by ISO 2631-1") && Contains("over 3 bumps of 60 mm, 6 m apart") &&
                 !Contains(">this run<"));  // the record lacks what a ride is judged by
  const std::string whole =
      make_simulate_command("three_bumps", folder / "whole.csv", folder / "whole");
  REQUIRE(test::run_program(whole + " --beside " + (folder / "worn.csv").string()).code == 0);
  test::check_page(folder / "whole/report.html", 1);
  CHECK_THAT(test::read_text(folder / "whole/report.html"),
             Contains(">this run<") && Contains(">worn.csv<"));
  CHECK_THAT(test::read_text(folder / "whole/figures/curves.csv"),
             Contains("\"tire load [N] over time [s]\",\"worn.csv, front left\""));
  test::check_page(folder / "worn/report.html", 1);
  const auto refuse = [&](const std::string& text, const std::string& told) {
    const test::Outcome outcome =
        test::run_program(simulate + folder.write("other.csv", text).string() + " --force");
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains("other.csv") && Contains(told));
  };
  refuse("time,speed\n0,1\n1,2\n", "body_position_z");
  refuse("time,body_position_z\n0,1\n", "sample");
  refuse("time,body_position_z\n1,1\n0,2\n", "ascend");
  refuse("t,body_position_z\n1,1\n2,2\n", "time");
}

TEST_CASE("A run's report replaces no page but an earlier run's", "[io]") {
  const TemporaryFolder folder;
  const std::string simulate = make_simulate_command("bump_20mps", folder / "run.csv", folder / "");
  for (const char* name : {"report.html", "report.json"}) {
    folder.write(name, "[1, 2]\n");
    const test::Outcome outcome = test::run_program(simulate);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains(std::string("holds ") + name) &&
                                     Contains("which no earlier simulated run wrote"));
    CHECK(test::read_text(folder / name) == "[1, 2]\n");
    fs::remove(folder / name);
  }
  CHECK_FALSE(fs::exists(folder / "run.csv"));
}

TEST_CASE("A rig's report shows its channels, those of one unit together", "[io]") {
  const TemporaryFolder folder;
  const std::string rigs = "examples/rigs/", out = folder / "report";
  const test::Outcome run = test::run_program("simulate " + rigs + "quarter_car.toml " + rigs +
                                              "maneuvers/bump.toml -o " +
                                              (folder / "run.csv").string() + " --report " + out);
  INFO(run.messages);
  REQUIRE(run.code == 0);
  test::check_page(out + "/report.html", 1);
  CHECK_THAT(test::read_text(out + "/report.html"),
             Contains("quarter_car over bump") && Contains("sprung_mass"));
  const std::string curves = test::read_text(out + "/figures/curves.csv");
  CHECK_THAT(curves, Contains("[N] over time [s]\",\"tire force\"") &&
                         Contains("[m] over time [s]\",\"sprung position\""));
  CHECK(test::run_program("report " + out).code == 0);
  const std::string time = "simulate " + rigs + "quarter_car.toml " + rigs +
                           "maneuvers/bump.toml --channels time --force -o " +
                           (folder / "run.csv").string() + " --report " + out;
  REQUIRE(test::run_program(time).code == 0);
  test::check_page(out + "/report.html", 0);
}

TEST_CASE("The motion's road is the maneuver's, however its table is spaced", "[unit]") {
  RoadSpec cleat;
  cleat.shape = BumpShape::kTable;
  for (int i = 0; i <= 4000; ++i) {  // 20 mm high, 60 mm long, of a survey of 40 m
    const double x = -20.0 + 0.01 * i, beyond = std::abs(x - 3.05);
    cleat.table_x.push_back(x);
    cleat.table_z.push_back(beyond < 0.03 ? 0.02 * (1.0 - beyond / 0.03) : 0.0);
  }
  double high = 0.0, at = 0.0;
  for (const auto& [x, z] : list_profile(cleat)) {
    if (z > high) std::tie(high, at) = std::pair(z, x);
    CHECK(std::abs(z - calc_profile_height(cleat, x)) < 1e-12);
  }
  CHECK(high == Approx(0.02).epsilon(0.05));
  CHECK(at == Approx(3.05).margin(0.005));
}

}  // namespace
}  // namespace strut
