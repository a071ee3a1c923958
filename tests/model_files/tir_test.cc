// Property files: the generic reader, and the mapping onto a PAC2002 tire.
#include "io/format/tir.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "model_files/read_tire.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

const std::string kPaperTire = std::string(STRUT_SOURCE_DIR) + "/examples/tires/paper_sedan.tir";

/// The paper's tire file with `from` replaced by `to`, on disk while the object lives.
class ChangedTire {
 public:
  ChangedTire(const std::string& from, const std::string& to) {
    std::string text = test::read_text(kPaperTire);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    path_ = folder_.write("changed.tir", text).string();
  }

  const std::string& path() const { return path_; }

  /// The message of the error, "" if the tire is accepted.
  std::string message() const {
    try {
      read_tire(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  test::TemporaryFolder folder_;
  std::string path_;
};

std::string parse_error(const std::string& content) {
  try {
    parse_tir(content, "x.tir");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

TEST_CASE("A property file is sections, entries and tables", "[io]") {
  const TirFile file = parse_tir(
      "$ comment\r\n"
      "[units]\r\n"
      "length = 'meter'  $ comment\n"
      "! comment\n"
      "\n"
      "[MODEL]\n"
      "  NAME='a $ b ! c = d'   ! comment\n"
      "VALUE = -1.5e-3$ comment\n"
      "PLUS = +2\n"
      "[SHAPE]\n"
      "{radial width}\n"
      " 1.0  0.5\n"
      " 0.9, 1.0 $ comment\n",
      "x.tir");
  REQUIRE(file.entries.size() == 4);
  CHECK(file.entries[0].section == "UNITS");
  CHECK(file.entries[0].key == "LENGTH");
  CHECK(file.entries[0].text == "meter");
  CHECK(file.entries[0].quoted);
  CHECK(file.entries[0].line == 3);
  REQUIRE(file.find("NAME") != nullptr);
  CHECK(file.find("NAME")->text == "a $ b ! c = d");
  CHECK(get_number(file, *file.find("VALUE")) == -1.5e-3);
  CHECK(get_number(file, *file.find("PLUS")) == 2.0);
  CHECK(file.find("NOTHING") == nullptr);
  REQUIRE(file.tables.size() == 1);
  CHECK(file.tables[0].section == "SHAPE");
  CHECK(file.tables[0].columns == "radial width");
  CHECK(file.tables[0].rows == std::vector<std::vector<double>>{{1.0, 0.5}, {0.9, 1.0}});
}

TEST_CASE("A broken line is named by file and number", "[io]") {
  CHECK_THAT(parse_error("\n[MODEL\n"), StartsWith("x.tir:2: "));
  CHECK_THAT(parse_error("[MODEL]\nwhat is this\n"), StartsWith("x.tir:2: 'what is this'"));
  CHECK_THAT(parse_error("A = 'open\n"), Contains("closing quote"));
  CHECK_THAT(parse_error("A =  $ nothing\n"), Contains("A: a value must follow"));
  CHECK_THAT(parse_error("= 3\n"), Contains("a name must precede"));
  CHECK_THAT(parse_error("[S]\n{a b}\n1.0 two\n"), StartsWith("x.tir:3: 'two'"));
  CHECK_THAT(parse_error("[S]\nA = 1\nA = 2\n"),
             Contains("x.tir:3: A = 2: already given in line 2"));
  CHECK(parse_error("A = 1").empty());  // the last line needs no line feed
  const TirFile file = parse_tir("A = 1.5x\nB = 'text'\nC = nan\n", "x.tir");
  CHECK_THROWS_WITH(get_number(file, *file.find("A")),
                    "x.tir:1: A = 1.5x: must be a finite number");
  CHECK_THROWS_WITH(get_number(file, *file.find("B")), Contains("B = 'text'"));
  CHECK_THROWS_AS(get_number(file, *file.find("C")), InputError);
  CHECK_THROWS_WITH(read_tir("/nowhere/x.tir"), "/nowhere/x.tir: file not found");
}

TEST_CASE("The paper's tire is read", "[io]") {
  const TireData tire = read_tire(kPaperTire);
  CHECK(tire.unloaded_radius == 0.4673);
  CHECK(tire.vertical_stiffness == 200000.0);
  CHECK(tire.vertical_damping == 500.0);
  CHECK(tire.pacejka.FNOMIN == 4850.0);
  CHECK(tire.pacejka.LFZO == 0.81);
  CHECK(tire.pacejka.LMUX == 1.0);
  CHECK(tire.pacejka.PCX1 == 1.6411);
  CHECK(tire.pacejka.PEX4 == -3.7604e-5);
  CHECK(tire.pacejka.PKY1 == -21.92);
  CHECK(tire.pacejka.RHY1 == 5.7448e-6);
  CHECK(tire.pacejka.SSZ4 == -0.24116);
}

TEST_CASE("A wrong tire file is refused with key, value and range", "[io]") {
  const auto check = [](const std::string& from, const std::string& to, const std::string& what) {
    const ChangedTire tire(from, to);
    CHECK_THAT(tire.message(), Contains(what));
  };
  check("'PAC2002'", "'MF-TYRE'", "PROPERTY_FILE_FORMAT = 'MF-TYRE': must be 'PAC2002'");
  check("'meter'", "'mm'", "LENGTH = 'mm': must be 'meter' (SI units only)");
  check("'radian'", "'degree'", "ANGLE = 'degree': must be 'radian' (SI units only)");
  check("TIME  ", "$ TIME", "[UNITS] TIME is missing: must be 'second'");
  check("PKX1  ", "PKXX1 ", "[LONGITUDINAL_COEFFICIENTS] PKX1 is missing");
  check("PHX1  ", "PHXI  ", "PHXI = 0.0012297: unknown key; did you mean 'PHX1'?");
  check("FNOMIN                   = 4850", "FNOMIN = -3", "FNOMIN = -3: must be > 0 N");
  check("PCX1                     = 1.6411", "PCX1 = 2.5", "PCX1 = 2.5: must lie in (0, 2]");
  check("PKY1                     = -21.92", "PKY1 = 21.92", "PKY1 = 21.92: must be <= ");
  check("VERTICAL_DAMPING         = 500", "VERTICAL_DAMPING = -1", "must be >= 0 N s/m");
  check("USE_MODE                 = 4", "USE_MODE = 2", "USE_MODE = 2: must be 4, 14, 24");
  check("'LEFT'", "'TOP'", "TYRESIDE = 'TOP': must be 'LEFT'");
  check("QSX1                     = 0", "QSX4 = 0.5", "QSX4 = 0.5: not modeled; must be 0");
  check("FZMAX                    = 10125", "FZMAX = 100",
        "FZMIN = 225: must be FZMIN < FZMAX = 100");
  check("FZMAX                    = 10125", "FZMAX = 60000",
        "PDX2 = -0.16395: PDX1 + PDX2 df_z is");
  check("LFZO  ", "LCX = 1.5\nLFZO  ", "LCX = 1.5: PCX1 LCX must lie in (0, 2]");
  check("[DIMENSION]", "[DIMENSION]\nPCX1 = 1.6", "PCX1 = 1.6411: already given in line");
  const auto check_curve = [&](const std::string& rows, const std::string& what) {
    check("[DIMENSION]", "[DEFLECTION_LOAD_CURVE]\n{pen fz}\n" + rows + "[DIMENSION]", what);
  };
  check_curve("", "[DEFLECTION_LOAD_CURVE]: must have rows");
  check_curve("0 0\n", "two points or more");
  check_curve("0 0\n0.01 2000 3\n", "two numbers");
  check_curve("0 0\n0.01 2000\n0.02 1000\n", "1000 N at 0.02 m after 2000 N");
  check_curve("0 0\n0.01 2000\n[DEFLECTION_LOAD_CURVE]\n{pen fz}\n0 0\n", "a second table");
  check("[DIMENSION]", "[DEFLECTION_LOAD_CURVE]\n{fz pen}\n0 0\n2000 0.01\n[DIMENSION]",
        "{pen fz}");
  check("[DIMENSION]", "[BOTTOMING_CURVE]\n{pen fz}\n0 0\n[DIMENSION]", "not modeled");
}

TEST_CASE("A tire's load over its deflection may be a table", "[io]") {
  const ChangedTire tire("[DIMENSION]",
                         "[DEFLECTION_LOAD_CURVE]\n{pen fz}\n0.000 0.0\n"
                         "0.010 1800.0\n0.030 6600.0 $ stiffer\n[DIMENSION]");
  const TireData data = read_tire(tire.path());
  CHECK(data.vertical_curve.x == std::vector<double>{0.0, 0.01, 0.03});
  CHECK(data.vertical_curve.force == std::vector<double>{0.0, 1800.0, 6600.0});
  CHECK(data.vertical_stiffness == Approx((18.0 + 198.0) / 0.001));
}

TEST_CASE("A message starts with file and line", "[io]") {
  const ChangedTire tire("PHX1  ", "PHXI  ");
  const std::string text = test::read_text(tire.path());
  const auto line =
      std::count(text.begin(), text.begin() + static_cast<long>(text.find("PHXI")), '\n') + 1;
  CHECK_THAT(tire.message(), StartsWith(tire.path() + ":" + std::to_string(line) + ": PHXI"));
}

TEST_CASE("A tire measured on the right is mirrored, a mode without combined slip drops it",
          "[io]") {
  const Pac2002<double> left = read_tire(kPaperTire).pacejka;
  {
    const ChangedTire tire("'LEFT'", "'RIGHT'");
    const Pac2002<double> right = read_tire(tire.path()).pacejka;
    CHECK(right.PHY1 == -left.PHY1);
    CHECK(right.PVY1 == -left.PVY1);
    CHECK(right.PKY1 == left.PKY1);
  }
  const ChangedTire tire("USE_MODE                 = 4", "USE_MODE = 3");
  const Pac2002<double> uncombined = read_tire(tire.path()).pacejka;
  CHECK(uncombined.RBX1 == 0.0);
  CHECK_FALSE(find_parts(uncombined).combined);
}

TEST_CASE("Rim geometry, shape tables and neutral values are read over", "[io]") {
  const ChangedTire tire("[DIMENSION]",
                         "[SHAPE]\n{radial width}\n1.0 0.0\n1.0 0.9\n"
                         "[TIRE_CONDITIONS]\nIP = 200000\nLIP = 1\nPPX1 = 0.0\n"
                         "[DIMENSION]\nWIDTH = 0.245\nRIM_RADIUS = 0.2");
  CHECK(tire.message().empty());
}

}  // namespace
}  // namespace strut
