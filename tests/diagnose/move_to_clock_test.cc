#include "diagnose/campaign/move_to_clock.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "diagnose/campaign/campaign_data.h"
#include "tests/support/campaign_files.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::CampaignText;
using test::TemporaryFolder;

std::string print(const std::vector<double>& values) {
  std::string text;
  for (const double v : values) text += (std::isnan(v) ? "-" : test::print_number(v)) + " ";
  return text;
}

TEST_CASE("A slow channel keeps its readings on a fast clock", "[unit]") {
  const std::vector<double> fast = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5};
  CHECK(print(move_to_clock({0.0, 0.2, 0.4}, {1.0, 3.0, 5.0}, fast, false)) == "1 - 3 - 5 - ");
  // Not a subset of the times: the line through its neighbors at the nearest time
  CHECK(print(move_to_clock({0.04, 0.24, 0.44}, {1.0, 3.0, 5.0}, fast, false)) ==
        "- - 2.6 - 4.6 - ");
  CHECK(print(move_to_clock({0.0, 0.2, 0.4}, {1.0, 3.0, 5.0}, fast, true)) == "1 2 3 4 5 - ");
  CHECK(print(move_to_clock({0.0, 0.2, 0.4}, {1.0, std::nan(""), 5.0}, fast, true)) ==
        "1 - - - 5 - ");
}

TEST_CASE("A fast channel is interpolated on a slow clock", "[unit]") {
  CHECK(print(move_to_clock({0.0, 0.1, 0.2, 0.3, 0.4}, {0.0, 1.0, 2.0, 3.0, 4.0}, {0.05, 0.25, 9.0},
                            false)) == "0.5 2.5 - ");
}

TEST_CASE("A campaign reads channels of different rates from one file", "[io]") {
  const TemporaryFolder folder;
  for (const char* name : {"a.csv", "b.csv"}) {
    const test::QuarterRecord record = test::record_quarter_car({});
    std::string text = "Time [s];Road [mm];Body [m];Time slow [ms];Wheel [m]\n";
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      const std::size_t slow = 4 * i;
      text += test::print_number(record.time[i]) + ";" + test::print_number(1e3 * record.road[i]) +
              ";" + test::print_number(record.sprung[i]) + ";" +
              (slow < record.time.size() ? test::print_number(1e3 * record.time[slow]) + ";" +
                                               test::print_number(record.unsprung[slow])
                                         : std::string(";")) +
              "\n";
    }
    folder.write(name, text);
  }
  CampaignText text;
  text.time = "{ column = \"Time\" }";
  text.road = "{ column = \"Road\", role = \"input\" }";
  text.sprung = "{ column = \"Body [m]\" }";
  text.unsprung = "{ column = \"Wheel\", clock = \"Time slow\" }";
  const CampaignData data = read_campaign_data(test::write_campaign(folder, text));
  const test::QuarterRecord record = test::record_quarter_car({});
  const MeasuredColumn& wheel = *data.tables[0].find(data.campaign.columns, "unsprung_position");
  CHECK(wheel.values[8] == Approx(record.unsprung[8]).margin(1e-9));
  CHECK(std::isnan(wheel.values[9]));
  const MeasuredColumn& road = *data.tables[0].find(data.campaign.columns, "road_position");
  CHECK(road.values[100] == Approx(record.road[100]).margin(1e-9));  // mm, as the file says
  text.road = "{ column = \"Road\", role = \"input\", unit = \"m\" }";
  CHECK_THROWS_WITH(read_campaign_data(test::write_campaign(folder, text)), Contains("its unit"));
  text.road = "{ column = \"Road\", role = \"input\", scale = 1e-3 }";  // includes the unit
  CHECK_NOTHROW(read_campaign_data(test::write_campaign(folder, text)));
}

TEST_CASE("A channel's delay is taken back", "[io]") {
  const TemporaryFolder folder;
  const test::QuarterRecord record = test::record_quarter_car({});
  test::QuarterRecord late = record;
  for (std::size_t i = 0; i < late.sprung.size(); ++i) {
    late.sprung[i] = record.sprung[i < 4 ? 0 : i - 4];  // 20 ms
  }
  for (const char* name : {"a.csv", "b.csv"}) test::write_record(folder, name, late);
  CampaignText text;
  text.sprung = "{ column = \"sprung\", delay = 0.02 }";
  const CampaignData data = read_campaign_data(test::write_campaign(folder, text));
  const MeasuredColumn& body = *data.tables[0].find(data.campaign.columns, "sprung_position");
  CHECK(body.values[100] == Approx(record.sprung[100]).margin(1e-9));
  CHECK(std::isnan(body.values.back()));
}

TEST_CASE("A column in another quantity's unit is refused", "[io]") {
  const TemporaryFolder folder;
  for (const char* name : {"a.csv", "b.csv"}) {
    test::write_record(folder, name, test::record_quarter_car({}));
  }
  std::string text = test::read_text(folder / "a.csv");
  text.replace(0, text.find('\n'), "t,road [N],unsprung,sprung");
  folder.write("a.csv", text);
  CampaignText campaign;
  campaign.road = "{ column = \"road [N]\", role = \"input\" }";
  CHECK_THROWS_WITH(read_campaign_data(test::write_campaign(folder, campaign)),
                    Contains("a.csv: column 'road [N]': unit \"N\"") && Contains("allowed: m, mm"));
}

}  // namespace
}  // namespace strut
