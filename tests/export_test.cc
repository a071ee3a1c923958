// strut export: what other compilers and other runtimes make of it.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "io/config.h"
#include "tests/run_program.h"
#include "tests/test_model.h"
#include "train/export_header.h"
#include "train/export_onnx.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::run_shell;
using test::TemporaryFolder;
namespace fs = std::filesystem;

constexpr char kWarnings[] = " -Wall -Wextra -Wpedantic -Werror ";

/// Reads rows of inputs, writes the mask and the outputs of each with 17 digits.
std::string make_driver(const std::string& include, int inputs, int outputs) {
  std::ostringstream text;
  text << include << "#include <stdio.h>\nint main(void) {\n  double in[" << inputs << "], out["
       << outputs << "];\n  int i, mask;\n  for (;;) {\n    for (i = 0; i < " << inputs
       << "; ++i) if (scanf(\"%lf\", &in[i]) != 1) return 0;\n"
       << "    mask = strut_identify_car(in, out);\n    printf(\"%d\", mask);\n"
       << "    for (i = 0; i < " << outputs << "; ++i) printf(\" %.17g\", out[i]);\n"
       << "    printf(\"\\n\");\n  }\n}\n";
  return text.str();
}

std::string to_lines(const std::vector<double>& rows, std::size_t columns) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += format_number(rows[i]) + ((i + 1) % columns == 0 ? "\n" : " ");
  }
  return text;
}

/// The mask that the model asks for.
int find_mask(const Model& model, const double* in, const double* out) {
  int mask = 0;
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    if (calc_excess(in[i], model.input_map.low()[i], model.input_map.high()[i]) != 0.0) mask |= 1;
  }
  for (std::size_t t = 0; t < model.targets.size(); ++t) {
    if (!is_parameter_in_range(model, t, out[t], model.ci95[t])) mask |= 2;
  }
  return mask;
}

/// Answers of a compiled program against the library's.
void check_program(const Model& model, const std::string& program, const TemporaryFolder& folder) {
  const std::size_t n = model.inputs.size(), m = model.targets.size(), count = 2000;
  const std::vector<double> rows = test::draw_inputs(model, count, 1.2);
  folder.write("rows", to_lines(rows, n));
  std::istringstream answers(run_shell(program + " < " + (folder / "rows").string()).out);
  const Identifier identifier(model);
  std::vector<double> values(m);
  double worst = 0.0;
  int masks = 0, wrong = 0;
  for (std::size_t row = 0; row < count; ++row) {
    const double* in = rows.data() + row * n;
    identifier.identify(in, values.data());
    int mask = -1;
    answers >> mask;
    if (mask != find_mask(model, in, values.data())) ++wrong;
    masks |= 1 << mask;
    for (std::size_t t = 0; t < m; ++t) {
      double value = std::nan("");
      answers >> value;
      const double range = model.target_map.high()[t] - model.target_map.low()[t];
      const double error = std::abs(value - values[t]) / range;
      worst = error <= worst ? worst : error;  // a NaN stays
    }
  }
  REQUIRE(answers);
  CHECK(wrong == 0);
  CHECK((masks & 3) == 3);  // both within and outside were tried
  // Sums of some ten terms of order one, tanh good to an ulp or two.
  CHECK(worst < 1e-13);
}

TEST_CASE("An exported header gives the network's answers in C and in C++", "[reference]") {
  const TemporaryFolder folder;
  const Model model =
      test::make_random_model(GENERATE(std::vector<int>{4, 9, 7, 2}, std::vector<int>{2, 1}));
  folder.write("car.h", make_c_source(model, "car", SourceKind::kHeader));
  // Twice: the guard is tested too.
  const std::string driver = make_driver("#include \"car.h\"\n#include \"car.h\"\n",
                                         model.sizes.front(), model.sizes.back());
  const auto compiler =
      GENERATE(std::string("cc -std=c99"), std::string("cc -std=c11"),
               std::string("c++ -x c++ -std=c++11"), std::string("c++ -x c++ -std=c++20"));
  const std::string source = folder.write("main.c", driver), program = folder / "program";
  const Outcome compiled = run_shell(compiler + kWarnings + source + " -o " + program + " -lm");
  INFO(compiler << "\n" << compiled.messages);
  REQUIRE(compiled.code == 0);
  check_program(model, program, folder);
}

TEST_CASE("An exported C source links to a program that declares its function", "[reference]") {
  const TemporaryFolder folder;
  const Model model = test::make_random_model();
  const std::string unit = folder.write("car.c", make_c_source(model, "car", SourceKind::kSource));
  const std::string driver = folder.write(
      "main.c", make_driver("int strut_identify_car(const double in[4], double out[2]);\n", 4, 2));
  const std::string program = folder / "program";
  const Outcome compiled = run_shell(std::string("cc -std=c99") + kWarnings + unit + " " + driver +
                                     " -o " + program + " -lm");
  INFO(compiled.messages);
  REQUIRE(compiled.code == 0);
  check_program(model, program, folder);
}

TEST_CASE("Names, units and infinite intervals survive the C source", "[reference]") {
  const TemporaryFolder folder;
  Model model = test::make_random_model();
  model.inputs[0].name = "a\"b\\c?\?/ */";
  model.inputs[1].unit =
      "\xc2\xb0"
      "C";  // degrees Celsius
  model.ci95[1] = std::numeric_limits<double>::infinity();
  model.plan_hash = "*/ #error";
  folder.write("car.h", make_c_source(model, "car", SourceKind::kHeader));
  const std::string source = folder.write("main.c", R"(#include "car.h"
#include <stdio.h>
int main(void) {
  printf("%s|%s|%g|%.17g|%.17g", strut_car_input_names()[0], strut_car_input_units()[1],
         strut_car_output_ci95()[1], strut_car_input_low()[3], strut_car_output_high()[1]);
  return 0;
}
)");
  const std::string program = folder / "program";
  const Outcome compiled =
      run_shell(std::string("cc -std=c99") + kWarnings + source + " -o " + program + " -lm");
  INFO(compiled.messages);
  REQUIRE(compiled.code == 0);
  CHECK(run_shell(program).out ==
        "a\"b\\c?\?/ */|\xc2\xb0"
        "C|inf|-0.0078499999999999993|1980");
}

/// A model file and what export makes of it.
struct Desk {
  Desk() { write_model(folder / "m.h5", test::make_random_model()); }
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
  check_refused("-o " + desk.file("m.h5") + " --force", "is what is read");
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
  Model model = test::make_random_model({4, 5, 2});
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
    const Model model = test::make_random_model(sizes);
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
