// Files that people write: TOML, property files of tires, tables.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "diagnose/campaign/campaign_data.h"
#include "estimate/sensor_noise.h"
#include "io/format/toml_text.h"
#include "io/store/measurement.h"
#include "io/table/csv.h"
#include "io/table/summary.h"
#include "model/kernel/simulation.h"
#include "model_files/named_files.h"
#include "model_files/parameters.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_rig.h"
#include "model_files/read_tire.h"
#include "model_files/read_vehicle.h"
#include "sweep/plan.h"
#include "tests/fuzz/format.h"

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;

/// Calls `function`, which the model may refuse: a car that no spring carries, a road that no wheel
/// follows.
template <class Function>
void call_model(const Function& function) {
  try {
    function();
  } catch (const ModelError&) {
  }
}

/// Trims a car and drives it for some steps.
void prepare(const Case& c) {
  constexpr double kSeconds = 0.02;
  call_model([&] {
    PreparedCase prepared = CasePreparer().prepare(c);
    for (const double x : prepared.start) {
      if (!std::isfinite(x)) throw std::logic_error("a car that starts at no finite place");
    }
    prepared.duration = std::min(prepared.duration, kSeconds);
    list_kernels().back().run_scalar(prepared, IntegrateOptions{}, SamplePlan{.interval = 0.0});
  });
}

Dictionary make_toml_dictionary(std::vector<std::string> tokens) {
  for (const char* token : {"[",
                            "]",
                            "{",
                            "}",
                            "=",
                            "\"",
                            "'",
                            ",",
                            ".",
                            "#",
                            "\n",
                            "\"\"\"",
                            "[[a]]\n",
                            "true",
                            "[]",
                            "{}",
                            "\"\"",
                            "\\u0000",
                            "\\x1b",
                            "\xef\xbb\xbf",
                            "\r\n",
                            "[effect]\n",
                            "[[effect]]\n",
                            "[fitted]\n",
                            "file = \"../..\"",
                            "file = \"/dev/null\"",
                            "\"input.toml\""}) {
    tokens.emplace_back(token);
  }
  return {true, std::move(tokens), {"a.", "[", "[[", "{a=", "a=[", "[a.", "a={b=", "\"a\"."}};
}

void read_vehicle_file(const fs::path& path) {
  list_named_files(path);
  flatten_toml(path);
  if (find_rig_kind(path)) {
    read_rig(path);
    return;
  }
  Case c;
  c.vehicle = read_vehicle(path);
  c.maneuver = read_maneuver(path.parent_path() / "../maneuvers/bump_20mps.toml");
  prepare(c);
}

void read_maneuver_file(const fs::path& path) {
  Case c;
  c.maneuver = read_maneuver(path);
  c.vehicle = read_vehicle(path.parent_path() / "../vehicles/paper_sedan.toml");
  prepare(c);
}

void simulate_briefly(const RigSpec& rig, const RigManeuver& maneuver) {
  call_model([&] {
    const RigSpec* const specs[] = {&rig};
    constexpr double kSeconds = 0.02;
    list_kernels().back().run_rigs(specs, 1, maneuver.inputs, StepOptions{},
                                   SamplePlan{.duration = kSeconds, .interval = 1e-3});
  });
}

void read_rig_file(const fs::path& path) {
  const RigSpec rig = read_rig(path);
  const char* const maneuvers[] = {"force_step.toml", "bump.toml", "dynamometer.toml"};
  for (const char* name : maneuvers) {
    try {
      simulate_briefly(rig, read_rig_maneuver(path.parent_path() / "maneuvers" / name, rig.kind));
    } catch (const InputError&) {
      // Another kind's.
    }
  }
}

void read_rig_maneuver_file(const fs::path& path) {
  const RigSpec rig = read_rig(path.parent_path() / "../quarter_car.toml");
  simulate_briefly(rig, read_rig_maneuver(path, rig.kind));
}

void read_sweep_file(const fs::path& path) {
  const Plan plan(read_request(path));
  if (plan.case_count() == 0) throw std::logic_error("a plan without cases");
  const std::int64_t last = plan.case_count() - 1;
  for (const std::int64_t position : {std::int64_t{0}, last / 2, last}) {
    const std::int64_t id = plan.calc_case_id(position);
    if (plan.find_position(id) != position) throw std::logic_error("a case at another position");
    plan.calc_stratum(id);
    prepare(plan.make_case(id));
  }
}

void read_any_csv(const fs::path& path) {
  for (const MissingCells missing : {MissingCells::kRefused, MissingCells::kNan}) {
    const CsvTable table = read_csv(path, missing);
    read_measurement(path, {.required = {table.columns.front().name}, .missing = missing});
  }
}

/// As `strut inspect` does, whatever the format.
void read_recording(const fs::path& path) {
  for (const MeasuredPart part : {MeasuredPart::kHistory, MeasuredPart::kSnapshot}) {
    summarize_table(*open_table_file(path, part));
  }
}

}  // namespace

std::vector<Format> list_text_formats() {
  const Dictionary vehicle = make_toml_dictionary(
      {"damper_blow_off", "place = \"rear\"", "type = \"quarter_car\"", "[[force_map]]\n",
       "deflection = [-0.05, 0.08]", "velocity = [-1.0, 1.0]", "force = [[1, 2], [3, 4]]"});
  const Dictionary maneuver = make_toml_dictionary(
      {"shape = \"file\"", "profile.csv", "trapezoid", "trim = \"steady\"", "side = \"left\""});
  const Dictionary sweep = make_toml_dictionary(
      {"latin_hypercube", "sobol", "count = ", "strata = ", "step = ", "from = ", "to = ",
       "degradation", "abm4", "cvode", "newton", "speed = { from = 19, to = 20, count = 3 }"});
  const Dictionary campaign =
      make_toml_dictionary({"hold_out", "fit", "optional = true", "noise = ", "unit = \"mm\"",
                            "sign = -1", "window = [0, 1]", "gain = [1, 0.1]"});
  const Dictionary tir = {true,
                          {"[", "]", "{", "}", "=", "'", "$", "!", "\n", "\r\n", "[MODEL]\n",
                           "{a b}\n 1 2\n", "TYRESIDE = 'RIGHT'\n"},
                          {"[", "{a}\n", "{"}};
  const Dictionary csv = {
      true,
      {",", "\n", "\r\n", "#", "\"", ";", "# units: ", "nan", "inf", "\t", "time", ",,"},
      {","}};
  const Dictionary recording = {true,
                                {",",
                                 ";",
                                 "\t",
                                 "\n",
                                 "\r",
                                 "\r\n",
                                 "\"",
                                 "'",
                                 "\xef\xbb\xbf",
                                 "nan",
                                 "Infinity",
                                 "-1,5",
                                 "1e308",
                                 "***End_of_Header***\n",
                                 "[data]\n",
                                 "[column names]\n",
                                 "Time [s]",
                                 "(mm/s)",
                                 "23:59:59.9",
                                 "31.12.2026",
                                 "2026-02-29T24:00:60Z",
                                 "+14:00",
                                 "12:00 AM",
                                 "1,234.5",
                                 "1'234",
                                 "1700000000000000000"},
                                {",", ";"}};
  return {
      {"vehicle",
       "vehicles/input.toml",
       {"vehicles/paper_sedan.toml", "vehicles/compact_hatch.toml", "vehicles/generic_wide.toml",
        "extended_loop/model.toml"},
       vehicle,
       read_vehicle_file},
      {"rig",
       "rigs/input.toml",
       {"rigs/quarter_car.toml", "rigs/damper_dyno.toml", "rigs/single_mass.toml",
        "rigs/strut_rig.toml"},
       vehicle,
       read_rig_file},
      {"maneuver",
       "maneuvers/input.toml",
       {"maneuvers/bump_20mps.toml", "maneuvers/measured_profile.toml", "maneuvers/one_sided.toml"},
       maneuver,
       read_maneuver_file},
      {"rig_maneuver",
       "rigs/maneuvers/input.toml",
       {"rigs/maneuvers/bump.toml", "rigs/maneuvers/chirp.toml", "rigs/maneuvers/force_step.toml"},
       maneuver,
       read_rig_maneuver_file},
      {"sweep",
       "sweeps/input.toml",
       {"sweeps/paper.toml", "sweeps/stratified_2000.toml", "sweeps/window_2000.toml",
        "api/small_sweep.toml"},
       sweep,
       read_sweep_file},
      {"campaign",
       "extended_loop/input.toml",
       {"extended_loop/campaign.toml"},
       campaign,
       [](const fs::path& path) { read_campaign_data(path); }},
      {"tir",
       "tires/input.tir",
       {"tires/paper_sedan.tir", "extended_loop/tire.tir"},
       tir,
       [](const fs::path& path) { read_tire(path); }},
      {"csv",
       "maneuvers/input.csv",
       {"maneuvers/measured_profile.csv", "extended_loop/truth.csv"},
       csv,
       read_any_csv},
      {"recording",
       "recordings/input.csv",
       {"recordings/labview.seed", "recordings/vbox.seed", "recordings/aim.seed",
        "recordings/european.seed"},
       recording,
       read_recording},
      {"mat",
       "recordings/input.mat",
       {"recordings/mat.seed"},
       {false,
        {std::string(8, '\0'), std::string(4, '\xff'), std::string{'\x0e', '\0', '\0', '\0'}},
        {}},
       read_recording},
  };
}

}  // namespace strut::fuzz
