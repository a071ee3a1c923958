// Measured files for tests of campaigns: a quarter car integrated by an integrator of its own.
#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "base/math/random.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

/// The truth behind a record; its law of the strut is the test's own.
struct QuarterTruth {
  double sprung_mass = 2.6, unsprung_mass = 1.1;       // kg
  double stiffness = 950.0, damping = 8.0;             // N/m, N s/m
  double tire_stiffness = 1300.0, tire_damping = 6.0;  // N/m, N s/m
  double cubic = 0.0;                                  // N/m^3, of the strut's spring
  double friction = 0.0;                               // N, smoothed over 1 cm/s
  std::array<double, 4> start{};                       // z_u, z_s [m], rates [m/s]
  double noise = 0.0;                                  // m, 1 sigma of both positions
  std::uint64_t seed = 1;
  double amplitude = 0.002;      // m, of the road's chirp
  double stroke_friction = 0.0;  // N/m, friction by the strut's deflection, smoothed alike
  double hum = 0.0;              // m, a tone of 31.2 Hz in the sensor of the unsprung position
  double lost_stroke = 0.0;      // m, play before the damper, hard at both ends
  double jitter = 0.0;           // s, 1 sigma of the times of all samples but the first
  double stop_gap = 1.0;         // m of compression before a stop of 50 kN/m touches
};

struct QuarterRecord {
  std::vector<double> time, road, unsprung, sprung, sprung_acceleration;
};

/// A chirp from 1 to 8 Hz that begins and ends gently.
inline double calc_test_road(const QuarterTruth& truth, double t, double duration) {
  constexpr double kPi = std::numbers::pi;
  const double envelope = std::pow(std::sin(kPi * t / duration), 2.0);
  return truth.amplitude * envelope * std::sin(2.0 * kPi * (t + 3.5 * t * t / duration));
}

/// Standard normal number of a place (Box and Muller).
inline double calc_test_normal(std::uint64_t seed, std::uint64_t stream, std::uint64_t place) {
  const double u = calc_uniform(seed, stream, 2 * place);
  const double v = calc_uniform(seed, stream, 2 * place + 1);
  return std::sqrt(-2.0 * std::log1p(-u)) * std::cos(2.0 * std::numbers::pi * v);
}

/// Ralston's third-order method at a twentieth of the sampling interval, written out: nothing of
/// the program's.
inline QuarterRecord record_quarter_car(const QuarterTruth& truth, double duration = 4.0,
                                        double rate = 200.0) {
  constexpr int kSubsteps = 20;
  constexpr double kSmall = 1e-6;
  using State = std::array<double, 4>;
  const auto road_rate = [&](double t) {
    return (calc_test_road(truth, t + kSmall, duration) -
            calc_test_road(truth, t - kSmall, duration)) /
           (2.0 * kSmall);
  };
  const double half_play = 0.5 * truth.lost_stroke;
  double joint = 0.0;  // where the rod is in its play
  const auto derive = [&](double t, const State& x) {
    const double length = x[1] - x[0], speed = x[3] - x[2];
    const bool is_loose = speed > 0.0 ? joint < half_play : joint > -half_play;
    const double damping = is_loose ? 0.0 : truth.damping;
    const double stop = 5e4 * std::max(0.0, -length - truth.stop_gap);
    const double strut =
        stop - truth.stiffness * length - truth.cubic * length * length * length - damping * speed -
        (truth.friction + truth.stroke_friction * std::abs(length)) * std::tanh(speed / 0.01);
    const double tire = truth.tire_stiffness * (calc_test_road(truth, t, duration) - x[0]) +
                        truth.tire_damping * (road_rate(t) - x[2]);
    return State{x[2], x[3], (tire - strut) / truth.unsprung_mass, strut / truth.sprung_mass};
  };
  const auto add = [](const State& x, double s, const State& d) {
    State sum;
    for (std::size_t i = 0; i < 4; ++i) sum[i] = x[i] + s * d[i];
    return sum;
  };
  QuarterRecord record;
  State x = truth.start;
  const auto calc_time = [&](int i) {
    const auto place = static_cast<std::uint64_t>(i);
    return i / rate + (i > 0 ? truth.jitter * calc_test_normal(truth.seed, 2, place) : 0.0);
  };
  const auto count = static_cast<int>(std::lround(duration * rate)) + 1;
  for (int i = 0; i < count; ++i) {
    const double begin = calc_time(i), h = (calc_time(i + 1) - begin) / kSubsteps;
    const auto place = static_cast<std::uint64_t>(i);
    record.time.push_back(begin);
    record.road.push_back(calc_test_road(truth, begin, duration));
    const double hum = truth.hum * std::sin(2.0 * std::numbers::pi * 31.2 * begin);
    record.unsprung.push_back(x[0] + hum + truth.noise * calc_test_normal(truth.seed, 0, place));
    record.sprung.push_back(x[1] + truth.noise * calc_test_normal(truth.seed, 1, place));
    record.sprung_acceleration.push_back(derive(begin, x)[3]);
    for (int k = 0; k < kSubsteps; ++k) {
      const double t = begin + k * h;
      joint = std::clamp(joint + h * (x[3] - x[2]), -half_play, half_play);
      const State a = derive(t, x), b = derive(t + 0.5 * h, add(x, 0.5 * h, a));
      const State c = derive(t + 0.75 * h, add(x, 0.75 * h, b));
      x = add(add(add(x, 2.0 / 9.0 * h, a), h / 3.0, b), 4.0 / 9.0 * h, c);
    }
  }
  return record;
}

/// A row "t,road,unsprung,sprung"; `change` may replace any of its texts.
using ChangeRow = std::function<void(std::size_t row, std::array<std::string, 4>& cells)>;

inline std::string print_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

inline void write_record(const TemporaryFolder& folder, const std::string& name,
                         const QuarterRecord& r, const ChangeRow& change = {}) {
  std::string text = "t,road,unsprung,sprung\n";
  for (std::size_t i = 0; i < r.time.size(); ++i) {
    std::array<std::string, 4> cells = {print_number(r.time[i]), print_number(r.road[i]),
                                        print_number(r.unsprung[i]), print_number(r.sprung[i])};
    if (change) change(i, cells);
    text += cells[0] + "," + cells[1] + "," + cells[2] + "," + cells[3] + "\n";
  }
  folder.write(name, text);
}

/// Parts of a campaign file.
struct CampaignText {
  std::string model = STRUT_SOURCE_DIR "/examples/rigs/quarter_car.toml";
  std::string time = "{ column = \"t\" }";
  std::string road = "{ column = \"road\", role = \"input\" }";
  std::string unsprung = "{ column = \"unsprung\" }";
  std::string sprung = "{ column = \"sprung\" }";
  std::string more_columns;
  std::string fit =
      "free = [\"unsprung_mass\", \"stiffness\", \"damping\", \"tire_stiffness\", "
      "\"tire_damping\"]\nfix = { sprung_mass = 2.6 }\n";
  std::string runs =
      "[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n[[run]]\nfile = \"b.csv\"\nuse = \"hold_out\"\n";
};

inline std::filesystem::path write_campaign(const TemporaryFolder& folder,
                                            const CampaignText& text = {}) {
  return folder.write("campaign.toml", "model = \"" + text.model + "\"\n[columns]\ntime = " +
                                           text.time + "\nroad_position = " + text.road +
                                           "\nunsprung_position = " + text.unsprung +
                                           "\nsprung_position = " + text.sprung + "\n" +
                                           text.more_columns + "\n[fit]\n" + text.fit + text.runs);
}

/// a.csv and b.csv: the same rig, driven twice.
inline void write_two_runs(const TemporaryFolder& folder, QuarterTruth truth = {},
                           const ChangeRow& change = {}) {
  write_record(folder, "a.csv", record_quarter_car(truth), change);
  truth.amplitude = 0.0013;
  truth.seed += 1;
  write_record(folder, "b.csv", record_quarter_car(truth), change);
}

}  // namespace strut::test
