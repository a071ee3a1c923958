#include "tests/hidden/report.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <set>

namespace strut::hidden {
namespace {

template <class... Numbers>
std::string print(const char* form, Numbers... numbers) {
  std::array<char, 256> buffer{};
  std::snprintf(buffer.data(), buffer.size(), form, numbers...);
  return buffer.data();
}

/// Whether the point value is on the right side of the target, and the interval.
std::string judge(const Gate& gate, const Cell& cell) {
  if (cell.total == 0) return "no trial";
  if (!passes(gate, cell)) return "MISSED";
  const double share = static_cast<double>(cell.hits) / cell.total;
  const bool met = gate.at_least ? share >= gate.target : share <= gate.target;
  return met ? "met" : "open: the interval holds the target";
}

std::string make_gates(const Score& score, bool& passed) {
  std::string out = "| score | grades | target | measured | |\n|---|---|---|---|---|\n";
  for (const Gate& gate : list_gates()) {
    const Cell cell = pool(score, gate.metric, gate.grades);
    passed = passed && passes(gate, cell);
    out += print("| %s | %s | %s %.2f | ", get_name(gate.metric), gate.grades.c_str(),
                 gate.at_least ? ">=" : "<=", gate.target) +
           print_cell(cell) + " | " + judge(gate, cell) + " |\n";
  }
  for (const Quantity& q : list_quantities(score)) {
    passed = passed && q.passes();
    out += print("| %s | | %s %g | ", q.name.c_str(), q.at_least ? ">=" : "<=", q.target) +
           (q.count == 0
                ? "- | no trial |\n"
                : print("%.4g of %zu | %s |\n", q.value, q.count, q.passes() ? "met" : "MISSED"));
  }
  return out;
}

std::string make_table(const Score& score) {
  std::string out = "| score | A | B | C | D | nothing hidden |\n|---|---|---|---|---|---|\n";
  for (int m = 0; m < static_cast<int>(Metric::kCount); ++m) {
    const auto metric = static_cast<Metric>(m);
    out += std::string("| ") + get_name(metric) + " |";
    for (const char grade : {'A', 'B', 'C', 'D', '-'}) {
      out += " " + print_cell(pool(score, metric, std::string(1, grade))) + " |";
    }
    out += "\n";
  }
  return out;
}

std::string quote(const std::string& text) { return "\"" + text + "\""; }

}  // namespace

std::string print_cell(const Cell& cell) {
  if (cell.total == 0) return "-";
  const Interval i = calc_wilson(cell.hits, cell.total);
  return print("%d/%d %.3f [%.3f, %.3f]", cell.hits, cell.total,
               static_cast<double>(cell.hits) / cell.total, i.low, i.high);
}

std::string make_report(const std::vector<TrueTrial>& trials,
                        const std::map<std::string, Verdict>& verdicts, bool& passed) {
  const Score score = calc_score(trials, verdicts);
  passed = score.missing == 0;
  std::string out = make_gates(score, passed);
  out += "\n" + print("%zu trials, verdicts missing: %d\n", trials.size(), score.missing);
  out += "\n" + make_table(score);
  std::set<std::string> kits;
  for (const TrueTrial& t : trials) kits.insert(t.kit);
  for (const std::string& kit : kits) {
    if (kits.size() == 1) break;
    std::vector<TrueTrial> part;
    for (const TrueTrial& t : trials) {
      if (t.kit == kit) part.push_back(t);
    }
    out += "\nThe kit `" + kit + "` alone, " + std::to_string(part.size()) + " trials:\n\n" +
           make_table(calc_score(part, verdicts));
  }
  out += print("\n%zu trials not answered right:\n\n", score.failures.size());
  for (const std::string& line : score.failures) out += "- " + line + "\n";
  return out;
}

std::string make_score_json(const Score& score) {
  std::string cells, quantities;
  for (const auto& [metric, grades] : score.cells) {
    std::string entries;
    for (const auto& [grade, cell] : grades) {
      entries += (entries.empty() ? "" : ", ") + quote(std::string(1, grade)) +
                 print(": [%d, %d]", cell.hits, cell.total);
    }
    cells += (cells.empty() ? "" : ",\n  ") + quote(get_name(metric)) + ": {" + entries + "}";
  }
  for (const Quantity& q : list_quantities(score)) {
    quantities += (quantities.empty() ? "" : ",\n  ") + quote(q.name) +
                  print(": [%.6g, %zu]", q.value, q.count);
  }
  return "{\"cells\": {" + cells + "},\n \"quantities\": {" + quantities +
         print("},\n \"missing\": %d}\n", score.missing);
}

}  // namespace strut::hidden
