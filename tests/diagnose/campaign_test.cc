// Campaigns and measured files: reading, and messages of errors.
#include "diagnose/campaign/campaign.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "diagnose/campaign/campaign_data.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "io/format/hdf5.h"
#include "io/table/units.h"
#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::CampaignText;
using test::TemporaryFolder;

std::string find_refusal(const std::filesystem::path& campaign) {
  try {
    read_campaign_data(campaign);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// The error message for a campaign whose text `change` has spoiled.
template <class Change>
std::string spoil(const Change& change) {
  const TemporaryFolder folder;
  test::write_two_runs(folder);
  CampaignText text;
  change(text);
  return find_refusal(test::write_campaign(folder, text));
}

/// The error message for files whose rows `change` has spoiled.
std::string spoil_rows(const test::ChangeRow& change, const CampaignText& text = {}) {
  const TemporaryFolder folder;
  test::write_two_runs(folder, {}, change);
  return find_refusal(test::write_campaign(folder, text));
}

TEST_CASE("A campaign reads units signs scales offsets and uses of its columns", "[unit]") {
  const TemporaryFolder folder;
  test::write_two_runs(folder, {}, [](std::size_t, std::array<std::string, 4>& cells) {
    cells[0] = test::print_number(1000.0 * std::stod(cells[0]));
    cells[2] = test::print_number(-1000.0 * std::stod(cells[2]) + 4.0);
    cells[3] = test::print_number(500.0 * std::stod(cells[3]));
  });
  CampaignText text;
  text.time = "{ column = \"t\", unit = \"ms\" }";
  text.unsprung =
      "{ column = \"unsprung\", unit = \"mm\", sign = -1, offset = 0.004, noise = 2e-5 }";
  text.sprung = "{ column = \"sprung\", unit = \"mm\", scale = 2 }";
  const CampaignData data = read_campaign_data(test::write_campaign(folder, text));
  const test::QuarterRecord truth = test::record_quarter_car({});
  REQUIRE(data.runs.size() == 2);
  CHECK(data.campaign.runs[0].use == RunUse::kFit);
  CHECK(data.campaign.runs[1].use == RunUse::kHoldOut);
  CHECK(data.runs[0].setup.rig().rig.sprung_mass == 2.6);
  const MeasuredRun& run = data.runs[0];
  REQUIRE(run.channels.size() == 2);
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.time.size(); ++i) {
    worst = std::max(worst, std::abs(run.times[i] - truth.time[i]));
    worst = std::max(worst, std::abs(run.channels[0].values[i] - truth.unsprung[i]));
    worst = std::max(worst, std::abs(run.channels[1].values[i] - truth.sprung[i]));
  }
  // Twelve printed digits, of times up to 4 s.
  CHECK(worst < test::tolerance(1e-10));
  CHECK(data.find_noise(run.channels[0].channel).source == NoiseSource::kGiven);
  CHECK(run.channels[0].sigma == 2e-5);
}

TEST_CASE("Units convert by their definitions, and unknown ones name the nearest", "[unit]") {
  const auto to_si = [](const std::string& unit, const std::string& si, double value) {
    const UnitScale scale = find_unit_scale(unit, si);
    return scale.factor * value + scale.offset;
  };
  const double exact = test::tolerance(1e-12);  // a few roundings
  CHECK(to_si("g", "m/s^2", 2.0) == Approx(19.6133).epsilon(exact));
  CHECK(to_si("deg/s", "rad/s", 180.0) == Approx(std::acos(-1.0)).epsilon(exact));
  CHECK(to_si("km/h", "m/s", 36.0) == Approx(10.0).epsilon(exact));
  CHECK(to_si("kN", "N", 0.5) == Approx(500.0).epsilon(exact));
  CHECK(to_si("degC", "K", 20.0) == Approx(293.15).epsilon(exact));
  CHECK(to_si("degF", "K", 212.0) == Approx(373.15).epsilon(exact));
  CHECK(to_si("", "m", 3.0) == 3.0);
  CHECK_THROWS_WITH(find_unit_scale("mmm", "m"), Contains("did you mean 'mm'"));
  CHECK_THROWS_WITH(find_unit_scale("kN", "m"), Contains("allowed: m, mm"));
  CHECK(guess_unit("m", 1100.0) == "mm");
  CHECK(guess_unit("m/s^2", 0.1) == "g");
  CHECK(guess_unit("m", 1.0) == "m");
  CHECK(guess_unit("m", 15.0).empty());
}

TEST_CASE("Unknown keys of a campaign are errors with the nearest known key", "[unit]") {
  CHECK_THAT(spoil([](CampaignText& t) { t.sprung = "{ colum = \"sprung\" }"; }),
             Contains("colum") && Contains("did you mean 'column'"));
  CHECK_THAT(spoil([](CampaignText& t) { t.more_columns = "sprung_positon = { column = \"x\" }"; }),
             Contains("did you mean 'sprung_position'"));
  CHECK_THAT(spoil([](CampaignText& t) { t.fit = "free = [\"stifness\"]\n"; }),
             Contains("did you mean 'stiffness'"));
  CHECK_THAT(spoil([](CampaignText& t) { t.fit = "fre = [\"stiffness\"]\n"; }),
             Contains("did you mean 'free'"));
  CHECK_THAT(spoil([](CampaignText& t) { t.runs += "used = \"fit\"\n"; }),
             Contains("did you mean 'use'"));
  CHECK_THAT(spoil([](CampaignText& t) { t.fit += "prior = { mass = [1, 0.1] }\n"; }),
             Contains("mass") && Contains("is not free"));
}

TEST_CASE("A campaign whose runs are all for fitting or all held out is refused", "[unit]") {
  CHECK_THAT(spoil([](CampaignText& t) {
               t.runs =
                   "[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n[[run]]\nfile = \"b.csv\"\n"
                   "use = \"fit\"\n";
             }),
             Contains("every run is for fitting") && Contains("hold_out"));
  CHECK_THAT(
      spoil([](CampaignText& t) { t.runs = "[[run]]\nfile = \"a.csv\"\nuse = \"hold_out\"\n"; }),
      Contains("every run is held out"));
  CHECK_THAT(spoil([](CampaignText& t) {
               t.runs =
                   "[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n[[run]]\nfile = \"a.csv\"\n"
                   "use = \"hold_out\"\n";
             }),
             Contains("is listed twice"));
}

TEST_CASE("A missing column is an error that lists the file's columns, unless it is optional",
          "[unit]") {
  CHECK_THAT(spoil([](CampaignText& t) { t.sprung = "{ column = \"sprang\" }"; }),
             Contains("a.csv") && Contains("no column 'sprang'") &&
                 Contains("t, road, unsprung, sprung") && Contains("did you mean 'sprung'"));
  CHECK(spoil([](CampaignText& t) {
          t.more_columns = "actuator_force = { column = \"F\", optional = true }";
        }).empty());
  CHECK_THAT(spoil([](CampaignText& t) { t.more_columns = "actuator_force = { column = \"F\" }"; }),
             Contains("no column 'F'"));
  CHECK_THAT(spoil([](CampaignText& t) { t.sprung = "{ column = \"sprung\", role = \"input\" }"; }),
             Contains("sprung_position") &&
                 Contains("road_position, road_velocity, road_acceleration, actuator_force"));
}

TEST_CASE("A clock that runs backwards or stands still is an error with its line", "[unit]") {
  const auto set_time = [](std::size_t at, const char* value) {
    return [=](std::size_t row, std::array<std::string, 4>& cells) {
      if (row == at) cells[0] = value;
    };
  };
  CHECK_THAT(spoil_rows(set_time(100, "0.3")),
             Contains("a.csv:102") && Contains("the clock runs backwards"));
  CHECK_THAT(spoil_rows(set_time(100, "0.495")), Contains("the clock stands still"));
  CHECK_THAT(spoil_rows(set_time(100, "")), Contains("a.csv:102") && Contains("t is missing"));
}

TEST_CASE("Missing samples are left out and counted", "[unit]") {
  const TemporaryFolder folder;
  test::write_two_runs(folder, {}, [](std::size_t row, std::array<std::string, 4>& cells) {
    if (row % 3 == 1) cells[2] = "";
    if (row % 5 == 2) cells[3] = "NaN";
    if (row == 77) cells[1] = "nan";
  });
  const CampaignData data = read_campaign_data(test::write_campaign(folder));
  const MeasuredTable& table = data.tables[0];
  CHECK(table.find(data.campaign.columns, "unsprung_position")->missing == 267);
  CHECK(table.find(data.campaign.columns, "sprung_position")->missing == 160);
  CHECK(std::isnan(data.runs[0].channels[0].values[1]));
  CHECK(data.notes.size() == 6);
  const auto unknowns = make_run_unknowns(data, {0}, {});
  CHECK(make_reading_model(data, {0}, unknowns)->reading_count() == 2 * 801 - 267 - 160);
}

TEST_CASE("A constant or empty channel is an error", "[unit]") {
  const auto fill = [](std::size_t at, const char* value) {
    return [=](std::size_t, std::array<std::string, 4>& cells) { cells[at] = value; };
  };
  CHECK_THAT(spoil_rows(fill(3, "0.25")),
             Contains("sprung_position") && Contains("0.25 m in all 801 readings"));
  CHECK_THAT(spoil_rows(fill(3, "")), Contains("has no reading at all"));
  CHECK_THAT(spoil_rows(fill(1, "0")), Contains("nothing drives the rig"));
}

TEST_CASE("A unit wrong by a factor of 1000 is suspected, and the right one named", "[unit]") {
  const auto scale = [](std::size_t at, double factor) {
    return [=](std::size_t, std::array<std::string, 4>& cells) {
      cells[at] = test::print_number(factor * std::stod(cells[at]));
    };
  };
  CHECK_THAT(spoil_rows(scale(3, 1000.0)), Contains("sprung_position") && Contains("wrong") &&
                                               Contains("factor of 1000") &&
                                               Contains("unit = \"mm\""));
  CampaignText in_mm;
  in_mm.sprung = "{ column = \"sprung\", unit = \"mm\" }";
  CHECK_THAT(spoil_rows([](std::size_t, std::array<std::string, 4>&) {}, in_mm),
             Contains("sprung_position") && Contains("factor of 1000"));
  // Everything in mm: only what a rig can be tells.
  CHECK_THAT(spoil_rows([](std::size_t, std::array<std::string, 4>& cells) {
               for (std::size_t i = 1; i < 4; ++i) {
                 cells[i] = test::print_number(4e3 * std::stod(cells[i]));
               }
             }),
             Contains("the plausible"));
  CHECK_THAT(spoil_rows(scale(0, 1000.0)), Contains("unit = \"ms\""));
  CHECK_THAT(spoil_rows(scale(0, 1e-3)), Contains("samples per second"));
}

TEST_CASE("A file with a tenth of the required samples is refused", "[unit]") {
  const TemporaryFolder folder;
  test::write_record(folder, "a.csv", test::record_quarter_car({}, 4.0, 10.0));
  test::write_record(folder, "b.csv", test::record_quarter_car({}, 4.0, 100.0));
  CHECK_THAT(find_refusal(test::write_campaign(folder)),
             Contains("a.csv: 10 samples per second") && Contains("required"));
}

TEST_CASE("Every file has its own clock and rate, CSV or HDF5", "[io]") {
  const TemporaryFolder folder;
  const test::QuarterRecord record = test::record_quarter_car({}, 4.0, 250.0);
  test::write_record(folder, "a.csv", test::record_quarter_car({}),
                     [](std::size_t, std::array<std::string, 4>& cells) {
                       cells[0] = test::print_number(std::stod(cells[0]) + 1234.5);
                     });
  Hdf5Writer file(folder / "b.h5");
  const Hdf5Label label{"m", "as another tool writes it", {}, {}};
  file.write("/t", record.time, {"s", "", {}, {}});
  file.write("/road", record.road, label);
  file.write("/unsprung", record.unsprung, label);
  file.write("/sprung", record.sprung, label);
  file.commit();
  CampaignText text;
  text.runs =
      "[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n[[run]]\nfile = \"b.h5\"\nuse = \"hold_out\"\n";
  const CampaignData data = read_campaign_data(test::write_campaign(folder, text));
  CHECK(data.tables[0].rate() == Approx(200.0));
  CHECK(data.tables[1].rate() == Approx(250.0));
  CHECK(data.runs[0].times.front() == 0.0);
  CHECK(data.tables[0].times.front() == Approx(1234.5));
  CHECK(data.runs[1].channels[1].values == record.sprung);
}

TEST_CASE("Times rounded to few digits become the even clock they are rounded from", "[unit]") {
  std::vector<double> rounded, jittered;
  for (int i = 0; i < 3000; ++i) {
    rounded.push_back(std::round(i / 300.0 * 1e4) / 1e4);
    jittered.push_back(i / 300.0 + (i % 7 == 0 ? 4e-4 : 0.0));
  }
  const std::vector<double> before = jittered;
  CHECK(even_clock(rounded));
  for (int i = 0; i < 3000; i += 500) {
    // Least squares of 3000 roundings of 3e-5 s.
    CHECK(std::abs(rounded[static_cast<std::size_t>(i)] - i / 300.0) < test::tolerance(5e-6));
  }
  CHECK_FALSE(even_clock(jittered));
  CHECK(jittered == before);
}

TEST_CASE("Runs over one bump share the error of its survey", "[unit]") {
  // The left wheels of the second run meet the bump that both axles of the first do; the third
  // bump is another, the fourth was surveyed on its own.
  Case both = test::make_paper_case(), left = both, higher = both;
  left.maneuver.road.side = BumpSide::kLeft;
  higher.maneuver.road.height *= 1.1;
  CampaignData data;
  data.campaign.info = &get_car_info();
  for (const auto& [known, sigma] :
       {std::pair{both, 0.001}, {left, 0.001}, {higher, 0.001}, {both, 0.002}}) {
    data.campaign.runs.emplace_back();
    data.campaign.runs.back().known["bump_height"] = {known.maneuver.road.height, sigma};
    data.runs.push_back({"run", known, {0.0, 0.1}, {}});
    data.tables.emplace_back();
  }
  std::vector<double> sigmas;
  for (const Unknown& u : make_run_unknowns(data, {0, 1, 2, 3}, {})) {
    if (u.name == "bump_height") sigmas.push_back(u.prior.sigma);
  }
  REQUIRE(sigmas.size() == 4);
  CHECK(sigmas[0] == Approx(0.001 * std::sqrt(2.0)));
  CHECK(sigmas[1] == Approx(0.001 * std::sqrt(2.0)));
  CHECK(sigmas[2] == 0.001);
  CHECK(sigmas[3] == 0.002);
  // A run alone knows what the survey knows.
  for (const Unknown& u : make_run_unknowns(data, {1}, {})) {
    if (u.name == "bump_height") CHECK(u.prior.sigma == 0.001);
  }
}

}  // namespace
}  // namespace strut
