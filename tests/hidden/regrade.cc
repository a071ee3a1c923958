#include "tests/hidden/regrade.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <exception>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/hidden/fault_range.h"
#include "tests/hidden/report.h"

namespace strut::hidden {
namespace {

constexpr std::array<const char*, 3> kKits = {"dyno", "quarter_car", "car"};

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, mark);) words.push_back(word);
  if (!text.empty() && text.back() == mark) words.emplace_back();
  return words;
}

Fault find_fault(const std::string& name) {
  for (const FaultInfo& info : list_faults()) {
    if (name == info.name) return info.fault;
  }
  throw std::invalid_argument("fault '" + name + "': no such fault");
}

PublishedTrial parse_line(const std::string& line) {
  constexpr std::size_t kHead = 4, kOfFault = 5;
  const std::vector<std::string> words = split(line, ',');
  if (words.size() < kHead || (words.size() - kHead) % kOfFault != 0) {
    throw std::invalid_argument(fmt::format("{} fields", words.size()));
  }
  PublishedTrial trial;
  trial.kit = words[0];
  trial.seed = std::stoull(words[1]);
  trial.answer = words[2];
  trial.names = split(words[3], ' ');
  for (std::size_t i = kHead; i < words.size(); i += kOfFault) {
    trial.faults.push_back(
        {find_fault(words[i]), std::stoi(words[i + 1]), std::stod(words[i + 2]), 0.0});
    trial.ratios.push_back(std::stod(words[i + 3]));
    trial.grades += words[i + 4].at(0);
  }
  return trial;
}

std::string make_name(const std::string& effect, const std::string& place) {
  // A lost stroke and a worn joint are one answer.
  const std::string known = effect == "joint_play" ? "damper_leak" : effect;
  return place.empty() ? known : known + "@" + place;
}

/// Whether names hold a hidden fault, or with `by_class` one that the runs cannot tell from it.
bool is_named(const PublishedTrial& published, const Kit& kit, const HiddenFault& fault,
              bool by_class) {
  const std::string effect = get_info(fault.setting.fault).effect;
  if (effect.empty()) return false;
  std::vector<std::string> right = {make_name(effect, get_place(kit, fault.setting))};
  if (by_class) {
    for (const CauseName& c : fault.twins) right.push_back(make_name(c.effect, c.place));
  }
  return std::any_of(published.names.begin(), published.names.end(), [&](const std::string& name) {
    const std::vector<std::string> parts = split(name, '@');
    const std::string own = make_name(parts[0], parts.size() > 1 ? parts[1] : "");
    return std::find(right.begin(), right.end(), own) != right.end();
  });
}

bool claims_names(const PublishedTrial& published) {
  return published.answer == "named" || published.answer == "group" ||
         published.answer == "form_incomplete";
}

int count_right(const PublishedTrial& published, const Trial& trial, bool by_class) {
  if (published.answer == "right") return static_cast<int>(trial.faults.size());
  if (!claims_names(published)) return 0;
  const Kit kit = make_kit(published.kit);
  return static_cast<int>(
      std::count_if(trial.faults.begin(), trial.faults.end(),
                    [&](const HiddenFault& f) { return is_named(published, kit, f, by_class); }));
}

/// Counts of one kit by grade.
using Cells = std::map<Metric, std::map<char, Cell>>;

struct Grades {
  char of_detection = '-', of_distinction = '-';
};

void count(const PublishedTrial& published, const Trial& trial, const Grades& grades, bool by_class,
           Cells& cells) {
  const bool detected = published.answer != "adequate";
  const int right = count_right(published, trial, by_class);
  switch (trial.category) {
    case Category::kNone:
      cells[Metric::kFalseAlarm]['-'].add(published.answer != "right");
      break;
    case Category::kOne:
      cells[Metric::kDetected][grades.of_detection].add(detected);
      cells[Metric::kInPrintedGroup][grades.of_detection].add(right == 1);
      break;
    case Category::kTwo:
      cells[Metric::kBothNamed][grades.of_distinction].add(right == 2);
      cells[Metric::kOneOfTwoNamed][grades.of_detection].add(right >= 1);
      break;
    case Category::kUnknown:
      cells[Metric::kUnknownFlagged][grades.of_distinction].add(
          published.answer == "right" || published.answer == "unknown" ||
          published.answer == "form_incomplete");
      break;
  }
}

char get_old_grade(const PublishedTrial& published) {
  char grade = '-';
  for (const char g : published.grades) grade = std::max(grade, g);
  return grade;
}

Grades get_new_grades(const Trial& trial) {
  const char grade = trial.get_grade();
  if (trial.category == Category::kUnknown) return {grade, find_grade(trial.beyond_one)};
  if (trial.category == Category::kTwo) {
    return {grade, std::max(grade, find_grade(trial.beyond_two))};
  }
  return {grade, grade};
}

std::string print_row(const std::string& title, const std::array<std::string, 4>& cells) {
  std::string row = "| " + title + " |";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

std::string make_scores(const std::string& kit, const std::vector<PublishedTrial>& published,
                        const std::vector<Trial>& trials) {
  Cells old_cells, new_cells;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (published[i].kit != kit) continue;
    const char old_grade = get_old_grade(published[i]);
    count(published[i], trials[i], {old_grade, old_grade}, false, old_cells);
    count(published[i], trials[i], get_new_grades(trials[i]), true, new_cells);
  }
  std::string out;
  for (const Metric metric : {Metric::kDetected, Metric::kInPrintedGroup, Metric::kUnknownFlagged,
                              Metric::kBothNamed, Metric::kOneOfTwoNamed}) {
    for (const auto& [title, cells] : {std::pair{"old", &old_cells}, {"new", &new_cells}}) {
      std::array<std::string, 4> row;
      for (std::size_t g = 0; g < row.size(); ++g) {
        row[g] = print_cell((*cells)[metric]["ABCD"[g]]);
      }
      out += print_row(fmt::format("{} | {} | {}", kit, get_name(metric), title), row);
    }
  }
  return out;
}

double calc_median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string make_ratios(const std::vector<PublishedTrial>& published,
                        const std::vector<Trial>& trials) {
  std::map<std::string, std::map<std::string, std::vector<double>>> quotients;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    for (std::size_t f = 0; f < trials[i].faults.size(); ++f) {
      const HiddenFault& fault = trials[i].faults[f];
      quotients[get_info(fault.setting.fault).name][published[i].kit].push_back(
          fault.ratio / published[i].ratios[f]);
    }
  }
  std::string out = "| fault | dyno | quarter_car | car |\n|---|---|---|---|\n";
  for (const auto& [fault, kits] : quotients) {
    out += "| " + fault + " |";
    for (const char* kit : kKits) {
      const auto found = kits.find(kit);
      out += found == kits.end()
                 ? " - |"
                 : fmt::format(" {:.2f} ({}) |", calc_median(found->second), found->second.size());
    }
    out += "\n";
  }
  return out;
}

std::string make_migration(const std::vector<PublishedTrial>& published,
                           const std::vector<Trial>& trials) {
  std::map<std::string, std::map<char, std::map<char, int>>> moves;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const char old_grade = get_old_grade(published[i]);
    if (old_grade != '-') ++moves[published[i].kit][old_grade][trials[i].get_grade()];
  }
  std::string out = "| kit | old grade | now A | B | C | D |\n|---|---|---|---|---|---|\n";
  for (const char* kit : kKits) {
    for (const char old_grade : {'A', 'B', 'C', 'D'}) {
      std::array<std::string, 4> row;
      for (std::size_t g = 0; g < row.size(); ++g) {
        row[g] = std::to_string(moves[kit][old_grade]["ABCD"[g]]);
      }
      out += print_row(fmt::format("{} | {}", kit, old_grade), row);
    }
  }
  return out;
}

}  // namespace

std::vector<PublishedTrial> read_published(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path.string() + ": cannot be read");
  std::vector<PublishedTrial> trials;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    try {
      trials.push_back(parse_line(line));
    } catch (const std::exception& e) {
      throw std::runtime_error(fmt::format("{}, line {}: {}", path.string(), number, e.what()));
    }
  }
  return trials;
}

std::vector<Trial> regrade(const std::vector<PublishedTrial>& published, unsigned threads) {
  std::vector<Trial> trials(published.size());
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex guard;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < published.size(); i = next++) {
        trials[i] = grade_trial(make_kit(published[i].kit), published[i].seed, published[i].faults);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      failure = std::current_exception();
      next = published.size();
    }
  };
  std::vector<std::thread> team;
  for (unsigned i = 0; i < std::max(threads, 1U); ++i) team.emplace_back(work);
  for (std::thread& t : team) t.join();
  if (failure) std::rethrow_exception(failure);
  return trials;
}

std::string make_regrade_report(const std::vector<PublishedTrial>& published,
                                const std::vector<Trial>& trials) {
  std::string out = "Median of the new over the old ratio (number of faults):\n\n";
  out += make_ratios(published, trials);
  out += "\nTrials by the grade of their fault that is harder to detect:\n\n";
  out += make_migration(published, trials);
  out += "\n| kit | score | grades | A | B | C | D |\n|---|---|---|---|---|---|---|\n";
  for (const char* kit : kKits) out += make_scores(kit, published, trials);
  return out;
}

std::string make_regrade_list(const std::vector<PublishedTrial>& published,
                              const std::vector<Trial>& trials) {
  std::string out = "kit,seed,answer,beyond_one,beyond_two,fault,ratio_old,ratio_new,twins\n";
  for (std::size_t i = 0; i < trials.size(); ++i) {
    for (std::size_t f = 0; f < trials[i].faults.size(); ++f) {
      const HiddenFault& fault = trials[i].faults[f];
      std::string twins;
      for (const CauseName& c : fault.twins) twins += make_name(c.effect, c.place) + " ";
      out += fmt::format("{},{},{},{:.3g},{:.3g},{},{:.3g},{:.3g},{}\n", published[i].kit,
                         published[i].seed, published[i].answer, trials[i].beyond_one,
                         trials[i].beyond_two, get_info(fault.setting.fault).name,
                         published[i].ratios[f], fault.ratio, twins);
    }
  }
  return out;
}

}  // namespace strut::hidden
