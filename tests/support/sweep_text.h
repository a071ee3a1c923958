// Sweep files for tests.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sweep/plan.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

inline const std::string kExampleFolder = STRUT_SOURCE_DIR "/examples/";

using Replacements = std::vector<std::pair<std::string, std::string>>;

/// examples/sweeps/paper.toml with texts replaced, each of which must be there.
inline std::string make_sweep_text(const Replacements& replacements = {}) {
  std::string text = read_text(kExampleFolder + "sweeps/paper.toml");
  Replacements all = {{"\"../vehicles/", "\"" + kExampleFolder + "vehicles/"},
                      {"\"../maneuvers/", "\"" + kExampleFolder + "maneuvers/"}};
  all.insert(all.end(), replacements.begin(), replacements.end());
  for (const auto& [from, to] : all) {
    const std::size_t at = text.find(from);
    INFO("'" << from << "' in paper.toml");
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  }
  return text;
}

/// The same without its four axes, with these lines in their place.
inline std::string make_grid_text(const std::string& axes, const Replacements& replacements = {}) {
  std::string text = make_sweep_text(replacements);
  const std::size_t begin = text.find("front_stiffness = {"), end = text.find("[sample]");
  REQUIRE(begin != std::string::npos);
  return text.substr(0, begin) + axes + "\n" + text.substr(end);
}

inline SweepRequest read_sweep_text(const std::string& text) {
  const TemporaryFolder folder;
  return read_request(folder.write("sweep.toml", text));
}

inline Plan make_plan_of(const std::string& text) { return Plan(read_sweep_text(text)); }

}  // namespace strut::test
