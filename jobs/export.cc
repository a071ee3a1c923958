#include "jobs/export.h"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "io/file/atomic_file.h"
#include "jobs/cli/arguments.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/provenance.h"
#include "jobs/cli/unsealed.h"
#include "train/export/header.h"
#include "train/export/onnx.h"
#include "train/model/model_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

enum class ExportFormat { kOnnx, kHeader, kSource };

ExportFormat find_format(const fs::path& output) {
  const std::string extension = output.extension().string();
  if (extension == ".onnx") return ExportFormat::kOnnx;
  if (extension == ".h") return ExportFormat::kHeader;
  if (extension == ".c") return ExportFormat::kSource;
  throw InputError(
      fmt::format("--output = {}: the name must end in .onnx, .h or .c", output.string()));
}

std::string find_name(const Arguments& arguments, const fs::path& output) {
  if (!arguments.has("name")) return make_c_name(output.stem().string());
  std::string name = arguments.text("name");
  if (name.empty() || name != make_c_name(name)) {
    throw InputError(fmt::format("--name = {}: must be ASCII letters, digits and _", name));
  }
  return name;
}

std::string make_text(const Arguments& arguments, const TrainedModel& model,
                      const fs::path& output) {
  const ExportFormat format = find_format(output);
  const bool is_onnx = format == ExportFormat::kOnnx;
  if (is_onnx && arguments.has("name")) throw arguments.usage_error("--name: only for .h and .c");
  if (!is_onnx && arguments.is_on("float")) throw arguments.usage_error("--float: only for .onnx");
  if (arguments.is_on("float") && model.window) {
    throw InputError(
        "--float: single precision cannot align a record of a network over windows; leave it out");
  }
  if (is_onnx) {
    const OnnxNumber number = arguments.is_on("float") ? OnnxNumber::kFloat : OnnxNumber::kDouble;
    return make_onnx(model, number, make_provenance());
  }
  const auto kind = format == ExportFormat::kHeader ? SourceKind::kHeader : SourceKind::kSource;
  return make_c_source(model, find_name(arguments, output), kind);
}

/// Suggests how other programs read or call the exported file.
void suggest_next_step(const Arguments& arguments, const TrainedModel& model,
                       const fs::path& output) {
  const std::string file = output.string();
  if (find_format(output) == ExportFormat::kOnnx) {
    suggest_next(
        {"python3", "-c", "import onnx, sys; print(onnx.load(sys.argv[1]).graph.input)", file},
        "its inputs; onnxruntime and others run it");
    return;
  }
  const std::string call =
      fmt::format("then call strut_identify_{}({}, out)", find_name(arguments, output),
                  model.window ? "record, samples" : "in");
  if (find_format(output) == ExportFormat::kHeader) {
    suggest_next({"cc", "-x", "c", "-fsyntax-only", file}, "#include it, " + call);
  } else {
    suggest_next({"cc", "-c", file}, call);
  }
}

}  // namespace

Arguments describe_export() {
  Arguments arguments(
      "strut export MODEL -o model.onnx|model.h|model.c [OPTIONS]",
      "Writes the network in MODEL for other programs, in the units of its columns: as an ONNX\n"
      "model, or as C source that needs nothing but tanh, for C99 and C++. That of a window takes "
      "a\n"
      "record of its channels, in which it searches for the window.",
      "  strut export model.h5 -o model.onnx\n"
      "  strut export model.h5 -o strut_identify.h --name sedan");
  arguments.add_operand(ArgumentValue::file("MODEL", {"h5"}));
  arguments.add_option("output,o", ArgumentValue::file("FILE", {"onnx", "h", "c"}),
                       "file to write; its name ends in .onnx, .h or .c");
  arguments.add_option("name", "NAME",
                       "C: the function is strut_identify_NAME; default: the file's name");
  arguments.add_switch("float", "ONNX: single precision, for runtimes without double");
  arguments.add_switch("force", "replace FILE where it exists");
  return arguments;
}

int run_export(const Arguments& arguments) {
  const std::string& file = arguments.only_operand(", a file of `strut train`");
  const fs::path output = find_output_file(arguments, {file});
  const TrainedModel model = load_model(file);
  write_text_file(output, make_text(arguments, model, output));
  std::cout << output.string() << "\n";
  suggest_next_step(arguments, model, output);
  return kExitDone;
}

}  // namespace strut
