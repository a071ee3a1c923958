// strut export: what other compilers and other runtimes make of it.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "tests/jobs/run_program.h"
#include "tests/support/test_model.h"
#include "train/export/header.h"
#include "train/export/onnx.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::run_shell;
using test::TemporaryFolder;
namespace fs = std::filesystem;

constexpr char kWarnings[] = " -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror ";

/// A model file and what export makes of it.
struct Desk {
  Desk() { write_trained_model(folder / "m.h5", test::make_random_model()); }
  Outcome export_to(const std::string& words) const {
    return run_program("export " + (folder / "m.h5").string() + " " + words);
  }
  std::string file(const std::string& name) const { return (folder / name).string(); }
  TemporaryFolder folder;
};

TEST_CASE("export writes what the file's name asks for, and nothing over another file", "[io]") {
  const Desk desk;
  CHECK(desk.export_to("-o " + desk.file("my-car.h")).code == 0);
  CHECK_THAT(test::read_text(desk.file("my-car.h")),
             Contains("static inline int strut_identify_my_car(const double in[4]"));
  CHECK(desk.export_to("-o " + desk.file("x.c") + " --name front").code == 0);
  CHECK_THAT(test::read_text(desk.file("x.c")), Contains("\nint strut_identify_front("));
  CHECK(desk.export_to("-o " + desk.file("m.onnx")).code == 0);
  CHECK(desk.export_to("-o " + desk.file("f.onnx") + " --float").code == 0);
  CHECK(fs::file_size(desk.file("f.onnx")) < fs::file_size(desk.file("m.onnx")));
  const auto check_refused = [&](const std::string& words, const std::string& text) {
    const Outcome outcome = desk.export_to(words);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.messages, Contains(text));
  };
  check_refused("-o " + desk.file("m.onnx"), "m.onnx: exists; --force replaces it");
  CHECK(desk.export_to("-o " + desk.file("m.onnx") + " --force").code == 0);
  check_refused("", "--output: missing");
  check_refused("-o " + desk.file("m.pt"), "must end in .onnx, .h or .c");
  check_refused("-o " + desk.file("y.h") + " --name 'a b'", "--name = a b");
  check_refused("-o " + desk.file("y.h") + " --float", "--float: only for .onnx");
  check_refused("-o " + desk.file("y.onnx") + " --name a", "--name: only for .h and .c");
  check_refused("-o " + desk.file("m.h5") + " --force", "is an input of this command");
  CHECK(desk.export_to("-o " + desk.file("none/y.h")).code == 3);  // no such folder
  CHECK(run_program("export -o " + desk.file("y.h")).code == 2);
  CHECK(!fs::exists(desk.file("y.h")));
}

/// The block of the guide that begins with ```LANGUAGE.
std::string read_snippet(const std::string& language) {
  const std::string text = test::read_text(STRUT_SOURCE_DIR "/docs/identify.md");
  const std::string fence = "\n```" + language + "\n";
  const auto begin = text.find(fence);
  REQUIRE(begin != std::string::npos);
  const auto from = begin + fence.size();
  return text.substr(from, text.find("\n```\n", from) + 1 - from);
}

TEST_CASE("The guide's programs for online users compile and run", "[io]") {
  const TemporaryFolder folder;
  TrainedModel model = test::make_random_model({4, 5, 2});
  // The guide's model has four parameters.
  model.sizes.back() = 4;
  model.weights = make_xavier_weights(NetworkShape(model.sizes), 1);
  const std::vector<ColumnInfo> both = model.targets;
  model.targets.insert(model.targets.end(), both.begin(), both.end());
  model.target_map = Normalizer({1.0, 1.0, 1.0, 1.0}, {2.0, 2.0, 2.0, 2.0});
  model.ci95.assign(4, 0.25);
  folder.write("sedan.h", make_c_source(model, "sedan", SourceKind::kHeader));
  const std::string source = folder.write("main.c", read_snippet("c")),
                    program = folder / "program";
  const Outcome compiled =
      run_shell(std::string("cc -std=c99") + kWarnings + source + " -o " + program + " -lm");
  INFO(compiled.messages);
  REQUIRE(compiled.code == 0);
  const Outcome ran = run_shell(program);
  CHECK((ran.code & 1) == 0);
  CHECK_THAT(ran.out, Contains("front_stiffness = ") && Contains(" +- 0.25 N s/m"));
  const std::string unit = folder.write("unit.cc", read_snippet("cpp"));
  const Outcome checked =
      run_shell(std::string("c++ -std=c++20 -fsyntax-only -I" STRUT_SOURCE_DIR) + kWarnings + unit);
  INFO(checked.messages);
  CHECK(checked.code == 0);
}

// For read_with_onnx.py: models, inputs and the library's answers, by rows of doubles.
TEST_CASE("Example models for other runtimes", "[.][example_models]") {
  const char* const name = std::getenv("STRUT_EXAMPLE_FOLDER");
  REQUIRE(name != nullptr);
  const fs::path folder = name;
  const auto write = [&](const std::string& file, const std::string& bytes) {
    std::ofstream(folder / file, std::ios::binary) << bytes;
  };
  const auto write_rows = [&](const std::string& file, const std::vector<double>& rows) {
    write(file, {reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(double)});
  };
  const std::vector<std::pair<std::string, std::vector<int>>> shapes = {
      {"deep", {4, 27, 19, 11, 2}}, {"linear", {3, 1}}};
  for (const auto& [stem, sizes] : shapes) {
    const TrainedModel model = test::make_random_model(sizes);
    const NamedTexts provenance = {{"strut_version", "1.2.3"}};
    write(stem + "_double.onnx", make_onnx(model, OnnxNumber::kDouble, provenance));
    write(stem + "_float.onnx", make_onnx(model, OnnxNumber::kFloat, provenance));
    constexpr std::size_t kCount = 100;
    const std::vector<double> inputs = test::draw_inputs(model, kCount);
    const std::size_t n = model.inputs.size(), m = model.targets.size();
    std::vector<double> outputs(kCount * m), jacobians;
    const Identifier identifier(model);
    for (std::size_t row = 0; row < kCount; ++row) {
      identifier.identify(inputs.data() + row * n, outputs.data() + row * m);
      const std::vector<double> jacobian = identifier.calc_jacobian(inputs.data() + row * n);
      jacobians.insert(jacobians.end(), jacobian.begin(), jacobian.end());
    }
    write_rows(stem + "_inputs.bin", inputs);
    write_rows(stem + "_outputs.bin", outputs);
    write_rows(stem + "_jacobians.bin", jacobians);
  }
}

}  // namespace
}  // namespace strut
