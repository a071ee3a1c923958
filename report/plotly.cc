#include "report/plotly.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace strut {
namespace {

Json round(double value) {
  if (!std::isfinite(value)) return {};
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return std::strtod(text, nullptr);
}

Json make_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push(round(value));
  return list;
}

std::string get_color(int color) { return color == kInk ? "ink" : kChartColors[color - 1]; }

/// The color with an opacity, as two more hexadecimal digits.
std::string get_fill(int color) { return get_color(color) + "40"; }

const char* get_symbol(Marker marker) {
  switch (marker) {
    case Marker::kCircle:
      return "circle-open";
    case Marker::kCross:
      return "x";
    case Marker::kTriangle:
      return "triangle-up";
    case Marker::kDot:
      break;
  }
  return "circle";
}

int get_size(const ChartSeries& s) {
  constexpr std::size_t kMany = 400;  // beyond, smaller ones
  if (s.marker != Marker::kDot)
    return s.kind == SeriesKind::kPoints3d ? (s.marker == Marker::kCross ? 3 : 5) : 8;
  return s.kind == SeriesKind::kLinePoints || s.x.size() <= kMany ? 6 : 3;
}

Json make_marker(const ChartSeries& s) {
  return Json::object()
      .set("color", get_color(s.color))
      .set("symbol", get_symbol(s.marker))
      .set("size", get_size(s));
}

const char* get_mode(SeriesKind kind) {
  switch (kind) {
    case SeriesKind::kPoints:
    case SeriesKind::kPoints3d:
      return "markers";
    case SeriesKind::kLinePoints:
      return "lines+markers";
    default:
      return "lines";
  }
}

void set_lines(const ChartSeries& s, Json& trace) {
  trace.set("type", "scatter").set("mode", get_mode(s.kind));
  trace.set("x", make_numbers(s.x)).set("y", make_numbers(s.y));
  if (s.kind != SeriesKind::kPoints) {
    Json line = Json::object().set("color", get_color(s.color)).set("width", 1.5);
    if (s.kind == SeriesKind::kDashedLine) line.set("dash", "dash");
    trace.set("line", line);
  }
  if (s.kind != SeriesKind::kLine && s.kind != SeriesKind::kDashedLine) {
    trace.set("marker", make_marker(s));
  }
}

/// The band's outline, there on the high edge and back on the low one.
void set_band(const ChartSeries& s, Json& trace) {
  std::vector<double> x = s.x, y = s.high;
  x.insert(x.end(), s.x.rbegin(), s.x.rend());
  y.insert(y.end(), s.low.rbegin(), s.low.rend());
  trace.set("type", "scatter").set("mode", "lines").set("fill", "toself");
  trace.set("x", make_numbers(x)).set("y", make_numbers(y)).set("hoverinfo", "skip");
  trace.set("line", Json::object().set("width", 0)).set("fillcolor", get_fill(s.color));
}

Json make_whiskers(const ChartSeries& s) {
  std::vector<double> up, down;
  for (std::size_t i = 0; i < s.y.size(); ++i) {
    up.push_back(s.high[i] - s.y[i]);
    down.push_back(s.y[i] - s.low[i]);
  }
  return Json::object()
      .set("type", "data")
      .set("symmetric", false)
      .set("color", "ink")
      .set("array", make_numbers(up))
      .set("arrayminus", make_numbers(down));
}

void set_bars(const ChartSeries& s, Json& trace) {
  trace.set("type", "bar").set("x", make_numbers(s.x)).set("y", make_numbers(s.y));
  trace.set("marker", Json::object().set("color", get_color(s.color)));
  if (s.width > 0.0) trace.set("width", s.width);
  if (!s.low.empty()) trace.set("error_y", make_whiskers(s));
}

void set_boxes(const ChartSeries& s, Json& trace) {
  trace.set("type", "box").set("x", make_numbers(s.x)).set("y", make_numbers(s.y));
  trace.set("fillcolor", get_fill(s.color)).set("boxpoints", "outliers");
  trace.set("line", Json::object().set("color", get_color(s.color)).set("width", 1.5));
  trace.set("marker", Json::object().set("size", 3).set("symbol", "circle-open"));
}

void set_points_3d(const ChartSeries& s, Json& trace) {
  trace.set("type", "scatter3d").set("mode", "markers").set("marker", make_marker(s));
  trace.set("x", make_numbers(s.x)).set("y", make_numbers(s.y)).set("z", make_numbers(s.z));
}

void set_values(const ChartSeries& s, Json& trace) {
  switch (s.kind) {
    case SeriesKind::kBand:
      return set_band(s, trace);
    case SeriesKind::kBars:
      return set_bars(s, trace);
    case SeriesKind::kBoxes:
      return set_boxes(s, trace);
    case SeriesKind::kPoints3d:
      return set_points_3d(s, trace);
    default:
      return set_lines(s, trace);
  }
}

/// "" for the first panel, then "2", "3", ...: how plotly.js numbers axes and scenes.
std::string get_number(std::size_t panel) { return panel == 0 ? "" : std::to_string(panel + 1); }

Json make_trace(const ChartSeries& s, const std::string& panel_name, std::size_t panel, bool is_3d,
                bool has_entry) {
  Json trace = Json::object().set("name", s.name).set("legendgroup", s.name);
  trace.set("showlegend", has_entry);
  set_values(s, trace);
  trace.set("meta", panel_name);
  if (is_3d) return trace.set("scene", "scene" + get_number(panel));
  return trace.set("xaxis", "x" + get_number(panel)).set("yaxis", "y" + get_number(panel));
}

Json make_traces(const Chart& chart) {
  Json traces = Json::array();
  std::set<std::string> names = {""};
  const bool is_3d = chart.is_3d();
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    for (const ChartSeries& s : chart.panels[p].series) {
      traces.push(
          make_trace(s, name_panel(chart.panels[p]), p, is_3d, names.insert(s.name).second));
    }
  }
  return traces;
}

/// plotly.js takes the logarithms of a logarithmic axis' ends.
Json make_range(const ChartAxis& axis) {
  const auto place = [&](double value) { return axis.is_logarithmic ? std::log10(value) : value; };
  return make_numbers({place(axis.range[0]), place(axis.range[1])});
}

Json make_axis(const ChartAxis& axis) {
  Json json = Json::object().set("title", Json::object().set("text", axis.label));
  // "D2": digits 2 and 5 between the powers of ten.
  if (axis.is_logarithmic) {
    json.set("type", "log").set("exponentformat", "power").set("dtick", "D2");
  }
  if (!axis.range.empty()) json.set("range", make_range(axis));
  if (!axis.categories.empty()) {
    std::vector<double> places;
    for (std::size_t c = 0; c < axis.categories.size(); ++c) {
      places.push_back(static_cast<double>(c + 1));
    }
    json.set("tickmode", "array")
        .set("tickvals", make_numbers(places))
        .set("ticktext", Json::texts(axis.categories));
  }
  return json;
}

void add_axes(const Chart& chart, std::size_t p, Json& layout) {
  const ChartPanel& panel = chart.panels[p];
  const PanelPlace place = calc_place(chart, p);
  const std::string number = get_number(p);
  Json x = make_axis(panel.x), y = make_axis(panel.y);
  x.set("domain", make_numbers({place.left, place.right})).set("anchor", "y" + number);
  y.set("domain", make_numbers({place.bottom, place.top})).set("anchor", "x" + number);
  if (chart.shares_x && p > 0) x.set("matches", "x");
  layout.set("xaxis" + number, x).set("yaxis" + number, y);
}

void add_scene(const Chart& chart, std::size_t p, Json& layout) {
  const ChartPanel& panel = chart.panels[p];
  const PanelPlace place = calc_place(chart, p);
  const Json domain = Json::object()
                          .set("x", make_numbers({place.left, place.right}))
                          .set("y", make_numbers({place.bottom, place.top}));
  const Json eye = Json::object().set("x", 1.8).set("y", -1.9).set("z", 0.9);
  layout.set("scene" + get_number(p), Json::object()
                                          .set("domain", domain)
                                          .set("camera", Json::object().set("eye", eye))
                                          .set("xaxis", make_axis(panel.x))
                                          .set("yaxis", make_axis(panel.y))
                                          .set("zaxis", make_axis(panel.z)));
}

Json make_title(const std::string& text, const PanelPlace& place) {
  return Json::object()
      .set("text", text)
      .set("showarrow", false)
      .set("xref", "paper")
      .set("yref", "paper")
      .set("x", round(0.5 * (place.left + place.right)))
      .set("y", round(place.top))
      .set("xanchor", "center")
      .set("yanchor", "bottom");
}

Json make_layout(const Chart& chart) {
  const bool is_3d = chart.is_3d();
  Json titles = Json::array();
  Json layout =
      Json::object().set("margin", Json::object().set("l", 0).set("r", 0).set("t", 0).set("b", 0));
  layout.set("legend", Json::object()
                           .set("orientation", "h")
                           .set("x", 0.05)
                           .set("xanchor", "left")
                           .set("y", 1)
                           .set("yanchor", "top"));
  layout.set("barmode", "overlay").set("hovermode", "closest");
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    is_3d ? add_scene(chart, p, layout) : add_axes(chart, p, layout);
    const std::string& title = chart.panels[p].title;
    if (!title.empty()) titles.push(make_title(title, calc_place(chart, p)));
  }
  return layout.set("annotations", titles);
}

}  // namespace

Json make_plotly(const Chart& chart) {
  return Json::object()
      .set("name", chart.name)
      .set("height", calc_height(chart))
      .set("width", chart.width)
      .set("three_d", chart.is_3d())
      .set("data", make_traces(chart))
      .set("layout", make_layout(chart));
}

}  // namespace strut
