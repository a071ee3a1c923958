// Messages on standard error: errors, notes, details, suggested next commands. Standard output is
// flushed first, so that data precedes the messages about it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// --quiet, neither, --verbose.
enum class Verbosity { kQuiet, kNormal, kVerbose };

/// One setting for the whole program; initially kNormal.
void set_verbosity(Verbosity verbosity);
Verbosity get_verbosity();

/// Prints "strut: TEXT", at every verbosity: an error, or the reason for an exit code other than 0.
void print_error(const std::string& text);
/// Prints "strut: TEXT" unless --quiet is given.
void print_note(const std::string& text);
void print_notes(const std::vector<std::string>& texts);
/// Prints "strut: TEXT" only with --verbose: settings, files, durations.
void print_detail(const std::string& text);

/// Stores a suggestion, "next: strut run sweep  # WHY", for print_suggestions(). Words are quoted
/// for a shell where necessary; words in capitals are placeholders that only the user can fill in.
/// Ignored with --quiet.
void suggest_next(const std::vector<std::string>& words, const std::string& why = "");
/// The same for a complete shell command line, which is not quoted.
void suggest_next_line(const std::string& line, const std::string& why = "");
/// Suggests the current command again, with the words `added` appended.
void suggest_again(const Arguments& arguments, const std::string& why,
                   const std::vector<std::string>& added = {});
/// Suggests the current command again, with `setting` ("NAME=VALUE") replacing --set of that name.
void suggest_again_with_setting(const Arguments& arguments, const std::string& setting,
                                const std::string& why);
/// Suggests how to continue with the complete sweep in `root`, of which `failed` cases failed and
/// no resume will repair them.
void suggest_next_after_failures(const std::string& root, std::int64_t failed);
/// Suggests a command that opens a page.
void suggest_page(const std::string& file);
/// Prints the stored suggestions; called once, at the end of a command.
void print_suggestions();

/// Prepares the message printed if a signal ends the program: "interrupted", and the same command
/// again, which then does `what`.
void prepare_interrupt(const Arguments& arguments, const std::string& what = "starts over");

/// Prints its own lifetime on destruction, with --verbose: "NAME: 1.2 s".
class Stage {
 public:
  explicit Stage(std::string name);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  const std::string name_;
  const double start_;
};

/// For ProgressLine: an ordinary line, and the live line of a terminal, which is rewritten in place
/// and above which messages appear.
void show_line(const std::string& text);
void show_live_line(const std::string& text);
void erase_live_line();

}  // namespace strut
