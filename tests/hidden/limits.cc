#include "tests/hidden/limits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "tests/hidden/report.h"

namespace strut::hidden {
namespace {

/// The gate's cell that a limit is of; throws std::runtime_error for a score that is not counted.
Cell find_cell(const Score& score, const Limit& limit) {
  for (const Gate& gate : list_gates()) {
    if (get_name(gate.metric) == limit.score && gate.grades == limit.grades) {
      return pool(score, gate.metric, gate.grades);
    }
  }
  throw std::runtime_error("limit of '" + limit.score + "', grades " + limit.grades +
                           ": no such score");
}

std::string describe(const Limit& limit) {
  return limit.score + " (" + limit.grades + "): " + (limit.at_least ? "at least " : "at most ") +
         std::to_string(limit.count) + " of " + std::to_string(limit.of);
}

bool keeps(const Limit& limit, const Cell& cell) {
  return limit.at_least ? cell.hits >= limit.count : cell.hits <= limit.count;
}

/// The effect and place hidden most often.
Claim find_usual(const std::vector<TrueTrial>& trials) {
  std::map<std::pair<std::string, std::string>, int> count;
  for (const TrueTrial& t : trials) {
    for (const TrueFault& f : t.faults) {
      if (!f.effect.empty()) ++count[{f.effect, f.place}];
    }
  }
  if (count.empty()) throw std::invalid_argument("trials that hide nothing judge no tool");
  const auto usual = std::max_element(
      count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {usual->first.first, usual->first.second, 0.99, {}};
}

}  // namespace

Limits make_limits(const Score& score) {
  Limits made{score.contents, {}};
  for (const Gate& gate : list_gates()) {
    const Cell cell = pool(score, gate.metric, gate.grades);
    if (cell.total == 0) continue;
    const Interval usual = calc_wilson(cell.hits, cell.total, 0.5);
    const auto count = [&](double share) {
      return static_cast<int>(std::lround(share * cell.total));
    };
    const int bound = gate.at_least ? std::min(count(usual.low), cell.hits - 1)
                                    : std::max(count(usual.high), cell.hits + 1);
    if (bound <= 0) continue;
    made.limits.push_back(
        {get_name(gate.metric), gate.grades, gate.at_least, bound, cell.total, cell.hits});
  }
  return made;
}

std::vector<std::string> find_misses(const Limits& limits, const Score& score) {
  std::vector<std::string> misses;
  if (limits.contents != score.contents) {
    misses.emplace_back("these are not the trials that the limits were set for");
  }
  if (score.missing > 0) {
    misses.push_back(std::to_string(score.missing) + " verdicts are missing");
  }
  for (const Limit& limit : limits.limits) {
    const Cell cell = find_cell(score, limit);
    if (!keeps(limit, cell)) {
      misses.push_back(describe(limit) + ", measured " + std::to_string(cell.hits) + " of " +
                       std::to_string(cell.total));
    }
  }
  return misses;
}

std::string make_limits_table(const Limits& limits, const Score& score) {
  std::string out =
      "| score | grades | limit | when set | measured | |\n|---|---|---|---|---|---|\n";
  for (const Limit& limit : limits.limits) {
    const Cell cell = find_cell(score, limit);
    out += "| " + limit.score + " | " + limit.grades + (limit.at_least ? " | >= " : " | <= ") +
           std::to_string(limit.count) + " | " + std::to_string(limit.measured) + "/" +
           std::to_string(limit.of) + " | " + print_cell(cell) + " | " +
           (keeps(limit, cell) ? "kept" : "MISSED") + " |\n";
  }
  return out;
}

std::vector<Impostor> make_impostors(const std::vector<TrueTrial>& trials,
                                     const std::map<std::string, Verdict>& verdicts) {
  Impostor always{"who always names the usual effect", {}}, never{"who never names any", {}},
      shuffled{"the tool, its verdicts handed out to other trials", {}};
  Verdict named;
  named.verdict = "named";
  named.causes = {find_usual(trials)};
  Verdict adequate;
  adequate.verdict = "adequate";
  for (std::size_t i = 0; i < trials.size(); ++i) {
    always.verdicts[trials[i].name] = named;
    never.verdicts[trials[i].name] = adequate;
    const auto other = verdicts.find(trials[(i + trials.size() / 3) % trials.size()].name);
    if (other != verdicts.end()) shuffled.verdicts[trials[i].name] = other->second;
  }
  return {always, never, shuffled};
}

std::string make_limits_json(const Limits& limits) {
  std::string contents, lines;
  for (const auto& [category, grades] : limits.contents) {
    std::string entries;
    for (const auto& [grade, count] : grades) {
      entries += (entries.empty() ? "\"" : ", \"") + std::string(1, grade) +
                 "\": " + std::to_string(count);
    }
    contents += (contents.empty() ? "\"" : ",\n  \"") + category + "\": {" + entries + "}";
  }
  for (const Limit& limit : limits.limits) {
    lines += (lines.empty() ? "" : ",\n  ");
    lines += R"({"score": ")" + limit.score + R"(", "grades": ")" + limit.grades + "\", \"" +
             (limit.at_least ? "at_least" : "at_most") + "\": " + std::to_string(limit.count) +
             ", \"of\": " + std::to_string(limit.of) +
             ", \"measured\": " + std::to_string(limit.measured) + "}";
  }
  return "{\"trials\": {\n  " + contents + "},\n \"limits\": [\n  " + lines + "]}\n";
}

Limits read_limits(const std::filesystem::path& path) {
  const test::JsonTree tree = read_json(path);
  try {
    Limits read;
    for (const auto& [category, grades] : tree.get_child("trials")) {
      for (const auto& [grade, count] : grades) {
        read.contents[category][grade.at(0)] = count.get_value<int>();
      }
    }
    for (const auto& entry : tree.get_child("limits")) {
      const test::JsonTree& l = entry.second;
      const auto least = l.get_optional<int>("at_least");
      read.limits.push_back({l.get<std::string>("score"), l.get<std::string>("grades"),
                             least.has_value(), least ? *least : l.get<int>("at_most"),
                             l.get<int>("of"), l.get<int>("measured")});
    }
    return read;
  } catch (const boost::property_tree::ptree_error& e) {
    throw std::runtime_error(path.string() + ": " + e.what());
  }
}

}  // namespace strut::hidden
