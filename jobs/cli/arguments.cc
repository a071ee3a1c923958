#include "jobs/cli/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <set>
#include <utility>

#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "jobs/cli/standard_output.h"

namespace strut {
namespace {

namespace po = boost::program_options;

constexpr const char* kPositional = "positional";

std::string strip_dashes(const std::string& option) {
  const auto begin = option.find_first_not_of('-');
  return begin == std::string::npos ? option : option.substr(begin);
}

void add_to(po::options_description& all, const ArgumentOption& option) {
  const std::string name = option.name + (option.letter.empty() ? "" : "," + option.letter);
  const char* help = option.help.c_str();
  if (option.is_switch) {
    all.add_options()(name.c_str(), po::bool_switch(), help);
  } else if (option.repeats) {
    using Texts = std::vector<std::string>;
    all.add_options()(name.c_str(), po::value<Texts>()->value_name(option.value.name), help);
  } else {
    all.add_options()(name.c_str(), po::value<std::string>()->value_name(option.value.name), help);
  }
}

/// NAME of "NAME=VALUE".
std::string cut_name(const std::string& setting) { return setting.substr(0, setting.find('=')); }

}  // namespace

ArgumentValue ArgumentValue::file(const char* name, std::vector<std::string> endings) {
  ArgumentValue value(name);
  value.kind = Kind::kFile;
  value.endings = std::move(endings);
  return value;
}

ArgumentValue ArgumentValue::folder(const char* name) {
  ArgumentValue value(name);
  value.kind = Kind::kFolder;
  return value;
}

ArgumentValue ArgumentValue::path(const char* name, std::vector<std::string> endings) {
  ArgumentValue value = file(name, std::move(endings));
  value.kind = Kind::kPath;
  return value;
}

ArgumentValue ArgumentValue::setting() {
  ArgumentValue value("NAME=VALUE");
  value.kind = Kind::kSetting;
  return value;
}

ArgumentValue ArgumentValue::one_of(std::vector<std::string> words) {
  const std::string name = fmt::format("{}", fmt::join(words, "|"));
  return one_of(name.c_str(), std::move(words));
}

ArgumentValue ArgumentValue::one_of(const char* name, std::vector<std::string> words) {
  ArgumentValue value(name);
  value.kind = Kind::kChoice;
  value.words = std::move(words);
  return value;
}

Arguments::Arguments(std::string synopsis, std::string description, std::string examples)
    : synopsis_(std::move(synopsis)),
      description_(std::move(description)),
      examples_(std::move(examples)) {}

void Arguments::add_operand(ArgumentValue value) { operands_.push_back(std::move(value)); }

void Arguments::add_operands(ArgumentValue value) {
  add_operand(std::move(value));
  last_operand_repeats_ = true;
}

void Arguments::add(const std::string& name, ArgumentOption option) {
  const std::size_t comma = name.find(',');
  option.name = name.substr(0, comma);
  if (comma != std::string::npos) option.letter = name.substr(comma + 1);
  options_.push_back(std::move(option));
}

void Arguments::add_switch(const std::string& name, const std::string& help) {
  add(name, {"", "", true, false, "", help});
}

void Arguments::add_option(const std::string& name, ArgumentValue value, const std::string& help) {
  add(name, {"", "", false, false, std::move(value), help});
}

void Arguments::add_list(const std::string& name, ArgumentValue value, const std::string& help) {
  add(name, {"", "", false, true, std::move(value), help});
}

void Arguments::add_removed(const std::string& name, const std::string& remedy) {
  removed_[name] = remedy;
}

const std::vector<ArgumentOption>& Arguments::common_options() {
  static const std::vector<ArgumentOption> options = {
      {"quiet", "q", true, false, "", "print only errors on standard error"},
      {"verbose", "v", true, false, "", "print more there: settings, files, durations"},
      {"help", "h", true, false, "", "print this text"}};
  return options;
}

std::string Arguments::command() const {
  const std::size_t begin = synopsis_.find(' ') + 1;
  return synopsis_.substr(begin, synopsis_.find_first_of(" \n", begin) - begin);
}

po::options_description Arguments::describe_options() const {
  po::options_description all("", 100, 60);
  for (const ArgumentOption& option : options_) add_to(all, option);
  for (const ArgumentOption& option : common_options()) add_to(all, option);
  return all;
}

bool Arguments::parse(const std::vector<std::string>& words) {
  words_ = words;
  po::options_description all = describe_options();
  all.add_options()(kPositional, po::value<std::vector<std::string>>());
  po::positional_options_description positions;
  positions.add(kPositional, -1);
  using po::command_line_style::allow_guessing;
  using po::command_line_style::unix_style;
  try {
    po::store(po::command_line_parser(words)
                  .options(all)
                  .positional(positions)
                  .style(unix_style & ~allow_guessing)
                  .run(),
              values_);
  } catch (const po::unknown_option& e) {
    const std::string name = strip_dashes(e.get_option_name());
    if (const auto removed = removed_.find(name); removed != removed_.end()) {
      throw InputError(fmt::format("--{}: no longer an option: {}", name, removed->second));
    }
    const std::string nearest = nearest_name(name, list_option_names());
    throw usage_error(
        fmt::format("unknown option '{}'{}", e.get_option_name(),
                    nearest.empty() ? "" : fmt::format("; did you mean '--{}'?", nearest)));
  } catch (const po::error& e) {
    throw usage_error(e.what());
  }
  if (values_.count(kPositional) > 0) {
    positional_ = values_[kPositional].as<std::vector<std::string>>();
  }
  if (is_on("help")) {
    print_help();
    return false;
  }
  if (is_on("quiet") && is_on("verbose")) {
    throw InputError("--quiet, --verbose: mutually exclusive; give one of them");
  }
  check_repeated_names();
  return true;
}

void Arguments::print_help() const {
  print_styled("Usage:", Style::kBold);
  std::cout << fmt::format(" {}\n\n{}\n\n", synopsis_, description_);
  print_styled("Options:", Style::kBold);
  std::cout << "\n" << describe_options() << "\n";
  print_styled("Examples:", Style::kBold);
  std::cout << fmt::format("\n{}\n", examples_);
}

const std::string& Arguments::only_operand(const std::string& meaning) const {
  if (positional_.size() != 1) {
    throw usage_error(fmt::format("{} arguments; expected {}{}", positional_.size(),
                                  operands_.front().name, meaning));
  }
  return positional_.front();
}

InputError Arguments::usage_error(const std::string& what) const {
  return InputError(
      fmt::format("{}\nUsage: {}\nSee `strut {} --help`", what, synopsis_, command()));
}

std::vector<std::string> Arguments::list_option_names() const {
  std::vector<std::string> names;
  for (const ArgumentOption& option : options_) names.push_back(option.name);
  for (const ArgumentOption& option : common_options()) names.push_back(option.name);
  return names;
}

std::vector<std::string> Arguments::words_with_setting(const std::string& setting) const {
  const std::string option = "--set";
  const auto replaces = [&](const std::string& word) {
    return cut_name(word) == cut_name(setting);
  };
  std::vector<std::string> words;
  for (std::size_t i = 0; i < words_.size(); ++i) {
    const std::string& word = words_[i];
    if (word == option && i + 1 < words_.size() && replaces(words_[i + 1])) {
      ++i;
    } else if (!word.starts_with(option + "=") || !replaces(word.substr(option.size() + 1))) {
      words.push_back(word);
    }
  }
  words.insert(words.end(), {option, setting});
  return words;
}

void Arguments::check_repeated_names() const {
  for (const ArgumentOption& option : options_) {
    if (!option.repeats || option.value.name.find('=') == std::string::npos) continue;
    std::set<std::string> names;
    for (const std::string& setting : list(option.name)) {
      const std::string name = cut_name(setting);
      if (!names.insert(name).second) {
        throw InputError(fmt::format("--{}: '{}' given twice; allowed: once", option.name, name));
      }
    }
  }
}

std::string Arguments::text(const std::string& name) const {
  return values_[name].as<std::string>();
}

std::string Arguments::text_or(const std::string& name, const std::string& fallback) const {
  return has(name) ? text(name) : fallback;
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
  throw InputError(fmt::format("--{} = {}: {}", name, digits, allowed.describe()));
}

std::int64_t Arguments::integer_or(const std::string& name, std::int64_t fallback, std::int64_t low,
                                   std::int64_t high) const {
  if (!has(name)) return fallback;
  const std::string digits = text(name);
  const auto value = parse_number<std::int64_t>(digits);
  if (value && *value >= low && *value <= high) return *value;
  throw InputError(
      fmt::format("--{} = {}: must be a whole number in [{}, {}]", name, digits, low, high));
}

int Arguments::choice_or(const std::string& name, int fallback) const {
  if (!has(name)) return fallback;
  const std::string value = text(name);
  const auto option =
      std::find_if(options_.begin(), options_.end(),
                   [&name](const ArgumentOption& candidate) { return candidate.name == name; });
  const std::vector<std::string>& words = option->value.words;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == value) return static_cast<int>(i);
  }
  throw InputError(fmt::format("--{} = {}: must be one of {}{}", name, value, join_names(words),
                               suggest_name(value, words)));
}

}  // namespace strut
