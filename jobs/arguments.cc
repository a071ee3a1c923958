#include "jobs/arguments.h"

#include <iostream>

#include "io/nearest_name.h"
#include "io/parse_number.h"

namespace strut {
namespace {

namespace po = boost::program_options;

constexpr const char* kPositional = "positional";

std::string strip_dashes(const std::string& option) {
  const auto begin = option.find_first_not_of('-');
  return begin == std::string::npos ? option : option.substr(begin);
}

}  // namespace

Arguments::Arguments(std::string synopsis, std::string text, std::string examples)
    : synopsis_(std::move(synopsis)),
      text_(std::move(text)),
      examples_(std::move(examples)),
      options_("Options", 100, 60) {
  options_.add_options()("help,h", po::bool_switch(), "show this text");
}

void Arguments::add_switch(const char* name, const char* help) {
  options_.add_options()(name, po::bool_switch(), help);
}

void Arguments::add_option(const char* name, const char* value, const char* help) {
  options_.add_options()(name, po::value<std::string>()->value_name(value), help);
}

void Arguments::add_list(const char* name, const char* value, const char* help) {
  options_.add_options()(name, po::value<std::vector<std::string>>()->value_name(value), help);
}

bool Arguments::parse(const std::vector<std::string>& arguments) {
  po::options_description all;
  all.add(options_).add_options()(kPositional, po::value<std::vector<std::string>>());
  po::positional_options_description places;
  places.add(kPositional, -1);
  using po::command_line_style::allow_guessing;
  using po::command_line_style::unix_style;
  try {
    po::store(po::command_line_parser(arguments)
                  .options(all)
                  .positional(places)
                  .style(unix_style & ~allow_guessing)
                  .run(),
              values_);
  } catch (const po::unknown_option& e) {
    const std::string name = strip_dashes(e.get_option_name());
    std::string suggestion = nearest_name(name, known_options());
    if (!suggestion.empty()) suggestion = "; did you mean '--" + suggestion + "'?";
    throw usage_error("unknown option '" + e.get_option_name() + "'" + suggestion);
  } catch (const po::error& e) {
    throw usage_error(e.what());
  }
  if (values_.count(kPositional) > 0) {
    positional_ = values_[kPositional].as<std::vector<std::string>>();
  }
  if (!is_on("help")) return true;
  std::cout << "Usage: " << synopsis_ << "\n\n"
            << text_ << "\n\n"
            << options_ << "\nExamples:\n"
            << examples_ << "\n";
  return false;
}

InputError Arguments::usage_error(const std::string& what) const {
  return InputError(what + "\nUsage: " + synopsis_);
}

std::vector<std::string> Arguments::known_options() const {
  std::vector<std::string> names;
  for (const auto& option : options_.options()) names.push_back(option->long_name());
  return names;
}

std::string Arguments::text(const std::string& name) const {
  return values_[name].as<std::string>();
}

std::vector<std::string> Arguments::list(const std::string& name) const {
  if (!has(name)) return {};
  return values_[name].as<std::vector<std::string>>();
}

double Arguments::number_or(const std::string& name, double fallback, const Range& allowed) const {
  if (!has(name)) return fallback;
  const std::string digits = text(name);
  const auto value = parse_number<double>(digits);
  if (value && allowed.contains(*value)) return *value;
  throw InputError("--" + name + " = " + digits + ": " + allowed.describe());
}

std::int64_t Arguments::integer_or(const std::string& name, std::int64_t fallback, std::int64_t low,
                                   std::int64_t high) const {
  if (!has(name)) return fallback;
  const std::string digits = text(name);
  const auto value = parse_number<std::int64_t>(digits);
  if (value && *value >= low && *value <= high) return *value;
  throw InputError("--" + name + " = " + digits + ": must be a whole number in [" +
                   std::to_string(low) + ", " + std::to_string(high) + "]");
}

int Arguments::choice_or(const std::string& name, int fallback,
                         const std::vector<std::string>& names) const {
  if (!has(name)) return fallback;
  const std::string value = text(name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == value) return static_cast<int>(i);
  }
  throw InputError("--" + name + " = " + value + ": must be one of " + join_names(names) +
                   suggest_name(value, names));
}

}  // namespace strut
