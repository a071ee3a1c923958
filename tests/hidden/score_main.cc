// strut_hidden_score: verdicts against the sealed truths.
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>

#include "tests/hidden/score.h"

namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Usage: strut_hidden_score TRUTHS VERDICTS\n\n"
    "Prints how the verdicts VERDICTS/SEED/verdict.json answer the truths TRUTHS/SEED.json, per\n"
    "grade of the signal-to-noise ratio with 95 % Wilson intervals. Exit status 1 where the whole\n"
    "interval of a gate lies on the wrong side of its target, or a verdict is missing.\n\n"
    "Example: strut_hidden_score hidden/truths verdicts\n";

int score(const fs::path& truths, const fs::path& folder) {
  const auto trials = strut::hidden::read_truths(truths);
  std::map<std::string, strut::hidden::Verdict> verdicts;
  for (const auto& trial : trials) {
    const fs::path path = folder / trial.name / "verdict.json";
    if (fs::exists(path)) verdicts[trial.name] = strut::hidden::read_verdict(path);
  }
  bool passed = false;
  std::cout << strut::hidden::make_report(strut::hidden::calc_score(trials, verdicts), passed);
  return passed ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    return score(words[1], words[2]);
  } catch (const std::exception& e) {
    std::cerr << "strut_hidden_score: " << e.what() << "\n";
    return 2;
  }
}
