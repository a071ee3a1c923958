// Recorded windows: what they must hold, and how they come onto a model's grid.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "identify/record.h"
#include "io/table/csv.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

/// A window of one channel at 100 Hz, 0.2 s from 0.1 s on, not aligned.
WindowTransform make_window() {
  WindowTransform window;
  window.channels = {{"imu_rate_y", "rad/s", "pitch rate"}};
  window.grid.interval = 0.01;
  window.grid.first = 10;
  window.grid.samples = 20;
  window.grid.lags = 0;
  return window;
}

/// A quintic, which six samples determine.
double calc_rate(double t) { return 1.0 + t * (2.0 - t * (3.0 + t * (1.0 - t * (0.5 - t)))); }

fs::path write_record(const TemporaryFolder& folder, double first, double last, double interval,
                      const std::string& unit = "rad/s", std::size_t lost = 1 << 30) {
  CsvColumn time{"time", "s", {}}, rate{"imu_rate_y", unit, {}};
  const auto count = static_cast<std::size_t>(std::lround((last - first) / interval)) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == lost) continue;
    time.values.push_back(first + static_cast<double>(i) * interval);
    rate.values.push_back(calc_rate(time.values.back()));
  }
  write_csv(folder / "m.csv", {time, rate});
  return folder / "m.csv";
}

TEST_CASE("A record comes onto the model's grid, off it by interpolation", "[unit]") {
  const TemporaryFolder folder;
  const double first = GENERATE(0.0, 0.0037), interval = GENERATE(0.01, 0.005, 0.0083);
  const MeasuredRecord record =
      read_record(make_window(), write_record(folder, first, first + 0.6, interval));
  CHECK(record.begin == Approx(0.1));
  REQUIRE(record.samples >= 20);
  REQUIRE(record.values.size() == record.samples);
  for (std::size_t i = 0; i < record.samples; ++i) {
    // Lagrange's polynomials of degree 5 are exact; weights of up to ten lose two digits.
    CHECK(record.values[i] ==
          Approx(calc_rate(0.1 + 0.01 * static_cast<double>(i))).epsilon(1e-12));
  }
}

TEST_CASE("A record that a window cannot take is refused by file and row", "[unit]") {
  const TemporaryFolder folder;
  const WindowTransform window = make_window();
  const auto check = [&](const fs::path& file, const std::string& text) {
    CHECK_THROWS_WITH(read_record(window, file), Contains(text));
  };
  check(write_record(folder, 0.0, 0.2, 0.01), "m.csv: the record is from 0 to 0.2 s");
  check(write_record(folder, 0.0, 0.6, 0.02), "m.csv: 50 samples per second; must be at least 100");
  check(write_record(folder, 0.0, 3.0, 0.01, "rad/s", 40),
        "m.csv:43: 0.02 s after the sample before");
  check(write_record(folder, 0.0, 0.6, 0.01, "mm"), "column 'imu_rate_y': unit \"mm\"");
  check(folder.write("back.csv", "time,imu_rate_y\n0,1\n0,1\n"), "back.csv:3: time must ascend");
  check(folder.write("clock.csv", "time,imu_rate_y\n# units: mm,rad/s\n0,1\n10,1\n"),
        "column 'time': unit \"mm\"");
}

}  // namespace
}  // namespace strut
