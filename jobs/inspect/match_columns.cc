#include "jobs/inspect/match_columns.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/error/input_error.h"
#include "io/table/units.h"

namespace strut {
namespace {

using Words = std::set<std::string>;

/// Words that recordings use for those of channel names.
const std::map<std::string, std::vector<std::string>>& list_synonyms() {
  static const std::map<std::string, std::vector<std::string>> synonyms = {
      {"disp", {"displacement"}},
      {"displ", {"displacement"}},
      {"stroke", {"displacement"}},
      {"travel", {"displacement", "deflection"}},
      {"weg", {"displacement", "position"}},
      {"defl", {"deflection"}},
      {"pos", {"position"}},
      {"z", {"position", "z"}},
      {"x", {"position", "x"}},
      {"acc", {"acceleration"}},
      {"accel", {"acceleration"}},
      {"accz", {"acceleration", "z"}},
      {"accx", {"acceleration", "x"}},
      {"accy", {"acceleration", "y"}},
      {"az", {"acceleration", "z"}},
      {"vel", {"velocity"}},
      {"v", {"velocity"}},
      {"gyro", {"rate"}},
      {"f", {"force"}},
      {"load", {"force"}},
      {"kraft", {"force"}},
      {"temp", {"temperature"}},
      {"susp", {"suspension"}},
      {"fl", {"front", "left"}},
      {"fr", {"front", "right"}},
      {"rl", {"rear", "left"}},
      {"rr", {"rear", "right"}},
      {"lf", {"front", "left"}},
      {"rf", {"front", "right"}},
      {"lr", {"rear", "left"}},
      {"chassis", {"body", "sprung"}},
      {"body", {"body", "sprung"}},
      {"beschl", {"acceleration"}},
      {"beschleunigung", {"acceleration"}},
      {"geschw", {"velocity"}},
      {"geschwindigkeit", {"velocity"}},
      {"hoehe", {"position"}},
      {"federweg", {"displacement", "deflection"}},
      {"daempfer", {"damper"}},
      {"reifen", {"tire"}},
      {"plate", {"road"}},
      {"platte", {"road"}},
      {"ground", {"road"}},
      {"wheel", {"unsprung", "wheel"}},
      {"axle", {"unsprung"}},
      {"fahrbahn", {"road"}},
      {"strasse", {"road"}},
      {"rad", {"unsprung", "wheel"}},
      {"achse", {"unsprung"}},
      {"aufbau", {"body", "sprung"}},
      {"tyre", {"tire"}}};
  return synonyms;
}

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_word(char c) { return is_lower(c) || is_upper(c) || (c >= '0' && c <= '9'); }

/// Transliterates German letters in UTF-8: "ä" to "ae".
std::string spell_out(std::string text) {
  static const std::vector<std::pair<std::string, std::string>> pairs = {
      {"\u00e4", "ae"}, {"\u00f6", "oe"}, {"\u00fc", "ue"}, {"\u00df", "ss"},
      {"\u00c4", "AE"}, {"\u00d6", "OE"}, {"\u00dc", "UE"}};
  for (const auto& [letter, pair] : pairs) {
    for (std::size_t at = 0; (at = text.find(letter, at)) != std::string::npos;) {
      text.replace(at, letter.size(), pair);
    }
  }
  return text;
}

/// Appends the parts of a German compound, which an n or s may link: of "strassenhoehe" strasse and
/// hoehe. Returns false, and appends none, if a part is unknown.
bool split_compound(std::string_view word, std::vector<std::string>& parts) {
  constexpr std::size_t kMinPart = 3, kMaxWord = 64;  // longer ones are no words
  if (word.empty()) return true;
  if (word.size() > kMaxWord) return false;
  for (const auto& [part, meaning] : list_synonyms()) {
    if (part.size() < kMinPart || word.substr(0, part.size()) != part) continue;
    const std::string_view rest = word.substr(part.size());
    const bool is_linked = rest.size() > 1 && (rest[0] == 'n' || rest[0] == 's');
    parts.push_back(part);
    if (split_compound(rest, parts)) return true;
    if (is_linked && split_compound(rest.substr(1), parts)) return true;
    parts.pop_back();
  }
  return false;
}

/// The words of "AccZ_front", lower case: acc, z, front.
Words split_words(const std::string& text) {
  const std::string name = spell_out(text);
  std::vector<std::string> list;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is_word(name[i])) continue;
    const bool begins =
        i == 0 || !is_word(name[i - 1]) || (is_upper(name[i]) && is_lower(name[i - 1]));
    if (begins) list.emplace_back();
    list.back() += is_upper(name[i]) ? static_cast<char>(name[i] | 0x20) : name[i];
  }
  Words words;
  for (const std::string& word : list) {
    std::vector<std::string> parts;
    if (list_synonyms().count(word) > 0 || !split_compound(word, parts)) parts = {word};
    words.insert(parts.begin(), parts.end());
  }
  return words;
}

Words expand(const Words& words) {
  Words all = words;
  for (const std::string& word : words) {
    const auto found = list_synonyms().find(word);
    if (found != list_synonyms().end()) all.insert(found->second.begin(), found->second.end());
  }
  return all;
}

bool converts(const std::string& unit, const std::string& si) {
  if (unit.empty() || !is_known_unit(unit)) return true;
  try {
    find_unit_scale(unit, si);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

struct Candidate {
  double score;
  std::size_t channel, column;
};

/// The words of a column's name, and these with what they mean.
struct ColumnWords {
  Words own, meanings;
};

std::vector<ColumnWords> list_column_words(const TableSummary& table) {
  std::vector<ColumnWords> list;
  list.reserve(table.columns.size());
  for (const ColumnSummary& column : table.columns) {
    const Words own = split_words(column.name);
    list.push_back({own, expand(own)});
  }
  return list;
}

/// Fraction of the channel's words that stand in the column's name, less a little for each word too
/// many.
double calc_score(const Words& channel, const ColumnWords& column) {
  constexpr double kPerExtraWord = 0.01;
  const auto common = std::count_if(channel.begin(), channel.end(), [&](const std::string& word) {
    return column.meanings.count(word) > 0;
  });
  return static_cast<double>(common) / static_cast<double>(channel.size()) -
         kPerExtraWord * static_cast<double>(column.own.size());
}

}  // namespace

std::vector<ColumnMatch> match_columns(const ModelInfo& model, const TableSummary& table) {
  constexpr double kMinScore = 0.4, kSureScore = 0.9;
  const std::vector<ColumnWords> words = list_column_words(table);
  std::vector<Candidate> candidates;
  for (std::size_t c = 0; c < model.channels.size(); ++c) {
    const ChannelInfo& channel = model.channels[c];
    const Words wanted = split_words(channel.name);
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const ColumnSummary& column = table.columns[k];
      if (column.is_clock || !column.fault.empty()) continue;
      const std::string& unit = column.unit.empty() ? column.guessed_unit : column.unit;
      if (!converts(unit, channel.unit)) continue;
      const double score = calc_score(wanted, words[k]);
      if (score >= kMinScore) candidates.push_back({score, c, k});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::set<std::size_t> channels, columns;
  std::vector<std::pair<std::size_t, ColumnMatch>> found;
  for (const Candidate& c : candidates) {
    if (channels.count(c.channel) > 0 || columns.count(c.column) > 0) continue;
    channels.insert(c.channel);
    columns.insert(c.column);
    found.push_back({c.channel, {model.channels[c.channel].name, c.column, c.score >= kSureScore}});
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ColumnMatch> matches;
  matches.reserve(found.size());
  for (auto& [channel, match] : found) matches.push_back(std::move(match));
  return matches;
}

}  // namespace strut
