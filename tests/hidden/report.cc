#include "tests/hidden/report.h"

#include <array>
#include <cstddef>
#include <cstdio>

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

/// The trials of one kit, or of all.
struct Part {
  std::string kit;
  std::size_t count = 0;
  Score score;
};

/// A part for each kit; none where there is but one.
std::vector<Part> list_parts(const std::vector<TrueTrial>& trials,
                             const std::map<std::string, Verdict>& verdicts) {
  std::map<std::string, std::vector<TrueTrial>> kits;
  for (const TrueTrial& t : trials) kits[t.kit].push_back(t);
  std::vector<Part> parts;
  if (kits.size() == 1) return parts;
  for (const auto& [kit, own] : kits) {
    parts.push_back({kit, own.size(), calc_score(own, verdicts)});
  }
  return parts;
}

std::string print_quantity(const Quantity& q) {
  return q.count == 0 ? "-" : print("%.4g of %zu", q.value, q.count);
}

/// Gates and quantities of all trials, and those of the kits beside them.
std::string make_gates(const Score& score, const std::vector<Part>& parts, bool& passed) {
  std::string out = "| score | grades | target | measured | |";
  std::string rule = "|---|---|---|---|---|";
  for (const Part& part : parts) {
    out += " " + part.kit + " |";
    rule += "---|";
  }
  out += "\n" + rule + "\n";
  for (const Gate& gate : list_gates()) {
    const Cell cell = pool(score, gate.metric, gate.grades);
    passed = passed && passes(gate, cell);
    out += print("| %s | %s | %s %.2f | ", get_name(gate.metric), gate.grades.c_str(),
                 gate.at_least ? ">=" : "<=", gate.target) +
           print_cell(cell) + " | " + judge(gate, cell) + " |";
    for (const Part& part : parts) {
      const Cell own = pool(part.score, gate.metric, gate.grades);
      out += " " + print_cell(own) + (passes(gate, own) ? "" : " MISSED") + " |";
    }
    out += "\n";
  }
  const std::vector<Quantity> quantities = list_quantities(score);
  std::vector<std::vector<Quantity>> of_parts;
  of_parts.reserve(parts.size());
  for (const Part& part : parts) of_parts.push_back(list_quantities(part.score));
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Quantity& q = quantities[i];
    passed = passed && q.passes();
    out += print("| %s | | %s %g | ", q.name.c_str(), q.at_least ? ">=" : "<=", q.target) +
           print_quantity(q) + " | " +
           (q.count == 0 ? "no trial"
            : q.passes() ? "met"
                         : "MISSED") +
           " |";
    for (const std::vector<Quantity>& part : of_parts) {
      out += " " + print_quantity(part[i]) + (part[i].passes() ? "" : " MISSED") + " |";
    }
    out += "\n";
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
  const std::vector<Part> parts = list_parts(trials, verdicts);
  std::string out = make_gates(score, parts, passed);
  out += "\n" + print("%zu trials, verdicts missing: %d\n", trials.size(), score.missing);
  out += "\n" + make_table(score);
  for (const Part& part : parts) {
    out += "\nThe kit `" + part.kit + "` alone, " + std::to_string(part.count) + " trials:\n\n" +
           make_table(part.score);
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
