#include "jobs/cli/messages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <iostream>
#include <mutex>
#include <string_view>
#include <utility>

#include "base/text/quote_word.h"
#include "base/text/shorten.h"
#include "base/text/utf8.h"
#include "jobs/cli/clock.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/progress.h"
#include "jobs/cli/terminal.h"

namespace strut {
namespace {

constexpr const char* kEraseLine = "\r\033[K";

std::atomic<Verbosity> verbosity{Verbosity::kNormal};
std::mutex mutex;       // guards standard error and the variables below
std::string live_line;  // the text on the terminal's live line; empty: none
std::vector<std::string> suggestions;

/// Bounds of a message, which may quote a file of any content.
constexpr std::size_t kMaxBytes = 8000, kMaxLineBytes = 4000, kMaxLines = 24;

/// Makes untrusted `text`, which may quote files and names, safe for a terminal: bounded, without
/// control characters.
std::string make_safe(const std::string& text) {
  std::string safe;
  const std::string escaped = escape_controls(shorten(text, kMaxBytes));
  std::size_t begin = 0, lines = 0;
  for (; begin <= escaped.size() && lines < kMaxLines; ++lines) {
    const std::size_t end = std::min(escaped.find('\n', begin), escaped.size());
    const std::string_view line = std::string_view(escaped).substr(begin, end - begin);
    safe += (lines == 0 ? "" : "\n") + shorten(line, kMaxLineBytes);
    begin = end + 1;
  }
  if (begin <= escaped.size()) safe += "\n...";
  return shorten(safe, kMaxBytes);
}

std::string paint(const std::string& text, Style style) {
  const std::string safe = make_safe(text);
  return shows_colors(STDERR_FILENO) ? get_sequence(style) + safe + kPlainSequence : safe;
}

std::string make_next_line(const std::string& line, const std::string& why) {
  return paint("next:", Style::kBold) + " " + make_safe(line) +
         (why.empty() ? "" : paint("  # " + why, Style::kDim));
}

std::string make_error(const std::string& text) {
  return paint("strut:", Style::kRed) + " " + make_safe(text);
}

std::string join_quoted(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  quoted.reserve(words.size());
  for (const std::string& word : words) quoted.push_back(quote_if_needed(word));
  return fmt::format("{}", fmt::join(quoted, " "));
}

/// The words of a command line of the current command.
std::vector<std::string> name_command(const Arguments& arguments,
                                      const std::vector<std::string>& words) {
  std::vector<std::string> line = {"strut", arguments.command()};
  line.insert(line.end(), words.begin(), words.end());
  return line;
}

/// Prints a line of safe text above the live line.
void print_line(const std::string& line) {
  // Data precedes the message, although only one of the streams is buffered.
  std::cout.flush();
  const std::lock_guard lock(mutex);
  std::cerr << (live_line.empty() ? "" : kEraseLine) << line << "\n" << live_line << std::flush;
}

}  // namespace

void set_verbosity(Verbosity value) { verbosity = value; }

Verbosity get_verbosity() { return verbosity; }

void print_error(const std::string& text) { print_line(make_error(text)); }

void print_note(const std::string& text) {
  if (verbosity != Verbosity::kQuiet) print_line("strut: " + make_safe(text));
}

void print_notes(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) print_note(text);
}

void print_detail(const std::string& text) {
  if (verbosity == Verbosity::kVerbose) print_line(paint("strut: " + text, Style::kDim));
}

void suggest_next_line(const std::string& line, const std::string& why) {
  if (verbosity == Verbosity::kQuiet) return;
  const std::lock_guard lock(mutex);
  suggestions.push_back(make_next_line(line, why));
}

void print_suggestions() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(mutex);
    lines.swap(suggestions);
  }
  for (const std::string& line : lines) print_line(line);
}

void suggest_next(const std::vector<std::string>& words, const std::string& why) {
  suggest_next_line(join_quoted(words), why);
}

void suggest_again(const Arguments& arguments, const std::string& why,
                   const std::vector<std::string>& added) {
  std::vector<std::string> words = arguments.words();
  words.insert(words.end(), added.begin(), added.end());
  suggest_next(name_command(arguments, words), why);
}

void suggest_again_with_setting(const Arguments& arguments, const std::string& setting,
                                const std::string& why) {
  suggest_next(name_command(arguments, arguments.words_with_setting(setting)), why);
}

void suggest_next_after_failures(const std::string& root, std::int64_t failed) {
  suggest_next(
      {"strut", "verify", root},
      fmt::format("{} {} failed; strut train leaves {} out", format_count(failed),
                  failed == 1 ? "case remains" : "cases remain", failed == 1 ? "it" : "them"));
}

void suggest_page(const std::string& file) { suggest_next({"xdg-open", file}); }

void prepare_interrupt(const Arguments& arguments, const std::string& what) {
  std::string text = is_live_terminal(STDERR_FILENO) ? kEraseLine : "";
  text += make_error("interrupted") + "\n";
  if (verbosity != Verbosity::kQuiet) {
    const std::vector<std::string> line = name_command(arguments, arguments.words());
    text += make_next_line(join_quoted(line), what) + "\n";
  }
  set_interrupt_message(text);
}

Stage::Stage(std::string name) : name_(std::move(name)), start_(now()) {}

Stage::~Stage() { print_detail(fmt::format("{}: {}", name_, format_duration(now() - start_))); }

void show_line(const std::string& text) { print_line(make_safe(text)); }

void show_live_line(const std::string& text) {
  const std::lock_guard lock(mutex);
  live_line = make_safe(text);
  std::cerr << kEraseLine << live_line << std::flush;
}

void erase_live_line() {
  const std::lock_guard lock(mutex);
  if (live_line.empty()) return;
  live_line.clear();
  std::cerr << kEraseLine << std::flush;
}

}  // namespace strut
