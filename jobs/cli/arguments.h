// The arguments of one command, a table: from it options are parsed by Boost.Program_options, and
// help, completion, man page and the messages about wrong values are made.
#pragma once

#include <boost/program_options.hpp>
#include <map>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/range.h"

namespace strut {

/// What stands on a command line where the help says FILE, NAME or the like.
struct ArgumentValue {
  enum class Kind { kText, kChoice, kFile, kFolder, kPath, kSetting };

  ArgumentValue(const char* text_name) : name(text_name) {}  // NOLINT: most values are plain text
  /// A file; `endings`: "toml", as far as one is expected.
  static ArgumentValue file(const char* name, std::vector<std::string> endings = {});
  static ArgumentValue folder(const char* name);
  /// Either.
  static ArgumentValue path(const char* name, std::vector<std::string> endings = {});
  /// "NAME=VALUE" of a parameter.
  static ArgumentValue setting();
  /// One of `words`, which are its name in the help.
  static ArgumentValue one_of(std::vector<std::string> words);
  /// The same under another name, for words that differ between machines.
  static ArgumentValue one_of(const char* name, std::vector<std::string> words);

  std::string name;
  Kind kind = Kind::kText;
  std::vector<std::string> words;    // of a choice
  std::vector<std::string> endings;  // of a file, without the dot
};

struct ArgumentOption {
  std::string name;    // without dashes
  std::string letter;  // the short name, or nothing
  bool is_switch = false, repeats = false;
  ArgumentValue value;  // nameless for a switch
  std::string help;
};

class Arguments {
 public:
  /// `synopsis`: "strut simulate VEHICLE ...". `description` stands below it in the help,
  /// `examples` at the end.
  Arguments(std::string synopsis, std::string description, std::string examples);

  /// What the command takes beside options, in its order.
  void add_operand(ArgumentValue value);
  /// The last of them, which may be given more than once.
  void add_operands(ArgumentValue value);
  /// A switch, or an option with a value; `name`: "output,o" with its letter.
  void add_switch(const std::string& name, const std::string& help);
  void add_option(const std::string& name, ArgumentValue value, const std::string& help);
  /// As add_option; may be given more than once, of NAME=VALUE once for each NAME.
  void add_list(const std::string& name, ArgumentValue value, const std::string& help);

  /// An option that earlier versions had; `why` says what to do instead.
  void add_removed(const std::string& name, const std::string& why);

  const std::string& synopsis() const { return synopsis_; }
  const std::string& description() const { return description_; }
  const std::string& examples() const { return examples_; }
  const std::vector<ArgumentValue>& operands() const { return operands_; }
  bool last_operand_repeats() const { return last_operand_repeats_; }
  /// The command's own.
  const std::vector<ArgumentOption>& options() const { return options_; }
  /// Those of every command: --help, --quiet, --verbose.
  static const std::vector<ArgumentOption>& common_options();
  /// "simulate", of the synopsis.
  std::string command() const;

  /// False where --help was asked for and printed. Throws InputError.
  bool parse(const std::vector<std::string>& words);

  /// What was parsed.
  const std::vector<std::string>& words() const { return words_; }
  /// The same with `NAME=VALUE` of --set in place of what they set NAME to, if anything.
  std::vector<std::string> words_with_setting(const std::string& setting) const;
  const std::vector<std::string>& positional() const { return positional_; }
  /// InputError that shows how to call the command.
  InputError usage_error(const std::string& what) const;

  bool has(const std::string& name) const { return values_.count(name) > 0; }
  bool is_on(const std::string& name) const { return values_[name].as<bool>(); }
  std::string text(const std::string& name) const;
  std::string text_or(const std::string& name, const std::string& fallback) const;
  std::vector<std::string> list(const std::string& name) const;
  double number_or(const std::string& name, double fallback, const Range& allowed) const;
  /// Of [low, high].
  std::int64_t integer_or(const std::string& name, std::int64_t fallback, std::int64_t low,
                          std::int64_t high) const;
  /// Position of the option's value among its words.
  int choice_or(const std::string& name, int fallback) const;

 private:
  void add(const std::string& name, ArgumentOption option);
  boost::program_options::options_description describe_options() const;
  std::vector<std::string> known_options() const;
  /// In each list of NAME=VALUE. Throws InputError.
  void refuse_doubled_names() const;
  void print_help() const;

  std::string synopsis_, description_, examples_;
  std::vector<ArgumentValue> operands_;
  bool last_operand_repeats_ = false;
  std::vector<ArgumentOption> options_;
  std::map<std::string, std::string> removed_;  // name -> what to do instead
  std::vector<std::string> words_;
  boost::program_options::variables_map values_;
  std::vector<std::string> positional_;
};

}  // namespace strut
