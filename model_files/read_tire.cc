#include "model_files/read_tire.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "io/format/text_line.h"
#include "io/format/tir.h"
#include "model/error/model_error.h"

namespace strut {
namespace {

struct Coefficient {
  const char* section;
  const char* name;
  double Pac2002<double>::*field;
  const char* unit;
};

const std::vector<Coefficient>& get_coefficients() {
  static const std::vector<Coefficient> kCoefficients = {
#define STRUT_PAC2002_ROW(section, name, value, unit, meaning) \
  {section, #name, &Pac2002<double>::name, unit},
      STRUT_PAC2002_COEFFICIENTS(STRUT_PAC2002_ROW)
#undef STRUT_PAC2002_ROW
  };
  return kCoefficients;
}

constexpr const char* kCurveSection = "DEFLECTION_LOAD_CURVE";

/// Required keys with their sections.
constexpr std::array<std::array<const char*, 2>, 11> kRequired = {{
    {"MODEL", "PROPERTY_FILE_FORMAT"},
    {"DIMENSION", "UNLOADED_RADIUS"},
    {"VERTICAL", "VERTICAL_STIFFNESS"},
    {"VERTICAL", "FNOMIN"},
    {"LONGITUDINAL_COEFFICIENTS", "PCX1"},
    {"LONGITUDINAL_COEFFICIENTS", "PDX1"},
    {"LONGITUDINAL_COEFFICIENTS", "PKX1"},
    {"LATERAL_COEFFICIENTS", "PCY1"},
    {"LATERAL_COEFFICIENTS", "PDY1"},
    {"LATERAL_COEFFICIENTS", "PKY1"},
    {"LATERAL_COEFFICIENTS", "PKY2"},
}};

/// The units that a file must state; messages show the first name.
const std::vector<std::pair<std::string, std::vector<std::string>>> kUnits = {
    {"LENGTH", {"meter", "m"}},
    {"FORCE", {"newton", "n"}},
    {"ANGLE", {"radian", "radians", "rad"}},
    {"MASS", {"kg", "kilogram"}},
    {"TIME", {"second", "sec", "s"}},
};

/// Parts of PAC2002 that are not modeled: accepted with their neutral values only.
const std::set<std::string> kZeroOnly = {"PPX1",
                                         "PPX2",
                                         "PPX3",
                                         "PPX4",
                                         "PPY1",
                                         "PPY2",
                                         "PPY3",
                                         "PPY4",
                                         "QPX1",
                                         "QPZ1",
                                         "QPZ2",
                                         "QSX4",
                                         "QSX5",
                                         "QSX6",
                                         "QSX7",
                                         "QSX8",
                                         "QSX9",
                                         "QSX10",
                                         "QSX11",
                                         "QSY5",
                                         "QSY6",
                                         "QSY7",
                                         "QSY8",
                                         "QFZ1",
                                         "QFZ2",
                                         "QFZ3",
                                         "QPFZ1",
                                         "QV1",
                                         "QV2",
                                         "QFCX1",
                                         "QFCY1",
                                         "QFCG1",
                                         "DYNAMIC_STIFFNESS",
                                         "DYNAMIC_DAMPING"};
const std::set<std::string> kOneOnly = {"LIP", "LCZ", "LKG"};

/// Keys without influence on the model.
const std::set<std::string> kIgnored = {"FILE_TYPE",
                                        "FILE_VERSION",
                                        "FILE_FORMAT",
                                        "COMMENT",
                                        "PRESSURE",
                                        "MESSAGES",
                                        "VXLOW",
                                        "BELT_DYNAMICS",
                                        "CONTACT_MODEL",
                                        "FITTYP",
                                        "FUNCTION_NAME",
                                        "N_TIRE_STATES",
                                        "WIDTH",
                                        "ASPECT_RATIO",
                                        "RIM_RADIUS",
                                        "RIM_WIDTH",
                                        "BOTTOMING_RADIUS",
                                        "IP",
                                        "IP_NOM",
                                        "KPUMIN",
                                        "KPUMAX",
                                        "ALPMIN",
                                        "ALPMAX",
                                        "CAMMIN",
                                        "CAMMAX",
                                        "LGYR",
                                        "QTZ1",
                                        "MBELT",
                                        "PTX4",
                                        "PTY3",
                                        "PECP1",
                                        "PECP2",
                                        "PDXP1",
                                        "PDXP2",
                                        "PDXP3",
                                        "PDYP1",
                                        "PDYP2",
                                        "PDYP3",
                                        "PDYP4",
                                        "PKYP1",
                                        "PHYP1",
                                        "PHYP2",
                                        "PHYP3",
                                        "PHYP4",
                                        "QDTP1",
                                        "QBRP1",
                                        "QCRP1",
                                        "QCRP2",
                                        "QDRP1",
                                        "QDRP2",
                                        "PA1",
                                        "PA2",
                                        "MC",
                                        "IC",
                                        "KX",
                                        "KY",
                                        "KP",
                                        "CX",
                                        "CY",
                                        "CP",
                                        "EP",
                                        "EP12",
                                        "BF2",
                                        "BP1",
                                        "BP2"};

/// Keys that this reader evaluates by name.
const std::set<std::string> kHandled = {"PROPERTY_FILE_FORMAT", "USE_MODE", "TYRESIDE",
                                        "VERTICAL_STIFFNESS", "VERTICAL_DAMPING"};

/// Shape factors C are at most 2: sin(C ...) falls again beyond, and `sin_bounded` is not valid
/// there.
bool is_shape_factor(const std::string& name) {
  static const std::set<std::string> kShapes = {"PCX1", "PCY1", "RCX1", "RCY1", "QCZ1"};
  return kShapes.contains(name);
}

Range get_range(const Coefficient& c) {
  static const std::set<std::string> kPositive = {"LONGVL", "UNLOADED_RADIUS",
                                                  "FNOMIN", "FZMAX",
                                                  "LFZO",   "LCX",
                                                  "LMUX",   "LKX",
                                                  "LCY",    "LMUY",
                                                  "LKY",    "PDX1",
                                                  "PKX1",   "PDY1",
                                                  "PKY2",   "PTY2"};
  const std::string name = c.name;
  const std::string unit = std::string(c.unit) == "1" ? "" : c.unit;
  if (is_shape_factor(name)) {
    return {.low = 0.0, .high = 2.0, .open_low = true, .unit = ""};
  }
  if (kPositive.contains(name)) return above(0.0, unit);
  if (name == "PKY1") return {.high = -1e-9, .unit = unit};
  if (name == "RVY5") return between(-2.0, 2.0);
  if (name == "FZMIN" || name.starts_with("L")) return at_least(0.0, unit);
  return any_number(unit);
}

double read_number(const TirFile& file, const TirEntry& entry, const Range& range) {
  const double value = get_number(file, entry);
  if (!range.contains(value)) throw tir_error(file, entry, range.describe());
  return value;
}

const TirEntry& require(const TirFile& file, const std::string& section, const std::string& key,
                        const std::string& what) {
  const TirEntry* entry = file.find(key);
  if (entry == nullptr) {
    throw InputError(
        fmt::format("{}: [{}] {} is missing: {}", file.path.string(), section, key, what));
  }
  return *entry;
}

bool equals_ignoring_case(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

void check_format(const TirFile& file) {
  const TirEntry& format = require(file, "MODEL", "PROPERTY_FILE_FORMAT", "must be 'PAC2002'");
  if (!equals_ignoring_case(format.text, "PAC2002")) {
    throw tir_error(file, format, "must be 'PAC2002'");
  }
}

void check_units(const TirFile& file) {
  for (const auto& [key, names] : kUnits) {
    const std::string what = fmt::format("must be '{}' (SI units only)", names.front());
    const TirEntry& entry = require(file, "UNITS", key, what);
    const bool is_si = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return equals_ignoring_case(entry.text, name);
    });
    if (!is_si) throw tir_error(file, entry, what);
  }
}

void check_tables(const TirFile& file) {
  for (const TirTable& table : file.tables) {
    if (table.section == "SHAPE" || table.section == kCurveSection) continue;
    throw InputError(fmt::format("{}:{}: [{}]: not modeled; allowed: [{}] {{pen fz}}",
                                 file.path.string(), table.line, table.section, kCurveSection));
  }
}

ForceCurveSpec read_vertical_curve(const TirFile& file) {
  ForceCurveSpec curve;
  for (const TirTable& table : file.tables) {
    if (table.section != kCurveSection) continue;
    const auto refuse = [&](const std::string& what) {
      return line_error(file.path, table.line, fmt::format("[{}]: {}", kCurveSection, what));
    };
    if (!curve.empty()) throw refuse("a second table; allowed: one");
    static const std::regex kColumns("\\s*pen\\s+fz\\s*", std::regex::icase);
    if (!std::regex_match(table.columns, kColumns)) throw refuse("must have the columns {pen fz}");
    for (const std::vector<double>& row : table.rows) {
      if (row.size() != 2) throw refuse("must be rows of two numbers, deflection [m] and load [N]");
      curve.x.push_back(row[0]);
      curve.force.push_back(row[1]);
    }
    try {
      validate_tire_curve(curve);
    } catch (const ModelError& e) {
      throw refuse(e.what());
    }
    if (curve.empty()) throw refuse("must have rows of deflection [m] and load [N]");
  }
  return curve;
}

InputError unknown_key(const TirFile& file, const TirEntry& entry) {
  std::vector<std::string> known(kHandled.begin(), kHandled.end());
  for (const Coefficient& c : get_coefficients()) known.emplace_back(c.name);
  for (const auto& unit : kUnits) known.push_back(unit.first);
  return tir_error(file, entry, "unknown key" + suggest_name(entry.key, known));
}

bool is_unit(const std::string& key) {
  return std::any_of(kUnits.begin(), kUnits.end(), [&](const auto& u) { return u.first == key; });
}

void read_entry(const TirFile& file, const TirEntry& entry, Pac2002<double>& tire) {
  for (const Coefficient& c : get_coefficients()) {
    if (entry.key == c.name) {
      tire.*c.field = read_number(file, entry, get_range(c));
      return;
    }
  }
  if (kZeroOnly.contains(entry.key)) {
    if (get_number(file, entry) != 0.0) throw tir_error(file, entry, "not modeled; must be 0");
  } else if (kOneOnly.contains(entry.key)) {
    if (get_number(file, entry) != 1.0) throw tir_error(file, entry, "not modeled; must be 1");
  } else if (!kHandled.contains(entry.key) && !kIgnored.contains(entry.key) &&
             !is_unit(entry.key)) {
    throw unknown_key(file, entry);
  }
}

/// Throws where a key is given twice in the file, also in different sections.
void check_once(const TirFile& file) {
  std::map<std::string_view, int> lines;
  for (const TirEntry& entry : file.entries) {
    const auto [first, is_new] = lines.try_emplace(entry.key, entry.line);
    if (is_new || kIgnored.contains(entry.key)) continue;
    throw tir_error(file, entry, fmt::format("already given in line {}", first->second));
  }
}

/// Throws unless `constant + slope df_z` is positive at every load between FZMIN and FZMAX.
void check_positive(const TirFile& file, const Pac2002<double>& tire, const std::string& name,
                    double constant, double slope) {
  for (const double load : {tire.FZMIN, tire.FZMAX}) {
    const double value = constant + slope * (load / (tire.LFZO * tire.FNOMIN) - 1.0);
    if (value > 0.0) continue;
    const std::string key = name + "2";
    throw tir_error(file, require(file, "", key, ""),
                    fmt::format("{}1 + {} df_z is {} at a load of {} N: must be > 0 between FZMIN "
                                "and FZMAX",
                                name, key, format_number(value), format_number(load)));
  }
}

void check_together(const TirFile& file, const Pac2002<double>& tire) {
  if (tire.FZMIN >= tire.FZMAX) {
    const TirEntry* low = file.find("FZMIN");
    throw tir_error(file, low != nullptr ? *low : require(file, "", "FZMAX", ""),
                    fmt::format("must be FZMIN < FZMAX = {} N", format_number(tire.FZMAX)));
  }
  if (tire.PCX1 * tire.LCX > 2.0) {
    throw tir_error(file, require(file, "", "LCX", ""), "PCX1 LCX must lie in (0, 2]");
  }
  if (tire.PCY1 * tire.LCY > 2.0) {
    throw tir_error(file, require(file, "", "LCY", ""), "PCY1 LCY must lie in (0, 2]");
  }
  check_positive(file, tire, "PDX", tire.PDX1, tire.PDX2);
  check_positive(file, tire, "PDY", tire.PDY1, tire.PDY2);
  check_positive(file, tire, "PKX", tire.PKX1, tire.PKX2);
}

void drop_combined_slip(Pac2002<double>& tire) {
  tire.RBX1 = tire.RBY1 = tire.RVY1 = tire.RVY2 = tire.RVY3 = 0.0;
}

void apply_mode(const TirFile& file, Pac2002<double>& tire) {
  const TirEntry* mode = file.find("USE_MODE");
  if (mode == nullptr) return;
  const double value = get_number(file, *mode);
  static const std::set<double> kCombined = {4, 14, 24};
  static const std::set<double> kUncombined = {3, 13, 23};
  if (kUncombined.contains(value)) {
    drop_combined_slip(tire);
  } else if (!kCombined.contains(value)) {
    throw tir_error(file, *mode, "must be 4, 14, 24 (combined slip) or 3, 13, 23 (uncombined)");
  }
}

void apply_side(const TirFile& file, Pac2002<double>& tire) {
  const TirEntry* side = file.find("TYRESIDE");
  if (side == nullptr) return;
  if (equals_ignoring_case(side->text, "RIGHT")) {
    tire = mirror_tire(tire);
    return;
  }
  for (const char* known : {"LEFT", "SYMMETRIC", "UNKNOWN"}) {
    if (equals_ignoring_case(side->text, known)) return;
  }
  throw tir_error(file, *side, "must be 'LEFT', 'RIGHT', 'SYMMETRIC' or 'UNKNOWN'");
}

}  // namespace

TireData read_tire(const std::filesystem::path& path) {
  const TirFile file = read_tir(path);
  check_format(file);
  check_units(file);
  check_once(file);
  check_tables(file);
  for (const auto& [section, key] : kRequired) require(file, section, key, "every tire needs it");
  TireData tire;
  for (const TirEntry& entry : file.entries) read_entry(file, entry, tire.pacejka);
  check_together(file, tire.pacejka);
  apply_mode(file, tire.pacejka);
  apply_side(file, tire.pacejka);
  tire.unloaded_radius = tire.pacejka.UNLOADED_RADIUS;
  tire.vertical_stiffness = read_number(file, *file.find("VERTICAL_STIFFNESS"), above(0.0, "N/m"));
  tire.vertical_curve = read_vertical_curve(file);
  if (!tire.vertical_curve.empty()) {
    tire.vertical_stiffness = calc_curve_rate(tire.vertical_curve);
  }
  if (const TirEntry* damping = file.find("VERTICAL_DAMPING")) {
    tire.vertical_damping = read_number(file, *damping, at_least(0.0, "N s/m"));
  }
  return tire;
}

}  // namespace strut
