#include "jobs/completion/words.h"

#include <algorithm>

#include "model_files/parameters.h"

namespace strut {

std::vector<std::string> list_spellings(const ArgumentOption& option) {
  std::vector<std::string> spellings = {"--" + option.name};
  if (!option.letter.empty()) spellings.push_back("-" + option.letter);
  return spellings;
}

namespace {

/// Shells show a description on one line.
std::string join_lines(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::vector<ArgumentOption> list_all_options(const Arguments& arguments) {
  std::vector<ArgumentOption> all = arguments.options();
  const std::vector<ArgumentOption>& common = Arguments::common_options();
  all.insert(all.end(), common.begin(), common.end());
  for (ArgumentOption& option : all) option.help = join_lines(option.help);
  return all;
}

std::string join_parameter_names() {
  std::string names;
  for (const ParameterInfo& p : list_parameters()) names += (names.empty() ? "" : " ") + p.name;
  return names;
}

}  // namespace strut
