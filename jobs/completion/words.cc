#include "jobs/completion/words.h"

#include "model_files/parameters.h"

namespace strut {

std::vector<std::string> list_spellings(const ArgumentOption& option) {
  std::vector<std::string> spellings = {"--" + option.name};
  if (!option.letter.empty()) spellings.push_back("-" + option.letter);
  return spellings;
}

std::vector<ArgumentOption> list_all_options(const Arguments& arguments) {
  std::vector<ArgumentOption> all = arguments.options();
  const std::vector<ArgumentOption>& common = Arguments::common_options();
  all.insert(all.end(), common.begin(), common.end());
  return all;
}

std::string join_parameter_names() {
  std::string names;
  for (const ParameterInfo& p : list_parameters()) names += (names.empty() ? "" : " ") + p.name;
  return names;
}

}  // namespace strut
