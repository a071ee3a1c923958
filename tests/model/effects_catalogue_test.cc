// The catalogue of effects: its table, its document, files and settings.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "base/error/input_error.h"
#include "model/effects/catalogue.h"
#include "model/error/model_error.h"
#include "model/model.h"
#include "model_files/parameters.h"
#include "model_files/read_effects.h"
#include "model_files/read_rig.h"
#include "model_files/read_vehicle.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

const fs::path kSource = STRUT_SOURCE_DIR;
const fs::path kCarFile = kSource / "examples/vehicles/paper_sedan.toml";
const fs::path kRigFile = kSource / "examples/rigs/quarter_car.toml";
const ModelInfo& kCar = get_car_info();

/// The names of interface and users' files.
const std::set<std::string> kNames = {
    "damper_asymmetry",     "damper_blow_off", "damper_hysteresis",  "damper_leak",
    "damper_fade",          "strut_friction",  "progressive_spring", "bump_stop",
    "top_mount_compliance", "gas_force",       "anti_roll_bar",      "payload",
    "center_of_mass_shift", "pitch_inertia",   "unsprung_mass",      "tire_stiffness",
    "tire_progressive",     "tire_damping",    "tire_enveloping",    "wheel_runout",
    "bump_height",          "bump_length",     "speed_error",        "road_gain",
    "sensor_gain",          "sensor_bias",     "sensor_delay",       "sensor_lowpass",
    "clock_offset",         "sensor_position", "aerodynamic_lift",   "joint_play"};

TEST_CASE("The catalogue holds each effect once, with a unit, a range and a source", "[unit]") {
  std::set<std::string> names;
  for (const EffectInfo& effect : list_effects()) {
    INFO(effect.name);
    CHECK(names.insert(effect.name).second);
    CHECK_FALSE(effect.equation.empty());
    CHECK_FALSE(effect.source.empty());
    bool switches = false;
    for (const EffectParameter& p : effect.parameters) {
      INFO(p.name);
      CHECK_FALSE(p.unit.empty());
      CHECK(p.low <= p.neutral);
      CHECK(p.neutral <= p.high);
      CHECK(p.typical > 0.0);
      CHECK(p.typical <= p.high);
      CHECK(std::any_of(list_models().begin(), list_models().end(),
                        [&](const ModelInfo* model) { return p.exists_in(*model); }));
      switches = switches || p.switches;
    }
    CHECK(switches);
  }
  CHECK(names == kNames);
}

/// A setting of ordinary size at each place of each effect.
EffectSettings make_ordinary_settings(const ModelInfo& kind) {
  EffectSettings settings;
  for (const EffectInfo& effect : list_effects()) {
    for (const std::string& place : list_effect_places(effect, kind)) {
      EffectSetting setting{effect.name, place, {}};
      for (const EffectParameter* p : list_effect_parameters(effect, kind)) {
        setting.values.push_back(p->typical / 3.0 + p->low / 7.0);
      }
      settings.push_back(setting);
    }
  }
  return settings;
}

TEST_CASE("Effects of a car's file are written back exactly", "[io][property]") {
  const test::TemporaryFolder folder;
  const EffectSettings settings = make_ordinary_settings(kCar);
  fs::copy(kSource / "examples/tires", folder / "tires", fs::copy_options::recursive);
  fs::create_directory(folder / "vehicles");
  const std::string plain = test::read_text(kCarFile);
  const std::string text = replace_effects(plain, settings, kCar);
  const VehicleSpec read = read_vehicle(folder.write("vehicles/car.toml", text));
  CHECK(read.effects == settings);
  VehicleSpec without = read;
  without.effects.clear();
  VehicleSpec base = read_vehicle(kCarFile);
  CHECK(without == base);
  CHECK(replace_effects(text, settings, kCar) == text);
  CHECK(replace_effects(text, {}, kCar) == plain);
}

TEST_CASE("Effects of a rig's file are written back exactly", "[io][property]") {
  const test::TemporaryFolder folder;
  const RigSpec base = read_rig(kRigFile);
  const ModelInfo& kind = get_rig_info(RigKind::kQuarterCar);
  const EffectSettings settings = make_ordinary_settings(kind);
  const std::string text = replace_effects(test::read_text(kRigFile), settings, kind);
  RigSpec read = read_rig(folder.write("rig.toml", text));
  CHECK(read.effects == settings);
  read.effects.clear();
  CHECK(read == base);
}

TEST_CASE("A table behind the effects stays behind them", "[io]") {
  const std::string text =
      "a = 1\n\n[[effect]]\nname = \"gas_force\"\nforce = 3\n\n[b]\nc = [\n  1,\n]\n";
  const EffectSettings none;
  CHECK(replace_effects(text, none, kCar) == "a = 1\n\n[b]\nc = [\n  1,\n]\n");
}

std::string refuse_rig(const std::string& table) {
  const test::TemporaryFolder folder;
  const std::string text = test::read_text(kRigFile) + "\n" + table;
  try {
    read_rig(folder.write("rig.toml", text));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_CASE("A wrong effect in a file is refused with its place and what is allowed", "[io]") {
  const std::string asymmetry = "[[effect]]\nname = \"damper_asymmetry\"\n";
  CHECK(refuse_rig(asymmetry + "asymmetry = 0.3\n").empty());
  CHECK_THAT(refuse_rig("[[effect]]\nname = \"damper_assymetry\"\nasymmetry = 0.3\n"),
             Contains("did you mean 'damper_asymmetry'"));
  CHECK_THAT(refuse_rig(asymmetry + "asymetry = 0.3\n"), Contains("asymmetry"));
  CHECK_THAT(refuse_rig(asymmetry + "asymmetry = 3\n"), Contains("must lie in [-0.9, 0.9]"));
  CHECK_THAT(refuse_rig(asymmetry + "asymmetry = 0.1\nplace = \"rear\"\n"), Contains("place"));
  CHECK_THAT(refuse_rig(asymmetry + "asymmetry = 0.1\n" + asymmetry + "asymmetry = 0.2\n"),
             Contains("twice"));
  CHECK_THAT(refuse_rig("[[effect]]\nname = \"anti_roll_bar\"\nstiffness = 1\n"),
             Contains("a quarter_car does not have this effect"));
  CHECK_THAT(refuse_rig("[[effect]]\nname = \"sensor_gain\"\nplace = \"sprung\"\ngain = 0.1\n"),
             Contains("sprung_position"));
  CHECK_THROWS_AS(replace_effects("effect = []\n", {}, kCar), InputError);
}

TEST_CASE("Settings that no model may have are refused", "[unit]") {
  const auto refuse = [](const EffectSettings& settings) {
    try {
      validate(settings, kCar);
    } catch (const ModelError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const EffectSetting good{"damper_asymmetry", "rear", {0.2}};
  CHECK(refuse({good}).empty());
  CHECK_THAT(refuse({good, good}), Contains("twice"));
  CHECK_THAT(refuse({{"damper_asymmetry", "roof", {0.2}}}), Contains("front_left"));
  CHECK_THAT(refuse({{"damper_asymmetry", "rear", {}}}), Contains("0 values"));
  CHECK_THAT(refuse({{"damper_asymmetry", "rear", {std::nan("")}}}), Contains("must lie in"));
  CHECK_THAT(refuse({{"sorcery", "rear", {1.0}}}), Contains("sorcery"));
}

TEST_CASE("An axle's setting holds for its corners unless they have their own", "[unit]") {
  Case c;
  apply_setting(c, "rear_damper_asymmetry=0.2");
  CHECK(c.vehicle.effects == EffectSettings{{"damper_asymmetry", "rear", {0.2}}});
  CHECK(get_parameter(c, "rear_left_damper_asymmetry") == 0.2);
  CHECK(get_parameter(c, "front_damper_asymmetry") == 0.0);
  apply_setting(c, "rear_left_damper_asymmetry=0.4");
  CHECK(get_parameter(c, "rear_right_damper_asymmetry") == 0.2);
  CHECK(get_parameter(c, "rear_damper_asymmetry") == Approx(0.3).epsilon(1e-15));
  apply_setting(c, "rear_damper_asymmetry=0.1");
  CHECK(c.vehicle.effects == EffectSettings{{"damper_asymmetry", "rear", {0.1}}});
  apply_setting(c, "rear_damper_asymmetry=0");
  CHECK(c.vehicle.effects.empty());
}

TEST_CASE("Names of an effect's settings have its parameter where there is more than one",
          "[unit]") {
  CHECK(find_parameter("front_damper_asymmetry").is_effect);
  CHECK(find_parameter("rear_right_damper_blow_off_knee").default_value == 0.1);
  CHECK(find_parameter("body_payload_mass").unit == "kg");
  CHECK(find_parameter("road_bump_height").unit == "1");
  CHECK(find_parameter("imu_rate_y_sensor_delay").unit == "s");
  CHECK(find_rig_parameter(RigKind::kQuarterCar, "payload").is_effect);
  CHECK(find_rig_parameter(RigKind::kStrutRig, "damper_fade").unit == "1/K");
  CHECK(find_rig_parameter(RigKind::kQuarterCar, "damper_fade").unit == "1");
  RigSpec spec = read_rig(kRigFile);
  set_rig_parameter(spec, "bump_stop_stiffness", 2000.0);
  CHECK(spec.effects == EffectSettings{{"bump_stop", "", {2000.0, 0.04, 50.0}}});
  CHECK_THROWS_WITH(set_rig_parameter(spec, "bump_stop_gap", 7.0), Contains("[0, 0.3] m"));
}

}  // namespace
}  // namespace strut
