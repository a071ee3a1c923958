// strut diagnose as a user runs it, and its outputs for a constructed diagnosis.

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "diagnose/campaign/campaign_unknowns.h"
#include "io/file/atomic_file.h"
#include "io/table/csv.h"
#include "jobs/diagnose/figures.h"
#include "jobs/diagnose/json.h"
#include "jobs/diagnose/report.h"
#include "jobs/diagnose/tables.h"
#include "tests/jobs/check_hint.h"
#include "tests/jobs/check_page.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::run_program;

std::string diagnose(const std::filesystem::path& campaign, const std::filesystem::path& folder,
                     const std::string& options = "") {
  return "diagnose " + campaign.string() + " -o " + folder.string() + " " + options;
}

/// Two causes, a group, a runner-up; curves of the nominal model before, with another spring after.
Diagnosis make_named(const CampaignData& data) {
  Diagnosis d;
  d.verdict.kind = VerdictKind::kGroup;
  d.sentence = "Cause: <friction> in the strut.";
  CausePosition position;
  position.candidates = {{"strut_friction", "", 0.9, 321.5, {{"friction", "N", 0.5, 0.4, 0.6}}},
                         {"damper_asymmetry", "", 0.06, 300.0, {}},
                         {"progressive_spring", "", 0.03, 12.0, {}}};
  position.close = 2;
  position.unknown = d.verdict.unknown_share = 0.01;
  d.verdict.positions = {position};
  SelectRound round;
  round.p_value = 0.25;
  round.threshold = 20.0;
  d.selection.rounds = {round};
  d.where = {"drive", "sprung_position", "0.8 to 1.6 s", "0.5-3 Hz", "suspension_velocity", ""};
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  d.parameters = {
      {"stiffness", "N/m", 880.0, 900.0, 890.0, 910.0, 950.0, 940.0, 960.0},
      {"strut_friction_friction", "N", kNan, kNan, kNan, kNan, 0.5, -kInfinity, kInfinity}};
  d.improvement.channels = {{"sprung_position", "m", 2e-4, 1e-4, 5e-5, 0.1, 0.05}};
  d.improvement.explained = 2.0 / 3.0;
  d.improvement.log_likelihood_before = -3.0;
  d.improvement.log_likelihood_after = -1.0;
  d.not_identifiable = {"all masses and stiffnesses scale together"};
  d.next_measurement = "repeat at twice the amplitude";
  d.notes = {"a note of the diagnosis"};
  const int channel = data.channels(0)[0].channel;
  FitResult& fit = d.selection.extended.fit;
  fit.unknowns = {
      make_sensor_unknown(UnknownKind::kSensorGain, data.model(), kEveryRun, channel, 1e-3),
      make_bias(data.model(), kEveryRun, channel, {})};
  fit.values = {2.5e-3, 1.0};
  fit.widened.sigma = {5e-4, 1.0};
  d.selection.base.spectra.resize(1);
  d.selection.base.spectra[0].color = {{channel, 0.3, {{50.0, 0.2}}}};
  const SharedValues nominal;
  SharedValues stiffer{make_free_unknowns(data, {0, 1}), {}};
  for (const Unknown& u : stiffer.unknowns) {
    stiffer.values.push_back(get_nominal(data, u) * (u.name == "stiffness" ? 1.05 : 1.0));
  }
  for (std::size_t run = 0; run < data.run_count(); ++run) {
    const std::vector<NoiseFloor> floors(data.channels(run).size(), {2e-5});
    const auto compare = [&](const SharedValues& shared) {
      return compare_run(data, run, shared, floors, make_time_windows(data, run));
    };
    d.runs.push_back({run, compare(nominal), compare(nominal), compare(stiffer)});
  }
  return d;
}

/// A campaign of two quick runs.
CampaignData make_data(const test::TemporaryFolder& folder) {
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  test::write_two_runs(folder, truth);
  return read_campaign_data(test::write_campaign(folder));
}

TEST_CASE("verdict.json has the keys that scripts rely on", "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  const auto json = test::parse_json(format_json(make_verdict_json(data, make_named(data))));
  CHECK(json.get<std::string>("verdict") == "group");
  CHECK(json.get<std::string>("badge") == "group");
  const auto& cause = json.get_child("causes").front().second;
  CHECK(cause.get<std::string>("effect") == "strut_friction");
  CHECK(cause.get<std::string>("place").empty());
  CHECK(cause.get<double>("probability") == 0.9);
  CHECK(cause.get<double>("parameters.friction.value") == 0.5);
  CHECK(cause.get<std::string>("parameters.friction.unit") == "N");
  CHECK(cause.get_child("parameters.friction.ci95").front().second.get_value<double>() == 0.4);
  CHECK(json.get_child("group").size() == 2);
  CHECK(json.get_child("runners_up").front().second.get<double>("probability") == 0.03);
  CHECK(json.get<double>("unknown_share") == 0.01);
  CHECK(json.get<double>("existence.p_value") == 0.25);
  CHECK(json.get<double>("existence.threshold") == 20.0);
  CHECK(json.get<std::string>("where.depends_on") == "suspension_velocity");
  CHECK(json.get<std::string>("where.run") == "drive");
  CHECK(json.get<double>("parameters.before.stiffness.value") == 900.0);
  CHECK(json.get<double>("parameters.after.stiffness.value") == 950.0);
  // A parameter of only the extended model is not in `before`; an unknown bound has no number.
  CHECK(json.get_child("parameters.before").size() == 1);
  const auto& open = json.get_child("parameters.after.strut_friction_friction.ci95");
  CHECK(open.front().second.get_value<std::string>() == "null");
  CHECK(json.get<double>("gain.hold_out_rms_before.sprung_position") == 2e-4);
  CHECK(json.get<double>("gain.hold_out_rms_after.sprung_position") == 1e-4);
  CHECK(json.get<double>("gain.noise_floor.sprung_position") == 5e-5);
  CHECK(json.get<double>("gain.explained") == 2.0 / 3.0);
  CHECK(json.get_child("gain.log_likelihood_per_sample").back().second.get_value<double>() == -1.0);
  CHECK(json.get_child("not_identifiable").size() == 1);
  CHECK(json.get<std::string>("next_measurement") == "repeat at twice the amplitude");
  CHECK(json.get<std::string>("extended_model") == "extended.toml");
  const std::string channel = data.info(data.channels(0)[0].channel).name;
  CHECK(json.get_child("sensor_errors").size() == 1);
  const auto& gain = json.get_child("sensor_errors." + channel + "_gain_error");
  CHECK(gain.get<double>("value") == 2.5e-3);
  CHECK(gain.get<double>("tolerance") == 1e-3);
  CHECK(gain.get_child("ci95").back().second.get_value<double>() ==
        Approx(2.5e-3 + 1.96 * 5e-4).epsilon(test::tolerance(1e-4)));
  CHECK(json.get<double>("noise." + channel + ".drift_corner") == 0.3);
  const auto& line = json.get_child("noise." + channel + ".mains").front().second;
  CHECK(line.get<double>("frequency") == 50.0);
  CHECK(line.get<double>("rms_over_sigma") == 0.2);
  // An error at more than two tolerances is told.
  CHECK_THAT(
      make_diagnose_text(data, make_named(data)),
      Contains("errors of sensors of two tolerances or more: " + channel + "_gain_error 0.0025"));
}

TEST_CASE("A verdict without causes names no extended model", "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  Diagnosis diagnosis;
  diagnosis.sentence = "Adequate.";
  const auto json = test::parse_json(format_json(make_verdict_json(data, diagnosis)));
  CHECK(json.get<std::string>("verdict") == "adequate");
  CHECK(json.get_child("causes").empty());
  CHECK(json.get<std::string>("extended_model").empty());
  CHECK(make_cause_tables(diagnosis).empty());
  CHECK_THAT(make_diagnose_text(data, diagnosis), Catch::StartsWith("[adequate] Adequate.\n"));
  CHECK(make_where_text(diagnosis.where).empty());
}

TEST_CASE("The terminal shows verdict, probabilities, improvement and the next measurement",
          "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  const std::string text = make_diagnose_text(data, make_named(data));
  CHECK_THAT(text, Catch::StartsWith("[group] Cause: <friction> in the strut.\n"));
  CHECK_THAT(text, Contains("friction = 0.50 (0.40 to 0.60) N") && Contains("not distinguished") &&
                       Contains("0.030") && Contains("none of the catalogue"));
  // A cause is listed once, though it is also a member of the group.
  const std::string row = "\nstrut_friction ";
  CHECK(text.find(row) == text.find(row, text.find("Causes and")));
  CHECK(text.find(row, text.find("not distinguished")) > text.find("Parameters of the model"));
  // The effect with its law; every held-out run; parameters before and after.
  CHECK_THAT(text, Contains("F_c tanh(v / v_s)") && Contains("docs/effects.md#strut_friction"));
  CHECK_THAT(text, Contains("b.csv") && !Contains("a.csv") && Contains("900 (890 to 910)") &&
                       Contains("950 (940 to 960)"));
  CHECK_THAT(text, Contains("(22.2 %)") && Contains("(10.6 %)") && Contains("66.7 %") &&
                       Contains("repeat at twice the amplitude"));
}

TEST_CASE("Where several causes act, each has its own probability of being none of the catalogue",
          "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  Diagnosis diagnosis = make_named(data);
  CausePosition second;
  second.candidates = {{"top_mount", "", 0.73, 40.0, {}}};
  second.unknown = 0.27;
  const auto list_unknown = [&] {
    std::vector<std::vector<std::string>> rows;
    const auto tables = make_cause_tables(diagnosis);
    for (const auto& row : tables.front().rows) {
      if (row[0] == "none of the catalogue")
        rows.push_back({row[1], row[3]});  // no stand has places
    }
    return rows;
  };
  using Rows = std::vector<std::vector<std::string>>;
  CHECK(list_unknown() == Rows{{"", "0.010"}});
  diagnosis.verdict.positions.push_back(second);
  CHECK(list_unknown() == Rows{{"instead of 1", "0.010"}, {"instead of 2", "0.270"}});
  const ChartPanel panel = make_cause_charts(diagnosis).front().panels.front();
  CHECK(panel.series.back().y == std::vector<double>{0.01, 0.27});
  CHECK(panel.x.categories.back() == "none, for cause 2");
}

TEST_CASE("The report is one file with the verdict first, figures inside", "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  const Diagnosis diagnosis = make_named(data);
  const DiagnoseFolder out{{std::filesystem::path(folder / "out")}};
  write_diagnose_report(out, data, diagnosis, {});
  const std::string report = test::read_text(out.report());
  const std::size_t verdict = report.find("Cause: &lt;friction&gt; in the strut.");
  REQUIRE(verdict != std::string::npos);
  CHECK(verdict < report.find("<table"));
  CHECK_THAT(report, Contains("b.csv, held out") && !Contains("a.csv, held out"));
  CHECK_THAT(report, Contains("all masses and stiffnesses scale together") &&
                         Contains("a note of the diagnosis") && Contains("</html>"));
  for (const char* figure : {"run_2_b_time", "states", "force_law"}) {
    CHECK(std::filesystem::exists(out.figures() / (std::string(figure) + ".json")));
  }
  test::check_page(out.report().string(), 5);
}

TEST_CASE("strut report makes a diagnosis' page again from its folder", "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  const DiagnoseFolder out{{std::filesystem::path(folder / "out")}};
  write_diagnose_report(out, data, make_named(data), {});
  write_text_file(out.verdict(), "{}\n");
  const std::string report = test::read_text(out.report());
  const std::string make_again = " " STRUT_PROGRAM " report " + out.root.string();

  const test::Outcome bare =
      test::run_shell("PATH=" + std::string(folder / "nothing") + make_again);
  CHECK(bare.code == 0);
  CHECK(bare.out == out.report().string() + "\n");
  CHECK(test::read_text(out.report()) == report);

  write_text_file(out.root / "report.json", "{ \"title\": \"cut off\" }\n");
  const test::Outcome broken = test::run_shell(make_again);
  CHECK(broken.code == 2);
  CHECK_THAT(broken.messages, Contains("report.json") && Contains("key 'sections' not found"));
}

TEST_CASE("The curves of every run are written beside each other", "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_data(folder);
  const Diagnosis diagnosis = make_named(data);
  write_diagnose_tables({{folder / "."}}, data, diagnosis);
  const CsvTable table = read_csv(folder / "run_2_b.csv", MissingCells::kNan);
  CHECK(table.row_count() == data.times(1).size());
  const auto& measured = table.column("sprung_position").values;
  const auto& before = table.column("sprung_position_calibrated").values;
  const auto& after = table.column("sprung_position_extended").values;
  const std::vector<double>& residual = diagnosis.runs[1].before.evaluation.residual.back();
  CHECK(measured[100] - before[100] == Approx(residual[100]).margin(1e-12));
  CHECK(before[400] != after[400]);
}

/// The rms that `strut compare` reports for the held-out run with `model`, fitting only the run's
/// initial state.
double compare_held_out(const std::filesystem::path& model, const test::QuarterTruth& truth) {
  test::CampaignText text;
  text.model = model;
  text.fit = "";
  const test::TemporaryFolder folder;
  test::write_two_runs(folder, truth);
  const test::Outcome compared =
      run_program("compare " + test::write_campaign(folder, text).string() + " --json -o " +
                  std::string(folder / "out"));
  REQUIRE(compared.code == 0);
  const auto json = test::parse_json(compared.out);
  return json.get_child("runs").back().second.get<double>("nominal.channels.sprung_position.rms");
}

/// The output of `strut diagnose --json` for two runs of a quarter car, into the folder's `out`.
test::JsonTree diagnose_truth(const test::TemporaryFolder& folder, const test::QuarterTruth& truth,
                              const test::CampaignText& text = {}) {
  test::write_two_runs(folder, truth);
  const test::Outcome outcome =
      run_program(diagnose(test::write_campaign(folder, text), folder / "out", "--json"));
  INFO(outcome.messages << outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(test::read_text(folder / "out" / "verdict.json") == outcome.out);
  test::check_hint(outcome.messages);
  return test::parse_json(outcome.out);
}

TEST_CASE("A tone no larger than the noise of its sensor is reported with frequency and place",
          "[io]") {
  const test::TemporaryFolder folder;
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  truth.hum = 2e-5;
  const auto json = diagnose_truth(folder, truth);
  CHECK(json.get<std::string>("verdict") == "unknown");
  CHECK(json.get<std::string>("where.place") == "unsprung_position");
  const std::string band = json.get<std::string>("where.band");  // "31-31.5 Hz"
  CHECK(std::stod(band) <= 31.2);
  CHECK(std::stod(band.substr(band.find('-') + 1)) > 31.2);
}

TEST_CASE("diagnose names friction that the rig's model does not have", "[io][threads]") {
  const test::TemporaryFolder folder;
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  truth.friction = 0.5;
  const auto json = diagnose_truth(folder, truth);
  const std::string verdict = json.get<std::string>("verdict");
  CHECK((verdict == "named" || verdict == "group"));
  REQUIRE(!json.get_child("causes").empty());
  CHECK(json.get_child("causes").front().second.get<std::string>("effect") == "strut_friction");
  CHECK(json.get<double>("gain.hold_out_rms_after.sprung_position") <
        0.5 * json.get<double>("gain.hold_out_rms_before.sprung_position"));
  CHECK_THAT(test::read_text(folder / "out" / "report.html"),
             Contains(json.get<std::string>("sentence")));
  CHECK(std::filesystem::exists(folder / "out" / "run_2_b.csv"));

  SECTION("and its extended model can be used as a model file") {
    CHECK(compare_held_out(folder / "out" / "extended.toml", truth) ==
          Approx(json.get<double>("gain.hold_out_rms_after.sprung_position")).epsilon(0.05));
  }

  SECTION("and is not replaced without --force") {
    const test::Outcome refused =
        run_program(diagnose(test::write_campaign(folder), folder / "out"));
    CHECK(refused.code == 2);
    CHECK_THAT(refused.messages, Contains("holds a diagnosis") && Contains("--force"));
  }
}

TEST_CASE("diagnose finds a short lost stroke, and cannot distinguish damper from joint", "[io]") {
  const test::TemporaryFolder folder;
  test::QuarterTruth truth;
  truth.noise = 2e-6;
  truth.lost_stroke = 1e-4;  // passed within 2 ms
  const auto json = diagnose_truth(folder, truth);
  CHECK(json.get<std::string>("verdict") != "adequate");
  std::map<std::string, double> probability;
  for (const auto& [key, cause] : json.get_child("group")) {
    probability[cause.get<std::string>("effect")] = cause.get<double>("probability");
  }
  REQUIRE(probability.count("damper_leak") == 1);
  CHECK(probability["damper_leak"] > 0.3);
  CHECK(probability["joint_play"] == probability["damper_leak"]);
  const auto& parameter = json.get_child("causes").front().second.get_child("parameters").front();
  CHECK(parameter.second.get<double>("value") ==
        Approx(truth.lost_stroke).epsilon(test::tolerance(0.15)));
}

TEST_CASE("diagnose gives an effect outside of its catalogue a force map", "[io]") {
  const test::TemporaryFolder folder;
  test::QuarterTruth truth;
  truth.noise = 1e-6;
  truth.stroke_friction = 150.0;
  test::CampaignText text;
  text.fit += "[noise]\ngain = 0.0\nskew = 0.0\n";  // errors of sensors are not in extended.toml
  const auto json = diagnose_truth(folder, truth, text);
  const std::string verdict = json.get<std::string>("verdict");
  CHECK((verdict == "unknown" || verdict == "form_incomplete"));
  CHECK_THAT(json.get<std::string>("sentence"), Contains("a force in the strut that depends on"));
  CHECK_THAT(json.get<std::string>("where.depends_on"), Catch::StartsWith("strut "));
  CHECK_THAT(json.get<std::string>("where.run"), Contains(".csv"));
  CHECK_THAT(json.get<std::string>("where.time"),
             Catch::Matches("segment [1-5] of 5, [0-9.]+ to [0-9.]+ s of the run"));
  CHECK(json.get<double>("force_map.share_of_velocity") > 0.3);
  CHECK(json.get<double>("force_map.hold_out_share") > 0.3);
  CHECK(json.get<std::string>("extended_model") == "extended.toml");
  const double after = json.get<double>("gain.hold_out_rms_after.sprung_position");
  CHECK(after < 0.5 * json.get<double>("gain.hold_out_rms_before.sprung_position"));
  CHECK_THAT(test::read_text(folder / "out" / "report.html"), Contains("Force map of the strut"));
  // Coefficients are printed to the last digit; the initial state is fitted in another metric.
  CHECK(compare_held_out(folder / "out" / "extended.toml", truth) == Approx(after).epsilon(0.05));
  const CsvTable table = read_csv(folder / "out" / "force_map.csv");
  CHECK(table.row_count() == 15 * 41);
  CHECK(table.column("force_sigma").values.front() > 0.0);
}

TEST_CASE("diagnose finds an exact model adequate", "[io]") {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const test::TemporaryFolder folder;
    test::QuarterTruth truth;
    truth.noise = 2e-5;
    truth.seed = seed;
    const auto json = diagnose_truth(folder, truth);
    CHECK(json.get<std::string>("verdict") == "adequate");
    CHECK(json.get_child("causes").empty());
    CHECK(json.get<std::string>("extended_model").empty());
  }
}

TEST_CASE("diagnose ends with code 2 and a plain message on bad data", "[io]") {
  const test::TemporaryFolder folder;
  test::write_two_runs(folder, {}, [](std::size_t row, std::array<std::string, 4>& cells) {
    if (row == 30) cells[0] = "0.1";
  });
  const test::Outcome outcome = run_program(diagnose(test::write_campaign(folder), folder / "out"));
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.messages, Contains("a.csv:32") && Contains("runs backwards"));
  CHECK(run_program("diagnose").code == 2);
  CHECK_THAT(run_program("diagnose --help").out, Contains("-o diagnosis"));
}

TEST_CASE("diagnose does not write over the model that it reads", "[io]") {
  const test::TemporaryFolder folder;
  test::write_two_runs(folder);
  test::CampaignText text;
  std::filesystem::copy_file(text.model, folder / "extended.toml");
  const std::string model = test::read_text(text.model);
  text.model = "extended.toml";
  const auto campaign = test::write_campaign(folder, text);
  const test::Outcome outcome = run_program(diagnose(campaign, folder / ""));
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.messages, Contains("holds extended.toml, an input of this command"));
  CHECK(test::read_text(folder / "extended.toml") == model);
}

TEST_CASE("diagnose ends with code 3 where its folder cannot be made", "[io]") {
  const test::TemporaryFolder folder;
  test::write_two_runs(folder);
  folder.write("file", "");
  const auto campaign = test::write_campaign(folder);
  CHECK(run_program(diagnose(campaign, folder / "file")).code == 2);
  CHECK(run_program(diagnose(campaign, folder / "file" / "below")).code == 3);
}

}  // namespace
}  // namespace strut
