// The arguments of one command as a table, from which the command line is parsed (by
// Boost.Program_options) and help, shell completion, manual page and error messages are generated.
#pragma once

#include <boost/program_options.hpp>
#include <map>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/range.h"

namespace strut {

/// The value of an operand or option: its placeholder in the help (FILE, NAME) and what it accepts.
struct ArgumentValue {
  enum class Kind { kText, kChoice, kFile, kFolder, kPath, kSetting };

  ArgumentValue(const char* text_name) : name(text_name) {}  // NOLINT: implicit for plain text
  /// A file with one of `endings` ("toml"), which only completion uses; none: any file.
  static ArgumentValue file(const char* name, std::vector<std::string> endings = {});
  static ArgumentValue folder(const char* name);
  /// A file or a folder.
  static ArgumentValue path(const char* name, std::vector<std::string> endings = {});
  /// "NAME=VALUE", the name being that of a parameter.
  static ArgumentValue setting();
  /// One of `words`; the placeholder in the help is "WORD|WORD|...".
  static ArgumentValue one_of(std::vector<std::string> words);
  /// The same with a placeholder of its own, for words that differ between machines.
  static ArgumentValue one_of(const char* name, std::vector<std::string> words);

  std::string name;
  Kind kind = Kind::kText;
  std::vector<std::string> words;    // allowed values; kChoice only
  std::vector<std::string> endings;  // expected endings without the dot; kFile and kPath only
};

struct ArgumentOption {
  std::string name;    // without dashes
  std::string letter;  // short name without dash; empty: none
  bool is_switch = false, repeats = false;
  ArgumentValue value;  // unused for a switch
  std::string help;
};

class Arguments {
 public:
  /// `synopsis` starts with the program and the command: "strut simulate VEHICLE ...".
  Arguments(std::string synopsis, std::string description, std::string examples);

  /// Adds the next positional argument.
  void add_operand(ArgumentValue value);
  /// Adds the last positional argument, which may be given more than once.
  void add_operands(ArgumentValue value);
  /// Adds a switch, or an option with a value; `name` may include the letter: "output,o".
  void add_switch(const std::string& name, const std::string& help);
  void add_option(const std::string& name, ArgumentValue value, const std::string& help);
  /// Adds an option that may be given more than once; one of NAME=VALUE, once for each NAME.
  void add_list(const std::string& name, ArgumentValue value, const std::string& help);

  /// Adds an option of earlier versions, which is refused; `remedy` says what to do instead.
  void add_removed(const std::string& name, const std::string& remedy);

  const std::string& synopsis() const { return synopsis_; }
  const std::string& description() const { return description_; }
  const std::string& examples() const { return examples_; }
  const std::vector<ArgumentValue>& operands() const { return operands_; }
  bool last_operand_repeats() const { return last_operand_repeats_; }
  /// The options of this command alone.
  const std::vector<ArgumentOption>& options() const { return options_; }
  /// The options of every command: --quiet, --verbose, --help.
  static const std::vector<ArgumentOption>& common_options();
  /// The name of the command, from the synopsis: "simulate".
  std::string command() const;

  /// Parses a command line. Returns false if --help was given and printed. Throws InputError.
  bool parse(const std::vector<std::string>& words);

  /// The words that were parsed.
  const std::vector<std::string>& words() const { return words_; }
  /// The words that were parsed, with --set `setting` ("NAME=VALUE") replacing any --set of NAME.
  std::vector<std::string> words_with_setting(const std::string& setting) const;
  const std::vector<std::string>& positional() const { return positional_; }
  /// The argument of a command that takes exactly one. Throws InputError for any other number;
  /// `meaning` follows the operand's name in the message (", a folder").
  const std::string& only_operand(const std::string& meaning = "") const;
  /// An InputError that adds the synopsis to `what`.
  InputError usage_error(const std::string& what) const;

  bool has(const std::string& name) const { return values_.count(name) > 0; }
  bool is_on(const std::string& name) const { return values_[name].as<bool>(); }
  std::string text(const std::string& name) const;
  std::string text_or(const std::string& name, const std::string& fallback) const;
  std::vector<std::string> list(const std::string& name) const;
  double number_or(const std::string& name, double fallback, const Range& allowed) const;
  /// An integer in [low, high].
  std::int64_t integer_or(const std::string& name, std::int64_t fallback, std::int64_t low,
                          std::int64_t high) const;
  /// Index of the option's value among its words.
  int choice_or(const std::string& name, int fallback) const;

 private:
  void add(const std::string& name, ArgumentOption option);
  boost::program_options::options_description describe_options() const;
  std::vector<std::string> list_option_names() const;
  /// Throws InputError if an option of NAME=VALUE sets a NAME twice.
  void check_repeated_names() const;
  void print_help() const;

  std::string synopsis_, description_, examples_;
  std::vector<ArgumentValue> operands_;
  bool last_operand_repeats_ = false;
  std::vector<ArgumentOption> options_;
  std::map<std::string, std::string> removed_;  // name -> remedy
  std::vector<std::string> words_;
  boost::program_options::variables_map values_;
  std::vector<std::string> positional_;
};

}  // namespace strut
