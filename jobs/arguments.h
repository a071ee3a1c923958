// The arguments of one command: options by Boost.Program_options, help, and messages that name the
// option, its value and what is allowed.
#pragma once

#include <boost/program_options.hpp>
#include <string>
#include <vector>

#include "io/config.h"

namespace strut {

class Arguments {
 public:
  /// `synopsis`: "strut simulate VEHICLE ...". `text` stands below it in the help, `examples` at
  /// the end.
  Arguments(std::string synopsis, std::string text, std::string examples);

  /// A switch, or an option with a value named `value` in the help.
  void add_switch(const char* name, const char* help);
  void add_option(const char* name, const char* value, const char* help);
  /// As add_option; may be given more than once.
  void add_list(const char* name, const char* value, const char* help);

  /// False where --help was asked for and printed. Throws InputError.
  bool parse(const std::vector<std::string>& arguments);

  const std::vector<std::string>& positional() const { return positional_; }
  /// InputError that shows how to call the command.
  InputError usage_error(const std::string& what) const;

  bool has(const std::string& name) const { return values_.count(name) > 0; }
  bool is_on(const std::string& name) const { return values_[name].as<bool>(); }
  std::string text(const std::string& name) const;
  std::vector<std::string> list(const std::string& name) const;
  double number_or(const std::string& name, double fallback, const Range& allowed) const;
  /// Of [low, high].
  std::int64_t integer_or(const std::string& name, std::int64_t fallback, std::int64_t low,
                          std::int64_t high) const;
  /// Position in `names` of the option's value.
  int choice_or(const std::string& name, int fallback, const std::vector<std::string>& names) const;

 private:
  std::vector<std::string> known_options() const;

  std::string synopsis_, text_, examples_;
  boost::program_options::options_description options_;
  boost::program_options::variables_map values_;
  std::vector<std::string> positional_;
};

}  // namespace strut
