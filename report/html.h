// One self-contained HTML page from sections of text, tables and figures: no file, font or script
// from outside.
#pragma once

#include <string>
#include <vector>

namespace strut {

/// `text` with the characters that HTML gives a meaning replaced.
std::string escape_html(const std::string& text);

/// The text of a number in one of printf's formats; empty for NaN, what is not there.
std::string print_number(const char* format, double value);

/// Four digits; "12.34 %"; empty for NaN.
std::string format_short(double value);
std::string format_percent(double share);

/// Texts by rows. On a page lines of a cell below its first stand smaller.
struct ReportTable {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows = {};
  std::vector<std::string> notes = {};  // below it
  std::size_t text_columns = 1;         // the first so many are words, the others numbers
};

struct ReportFigure {
  std::string name;  // of its files
  std::string caption;
  std::string chart;               // the text of make_plotly()
  std::vector<std::string> files;  // beside the page, as its links name them
};

/// A car crossing its bump, with a slider: see jobs/simulate/motion.h.
struct ReportMotion {
  std::string name;  // of its file
  std::string caption;
  std::string scene;  // the text of make_motion()
};

/// A part of a report. Whoever has something to report fills one of these.
struct ReportSection {
  std::string heading;
  std::vector<std::string> paragraphs = {};
  std::vector<ReportTable> tables = {};
  std::vector<ReportFigure> figures = {};
  std::vector<ReportMotion> motions = {};
};

struct ReportPage {
  std::string title;
  std::vector<std::string> lead;  // paragraphs below it
  std::vector<ReportSection> sections;
  std::string footer;
  std::vector<std::string> tables = {};  // files beside it: "channels" of channels.csv
  std::string of = {};                   // what its folder holds, as FolderContent names it
};

/// The page, readable in light and dark and on paper; the library that draws its charts is part of
/// it.
std::string make_html(const ReportPage& page);

/// The table for a terminal, columns aligned.
std::string make_text(const ReportTable& table);

}  // namespace strut
