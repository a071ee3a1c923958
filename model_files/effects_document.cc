#include <sstream>

#include "model/effects/catalogue.h"
#include "model/model.h"
#include "model_files/model_tables.h"

namespace strut {
namespace {

constexpr const char* kHead = R"(# Effects

An effect is a named extension of the model: what a real car or test stand may do that the model
does not. It has parameters with a neutral value at which it vanishes and a place where it acts. The
same names serve in a vehicle or rig file, in `--set`, as an axis of a sweep's grid, as an unknown of
a fit and in a verdict.

```toml
[[effect]]
name = "damper_blow_off"
place = "rear"      # front, rear, front_left, ..., body, road, or a channel; absent on a rig
loss = 0.4
knee = 0.12         # optional: 0.1 where it is not given
```

The same by a setting: `--set rear_damper_blow_off_loss=0.4`. A setting is called
`<place>_<effect>_<parameter>`, without the parameter where the effect has but one, without the place
on a rig (`damper_blow_off_loss`); on a sensor's channel the place is the channel
(`imu_rate_y_sensor_gain`).

Signs: deflection d and its rate v of a strut are positive in compression and count from nominal
trim; forces are positive where they push the ends of the strut apart. An effect with all its
switching parameters at the neutral value leaves every bit of a simulation as it is. Effects of one
damper multiply; friction, springs and stops add. A corner's setting replaces the axle's there.
Effects change the car that the file describes, not the file's geometry: the car finds its new
equilibrium. Effects of sensors change what `strut simulate` and the shards of a sweep give out, not
the motion, nor a channel that derives from theirs: the filter first, then delay, gain and bias. A
strut's force that no effect explains can be given as a map ([theory.md](theory.md), "Force maps").

This page is written from the program's own list (`write_effects_document`); a test fails where the
two differ.

)";

std::string describe_places(const EffectInfo& effect) {
  std::string text;
  const auto add = [&](unsigned place, const char* words) {
    if ((effect.places & place) != 0) text += (text.empty() ? "" : ", ") + std::string(words);
  };
  add(kOnAxle, "axle");
  add(kOnCorner, "corner");
  add(kOnBody, "body");
  add(kOnRoad, "road");
  add(kOnChannel, "channel");
  return text.empty() ? "Not in a car, whose hit_time is its clock" : "Place in a car: " + text;
}

std::string describe_models(const EffectParameter& parameter) {
  std::string text;
  for (const ModelInfo* model : list_models()) {
    if (parameter.exists_in(*model)) text += (text.empty() ? "" : ", ") + model->name;
  }
  return text;
}

void write_effect(const EffectInfo& effect, std::ostream& out) {
  out << "## `" << effect.name << "`\n\n"
      << effect.description << ".\n\n"
      << "    " << effect.equation << "\n\n"
      << describe_places(effect) << ". Source: " << effect.source << ".\n\n"
      << "| parameter | unit | meaning | neutral | range | ordinary | in |\n"
      << "|---|---|---|---|---|---|---|\n";
  for (const EffectParameter& p : effect.parameters) {
    out << "| `" << p.name << "` | " << p.unit << " | " << p.description << " | ";
    if (p.switches) {
      out << p.neutral;
    } else {
      out << "(" << p.neutral << " where not given)";
    }
    out << " | " << p.low << " to " << p.high << " | " << p.typical << " | " << describe_models(p)
        << " |\n";
  }
  out << '\n';
}

}  // namespace

std::string write_effects_document() {
  std::ostringstream out;
  out << kHead;
  for (const EffectInfo& effect : list_effects()) write_effect(effect, out);
  std::string text = out.str();
  text.pop_back();
  return text;
}

}  // namespace strut
