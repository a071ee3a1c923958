#include "report/plotly.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <set>

namespace strut {
namespace {

Json round(double value) {
  if (!std::isfinite(value)) return {};
  return std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr);
}

Json make_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(round(value));
  return list;
}

std::string get_color(int color) { return color == kInk ? "ink" : kChartColors[color - 1]; }

/// The color at 25 % opacity, given by two more hexadecimal digits.
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
  constexpr std::size_t kMany = 400;  // number of points above which dots are smaller
  if (s.marker != Marker::kDot) return 8;
  return s.kind == SeriesKind::kLinePoints || s.x.size() <= kMany ? 6 : 3;
}

Json make_marker(const ChartSeries& s) {
  return Json{
      {"color", get_color(s.color)}, {"symbol", get_symbol(s.marker)}, {"size", get_size(s)}};
}

const char* get_mode(SeriesKind kind) {
  switch (kind) {
    case SeriesKind::kPoints:
      return "markers";
    case SeriesKind::kLinePoints:
      return "lines+markers";
    default:
      return "lines";
  }
}

void set_lines(const ChartSeries& s, Json& trace) {
  trace["type"] = "scatter";
  trace["mode"] = get_mode(s.kind);
  trace["x"] = make_numbers(s.x);
  trace["y"] = make_numbers(s.y);
  if (s.kind != SeriesKind::kPoints) {
    Json line = Json{{"color", get_color(s.color)}, {"width", 1.5}};
    if (s.kind == SeriesKind::kDashedLine) line["dash"] = "dash";
    trace["line"] = line;
  }
  if (s.kind != SeriesKind::kLine && s.kind != SeriesKind::kDashedLine) {
    trace["marker"] = make_marker(s);
  }
}

/// The band's outline: forward along the high edge, back along the low one.
void set_band(const ChartSeries& s, Json& trace) {
  std::vector<double> x = s.x, y = s.high;
  x.insert(x.end(), s.x.rbegin(), s.x.rend());
  y.insert(y.end(), s.low.rbegin(), s.low.rend());
  trace["type"] = "scatter";
  trace["mode"] = "lines";
  trace["fill"] = "toself";
  trace["x"] = make_numbers(x);
  trace["y"] = make_numbers(y);
  trace["hoverinfo"] = "skip";
  trace["line"] = Json{{"width", 0}};
  trace["fillcolor"] = get_fill(s.color);
}

Json make_whiskers(const ChartSeries& s) {
  std::vector<double> up, down;
  for (std::size_t i = 0; i < s.y.size(); ++i) {
    up.push_back(s.high[i] - s.y[i]);
    down.push_back(s.y[i] - s.low[i]);
  }
  return Json{{"type", "data"},
              {"symmetric", false},
              {"color", "ink"},
              {"array", make_numbers(up)},
              {"arrayminus", make_numbers(down)}};
}

void set_bars(const ChartSeries& s, Json& trace) {
  trace["type"] = "bar";
  trace["x"] = make_numbers(s.x);
  trace["y"] = make_numbers(s.y);
  trace["marker"] = Json{{"color", get_color(s.color)}};
  if (s.width > 0.0) trace["width"] = s.width;
  if (!s.low.empty()) trace["error_y"] = make_whiskers(s);
}

void set_boxes(const ChartSeries& s, Json& trace) {
  trace["type"] = "box";
  trace["x"] = make_numbers(s.x);
  trace["y"] = make_numbers(s.y);
  trace["fillcolor"] = get_fill(s.color);
  trace["boxpoints"] = "outliers";
  trace["line"] = Json{{"color", get_color(s.color)}, {"width", 1.5}};
  trace["marker"] = Json{{"size", 3}, {"symbol", "circle-open"}};
}

void set_values(const ChartSeries& s, Json& trace) {
  switch (s.kind) {
    case SeriesKind::kBand:
      return set_band(s, trace);
    case SeriesKind::kBars:
      return set_bars(s, trace);
    case SeriesKind::kBoxes:
      return set_boxes(s, trace);
    default:
      return set_lines(s, trace);
  }
}

/// The bar of a panel's color scale, beside it.
Json make_color_bar(const Chart& chart, std::size_t panel) {
  const PanelPlace place = calc_place(chart, panel);
  const Json title = Json{
      {"text", chart.panels[panel].value_label}, {"side", "right"}, {"font", Json{{"size", 12}}}};
  return Json{{"x", round(place.right)},
              {"xanchor", "left"},
              {"y", round(0.5 * (place.bottom + place.top))},
              {"len", round(place.top - place.bottom)},
              {"thickness", 12},
              {"title", title}};
}

/// The color scale of points with values, from blue to orange, which is readable on light and dark
/// pages.
Json make_value_scale(const Chart& chart, std::size_t panel, const ChartSeries& s) {
  const Json colors =
      Json::array({Json::array({0.0, get_color(1)}), Json::array({0.5, get_color(4)}),
                   Json::array({1.0, get_color(5)})});
  return Json{{"color", make_numbers(s.value)},
              {"colorscale", colors},
              {"showscale", true},
              {"colorbar", make_color_bar(chart, panel)}};
}

/// Suffix of a panel's axes in plotly.js: "" for the first panel, then "2", "3", ...
std::string get_number(std::size_t panel) { return panel == 0 ? "" : std::to_string(panel + 1); }

Json make_trace(const Chart& chart, std::size_t panel, const ChartSeries& s, bool has_entry) {
  Json trace = Json{{"name", s.name}, {"legendgroup", s.name}};
  trace["showlegend"] = has_entry;
  set_values(s, trace);
  trace["meta"] = name_panel(chart.panels[panel]);
  trace["xaxis"] = "x" + get_number(panel);
  trace["yaxis"] = "y" + get_number(panel);
  if (!s.value.empty()) trace["marker"].update(make_value_scale(chart, panel, s));
  return trace;
}

Json make_traces(const Chart& chart) {
  Json traces = Json::array();
  std::set<std::string> names = {""};
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    for (const ChartSeries& s : chart.panels[p].series) {
      traces.push_back(make_trace(chart, p, s, names.insert(s.name).second));
    }
  }
  return traces;
}

/// The range of an axis; for a logarithmic axis plotly.js takes the logarithms of its ends.
Json make_range(const ChartAxis& axis) {
  const auto scale = [&](double value) { return axis.is_logarithmic ? std::log10(value) : value; };
  return make_numbers({scale(axis.range[0]), scale(axis.range[1])});
}

Json make_axis(const ChartAxis& axis) {
  Json json = Json{{"title", Json{{"text", axis.label}}}};
  if (axis.is_logarithmic) json["type"] = "log";
  if (!axis.range.empty()) json["range"] = make_range(axis);
  if (!axis.categories.empty()) {
    std::vector<double> places;
    for (std::size_t c = 0; c < axis.categories.size(); ++c) {
      places.push_back(static_cast<double>(c + 1));
    }
    json["tickmode"] = "array";
    json["tickvals"] = make_numbers(places);
    json["ticktext"] = axis.categories;
    json["automargin"] = true;  // names are of any length
  }
  return json;
}

void add_axes(const Chart& chart, std::size_t p, Json& layout) {
  const ChartPanel& panel = chart.panels[p];
  const PanelPlace place = calc_place(chart, p);
  const std::string number = get_number(p);
  Json x = make_axis(panel.x), y = make_axis(panel.y);
  x["domain"] = make_numbers({place.left, place.right});
  x["anchor"] = "y" + number;
  y["domain"] = make_numbers({place.bottom, place.top});
  y["anchor"] = "x" + number;
  if (chart.shares_x && p > 0) x["matches"] = "x";
  layout["xaxis" + number] = x;
  layout["yaxis" + number] = y;
}

Json make_title(const std::string& text, const PanelPlace& place) {
  return Json{{"text", text},
              {"showarrow", false},
              {"xref", "paper"},
              {"yref", "paper"},
              {"x", round(0.5 * (place.left + place.right))},
              {"y", round(place.top)},
              {"xanchor", "center"},
              {"yanchor", "bottom"}};
}

Json make_layout(const Chart& chart) {
  Json titles = Json::array();
  Json layout = Json{{"margin", Json{{"l", 0}, {"r", 0}, {"t", 0}, {"b", 0}}}};
  layout["legend"] =
      Json{{"orientation", "h"}, {"x", 0.05}, {"xanchor", "left"}, {"y", 1}, {"yanchor", "top"}};
  layout["barmode"] = "overlay";
  layout["hovermode"] = "closest";
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    add_axes(chart, p, layout);
    const std::string& title = chart.panels[p].title;
    if (!title.empty()) titles.push_back(make_title(title, calc_place(chart, p)));
  }
  layout["annotations"] = titles;
  return layout;
}

constexpr int kNarrowWidth = 380;  // px, of a phone

/// The same chart with its panels below each other: height, layout and, by trace, the bar of its
/// color scale or null.
Json make_narrow(Chart chart) {
  chart.columns = 1;
  chart.width = kNarrowWidth;
  Json bars = Json::array();
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    for (const ChartSeries& s : chart.panels[p].series) {
      bars.push_back(s.value.empty() ? Json() : make_color_bar(chart, p));
    }
  }
  return Json{{"height", calc_height(chart)},
              {"layout", make_layout(chart)},
              {"colorbars", std::move(bars)}};
}

}  // namespace

Json make_plotly(const Chart& chart) {
  return Json{{"name", chart.name},           {"height", calc_height(chart)},
              {"width", chart.width},         {"data", make_traces(chart)},
              {"layout", make_layout(chart)}, {"narrow", make_narrow(chart)}};
}

}  // namespace strut
