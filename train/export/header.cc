#include "train/export/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math/normal.h"
#include "base/text/fill_template.h"
#include "base/text/format_number.h"
#include "embedded/texts.h"
#include "io/store/shard_layout.h"
#include "train/export/layer_values.h"
#include "train/model/identifier.h"

namespace strut {
namespace {

/// A C literal that reads back as the same double.
std::string to_literal(double value) {
  if (std::isinf(value)) return "HUGE_VAL";
  std::string text = format_number(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// A C string literal; `?` is escaped as well, since C reads trigraphs.
std::string quote(const std::string& text) {
  static constexpr char kDigits[] = "01234567";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code > 0x7e || c == '"' || c == '\\' || c == '?') {
      quoted += {'\\', kDigits[code / 64], kDigits[code / 8 % 8], kDigits[code % 8]};
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

/// "{a, b, c}" in lines of at most 96 characters, each indented by `indent`.
template <class T, class ToText>
std::string list_values(const std::vector<T>& values, const std::string& indent,
                        const ToText& to_text) {
  std::string list = "{", line;
  for (const T& value : values) {
    const std::string text = to_text(value) + (&value == &values.back() ? "}" : ", ");
    if (indent.size() + line.size() + text.size() > 96) {
      list += "\n" + indent + line;
      line.clear();
    }
    line += text;
  }
  return list + "\n" + indent + line;
}

/// The names that all parts of a source share.
struct SourceNames {
  std::string guard;        // "STRUT_IDENTIFY_NAME_H"
  std::string prefix;       // "strut_NAME_"
  std::string storage;      // "static inline " or ""
  std::string function;     // "strut_identify_NAME"
  std::string declaration;  // declaration of the function, without storage
};

SourceNames make_names(const NetworkShape& shape, const std::string& name, SourceKind kind,
                       bool is_window) {
  const std::string function = "strut_identify_" + name;
  const std::string inputs = is_window ? "const double *record, int samples"
                                       : fmt::format("const double in[{}]", shape.inputs());
  return {fmt::format("STRUT_IDENTIFY_{}_H", name), fmt::format("strut_{}_", name),
          kind == SourceKind::kHeader ? "static inline " : "", function,
          fmt::format("int {}({}, double out[{}])", function, inputs, shape.outputs())};
}

std::string make_window_introduction(const TrainedModel& model, const SourceNames& names) {
  const WindowTransform& window = *model.window;
  return fmt::format(
      "/* Written by strut export: parameters from a record of measured channels, by a network\n"
      "   over a window that is searched for in the record. Trained on plan\n   {}.\n\n   {}{};\n\n"
      "   `record` holds `samples` values of each channel, channel by channel, sampled every\n"
      "   {} s, in the units and the order of {}channel_names() and _units();\n"
      "   at least {} samples.\n\n"
      "   Returns 0 where all is in range, else the sum of 1 (the record differs from all that\n"
      "   were trained on by more than the noise, or has NaN), 2 (an output lies outside of its\n"
      "   range by more than its interval: the values are extrapolated then) and 4 (the bump is\n"
      "   not in the record); or 8 (too few samples; `out` is left as it is). */\n",
      make_c_name(model.plan_hash), names.storage, names.declaration,
      format_number(window.grid.interval), names.prefix, window.minimum_samples());
}

std::string make_introduction(const TrainedModel& model, const SourceNames& names) {
  if (model.window) return make_window_introduction(model, names);
  return fmt::format(
      "/* Written by strut export: parameters from measured channels, by a network of layers {}.\n"
      "   Trained on plan {}.\n\n   {}{};\n\n"
      "   Returns 0 where all is in range, else the sum of 1 (an input lies outside of the range\n"
      "   trained on, or is NaN) and 2 (an output lies outside of it by more than its interval): "
      "the\n   values are extrapolated then. */\n",
      fmt::join(model.sizes, " "), make_c_name(model.plan_hash), names.storage, names.declaration);
}

/// A function that returns an array; `type` is that of its elements.
std::string make_list_function(const SourceNames& names, const std::string& what, const char* type,
                               const char* array, const std::string& values) {
  return fmt::format(
      "{}const {} *{}{}(void) {{\n"
      "  static const {} {}[] = {};\n  return {};\n}}\n\n",
      names.storage, type, names.prefix, what, type, array, values, array);
}

std::string make_numbers(const SourceNames& names, const std::string& what, const char* comment,
                         const std::vector<double>& values) {
  return fmt::format("/* {} */\n", comment) +
         make_list_function(names, what, "double", "values",
                            list_values(values, "      ", to_literal));
}

std::string make_texts(const SourceNames& names, const std::string& what,
                       const std::vector<std::string>& texts) {
  return make_list_function(names, what, "char *const", "texts",
                            list_values(texts, "      ", quote));
}

/// Functions for names and units of columns.
std::string make_labels(const SourceNames& names, const std::string& what,
                        const std::vector<ColumnInfo>& columns) {
  std::vector<std::string> units;
  units.reserve(columns.size());
  for (const ColumnInfo& column : columns) units.push_back(column.unit);
  return make_texts(names, what + "_names", list_names(columns)) +
         make_texts(names, what + "_units", units);
}

/// Functions for names, units and bounds of the inputs or outputs.
std::string make_columns(const SourceNames& names, const std::string& what,
                         const std::vector<ColumnInfo>& columns, const Normalizer& map) {
  return make_labels(names, what, columns) +
         make_numbers(names, what + "_low", "lowest values trained on", map.low()) +
         make_numbers(names, what + "_high", "highest values trained on", map.high());
}

std::string make_weights(const TrainedModel& model, const NetworkLayer& layer, std::size_t number) {
  const LayerValues values = get_layer_values(model, layer);
  return fmt::format("  static const double w{0}[] = {1};\n  static const double b{0}[] = {2};\n",
                     number, list_values(values.weights, "      ", to_literal),
                     list_values(values.biases, "      ", to_literal));
}

/// Functions that read the components of a record.
std::string make_window_functions(const WindowTransform& window, const SourceNames& names) {
  // C has no arrays without elements.
  const bool is_aligned = !window.reference.empty();
  const std::vector<double> reference = is_aligned ? window.reference : std::vector<double>{0.0};
  return make_labels(names, "channel", window.channels) +
         make_numbers(names, "sigma", "noise of each channel", window.noise.sigma) +
         make_numbers(names, "mean_share", "part of a channel's mean that is removed",
                      calc_mean_shares(window)) +
         make_numbers(names, "reference", "window that records are aligned to", reference) +
         make_numbers(names, "mean", "mean whitened window", window.mean) +
         make_numbers(names, "basis", "directions in whitened windows", window.basis) +
         fill_template(embedded::window_c_in,
                       {{"prefix", names.prefix},
                        {"function", names.function},
                        {"inline", names.storage.empty() ? "" : "inline "},
                        {"samples", std::to_string(window.grid.samples)},
                        {"channels", std::to_string(window.channels.size())},
                        {"components", std::to_string(window.components())},
                        {"minimum", std::to_string(window.minimum_samples())},
                        {"aligned", is_aligned ? "1" : "0"},
                        {"free", to_literal(window.residual_degrees())}});
}

/// The loop from a layer's inputs, a{number - 1}, to its outputs, a{number}.
std::string make_layer(const NetworkLayer& layer, std::size_t number, bool hidden) {
  return fmt::format(
      "  for (o = 0; o < {outputs}; ++o) {{\n"
      "    double sum = b{number}[o];\n"
      "    for (i = 0; i < {inputs}; ++i) sum += w{number}[o * {inputs} + i] * a{before}[i];\n"
      "    a{number}[o] = {value};\n  }}\n",
      fmt::arg("outputs", layer.outputs), fmt::arg("inputs", layer.inputs),
      fmt::arg("number", number), fmt::arg("before", number - 1),
      fmt::arg("value", hidden ? "tanh(sum)" : "sum"));
}

/// Checks and normalizes the inputs, which for a window are read from the record first.
std::string make_input_part(const TrainedModel& model, const NetworkShape& shape,
                            const SourceNames& names) {
  std::string read, margin = "0.0";
  if (model.window) {
    read = fmt::format(
        "  outside = {}read(record, samples, in, &leftover);\n"
        "  if (outside == 8) return outside;\n"
        "  if (!(leftover <= {})) outside |= 1;\n",
        names.prefix, to_literal(calc_residual_limit(*model.window)));
    margin = to_literal(kNormal95);
  }
  return fmt::format(
      "{}  for (i = 0; i < {}; ++i) {{\n"
      "    if (!(in[i] >= low[i] - {margin} && in[i] <= high[i] + {margin})) outside |= 1;\n"
      "    a0[i] = 2.0 * (in[i] - low[i]) / (high[i] - low[i]) - 1.0;\n  }}\n",
      read, shape.inputs(), fmt::arg("margin", margin));
}

/// Restores and checks the outputs.
std::string make_output_part(const NetworkShape& shape, const SourceNames& names) {
  return fmt::format(
      "  low = {prefix}output_low();\n  high = {prefix}output_high();\n"
      "  for (o = 0; o < {outputs}; ++o) {{\n"
      "    out[o] = low[o] + 0.5 * (a{last}[o] + 1.0) * (high[o] - low[o]);\n"
      "    margin = ci95[o] + {margin} * (high[o] - low[o]);\n"
      "    if (!(out[o] + margin >= low[o] && out[o] - margin <= high[o])) outside |= 2;\n  }}\n"
      "  return outside;\n",
      fmt::arg("prefix", names.prefix), fmt::arg("outputs", shape.outputs()),
      fmt::arg("last", shape.layers.size()), fmt::arg("margin", to_literal(kParameterMargin)));
}

std::string make_function(const TrainedModel& model, const NetworkShape& shape,
                          const SourceNames& names) {
  const std::size_t last = shape.layers.size();
  std::string text = names.storage + names.declaration + " {\n";
  for (std::size_t l = 0; l < last; ++l) text += make_weights(model, shape.layers[l], l + 1);
  text += fmt::format(
      "  const double *low = {0}{1}_low();\n  const double *high = {0}{1}_high();\n"
      "  const double *ci95 = {0}output_ci95();\n",
      names.prefix, model.window ? "component" : "input");
  for (std::size_t l = 0; l <= last; ++l) {
    text += fmt::format("  double a{}[{}];\n", l, shape.sizes[l]);
  }
  if (model.window) text += fmt::format("  double in[{}], leftover;\n", shape.inputs());
  text += "  double margin;\n  int i, o, outside = 0;\n";
  text += make_input_part(model, shape, names);
  for (std::size_t l = 0; l < last; ++l) text += make_layer(shape.layers[l], l + 1, l + 1 < last);
  return text + make_output_part(shape, names) + "}\n";
}

}  // namespace

std::string make_c_source(const TrainedModel& model, const std::string& name, SourceKind kind) {
  const NetworkShape shape(model.sizes);
  const SourceNames names = make_names(shape, name, kind, model.window.has_value());
  const bool guarded = kind == SourceKind::kHeader;
  std::string text = make_introduction(model, names);
  if (guarded) text += fmt::format("#ifndef {0}\n#define {0}\n\n", names.guard);
  text += model.window ? "#include <float.h>\n#include <math.h>\n\n" : "#include <math.h>\n\n";
  text += make_columns(names, model.window ? "component" : "input", model.inputs, model.input_map);
  text += make_columns(names, "output", model.targets, model.target_map);
  text += make_numbers(names, "output_ci95", "half widths of the intervals of 95 % in range",
                       model.ci95);
  if (model.window) text += make_window_functions(*model.window, names);
  text += make_function(model, shape, names);
  if (guarded) text += "\n#endif\n";
  return text;
}

std::string make_c_name(const std::string& text) {
  std::string name = text;
  const auto is_allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return !is_allowed(c); }, '_');
  return name;
}

}  // namespace strut
