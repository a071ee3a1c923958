#include "tests/hidden/campaign_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tests/hidden/fault_range.h"
#include "tests/hidden/sha256.h"
#include "tests/hidden/vehicle_file.h"

namespace strut::hidden {
namespace {

namespace fs = std::filesystem;

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error(path.string() + ": cannot be read");
  return text.str();
}

std::string format_pair(double mean, double sigma) {
  return "[" + format(mean) + ", " + format(sigma) + "]";
}

// --- the model ----------------------------------------------------------------------------------

std::string make_rig_file(const Kit& kit) {
  std::ostringstream out;
  const bool dyno = kit.kind == KitKind::kDyno;
  out << "type = \"" << (dyno ? "strut_rig" : "quarter_car") << "\"\n\n";
  for (const KitParameter& p : kit.parameters) {
    out << p.name << " = " << format(p.nominal) << "  # " << p.unit << "\n";
  }
  if (!dyno) out << "tire_contact = \"bilateral\"\ngravity = 9.81\n";
  return out.str();
}

std::string get_shape(BumpForm form) {
  switch (form) {
    case BumpForm::kArc:
      return "arc";
    case BumpForm::kHalfSine:
      return "half_sine";
    default:
      return "cosine";
  }
}

std::string make_maneuver(const RunPlan& run) {
  std::ostringstream out;
  out << "speed = " << format(run.speed) << "\nduration = " << format(run.duration)
      << "\ndrive_torque = 0.0\ntrim = \"steady\"\n\n[bump]\n";
  if (run.excitation == Excitation::kFlat) {
    out << "shape = \"none\"\n";
    return out.str();
  }
  out << "shape = \"" << get_shape(run.bump.form) << "\"\nheight = " << format(run.bump.height)
      << "\nlength = " << format(run.bump.length) << "\ndistance = " << format(run.distance)
      << "\nside = \"" << (run.one_sided ? "left" : "both") << "\"\n";
  return out.str();
}

void write_model(const Kit& kit, const fs::path& folder) {
  if (kit.kind != KitKind::kCar) return write_file(folder / "model.toml", make_rig_file(kit));
  const Car car = make_nominal_car();
  write_file(folder / "model.toml", make_vehicle_file(car, kFootprint, "tire.tir"));
  write_file(folder / "tire.tir", make_tire_file(car.wheel[0].tire, 3000.0));
  for (const RunPlan& run : kit.runs) {
    if (run.recorded) write_file(folder / (run.name + ".toml"), make_maneuver(run));
  }
}

// --- the campaign -------------------------------------------------------------------------------

void add_columns(const Kit& kit, std::ostringstream& out) {
  out << "[columns]\ntime = { column = \"Time\" }\n";
  for (const Sensor& s : kit.sensors) {
    if (!s.recorded) continue;
    out << s.channel << " = { column = \"" << s.column << "\", unit = \"" << s.unit << "\"";
    if (s.input) out << ", role = \"input\"";
    out << " }\n";
  }
}

void add_fit(const Kit& kit, std::ostringstream& out) {
  std::string free, prior;
  for (const KitParameter& p : kit.parameters) {
    if (p.survey) continue;
    free += (free.empty() ? "\"" : ", \"") + p.name + "\"";
    if (p.prior == 0.0) continue;
    prior +=
        (prior.empty() ? "" : ", ") + p.name + " = " + format_pair(p.nominal, p.prior * p.nominal);
  }
  out << "\n[fit]\nfree = [" << free << "]\n";
  if (!prior.empty()) out << "prior = { " << prior << " }\n";
}

void add_run(const Kit& kit, const RunPlan& run, std::ostringstream& out) {
  out << "\n[[run]]\nfile = \"" << run.name << ".csv\"\nuse = \"" << (run.fit ? "fit" : "hold_out")
      << "\"\n";
  if (kit.kind != KitKind::kCar) return;
  out << "maneuver = \"" << run.name << ".toml\"\n"
      << "speed = " << format_pair(run.speed, kit.speed_sigma * run.speed) << "\n"
      << "hit_time = " << format_pair(0.0, kit.time_sigma) << "\n";
  if (run.excitation != Excitation::kBump) return;
  for (const KitParameter& p : kit.parameters) {
    const std::string number = std::to_string(run.bump_number);
    if (p.name == "bump_height" + number) {
      out << "bump_height = " << format_pair(run.bump.height, p.prior * run.bump.height) << "\n";
    }
    if (p.name == "bump_length" + number) {
      out << "bump_length = " << format_pair(run.bump.length, p.prior * run.bump.length) << "\n";
    }
  }
}

std::string make_campaign(const Kit& kit) {
  std::ostringstream out;
  out << "model = \"model.toml\"\n\n";
  add_columns(kit, out);
  // Others have what a data sheet allows, which the program assumes.
  if (kit.regime == Regime::kExact) out << "\n[noise]\ngain = 0.0\nskew = 0.0\n";
  add_fit(kit, out);
  for (const RunPlan& run : kit.runs) {
    if (run.recorded) add_run(kit, run, out);
  }
  return out.str();
}

// --- the data -----------------------------------------------------------------------------------

std::string format_short(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.9g", value);
  return buffer.data();
}

std::string make_table(const Kit& kit, const Trial& trial, std::size_t run) {
  constexpr double kOversampling = 4.0;
  const RunPlan& plan = kit.runs[run];
  const std::vector<Signal> signals =
      simulate_run(kit, trial.truth, run, kOversampling * kit.rate, kMargin);
  const auto count = static_cast<std::size_t>(std::lround(plan.duration * kit.rate)) + 1;
  std::vector<double> stamps(count);
  for (std::size_t i = 0; i < count; ++i) stamps[i] = static_cast<double>(i) / kit.rate;
  std::vector<std::vector<double>> columns = {stamps};
  std::string text = "Time";
  for (std::size_t c = 0; c < kit.sensors.size(); ++c) {
    if (!kit.sensors[c].recorded) continue;
    text += "," + kit.sensors[c].column;
    columns.push_back(read_sensor(kit.sensors[c], signals[c], trial.clocks[run], stamps,
                                  trial.bias[c], trial.seed, plan.name));
  }
  text += "\n";
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text += (c > 0 ? "," : "") + format_short(columns[c][i]);
    }
    text += "\n";
  }
  return text;
}

std::string quote(const std::string& text) { return "\"" + text + "\""; }

std::string make_fault(const Kit& kit, const HiddenFault& hidden) {
  const FaultInfo& info = get_info(hidden.setting.fault);
  std::ostringstream out;
  out << "{\"fault\": " << quote(info.name) << ", \"effect\": " << quote(info.effect)
      << ", \"place\": " << quote(get_place(kit, hidden.setting))
      << ", \"where\": " << quote(get_where(kit, hidden.setting))
      << ", \"magnitude\": " << format(hidden.setting.magnitude)
      << ", \"parameter\": " << quote(info.parameter) << ", \"ratio\": " << format(hidden.ratio)
      << ", \"grade\": " << quote(std::string(1, find_grade(hidden.ratio))) << ", \"twins\": [";
  for (std::size_t i = 0; i < hidden.twins.size(); ++i) {
    out << (i > 0 ? ", " : "") << "{\"effect\": " << quote(hidden.twins[i].effect)
        << ", \"place\": " << quote(hidden.twins[i].place) << "}";
  }
  out << "]}";
  return out.str();
}

std::string join_faults(const Kit& kit, const std::vector<HiddenFault>& faults) {
  std::string text;
  for (const HiddenFault& f : faults) text += (text.empty() ? "" : ",\n  ") + make_fault(kit, f);
  return text;
}

}  // namespace

std::string make_trial_name(std::uint64_t seed) {
  std::string digits = std::to_string(seed);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

fs::path find_truth(const fs::path& folder, std::uint64_t seed) {
  return folder / "truths" / (make_trial_name(seed) + ".json");
}

std::string make_truth(const Kit& kit, const Trial& trial) {
  std::ostringstream out;
  out << "{\"seed\": " << trial.seed << ", \"kit\": " << quote(kit.name)
      << ", \"category\": " << quote(get_name(trial.category))
      << ", \"grade\": " << quote(std::string(1, trial.get_grade()))
      << ", \"beyond_one\": " << format(trial.beyond_one)
      << ", \"beyond_two\": " << format(trial.beyond_two)
      << ", \"roughness\": " << format(trial.truth.roughness) << ",\n \"faults\": ["
      << join_faults(kit, trial.faults) << "],\n \"misfits\": [" << join_faults(kit, trial.misfits);
  std::string bounds;
  out << "],\n \"parameters\": {";
  bool first = true;
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    const KitParameter& p = kit.parameters[i];
    if (p.survey) continue;
    out << (first ? "" : ", ") << quote(p.name) << ": "
        << format(p.nominal * trial.truth.factors[i]);
    first = false;
    if (trial.bounds.empty()) continue;
    bounds += (bounds.empty() ? "" : ", ") + quote(p.name) + ": " + format(trial.bounds[i]);
  }
  out << "},\n \"bounds\": {" << bounds << "}}\n";
  return out.str();
}

void write_trial(const Kit& kit, const Trial& trial, const fs::path& folder) {
  const std::string name = make_trial_name(trial.seed);
  const fs::path place = folder / "trials" / name;
  fs::create_directories(place);
  fs::create_directories(folder / "truths");
  write_model(kit, place);
  for (std::size_t r = 0; r < kit.runs.size(); ++r) {
    if (!kit.runs[r].recorded) continue;
    write_file(place / (kit.runs[r].name + ".csv"), make_table(kit, trial, r));
  }
  write_file(place / "campaign.toml", make_campaign(kit));
  // Last and at once: a trial whose truth is there is whole.
  const fs::path begun = folder / "truths" / (name + ".part");
  write_file(begun, make_truth(kit, trial));
  fs::rename(begun, find_truth(folder, trial.seed));
}

namespace {

/// Seals by file; none where nothing was sealed yet.
std::map<std::string, std::string> read_seals(const fs::path& path) {
  std::map<std::string, std::string> seals;
  if (!fs::exists(path)) return seals;
  std::istringstream lines(read_file(path));
  std::string seal, name;
  while (lines >> seal >> name) seals[name] = seal;
  return seals;
}

}  // namespace

void seal_truths(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder / "truths")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::string sums;
  std::map<std::string, std::string> sealed = read_seals(folder / "truths" / "SHA256SUMS");
  for (const fs::path& file : files) {
    const std::string name = file.filename().string(), seal = calc_sha256(read_file(file));
    const auto found = sealed.find(name);
    if (found != sealed.end() && found->second != seal) {
      throw std::runtime_error(file.string() + ": not the file that SHA256SUMS seals");
    }
    sealed[name] = seal;
  }
  for (const auto& [name, seal] : sealed) sums += seal + "  " + name + "\n";
  // At once: half a line would seal a file that is not there.
  const fs::path begun = folder / "truths" / "SHA256SUMS.part";
  write_file(begun, sums);
  fs::rename(begun, folder / "truths" / "SHA256SUMS");
}

}  // namespace strut::hidden
