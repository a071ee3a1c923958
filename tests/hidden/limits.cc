#include "tests/hidden/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "tests/hidden/report.h"

namespace strut::hidden {
namespace {

constexpr double kAllowed = 1.5;  // times as much error as measured

/// The gate that a limit is of; throws std::runtime_error for a score that is not counted.
const Gate& find_gate(const Limit& limit) {
  for (const Gate& gate : list_gates()) {
    if (get_name(gate.metric) == limit.score && gate.grades == limit.grades &&
        gate.at_least == limit.at_least) {
      return gate;
    }
  }
  throw std::runtime_error("limit of '" + limit.score + "', grades " + limit.grades +
                           ": no such score");
}

Cell find_cell(const Score& score, const Limit& limit) {
  return pool(score, find_gate(limit).metric, limit.grades);
}

Quantity find_quantity(const Score& score, const QuantityLimit& limit) {
  for (Quantity& q : list_quantities(score)) {
    if (q.name == limit.quantity && q.at_least == limit.at_least) return q;
  }
  throw std::runtime_error("limit of '" + limit.quantity + "': no such quantity");
}

std::string format(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
  return buffer.data();
}

std::string describe(const Limit& limit) {
  return limit.score + " (" + limit.grades + "): " + (limit.at_least ? "at least " : "at most ") +
         std::to_string(limit.count) + " of " + std::to_string(limit.of);
}

/// By count; by fraction where the verdicts determine the cell's size.
bool keeps(const Limit& limit, const Cell& cell) {
  int hits = cell.hits, bound = limit.count;
  if (!is_size_fixed(find_gate(limit).metric)) {
    if (cell.total == 0) return !limit.at_least;
    hits *= limit.of;
    bound *= cell.total;
  }
  return limit.at_least ? hits >= bound : hits <= bound;
}

std::string describe(const QuantityLimit& limit) {
  return limit.quantity + ": " + (limit.at_least ? "at least " : "at most ") + format(limit.bound);
}

bool keeps(const QuantityLimit& limit, const Quantity& q) {
  return q.count > 0 && (limit.at_least ? q.value >= limit.bound : q.value <= limit.bound);
}

/// Min or max hits of a run, from a measured cell.
int calc_bound(const Gate& gate, const Cell& cell) {
  if (gate.metric == Metric::kBaseCovered && gate.at_least) {
    const int missed = cell.total - cell.hits;
    return cell.total - std::max(static_cast<int>(kAllowed * missed), missed + 1);
  }
  const Interval usual = calc_wilson(cell.hits, cell.total, 0.5);
  const auto count = [&](double share) {
    return static_cast<int>(std::lround(share * cell.total));
  };
  if (gate.at_least) return std::min(count(usual.low), cell.hits - 1);
  // Who comes nearer to a target from below has not become worse.
  const double target = gate.target * cell.total;
  // Of few intervals all may hold.
  const double most = gate.metric == Metric::kEffectCovered || gate.metric == Metric::kBaseCovered
                          ? std::ceil(target)
                          : std::floor(target);
  return std::max({count(usual.high), cell.hits + 1, static_cast<int>(most)});
}

std::vector<QuantityLimit> make_quantity_limits(const Score& score) {
  constexpr int kLeast = 5;  // more than the parameters of a single car
  std::vector<QuantityLimit> made;
  for (const Quantity& q : list_quantities(score)) {
    if (q.count < kLeast) continue;
    const double bound = q.at_least ? q.value / kAllowed : kAllowed * q.value + q.slack;
    made.push_back({q.name, q.at_least, q.value == 0.0 ? q.target : bound, q.count, q.value});
  }
  return made;
}

/// The most frequently hidden effect and place.
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
  Limits made{score.contents, {}, make_quantity_limits(score)};
  for (const Gate& gate : list_gates()) {
    const Cell cell = pool(score, gate.metric, gate.grades);
    if (cell.total == 0) continue;
    const int bound = calc_bound(gate, cell);
    // A bound that every run keeps is none.
    if (!gate.at_least && bound >= cell.total) continue;
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
    if (cell.total != limit.of && is_size_fixed(find_gate(limit).metric)) {
      misses.push_back(describe(limit) + ", now of " + std::to_string(cell.total) +
                       ": these are not the trials that the limits were set for");
    }
  }
  for (const QuantityLimit& limit : limits.quantities) {
    const Quantity q = find_quantity(score, limit);
    if (keeps(limit, q)) continue;
    misses.push_back(describe(limit) + ", measured " +
                     (q.count == 0 ? "nothing" : format(q.value)));
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
  for (const QuantityLimit& limit : limits.quantities) {
    const Quantity q = find_quantity(score, limit);
    out += "| " + limit.quantity + " | | " + (limit.at_least ? ">= " : "<= ") +
           format(limit.bound) + " | " + format(limit.measured) + " of " +
           std::to_string(limit.of) + " | " +
           (q.count == 0 ? "-" : format(q.value) + " of " + std::to_string(q.count)) + " | " +
           (keeps(limit, q) ? "kept" : "MISSED") + " |\n";
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
  std::string quantities;
  for (const QuantityLimit& limit : limits.quantities) {
    quantities += (quantities.empty() ? "" : ",\n  ") + std::string("{\"quantity\": \"") +
                  limit.quantity + "\", \"" + (limit.at_least ? "at_least" : "at_most") +
                  "\": " + format(limit.bound) + ", \"of\": " + std::to_string(limit.of) +
                  ", \"measured\": " + format(limit.measured) + "}";
  }
  return "{\"trials\": {\n  " + contents + "},\n \"limits\": [\n  " + lines +
         "],\n \"quantities\": [\n  " + quantities + "]}\n";
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
    for (const auto& entry : tree.get_child("quantities")) {
      const test::JsonTree& l = entry.second;
      const auto least = l.get_optional<double>("at_least");
      read.quantities.push_back({l.get<std::string>("quantity"), least.has_value(),
                                 least ? *least : l.get<double>("at_most"),
                                 l.get<std::size_t>("of"), l.get<double>("measured")});
    }
    return read;
  } catch (const boost::property_tree::ptree_error& e) {
    throw std::runtime_error(path.string() + ": " + e.what());
  }
}

}  // namespace strut::hidden
