#include "jobs/report/html.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace strut {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1b1f24; --soft: #57606a; --line: #d0d7de; --paper: #ffffff; --band: #f3f5f8; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ee; --soft: #a3acb8; --line: #3b424c; --paper: #16191d; --band: #1f242a; }
}
body { margin: 0 auto; max-width: 80rem; padding: 1.5rem; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0.5rem 0 1rem; }
h2 { font-size: 1.25rem; margin: 2.5rem 0 0.75rem; padding-bottom: 0.25rem; border-bottom: 1px solid var(--line); }
p { max-width: 52rem; }
nav ul { margin: 0; padding-left: 1.2rem; }
a { color: inherit; }
.wide { overflow-x: auto; margin: 1rem 0 1.5rem; }
table { border-collapse: collapse; font-size: 0.8rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: 0.4rem; }
th, td { padding: 0.15rem 0.4rem; text-align: right; white-space: nowrap; }
th { border-bottom: 2px solid var(--line); }
td { border-bottom: 1px solid var(--line); }
.word { text-align: left; }
td { vertical-align: top; }
td small { color: var(--soft); font-size: 0.8em; }
.long { white-space: normal; overflow-wrap: anywhere; min-width: 18rem; }
tbody tr:nth-child(even) { background: var(--band); }
.note, footer, figcaption { color: var(--soft); font-size: 0.85rem; }
figure { margin: 1rem 0 2rem; break-inside: avoid; }
figure svg { display: block; max-width: 100%; height: auto; background: #ffffff; border-radius: 4px; }
footer { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 0.75rem; }
@page { size: A4 landscape; margin: 12mm; }
@media print {
  body { max-width: none; font-size: 10pt; padding: 0; }
  table { font-size: 6.5pt; }
  .wide { overflow-x: visible; }
  tr { break-inside: avoid; }
  h2 { break-after: avoid; }
  nav { display: none; }
}
)";

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// The `svg` element alone, its names with a prefix of their own.
std::string make_inline(const std::string& svg, std::size_t number) {
  const std::size_t begin = svg.find("<svg");
  if (begin == std::string::npos) return "";
  const std::string prefix = "f" + std::to_string(number) + "-";
  std::string text = svg.substr(begin);
  for (const char quote : {'"', '\''}) {
    text = replace_all(text, std::string("id=") + quote, std::string("id=") + quote + prefix);
    text = replace_all(text, std::string("href=") + quote + "#",
                       std::string("href=") + quote + "#" + prefix);
  }
  return replace_all(text, "url(#", "url(#" + prefix);
}

/// Longer texts of a cell may be broken.
constexpr std::size_t kLongText = 40;

/// Lines below the first stand smaller.
std::string make_cell(const std::string& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return escape_html(text);
  return escape_html(text.substr(0, end)) + "<br><small>" + escape_html(text.substr(end + 1)) +
         "</small>";
}

std::string make_cells(const std::vector<std::string>& cells, const std::string& tag,
                       std::size_t text_columns) {
  std::string text = "<tr>";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::string classes = c < text_columns ? "word" : "";
    if (cells[c].size() > kLongText) classes += " long";
    text += "<" + tag + (classes.empty() ? ">" : " class=\"" + classes + "\">") +
            make_cell(cells[c]) + "</" + tag + ">";
  }
  return text + "</tr>\n";
}

std::string make_table(const ReportTable& table) {
  std::string text = "<div class=\"wide\"><table>\n<caption>" + escape_html(table.caption) +
                     "</caption>\n<thead>" + make_cells(table.header, "th", table.text_columns) +
                     "</thead>\n<tbody>\n";
  for (const auto& row : table.rows) text += make_cells(row, "td", table.text_columns);
  text += "</tbody></table>\n";
  for (const std::string& note : table.notes) {
    text += "<p class=\"note\">" + escape_html(note) + "</p>\n";
  }
  return text + "</div>\n";
}

std::string make_paragraphs(const std::vector<std::string>& paragraphs) {
  std::string text;
  for (const std::string& p : paragraphs) text += "<p>" + escape_html(p) + "</p>\n";
  return text;
}

std::string make_contents(const std::vector<ReportSection>& sections) {
  std::string text = "<nav><ul>\n";
  for (std::size_t s = 0; s < sections.size(); ++s) {
    text += "<li><a href=\"#part" + std::to_string(s + 1) + "\">" +
            escape_html(sections[s].heading) + "</a></li>\n";
  }
  return text + "</ul></nav>\n";
}

}  // namespace

std::string print_number(const char* format, double value) {
  if (std::isnan(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string format_short(double value) { return print_number("%.4g", value); }

std::string format_percent(double share) { return print_number("%.2f %%", 100.0 * share); }

std::string escape_html(const std::string& text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string make_html(const ReportPage& page) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escape_html(page.title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" +
      escape_html(page.title) + "</h1>\n" + make_paragraphs(page.lead) +
      make_contents(page.sections);
  std::size_t figure = 0;
  for (std::size_t s = 0; s < page.sections.size(); ++s) {
    const ReportSection& section = page.sections[s];
    text += "<section>\n<h2 id=\"part" + std::to_string(s + 1) + "\">" +
            escape_html(section.heading) + "</h2>\n" + make_paragraphs(section.paragraphs);
    for (const ReportTable& table : section.tables) text += make_table(table);
    for (const ReportFigure& f : section.figures) {
      const std::string missing = f.svg.empty() ? "Left out, gnuplot is not there: " : "";
      text += "<figure>\n" + make_inline(f.svg, ++figure) + "<figcaption>" +
              escape_html(missing + f.caption) + "</figcaption>\n</figure>\n";
    }
    text += "</section>\n";
  }
  return text + "<footer>" + escape_html(page.footer) + "</footer>\n</body>\n</html>\n";
}

std::string make_text(const ReportTable& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);
  std::string text = table.caption + "\n";
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string pad(widths[c] - row[c].size(), ' ');
      line += (c == 0 ? "" : "  ") + (c < table.text_columns ? row[c] + pad : pad + row[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  for (const std::string& note : table.notes) text += note + "\n";
  return text;
}

}  // namespace strut
