#include "jobs/messages.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <utility>

#include "jobs/dispatch/quote_word.h"
#include "jobs/interrupt.h"
#include "jobs/machine.h"
#include "jobs/progress.h"
#include "jobs/terminal.h"

namespace strut {
namespace {

constexpr const char* kEraseLine = "\r\033[K";

std::atomic<Loudness> loudness{Loudness::kNormal};
/// Of standard error; what it holds back is the line shown there last.
std::mutex mutex;
std::string live_line;
std::vector<std::string> next_lines;

std::string paint_error(const std::string& text, Style style) {
  return paint(text, style, STDERR_FILENO);
}

std::string make_next_line(const std::string& line, const std::string& why) {
  return paint_error("next:", Style::kBold) + " " + line +
         (why.empty() ? "" : paint_error("  # " + why, Style::kDim));
}

std::string make_error(const std::string& text) {
  return paint_error("strut:", Style::kRed) + " " + text;
}

std::string join_quoted(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quote_if_needed(word);
  return line;
}

/// A command line of the command under way.
std::vector<std::string> name_command(const Arguments& arguments,
                                      const std::vector<std::string>& words) {
  std::vector<std::string> line = {"strut", arguments.command()};
  line.insert(line.end(), words.begin(), words.end());
  return line;
}

void say(const std::string& line) {
  // Data before the message, though one stream is buffered and the other is not.
  std::cout.flush();
  std::fflush(stdout);
  const std::lock_guard lock(mutex);
  std::cerr << (live_line.empty() ? "" : kEraseLine) << line << "\n" << live_line << std::flush;
}

}  // namespace

void set_loudness(Loudness value) { loudness = value; }

Loudness get_loudness() { return loudness; }

void tell_error(const std::string& text) { say(make_error(text)); }

void tell_note(const std::string& text) {
  if (loudness != Loudness::kQuiet) say("strut: " + text);
}

void tell_notes(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) tell_note(text);
}

void tell_detail(const std::string& text) {
  if (loudness == Loudness::kVerbose) say(paint_error("strut: " + text, Style::kDim));
}

void tell_next_line(const std::string& line, const std::string& why) {
  if (loudness == Loudness::kQuiet) return;
  const std::lock_guard lock(mutex);
  next_lines.push_back(make_next_line(line, why));
}

void say_next() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(mutex);
    lines.swap(next_lines);
  }
  for (const std::string& line : lines) say(line);
}

void tell_next(const std::vector<std::string>& words, const std::string& why) {
  tell_next_line(join_quoted(words), why);
}

void tell_next_again(const Arguments& arguments, const std::string& why,
                     const std::vector<std::string>& added) {
  std::vector<std::string> words = arguments.words();
  words.insert(words.end(), added.begin(), added.end());
  tell_next(name_command(arguments, words), why);
}

void tell_next_with_setting(const Arguments& arguments, const std::string& setting,
                            const std::string& why) {
  tell_next(name_command(arguments, arguments.words_with_setting(setting)), why);
}

void tell_next_of_failed(const std::string& root, std::int64_t failed) {
  tell_next({"strut", "verify", root},
            format_count(failed) + (failed == 1 ? " case stays failed" : " cases stay failed") +
                "; strut train leaves out what failed");
}

void tell_next_page(const std::string& file) { tell_next({"xdg-open", file}); }

void prepare_interrupt(const Arguments& arguments, const std::string& what) {
  std::string text = is_live_terminal(STDERR_FILENO) ? kEraseLine : "";
  text += make_error("interrupted") + "\n";
  if (loudness != Loudness::kQuiet) {
    const std::vector<std::string> line = name_command(arguments, arguments.words());
    text += make_next_line(join_quoted(line), what) + "\n";
  }
  set_last_words(text);
}

Stage::Stage(std::string name) : name_(std::move(name)), start_(now()) {}

Stage::~Stage() { tell_detail(name_ + ": " + format_duration(now() - start_)); }

void show_line(const std::string& text) { say(text); }

void show_live_line(const std::string& text) {
  const std::lock_guard lock(mutex);
  live_line = text;
  std::cerr << kEraseLine << text << std::flush;
}

void erase_live_line() {
  const std::lock_guard lock(mutex);
  if (live_line.empty()) return;
  live_line.clear();
  std::cerr << kEraseLine << std::flush;
}

}  // namespace strut
