// Charts for plotly.js, which draws them on a page.
#pragma once

#include "io/format/json.h"
#include "report/chart.h"

namespace strut {

/// Returns {"name", "height" [px], "width" [px], "data", "layout", "narrow"}: traces and layout of
/// plotly.js, and height, layout and color bars for pages too narrow for `width`. The color "ink"
/// stands for that of the page's text, which the page substitutes. Numbers have seven digits, more
/// than a figure resolves.
Json make_plotly(const Chart& chart);

}  // namespace strut
