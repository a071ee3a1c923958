// What the program says on standard error: errors, notes, details, the next command. Whatever was
// printed to standard output before comes before it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// --quiet, neither, --verbose.
enum class Loudness { kQuiet, kNormal, kVerbose };

/// One for the program; kNormal at its start.
void set_loudness(Loudness loudness);
Loudness get_loudness();

/// "strut: text". What is wrong, or why the exit code is not 0: said however quiet.
void tell_error(const std::string& text);
/// "strut: text". Not said with --quiet.
void tell_note(const std::string& text);
void tell_notes(const std::vector<std::string>& texts);
/// "strut: text". Said with --verbose: settings, files, seconds.
void tell_detail(const std::string& text);

/// "next: strut run sweep  # why": the command that is to follow, quoted for a shell where it must
/// be; by say_next(), as the last that a command says. Not said with --quiet. Words in capitals
/// stand for what only the user knows.
void tell_next(const std::vector<std::string>& words, const std::string& why = "");
/// The same with a line of shell as it stands.
void tell_next_line(const std::string& line, const std::string& why = "");
/// The command under way once more, with `added` words.
void tell_next_again(const Arguments& arguments, const std::string& why,
                     const std::vector<std::string>& added = {});
/// The same with `setting`, NAME=VALUE, in place of what --set said of that name.
void tell_next_with_setting(const Arguments& arguments, const std::string& setting,
                            const std::string& why);
/// The sweep in `root` is whole, some cases `failed` and no resume is to mend them: on to the rest.
void tell_next_of_failed(const std::string& root, std::int64_t failed);
/// How to look at a page.
void tell_next_page(const std::string& file);
void say_next();
/// Lets a signal that ends the program say that it did, and the command once more, which then does
/// `what`.
void prepare_interrupt(const Arguments& arguments, const std::string& what = "begins anew");

/// Tells, with --verbose, how long it lived: "NAME: 1.2 s".
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

/// For ProgressLine: a line, and the one that stands in place on a terminal, above which messages
/// appear.
void show_line(const std::string& text);
void show_live_line(const std::string& text);
void erase_live_line();

}  // namespace strut
