#include "report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "base/text/fill_template.h"
#include "base/text/format_number.h"
#include "base/text/utf8.h"
#include "embedded/texts.h"

namespace strut {
namespace {

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// JSON without the spaces and line ends between its tokens.
std::string compact_json(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  bool is_string = false, is_escaped = false;
  for (const char c : json) {
    if (!is_string && (c == ' ' || c == '\n' || c == '\r' || c == '\t')) continue;
    if (c == '"' && !is_escaped) is_string = !is_string;
    is_escaped = c == '\\' && !is_escaped;
    text += c;
  }
  return text;
}

/// In JSON, "<" occurs only in strings, where it can be escaped, so that none of them is a tag.
std::string make_json_element(const std::string& json) {
  return "<script type=\"application/json\">" + replace_all(compact_json(json), "<", "\\u003c") +
         "</script>";
}

/// Minimum length of a cell's text that may wrap [bytes].
constexpr std::size_t kLongText = 40;

/// Units as they are typeset: "m/s^2" with a raised 2. Other powers, as 10^20, stay.
std::string typeset_units(const std::string& text) {
  std::string typeset;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char power = i + 1 < text.size() && text[i] == '^' ? text[i + 1] : '\0';
    const bool ends = i + 2 >= text.size() || text[i + 2] < '0' || text[i + 2] > '9';
    if ((power != '2' && power != '3') || !ends) {
      typeset += text[i];
      continue;
    }
    typeset += power == '2' ? "\u00b2" : "\u00b3";
    ++i;
  }
  return typeset;
}

/// Escapes a cell; lines after the first are in small print.
std::string make_cell(const std::string& source) {
  const std::string text = typeset_units(source);
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return escape_html(text);
  return fmt::format("{}<br><small>{}</small>", escape_html(text.substr(0, end)),
                     escape_html(text.substr(end + 1)));
}

/// Tables with more columns become lists of their rows on a narrow screen, each cell behind the
/// name of its column.
constexpr std::size_t kMaxNarrowColumns = 3;

/// `names`: of the columns, for narrow screens; empty: none.
std::string make_cells(const std::vector<std::string>& cells, const std::string& tag,
                       std::size_t text_columns, const std::vector<std::string>& names = {}) {
  std::string text = "<tr>";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::string classes = c < text_columns ? "word" : "";
    if (cells[c].size() > kLongText) classes += " long";
    std::string attribute = classes.empty() ? "" : fmt::format(" class=\"{}\"", classes);
    if (c < names.size() && !cells[c].empty()) {
      attribute += fmt::format(" data-name=\"{}\"",
                               escape_html(typeset_units(replace_all(names[c], "\n", " "))));
    }
    text += fmt::format("<{0}{1}>{2}</{0}>", tag, attribute, make_cell(cells[c]));
  }
  return text + "</tr>\n";
}

/// Content that is hidden until its summary is opened; a print shows it (page.js).
std::string fold(const std::string& summary, const std::string& content) {
  return fmt::format("<details class=\"fold\"><summary>{}</summary>\n{}</details>\n",
                     escape_html(summary), content);
}

std::string make_table(const ReportTable& table) {
  const bool becomes_list = table.header.size() > kMaxNarrowColumns;
  std::string text =
      fmt::format("<div class=\"wide\"><table{}>\n", becomes_list ? " class=\"list\"" : "");
  if (!table.is_folded) text += fmt::format("<caption>{}</caption>\n", escape_html(table.caption));
  text += fmt::format("<thead>{}</thead>\n<tbody>\n",
                      make_cells(table.header, "th", table.text_columns));
  for (const auto& row : table.rows) {
    text += make_cells(row, "td", table.text_columns,
                       becomes_list ? table.header : std::vector<std::string>{});
  }
  text += "</tbody></table>\n";
  for (const std::string& note : table.notes) {
    text += fmt::format("<p class=\"note\">{}</p>\n", escape_html(note));
  }
  text += "</div>\n";
  return table.is_folded ? fold(table.caption, text) : text;
}

std::string make_badge(const ReportBadge& badge) {
  if (badge.text.empty()) return "";
  static constexpr std::array<const char*, 4> kTones = {"neutral", "good", "warning", "bad"};
  return fmt::format("<p class=\"badge {}\">{}</p>\n", kTones[static_cast<std::size_t>(badge.tone)],
                     escape_html(badge.text));
}

std::string make_key_numbers(const std::vector<KeyNumber>& numbers) {
  if (numbers.empty()) return "";
  std::string text = "<dl class=\"keys\">\n";
  for (const KeyNumber& number : numbers) {
    text += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_html(number.label),
                        escape_html(number.value));
  }
  return text + "</dl>\n";
}

std::string make_paragraphs(const std::vector<std::string>& paragraphs) {
  std::string text;
  for (const std::string& p : paragraphs) text += "<p>" + escape_html(p) + "</p>\n";
  return text;
}

std::string make_links(const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files) {
    text += fmt::format(" <a href=\"{}\">{}</a>", escape_html(file),
                        escape_html(file.substr(file.find_last_of('.') + 1)));
  }
  return text;
}

std::string make_figure(const ReportFigure& figure) {
  return fmt::format(
      "<figure id=\"figure-{}\">\n<div class=\"chart\">{}<noscript>The chart needs JavaScript; its "
      "numbers are linked below.</noscript></div><figcaption>{}{}</figcaption>\n</figure>\n",
      escape_html(figure.name), make_json_element(figure.chart), escape_html(figure.caption),
      make_links(figure.files));
}

std::string make_motion_figure(const ReportMotion& motion) {
  return fmt::format(
      "<figure>\n<div class=\"motion\">{}<noscript>The animation needs JavaScript.</noscript></div>"
      "<figcaption>{}</figcaption>\n</figure>\n",
      make_json_element(motion.scene), escape_html(motion.caption));
}

std::string make_contents(const std::vector<ReportSection>& sections) {
  std::string text = "<nav><ul>\n";
  for (std::size_t s = 0; s < sections.size(); ++s) {
    text += fmt::format("<li><a href=\"#part{}\">{}</a></li>\n", s + 1,
                        escape_html(sections[s].heading));
  }
  return text + "</ul></nav>\n";
}

std::string make_section(const ReportSection& section, const std::string& id) {
  std::string text = section.motions.empty() ? "<section>" : "<section class=\"beside\">";
  text += fmt::format("\n<h2 id=\"{}\">{}</h2>\n{}", id, escape_html(section.heading),
                      make_paragraphs(section.paragraphs));
  for (const ReportMotion& motion : section.motions) text += make_motion_figure(motion);
  for (const ReportTable& table : section.tables) {
    if (!table.is_folded) text += make_table(table);
  }
  for (const ReportFigure& figure : section.figures) text += make_figure(figure);
  for (const ReportTable& table : section.tables) {
    if (table.is_folded) text += make_table(table);
  }
  for (const std::string& file : section.files) {
    text += "<pre class=\"file\">" + escape_html(file) + "</pre>\n";
  }
  return text + "</section>\n";
}

/// Whether a page has content that needs scripts.
struct Moving {
  bool charts = false, motions = false;
};

Moving find_moving(const ReportPage& page) {
  Moving found;
  for (const ReportSection& section : page.sections) {
    found.motions = found.motions || !section.motions.empty();
    found.charts = found.charts || !section.figures.empty();
  }
  return found;
}

std::string make_script(std::string_view code) {
  return "<script>\n" + std::string(code) + "\n</script>\n";
}

std::string make_scripts(const ReportPage& page) {
  const Moving moving = find_moving(page);
  std::string text;
  if (moving.charts) {
    text += "<script type=\"application/gzip\" id=\"plotly\">" +
            std::string(embedded::plotly_gz_base64) + "</script>\n";
  }
  if (moving.charts) text += make_script(embedded::page_js);
  if (moving.motions) return text + make_script(embedded::motion_js);
  if (moving.charts) text += make_script("drawAll();");
  return text;
}

std::string make_footer(const ReportPage& page) {
  std::string text = "<footer>" + escape_html(page.footer);
  if (find_moving(page).charts) {
    text += "<details><summary>Charts drawn by plotly.js; its license</summary><pre>" +
            escape_html(std::string(embedded::LICENSE)) + "</pre></details>";
  }
  return text + "</footer>\n";
}

}  // namespace

std::string format_cell(fmt::format_string<double&> format, double value) {
  return std::isnan(value) ? "" : fmt::format(format, value);
}

std::string format_short(double value) {
  const double size = std::abs(value);
  const bool needs_exponent = size >= 9999.5 && size < 1e6;  // in four digits
  return needs_exponent ? format_significant(value, 4) : format_cell("{:.4g}", value);
}

std::string format_percent(double fraction) { return format_cell("{:.2f} %", 100.0 * fraction); }

std::string escape_html(const std::string& text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : make_valid_utf8(text)) {
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
  std::string sections;
  for (std::size_t s = 0; s < page.sections.size(); ++s) {
    sections += make_section(page.sections[s], fmt::format("part{}", s + 1));
  }
  return fill_template(embedded::page_html, {{"title", escape_html(page.title)},
                                             {"style", std::string(embedded::page_css)},
                                             {"badge", make_badge(page.badge)},
                                             {"keys", make_key_numbers(page.key_numbers)},
                                             {"lead", make_paragraphs(page.lead)},
                                             {"contents", make_contents(page.sections)},
                                             {"sections", sections},
                                             {"footer", make_footer(page)},
                                             {"scripts", make_scripts(page)}});
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
