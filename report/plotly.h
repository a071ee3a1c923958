// Charts for plotly.js, which draws them on a page.
#pragma once

#include "io/format/json.h"
#include "report/chart.h"

namespace strut {

/// {"name", "height" [px], "data", "layout"}: plotly.js's traces and layout. Colors of
/// the page's text are the word "ink", which the page replaces as it is light or dark. Numbers have
/// seven digits, more than is seen.
Json make_plotly(const Chart& chart);

}  // namespace strut
