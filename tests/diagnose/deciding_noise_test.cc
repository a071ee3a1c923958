// Notes on verdicts that rest on the estimated noise of an input.
#include "diagnose/compare/deciding_noise.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/support/campaign_files.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;

/// A spring of 40 kN/m on a crank, its force read precisely and its displacement by `noise` [m].
std::string record_spring(double noise, std::uint64_t seed) {
  std::string text = "t,x,F\n";
  for (int i = 0; i < 3000; ++i) {
    const double t = 1e-3 * i, x = 0.02 * std::sin(7.0 * t);
    const auto place = static_cast<std::uint64_t>(i);
    text += test::print_number(t) + "," +
            test::print_number(x + noise * test::calc_test_normal(seed, 0, place)) + "," +
            test::print_number(4e4 * x + 0.2 * test::calc_test_normal(seed, 1, place)) + "\n";
  }
  return text;
}

std::vector<std::string> compare_spring(double noise, const std::string& stated) {
  const TemporaryFolder folder;
  folder.write("a.csv", record_spring(noise, 1));
  folder.write("b.csv", record_spring(noise, 2));
  folder.write("rig.toml", "type = \"strut_rig\"\nstiffness = 35000\n");
  const CampaignData data = read_campaign_data(
      folder.write("campaign.toml",
                   "model = \"rig.toml\"\n[columns]\ntime = { column = \"t\" }\n"
                   "displacement = { column = \"x\"" +
                       stated +
                       " }\nforce = { column = \"F\", noise = 0.2 }\n"
                       "[fit]\nfree = [\"stiffness\"]\n[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n"
                       "[[run]]\nfile = \"b.csv\"\nuse = \"hold_out\"\n"));
  const Comparison comparison = compare_campaign(data);
  CHECK(comparison.is_adequate());
  return comparison.notes;
}

TEST_CASE("A verdict that rests on the estimated noise of an input says so", "[reference]") {
  const std::vector<std::string> notes = compare_spring(2e-4, "");
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes.front(), Contains("force in a.csv") && Contains("displacement (0.0002"));
}

TEST_CASE("A stated noise, or a small one, needs no note", "[reference]") {
  CHECK(compare_spring(2e-4, ", noise = 2e-4").empty());
  CHECK(compare_spring(1e-8, "").empty());
}

}  // namespace
}  // namespace strut
