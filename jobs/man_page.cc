#include "jobs/man_page.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <sstream>

#include "base/text/build_info.h"
#include "jobs/cli/messages.h"

namespace strut {
namespace {

/// Escapes text for troff: no escape sequence, no request; dashes stay ASCII minus signs.
std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\e";
        break;
      case '-':
        escaped += "\\-";
        break;
      case '\'':
        escaped += "\\(aq";
        break;
      case '`':
        escaped += "\\(ga";
        break;
      case '^':
        escaped += "\\(ha";
        break;
      case '~':
        escaped += "\\(ti";
        break;
      case '\n':
        escaped += ' ';
        break;
      default:
        escaped += c;
    }
  }
  return (escaped.starts_with('.') ? "\\&" : "") + escaped;
}

std::string bold(const std::string& text) { return "\\fB" + escape(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escape(text) + "\\fR"; }

std::string make_section(const std::string& title) { return ".SH " + title + "\n"; }

/// Lines without filling.
std::string make_verbatim(const std::string& text) {
  std::string page = ".PP\n.nf\n";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) page += escape(line) + "\n";
  return page + ".fi\n";
}

/// Paragraphs; lines that begin with a blank are a list and are not filled.
std::string make_text(const std::string& text) {
  std::string page, paragraph, list;
  const auto flush = [&page](std::string& part, const auto& make) {
    if (!part.empty()) page += make(part);
    part.clear();
  };
  const auto make_paragraph = [](const std::string& part) { return ".PP\n" + part; };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(' ')) {
      flush(paragraph, make_paragraph);
      list += line + "\n";
    } else {
      flush(list, make_verbatim);
      paragraph += escape(line) + "\n";
    }
  }
  flush(list, make_verbatim);
  flush(paragraph, make_paragraph);
  return page;
}

/// The forms of a command, one a line.
std::string make_synopsis(const std::string& synopsis) {
  std::string page = ".PP\n.nf\n";
  std::istringstream lines(synopsis);
  for (std::string line; std::getline(lines, line);) {
    page += escape(line.substr(line.find_first_not_of(' '))) + "\n";
  }
  return page + ".fi\n";
}

std::string make_item(const std::string& label, const std::string& text) {
  return fmt::format(".TP\n{}\n{}\n", label, escape(text));
}

std::string make_option(const ArgumentOption& option) {
  std::string label = option.letter.empty() ? "" : bold("-" + option.letter) + ", ";
  label += bold("--" + option.name);
  if (!option.is_switch) label += " " + italic(option.value.name);
  return make_item(label, option.help);
}

std::string make_options(const std::vector<ArgumentOption>& options) {
  std::string page;
  for (const ArgumentOption& option : options) page += make_option(option);
  return page;
}

std::string make_command(const Command& command) {
  const Arguments arguments = command.describe();
  return fmt::format(".SS strut {}\n{}{}{}{}.PP\nExamples:\n{}", command.name,
                     make_text(command.purpose), make_synopsis(arguments.synopsis()),
                     make_text(arguments.description()), make_options(arguments.options()),
                     make_verbatim(arguments.examples()));
}

std::string make_exit_codes() {
  std::string page;
  for (const ExitMeaning& exit : list_exit_meanings()) {
    page += make_item(bold(exit.code), exit.meaning);
  }
  return page;
}

constexpr const char* kDescription =
    "Simulates cars that cross bumps, thousands of them in a sweep; trains networks on the results "
    "that identify a car's springs and dampers from the motion of its body; compares measured runs "
    "with simulations, names the cause of a misfit and measures the improvement of the extended "
    "model. Data goes to standard output or the named file, messages to standard error.";

constexpr const char* kExample =
    "  strut plan examples/sweeps/paper.toml -o cars\n"
    "  strut run cars\n"
    "  strut verify cars\n"
    "  strut train cars -o model.h5\n"
    "  strut identify model.h5 measured.csv";

}  // namespace

Arguments describe_man_page() {
  return {"strut man",
          "Prints the manual page strut(1) in troff's man macros. An installed strut includes it.",
          "  strut man | man -l -"};
}

int run_man_page(const Arguments& arguments, const CommandTable& commands) {
  if (!arguments.positional().empty()) throw arguments.usage_error("expected no arguments");
  std::cout << make_man_page(commands);
  if (isatty(STDOUT_FILENO) == 1) suggest_next_line("strut man | man -l -");
  return kExitDone;
}

std::string make_man_page(const CommandTable& commands) {
  std::string page = fmt::format(".TH STRUT 1 \"\" \"strut {}\" \"User Commands\"\n",
                                 escape(get_build_info().version));
  page += make_section("NAME") + "strut \\- simulate suspensions, identify and diagnose them\n";
  page += make_section("SYNOPSIS") + make_verbatim(
                                         "strut COMMAND [ARGUMENTS]\n"
                                         "strut help COMMAND\n"
                                         "strut --version");
  page += make_section("DESCRIPTION") + make_text(kDescription);
  page += make_section("COMMANDS");
  for (const Command& command : commands) page += make_command(command);
  page += make_section("OPTIONS OF EVERY COMMAND") + make_options(Arguments::common_options());
  page += make_section("EXIT STATUS") + make_exit_codes();
  page += make_section("ENVIRONMENT");
  page += make_item(bold("NO_COLOR"), "set and not empty: no colors on a terminal");
  page += make_item(bold("TERM"), "dumb: neither colors nor lines rewritten in place");
  page += make_section("EXAMPLES") +
          make_text("From a sweep to the parameters of a measured car:") + make_verbatim(kExample);
  return page + make_section("SEE ALSO") +
         make_text("The documents in the folder docs of the sources.");
}

}  // namespace strut
