#include "train/export/header.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/text/format_number.h"
#include "train/model/identifier.h"
#include "train/network/network.h"

namespace strut {
namespace {

/// A literal that reads back as the same double.
std::string to_literal(double value) {
  if (std::isinf(value)) return "HUGE_VAL";
  std::string text = format_number(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// A string literal; `?` too is escaped, for C reads trigraphs.
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

/// "{a, b, c}" in lines of at most 96 characters, which begin with `indent`.
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

/// Writes the source of one model.
class CSource {
 public:
  CSource(const TrainedModel& model, const std::string& name, SourceKind kind)
      : model_(model),
        shape_(model.sizes),
        name_(name),
        storage_(kind == SourceKind::kHeader ? "static inline " : "") {}

  std::string write() {
    const bool guarded = !storage_.empty();
    write_introduction();
    if (guarded) text_ << "#ifndef " << guard() << "\n#define " << guard() << "\n\n";
    text_ << "#include <math.h>\n\n";
    write_columns("input", model_.inputs, model_.input_map);
    write_columns("output", model_.targets, model_.target_map);
    write_numbers("output_ci95", "half widths of the intervals of 95 % in range", model_.ci95);
    write_function();
    if (guarded) text_ << "\n#endif\n";
    return text_.str();
  }

 private:
  std::string prefix() const { return "strut_" + name_ + "_"; }
  std::string guard() const { return "STRUT_IDENTIFY_" + name_ + "_H"; }

  void write_introduction() {
    text_
        << "/* Written by strut export: parameters from measured channels, by a network of layers";
    for (const int size : model_.sizes) text_ << " " << size;
    text_
        << ".\n   Trained on plan " << make_c_name(model_.plan_hash) << ".\n\n   "
        << (storage_.empty() ? "" : storage_) << declaration()
        << ";\n\n   Returns 0 where all is in range, else the sum of 1 (an input lies outside of "
           "the range\n   trained on, or is NaN) and 2 (an output lies outside of it by more than "
           "its interval): the\n   values are extrapolated then. */\n";
  }

  std::string declaration() const {
    return "int strut_identify_" + name_ + "(const double in[" + std::to_string(shape_.inputs()) +
           "], double out[" + std::to_string(shape_.outputs()) + "])";
  }

  void write_numbers(const std::string& what, const char* comment,
                     const std::vector<double>& values) {
    text_ << "/* " << comment << " */\n"
          << storage_ << "const double *" << prefix() << what << "(void) {\n"
          << "  static const double values[] = " << list_values(values, "      ", to_literal)
          << ";\n  return values;\n}\n\n";
  }

  void write_texts(const std::string& what, const std::vector<std::string>& texts) {
    text_ << storage_ << "const char *const *" << prefix() << what << "(void) {\n"
          << "  static const char *const texts[] = " << list_values(texts, "      ", quote)
          << ";\n  return texts;\n}\n\n";
  }

  void write_columns(const std::string& what, const std::vector<ColumnInfo>& columns,
                     const Normalizer& map) {
    std::vector<std::string> names, units;
    names.reserve(columns.size());
    units.reserve(columns.size());
    for (const ColumnInfo& column : columns) {
      names.push_back(column.name);
      units.push_back(column.unit);
    }
    write_texts(what + "_names", names);
    write_texts(what + "_units", units);
    write_numbers(what + "_low", "lowest values trained on", map.low());
    write_numbers(what + "_high", "highest values trained on", map.high());
  }

  void write_weights(const NetworkLayer& layer, std::size_t number) {
    const auto part = [&](std::size_t begin, std::size_t end) {
      const auto from = model_.weights.begin();
      return list_values(std::vector<double>(from + static_cast<std::ptrdiff_t>(begin),
                                             from + static_cast<std::ptrdiff_t>(end)),
                         "      ", to_literal);
    };
    const auto outputs = static_cast<std::size_t>(layer.outputs);
    text_ << "  static const double w" << number << "[] = " << part(layer.weights, layer.biases)
          << ";\n  static const double b" << number
          << "[] = " << part(layer.biases, layer.biases + outputs) << ";\n";
  }

  void write_layer(const NetworkLayer& layer, std::size_t number, bool hidden) {
    const std::string x = "a" + std::to_string(number - 1), a = "a" + std::to_string(number);
    const std::string n = std::to_string(layer.inputs);
    text_ << "  for (o = 0; o < " << layer.outputs << "; ++o) {\n"
          << "    double sum = b" << number << "[o];\n"
          << "    for (i = 0; i < " << n << "; ++i) sum += w" << number << "[o * " << n
          << " + i] * " << x << "[i];\n"
          << "    " << a << "[o] = " << (hidden ? "tanh(sum)" : "sum") << ";\n  }\n";
  }

  void write_function() {
    const std::size_t last = shape_.layers.size();
    text_ << storage_ << declaration() << " {\n";
    for (std::size_t l = 0; l < last; ++l) write_weights(shape_.layers[l], l + 1);
    text_ << "  const double *low = " << prefix() << "input_low();\n"
          << "  const double *high = " << prefix() << "input_high();\n"
          << "  const double *ci95 = " << prefix() << "output_ci95();\n";
    for (std::size_t l = 0; l <= last; ++l) {
      text_ << "  double a" << l << "[" << shape_.sizes[l] << "];\n";
    }
    text_ << "  double margin;\n  int i, o, outside = 0;\n"
          << "  for (i = 0; i < " << shape_.inputs() << "; ++i) {\n"
          << "    if (!(in[i] >= low[i] && in[i] <= high[i])) outside |= 1;\n"
          << "    a0[i] = 2.0 * (in[i] - low[i]) / (high[i] - low[i]) - 1.0;\n  }\n";
    for (std::size_t l = 0; l < last; ++l) write_layer(shape_.layers[l], l + 1, l + 1 < last);
    text_ << "  low = " << prefix() << "output_low();\n  high = " << prefix() << "output_high();\n"
          << "  for (o = 0; o < " << shape_.outputs() << "; ++o) {\n"
          << "    out[o] = low[o] + 0.5 * (a" << last << "[o] + 1.0) * (high[o] - low[o]);\n"
          << "    margin = ci95[o] + " << to_literal(kParameterMargin) << " * (high[o] - low[o]);\n"
          << "    if (!(out[o] + margin >= low[o] && out[o] - margin <= high[o])) outside |= 2;\n  "
             "}\n"
          << "  return outside;\n}\n";
  }

  const TrainedModel& model_;
  const NetworkShape shape_;
  const std::string name_, storage_;
  std::ostringstream text_;
};

}  // namespace

std::string make_c_source(const TrainedModel& model, const std::string& name, SourceKind kind) {
  return CSource(model, name, kind).write();
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
