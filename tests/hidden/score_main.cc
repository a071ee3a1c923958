// strut_hidden_score: verdicts against the sealed truths.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/hidden/limits.h"
#include "tests/hidden/regrade.h"
#include "tests/hidden/report.h"

namespace strut::hidden {
namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Usage: strut_hidden_score [OPTION] TRUTHS VERDICTS [TRUTHS VERDICTS...]\n"
    "       strut_hidden_score --regrade FILE [THREADS] [LIST]\n\n"
    "Prints how the verdicts VERDICTS/SEED/verdict.json answer the truths TRUTHS/SEED.json, per\n"
    "grade of the signal-to-noise ratio with 95 % Wilson intervals, trials of several kits\n"
    "together and kit by kit. Exit status 1 where the whole interval of a gate lies on the wrong\n"
    "side of its target, a score without interval does, or a verdict is missing.\n\n"
    "  --limits FILE       exit status 1 where a score lies beyond its limit in FILE instead, or\n"
    "                      where the limits would let an impostor pass\n"
    "  --set-limits FILE   writes FILE from this run\n"
    "  --json              prints counts and values as JSON; exit status 0\n"
    "  --regrade FILE      grades the published trials of FILE anew, without new verdicts, and\n"
    "                      prints their scores by both grades; LIST gets a line for each fault\n\n"
    "Example: strut_hidden_score hidden/truths hidden/verdicts\n";

struct Request {
  std::string option, limits;
  std::vector<fs::path> folders;
};

bool is_regrade(const std::vector<std::string>& words) {
  return !words.empty() && words.front() == "--regrade";
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
}

int print_regrade(const std::vector<std::string>& words) {
  if (words.size() < 2 || words.size() > 4) {
    throw std::invalid_argument("--regrade FILE [THREADS] [LIST]");
  }
  const auto threads = words.size() > 2 ? static_cast<unsigned>(std::stoul(words[2])) : 1U;
  const std::vector<PublishedTrial> published = read_published(words[1]);
  const std::vector<Trial> trials = regrade(published, threads);
  std::cout << make_regrade_report(published, trials);
  if (words.size() > 3) write_text(words[3], make_regrade_list(published, trials));
  return 0;
}

struct Trials {
  std::vector<TrueTrial> truths;
  std::map<std::string, Verdict> verdicts;
};

Request parse(std::vector<std::string> words) {
  Request request;
  if (!words.empty() && words.front().rfind("--", 0) == 0) {
    request.option = words.front();
    words.erase(words.begin());
    if (request.option == "--limits" || request.option == "--set-limits") {
      if (words.empty()) throw std::invalid_argument(request.option + ": file is missing");
      request.limits = words.front();
      words.erase(words.begin());
    } else if (request.option != "--json") {
      throw std::invalid_argument(request.option + ": no such option");
    }
  }
  if (words.empty() || words.size() % 2 != 0) {
    throw std::invalid_argument("pairs of folders are asked for");
  }
  request.folders.assign(words.begin(), words.end());
  return request;
}

Trials read_trials(const std::vector<fs::path>& folders) {
  Trials trials;
  for (std::size_t i = 0; i + 1 < folders.size(); i += 2) {
    for (TrueTrial& truth : read_truths(folders[i])) {
      const fs::path path = folders[i + 1] / truth.name / "verdict.json";
      truth.name = truth.kit + " " + truth.name;
      if (fs::exists(path)) trials.verdicts[truth.name] = read_verdict(path);
      trials.truths.push_back(truth);
    }
  }
  return trials;
}

/// Impostors that pass the limits.
std::vector<std::string> find_passing_impostors(const Limits& limits, const Trials& trials) {
  std::vector<std::string> passing;
  for (const Impostor& impostor : make_impostors(trials.truths, trials.verdicts)) {
    if (find_misses(limits, calc_score(trials.truths, impostor.verdicts)).empty()) {
      passing.push_back("the limits let pass " + impostor.name);
    }
  }
  return passing;
}

int judge(const Limits& limits, const Trials& trials) {
  const Score score = calc_score(trials.truths, trials.verdicts);
  std::cout << "\n" << make_limits_table(limits, score) << "\n";
  std::vector<std::string> misses = find_misses(limits, score);
  for (const std::string& line : find_passing_impostors(limits, trials)) misses.push_back(line);
  for (const std::string& line : misses) std::cout << "MISSED: " << line << "\n";
  if (misses.empty()) std::cout << "every limit is kept\n";
  return misses.empty() ? 0 : 1;
}

int run(const Request& request) {
  const Trials trials = read_trials(request.folders);
  if (request.option == "--json") {
    std::cout << make_score_json(calc_score(trials.truths, trials.verdicts));
    return 0;
  }
  bool passed = false;
  std::cout << make_report(trials.truths, trials.verdicts, passed);
  if (request.option == "--limits") return judge(read_limits(request.limits), trials);
  if (request.option == "--set-limits") {
    const Limits limits = make_limits(calc_score(trials.truths, trials.verdicts));
    write_text(request.limits, make_limits_json(limits));
    return judge(limits, trials);
  }
  return passed ? 0 : 1;
}

}  // namespace
}  // namespace strut::hidden

int main(int count, char** words) {
  try {
    const std::vector<std::string> list(words + 1, words + count);
    if (strut::hidden::is_regrade(list)) return strut::hidden::print_regrade(list);
    return strut::hidden::run(strut::hidden::parse(list));
  } catch (const std::invalid_argument& e) {
    std::cerr << "strut_hidden_score: " << e.what() << "\n\n" << strut::hidden::kUsage;
    return 2;
  } catch (const std::exception& e) {
    std::cerr << "strut_hidden_score: " << e.what() << "\n";
    return 2;
  }
}
