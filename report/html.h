// A self-contained HTML page of sections with text, tables and figures: it loads no file, font or
// script.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

namespace strut {

/// Escapes the special characters of HTML; invalid UTF-8 is replaced.
std::string escape_html(const std::string& text);

/// Number of a table's cell in one of fmt's formats ("{:.3g}"); empty for NaN, a missing number.
std::string format_cell(fmt::format_string<double&> format, double value);

/// Four significant digits, without an exponent below a million; empty for NaN.
std::string format_short(double value);
/// "12.34 %" for 0.1234; empty for NaN.
std::string format_percent(double fraction);

/// Cells by row. A page sets the lines of a cell after its first in small print.
struct ReportTable {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows = {};
  std::vector<std::string> notes = {};  // below the table
  std::size_t text_columns = 1;         // number of leading columns of text; numbers follow
  bool is_folded = false;               // shown by its caption until it is opened
};

struct ReportFigure {
  std::string name;  // name of its files
  std::string caption;
  std::string chart;               // JSON of make_plotly()
  std::vector<std::string> files;  // linked below the chart, relative to the page
};

/// An animation of a car crossing its bump, with a slider (page/motion.js).
struct ReportMotion {
  std::string name;  // name of its file
  std::string caption;
  std::string scene;  // JSON of make_motion()
};

/// A section of a report.
struct ReportSection {
  std::string heading;
  std::vector<std::string> paragraphs = {};
  std::vector<ReportTable> tables = {};
  std::vector<ReportFigure> figures = {};
  std::vector<ReportMotion> motions = {};
  std::vector<std::string> files = {};  // texts as their files have them
};

enum class Tone { kNeutral, kGood, kWarning, kBad };

/// The result in a word or two, beside the title.
struct ReportBadge {
  std::string text;  // "": none
  Tone tone = Tone::kNeutral;
};

/// One of the few numbers that matter: "38.2 N/mm" above "front stiffness".
struct KeyNumber {
  std::string value, label;
};

struct ReportPage {
  std::string title;
  std::vector<std::string> lead;  // paragraphs below the title
  std::vector<ReportSection> sections;
  std::string footer;
  std::vector<std::string> tables = {};  // CSV files beside it: "channels" for channels.csv
  std::string of = {};                   // FolderContent::name of its folder
  ReportBadge badge = {};
  std::vector<KeyNumber> key_numbers = {};  // below the title
};

/// Returns the page, for light and dark screens and for paper. The library that draws its charts is
/// embedded.
std::string make_html(const ReportPage& page);

/// Returns the table for a terminal, with aligned columns.
std::string make_text(const ReportTable& table);

}  // namespace strut
