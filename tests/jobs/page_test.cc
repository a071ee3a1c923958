// Pages and tables of reports.
#include <catch2/catch.hpp>

#include "report/html.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("Texts of a page cannot become its markup", "[unit]") {
  CHECK(escape_html("a < b & \"c\" > d") == "a &lt; b &amp; &quot;c&quot; &gt; d");
  ReportPage page;
  page.title = "<script>";
  page.sections = {{"<b>", {"<i>"}, {{"<u>", {"<h>"}, {{"<td>"}}}}, {}}};
  const std::string html = make_html(page);
  for (const char* tag : {"<script>", "<b>", "<i>", "<u>", "<h>"}) {
    CHECK_THAT(html, !Contains(tag));
  }
}

TEST_CASE("A terminal's table is as wide as its widest cells", "[unit]") {
  const ReportTable table{"Caption", {"name", "value"}, {{"a", "1.25"}, {"longer", "3"}}, {}, 1};
  CHECK(make_text(table) == "Caption\nname    value\na        1.25\nlonger      3\n");
}

}  // namespace
}  // namespace strut
