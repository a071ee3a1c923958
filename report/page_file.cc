#include "report/page_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/text/shorten.h"
#include "io/file/atomic_file.h"
#include "io/format/json.h"
#include "io/format/read_json.h"
#include "report/figures.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Maps `make` over `elements`.
template <class T, class Make>
Json make_list(const std::vector<T>& elements, const Make& make) {
  Json list = Json::array();
  for (const T& element : elements) list.push_back(make(element));
  return list;
}

Json make_table_json(const ReportTable& table) {
  return Json{{"caption", table.caption},
              {"header", table.header},
              {"rows", table.rows},
              {"notes", table.notes},
              {"text_columns", table.text_columns},
              {"is_folded", table.is_folded}};
}

/// The entry of a figure or motion; its content is in the file of its name.
template <class T>
Json make_named(const T& figure) {
  return Json{{"name", figure.name}, {"caption", figure.caption}};
}

Json make_section_json(const ReportSection& section) {
  return Json{{"heading", section.heading},
              {"paragraphs", section.paragraphs},
              {"tables", make_list(section.tables, &make_table_json)},
              {"figures", make_list(section.figures, &make_named<ReportFigure>)},
              {"motions", make_list(section.motions, &make_named<ReportMotion>)}};
}

Json make_key_json(const KeyNumber& number) {
  return Json{{"value", number.value}, {"label", number.label}};
}

Json make_page_json(const ReportPage& page) {
  return Json{{"of", page.of},
              {"title", page.title},
              {"badge", Json{{"text", page.badge.text}, {"tone", page.badge.tone}}},
              {"key_numbers", make_list(page.key_numbers, &make_key_json)},
              {"lead", page.lead},
              {"sections", make_list(page.sections, &make_section_json)},
              {"tables", page.tables},
              {"footer", page.footer}};
}

/// Maps `read` over the list `key`.
template <class Read>
auto read_list(const Json& tree, const char* key, const Read& read) {
  std::vector<decltype(read(tree))> list;
  for (const Json& element : tree.at(key)) list.push_back(read(element));
  return list;
}

std::string read_text(const Json& tree) { return tree.get<std::string>(); }

std::vector<std::string> read_row(const Json& tree) { return tree.get<std::vector<std::string>>(); }

ReportTable read_table(const Json& tree) {
  return {tree.at("caption").get<std::string>(),      read_list(tree, "header", &read_text),
          read_list(tree, "rows", &read_row),         read_list(tree, "notes", &read_text),
          tree.at("text_columns").get<std::size_t>(), tree.value("is_folded", false)};
}

/// Pages of earlier versions have none; a tone that strut does not write is neutral.
ReportBadge read_badge(const Json& page) {
  if (!page.contains("badge")) return {};
  const Json& badge = page.at("badge");
  const auto tone = badge.at("tone").get<double>();
  const bool is_known = tone >= 0.0 && tone <= static_cast<double>(Tone::kBad);
  return {badge.at("text").get<std::string>(),
          is_known ? static_cast<Tone>(static_cast<int>(tone)) : Tone::kNeutral};
}

KeyNumber read_key_number(const Json& tree) {
  return {tree.at("value").get<std::string>(), tree.at("label").get<std::string>()};
}

/// Names of the figures and tables of comparisons, diagnoses, runs and benchmarks, except those of
/// a single run, run_NUMBER_...: a report.json can have no other files removed.
constexpr std::array<const char*, 10> kNames = {
    "channels", "curves",        "force_law", "force_map", "gain",
    "motion",   "probabilities", "states",    "balance",   "work_precision"};

bool is_page_name(const std::string& name) {
  constexpr std::string_view kRun = "run_";
  const std::size_t end = name.find_first_not_of("0123456789", kRun.size());
  const bool is_of_run =
      name.starts_with(kRun) && end != std::string::npos && end > kRun.size() && name[end] == '_';
  return is_figure_name(name) &&
         (is_of_run || std::find(kNames.begin(), kNames.end(), name) != kNames.end());
}

/// Checks that a later page will recognize these names and can remove their files.
void check_names(const ReportPage& page) {
  const auto check = [](const std::string& name) {
    STRUT_CHECK(is_page_name(name), "report: '" + name + "' is not in kNames");
  };
  for (const std::string& table : page.tables) check(table);
  for (const ReportSection& section : page.sections) {
    for (const ReportFigure& figure : section.figures) check(figure.name);
    for (const ReportMotion& motion : section.motions) check(motion.name);
  }
}

/// Lists the files that the folder's page names.
std::vector<fs::path> list_files(const PageFolder& folder, const Json& page) {
  std::vector<fs::path> files;
  for (const std::string& name : read_list(page, "tables", &read_text)) {
    if (is_page_name(name)) files.push_back(folder.table(name));
  }
  const auto add_figures = [&](const Json& list, const std::vector<const char*>& ends) {
    for (const Json& figure : list) {
      const auto name = figure.at("name").get<std::string>();
      for (const char* end : ends) {
        if (is_page_name(name)) files.push_back(folder.figures() / (name + end));
      }
    }
  };
  for (const Json& section : page.at("sections")) {
    add_figures(section.at("figures"), {".csv", ".json"});
    add_figures(section.at("motions"), {".json"});
  }
  return files;
}

/// The page of an earlier command in the folder.
struct EarlierPage {
  std::string of;               // ReportPage::of; "": no page written by strut
  std::vector<fs::path> files;  // beside it
};

EarlierPage read_earlier_page(const PageFolder& folder) {
  try {
    if (!fs::exists(folder.page())) return {};
    const Json page = read_json(folder.page());
    return {page.at("of").get<std::string>(), list_files(folder, page)};
  } catch (const Json::exception&) {
    return {};
  }
}

/// Throws unless each figure is named once: otherwise a small page could include a large file many
/// times.
void refuse_repeated(const PageFolder& folder, const Json& page) {
  std::set<std::string> names;
  for (const Json& section : page.at("sections")) {
    for (const char* list : {"figures", "motions"}) {
      for (const Json& figure : section.at(list)) {
        const auto name = figure.at("name").get<std::string>();
        if (!names.insert(name).second) {
          throw InputError(fmt::format("{}: figure '{}': named twice; must be as strut wrote it",
                                       folder.page().string(), shorten(name)));
        }
      }
    }
  }
}

ReportPage read_page(const Json& tree, const FigureDrawer& drawer) {
  ReportPage page;
  page.of = tree.at("of").get<std::string>();
  page.title = tree.at("title").get<std::string>();
  page.badge = read_badge(tree);
  if (tree.contains("key_numbers")) {
    page.key_numbers = read_list(tree, "key_numbers", &read_key_number);
  }
  page.lead = read_list(tree, "lead", &read_text);
  page.footer = tree.at("footer").get<std::string>();
  page.tables = read_list(tree, "tables", &read_text);
  page.sections = read_list(tree, "sections", [&](const Json& section) {
    return ReportSection{
        section.at("heading").get<std::string>(), read_list(section, "paragraphs", &read_text),
        read_list(section, "tables", &read_table),
        read_list(section, "figures",
                  [&](const Json& figure) {
                    return drawer.read_again(figure.at("name").get<std::string>(),
                                             figure.at("caption").get<std::string>());
                  }),
        read_list(section, "motions", [&](const Json& motion) {
          return drawer.read_motion_again(motion.at("name").get<std::string>(),
                                          motion.at("caption").get<std::string>());
        })};
  });
  return page;
}

}  // namespace

void check_page_folder(const std::string& option, const PageFolder& folder,
                       const FolderContent& content, const std::vector<fs::path>& files) {
  // Refuses links before anything is computed and before an earlier page is removed.
  if (fs::exists(folder.root))
    Folder(folder.root).find_folder(folder.figures().filename().string());
  const std::string start = "--" + option + " = " + folder.root.string() + ": holds ";
  const FolderContent* other = find_content(folder.root);
  if (other != nullptr && other != &content && other != &kRunContent) {
    throw InputError(start + "a " + other->name + " (" + other->file + "); must be another folder");
  }
  const std::string of = read_earlier_page(folder).of;
  if (of == content.name) return;  // its files may be replaced
  if (!of.empty()) throw InputError(start + "the report of a " + of + "; must be another folder");
  std::vector<fs::path> written = files;
  written.insert(written.end(), {folder.report(), folder.page()});
  if (fs::exists(folder.figures()) && !fs::is_empty(folder.figures())) {
    written.push_back(folder.figures());
  }
  for (const fs::path& file : written) {
    if (fs::exists(file)) {
      throw InputError(fmt::format("{}{}, which no earlier {} wrote; must be another folder", start,
                                   file.filename().string(), content.name));
    }
  }
}

void clear_page_folder(const PageFolder& folder, const std::filesystem::path& marker) {
  folder.make();
  const EarlierPage earlier = read_earlier_page(folder);
  remove_file_inside(folder.root, marker);
  for (const fs::path& file : earlier.files) remove_file_inside(folder.root, file);
  remove_file_inside(folder.root, folder.report());
  remove_file_inside(folder.root, folder.page());
}

void write_page(const PageFolder& folder, const ReportPage& page) {
  check_names(page);
  folder.make();
  write_text_file_inside(folder.root, folder.page(), format_json(make_page_json(page)) + "\n");
  write_text_file_inside(folder.root, folder.report(), make_html(page));
}

void write_page_again(const PageFolder& folder) {
  try {
    const Json tree = read_json(folder.page());
    refuse_repeated(folder, tree);
    const FigureDrawer drawer(Folder(folder.root));
    write_text_file_inside(folder.root, folder.report(), make_html(read_page(tree, drawer)));
  } catch (const Json::exception& e) {
    throw InputError(
        fmt::format("{}: {}; must be as strut wrote it", folder.page().string(), explain(e)));
  }
}

}  // namespace strut
