#include <sstream>

#include "base/text/format_number.h"
#include "model/model.h"
#include "model_files/model_tables.h"

namespace strut {
namespace {

constexpr const char* kParametersHead = R"(# Parameters

What files, `--set NAME=VALUE`, the axes of a sweep, the unknowns of a fit and the targets of a network call by name:
`strut list parameters [MODEL]`. SI units and radians. A value outside of the range is refused. A name of an axle
(`front_stiffness`) sets both of its corners, one of a corner (`front_left_stiffness`) that corner. The parameters of
effects are in [effects.md](effects.md).

This page is written from the program's own tables (`write_parameters_document`); a test fails where the two differ.
)";

constexpr const char* kChannelsHead = R"(# Channels

What a simulation gives out, and what a measured column may stand for: `strut list channels [MODEL]`. SI units and radians;
axes as in ISO 8855: x forward, y left, z up. Inputs are what drives a rig.

This page is written from the program's own tables (`write_channels_document`); a test fails where the two differ.
)";

std::string describe_kind(const ModelInfo& model) { return "\n## " + model.name + "\n\n"; }

}  // namespace

std::string write_parameters_document() {
  std::ostringstream text;
  text << kParametersHead;
  for (const ModelInfo* model : list_models()) {
    text << describe_kind(*model)
         << "| name | unit | default | allowed | meaning | source |\n|---|---|---|---|---|---|\n";
    for (const ListedParameter& listed : make_model_tables(model->name).parameters) {
      const Parameter& p = *listed.parameter;
      if (p.is_effect) continue;
      text << "| `" << p.name << "` | " << p.unit << " | "
           << (p.default_value ? format_number(*p.default_value) : "must be given") << " | "
           << (p.allowed.open_low ? "above " : "") << format_number(p.allowed.low) << " to "
           << format_number(p.allowed.high) << " | " << p.description << " | " << p.source
           << " |\n";
    }
  }
  return text.str();
}

std::string write_channels_document() {
  std::ostringstream text;
  text << kChannelsHead;
  for (const ModelInfo* model : list_models()) {
    text << describe_kind(*model) << "| name | unit | meaning |\n|---|---|---|\n";
    for (const ChannelInfo& c : model->channels) {
      text << "| `" << c.name << "` | " << c.unit << " | " << c.description << " |\n";
    }
    for (const InputInfo& i : model->inputs) {
      text << "| `" << i.name << "` | " << i.unit << " | "
           << (i.required ? "input: " : "optional input: ") << i.description << " |\n";
    }
  }
  return text.str();
}

}  // namespace strut
