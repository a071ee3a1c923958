// PAC2002 against the printed equations written out by hand, and against its own laws.
#include "model/force/pac2002.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "base/math/xsimd_backend.h"
#include "model_files/read_tire.h"

namespace strut {
namespace {

Pac2002<double> read_paper_tire() {
  return read_tire(std::string(STRUT_SOURCE_DIR) + "/examples/tires/paper_sedan.tir").pacejka;
}

/// The paper's tire without conicity, plysteer and the other shifts: odd in both slips.
Pac2002<double> make_symmetric_tire() {
  Pac2002<double> p = read_paper_tire();
  p.LHX = p.LVX = p.LHY = p.LVY = p.LVYKA = p.PEX4 = p.PEY3 = p.RHX1 = p.RHY1 = p.RHY2 = p.RBY3 =
      0.0;
  return p;
}

constexpr double kLoad = 4207.0;  // N, a front wheel of the paper's car at rest

TireForce<double> calc_left(const Pac2002<double>& p, double load, double kappa, double alpha,
                            double camber = 0.0) {
  return calc_tire_force(p, {load, kappa, alpha, camber, 20.0}, 1.0);
}

std::array<double, 6> to_array(const TireForce<double>& f) {
  return {f.fx, f.fy, f.mx, f.my, f.mz, f.slip_stiffness};
}

// Rows made by tests/reference/pac2002_longhand.py: load, kappa, alpha, camber, speed; fx, fy, mx,
// my, mz, slip stiffness.
using LonghandRows = std::array<std::array<double, 11>, 12>;
constexpr LonghandRows kLonghand = {{
    {{3928.5, 0, 0, 0, 20, 107.687975108453, -37.467506024166, 17.6487835946137, -21.0380170403092,
      -9.13215568011672, 87617.3355}},
    {{4207, 0.012, 0, 0, 20, 1236.26647159083, -12.6397433018062, 19.4031371396594,
      -23.4443792653488, 8.4742292182109, 95401.1584221407}},
    {{4207, 0.012, 0.002, 0.01, 20, 1232.23931543558, -190.2087109537, 9.90649480974444,
      -23.441114477089, 16.1023965228277, 95401.1584221407}},
    {{1459, -0.03, -0.015, -0.02, 20, -761.027736012099, 391.417932788516, 13.6598378637983,
      -7.56903895825328, -17.8303583935075, 28078.2840696835}},
    {{2500, 0.1, 0, 0.03, 3, 2908.42853182107, 91.553447501703, 2.27090273241098, -13.2948970794305,
      59.1258172242604, 51199.3520315072}},
    {{2500, -0.25, 0.08, 0, 3, -2781.01553136033, -1328.26364420934, -4.3148608489439,
      -10.5539927384772, -51.8023917503276, 51199.3520315072}},
    {{9000, 0.05, -0.12, 0.05, 30, 3731.97871055071, 5321.43783963663, 209.696975486183,
      -60.6163952841119, -32.4266960772688, 271570.181193664}},
    {{9000, -0.8, 0.3, -0.05, 10, -7011.82464868972, -2889.06343425726, -20.1207379943893,
      -32.4852684276286, -121.892174043647, 271570.181193664}},
    {{500, 0.02, 0.04, 0, -5, 151.440324751106, -347.244271888625, 1.50007088529096,
      2.42166017450488, 1.48625141251762, 9086.36721126273}},
    {{14000, 0.03, 0.01, 0, 20, 9710.82631731636, -1478.04249287282, -34.265109246109,
      -100.880690914447, 242.625846784942, 451692.741580053}},
    {{100, -0.02, -0.01, 0, 20, -33.5666477695407, 16.8636902844625, 0.475424126257659,
      -0.532800906660822, -1.08977652079573, 1787.63597733993}},
    {{4000, 0, 0.1, 0, 20, 55.3109481127858, -3798.57525301153, -54.5069367312284,
      -21.3805434838445, 43.7894497815486, 89593.4855597243}},
}};

// With every scale factor other than one.
constexpr LonghandRows kScaledLonghand = {{
    {{3928.5, 0, 0, 0, 20, 130.204354272451, 36.3120149345341, 17.0367985941018, -30.5298406609052,
      -9.04480654851683, 93105.4552631401}},
    {{4207, 0.012, 0, 0, 20, 1314.32117124468, 82.7991232470939, 19.5165036648677,
      -34.0861036396005, 1.74950222562704, 101129.295004807}},
    {{4207, 0.012, 0.002, 0.01, 20, 1310.98757576138, -81.7390341868533, 7.05257117245812,
      -34.0821849807959, 6.94166194279374, 101129.295004807}},
    {{1459, -0.03, -0.015, -0.02, 20, -799.166468604181, 371.28625440838, 15.0282937908111,
      -10.9595585232293, -11.7546356496972, 30491.7842320571}},
    {{2500, 0.1, 0, 0.03, 3, 2623.29873031135, 205.46927401682, -0.60208810928141,
      -19.0784258408897, 28.4873048103186, 55093.4567007552}},
    {{2500, -0.25, 0.08, 0, 3, -2276.55133407122, -1161.63316671173, -8.63577355376096,
      -15.6556785152458, -28.9408937871931, 55093.4567007552}},
    {{9000, 0.05, -0.12, 0.05, 30, 4084.843035503, 5717.24731351139, 286.386875857598,
      -88.7811381774696, -32.8229370421761, 276042.193570183}},
    {{9000, -0.8, 0.3, -0.05, 10, -4905.20113467107, -2546.88674699028, -27.0063219221958,
      -52.4012674442746, -77.9782782103813, 276042.193570183}},
    {{500, 0.02, 0.04, 0, -5, 170.602093224688, -304.057144987718, 1.06153663556069,
      3.51408431012304, 1.36464584322414, 9951.06685371976}},
    {{14000, 0.03, 0.01, 0, 20, 9538.66696315833, -1418.78952885629, -71.7747368059056,
      -145.603543539837, 163.342980295997, 454641.424611429}},
    {{100, -0.02, -0.01, 0, 20, -36.1050999072176, 16.5768807569952, 0.420836789288613,
      -0.772490386118327, -0.702745437525239, 1962.50447767805}},
    {{4000, 0, 0.1, 0, 20, 74.3541312782414, -3493.80017990625, -74.4877210307116,
      -31.0230719695377, 34.4693355540324, 95145.6429486835}},
}};

/// The paper's tire with what its file leaves at zero: overturning couple, terms of the speed.
Pac2002<double> make_whole_tire() {
  Pac2002<double> p = read_paper_tire();
  p.QSX1 = 0.01, p.QSX2 = 0.3, p.QSX3 = 0.05;
  p.QSY2 = 0.002, p.QSY3 = 0.001, p.QSY4 = 0.0001;
  p.PDX3 = 1.5, p.QBZ10 = 0.1;
  return p;
}

void check_longhand(const Pac2002<double>& p, const LonghandRows& rows) {
  for (const auto& row : rows) {
    const TireSlip<double> slip{row[0], row[1], row[2], row[3], row[4]};
    for (const Pac2002Parts& parts : {Pac2002Parts{}, find_parts(p)}) {
      const auto f = to_array(calc_tire_force(p, slip, 1.0, parts));
      // The arctangent is good to 3e-15 and enters up to five deep; 15 digits in the table.
      for (std::size_t i = 0; i < f.size(); ++i) {
        CHECK(f[i] == Approx(row[5 + i]).epsilon(1e-13).margin(1e-13 * row[0]));
      }
    }
  }
}

TEST_CASE("The tire is the printed PAC2002", "[reference]") {
  check_longhand(make_whole_tire(), kLonghand);
}

TEST_CASE("Each scale factor stands where the printed PAC2002 has it", "[reference]") {
  Pac2002<double> p = make_whole_tire();
  p.LFZO = 0.95, p.LCX = 1.03, p.LMUX = 0.85, p.LEX = 0.9, p.LKX = 1.1, p.LHX = 1.2, p.LVX = 0.8;
  p.LGAX = 1.15, p.LCY = 0.97, p.LMUY = 0.9, p.LEY = 1.05, p.LKY = 0.93, p.LHY = 0.75;
  p.LVY = 1.25, p.LGAY = 0.85, p.LTR = 1.12, p.LRES = 0.7, p.LGAZ = 1.3, p.LXAL = 0.88;
  p.LYKA = 1.07, p.LVYKA = 1.4, p.LS = 0.6, p.LMX = 1.35, p.LVMX = 0.65, p.LMY = 1.45;
  check_longhand(p, kScaledLonghand);
}

TEST_CASE("The bounded trigonometric functions are exact to rounding", "[reference]") {
  double atan_error = 0.0, sine_error = 0.0, small_error = 0.0;
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 1e-3 * i, wide = x * x * x, narrow = 0.03 * x;
    atan_error =
        std::max({atan_error, std::abs(atan_any(x) - std::atan(x)),
                  std::abs(atan_any(wide) - std::atan(wide)),
                  std::abs(atan_quadrant(std::abs(x), 0.7) - std::atan2(std::abs(x), 0.7))});
    const double angle = x * bounded_trig::kPi / 4.0;
    sine_error = std::max({sine_error, std::abs(sin_bounded(angle) - std::sin(angle)),
                           std::abs(cos_bounded(angle) - std::cos(angle))});
    small_error = std::max({small_error, std::abs(atan_small(narrow) - std::atan(narrow)),
                            std::abs(cos_small(2.0 * narrow) - std::cos(2.0 * narrow))});
  }
  CHECK(atan_error < 3e-15);   // truncation 1.3e-15 and rounding
  CHECK(sine_error < 5e-16);   // rounding of the argument near pi
  CHECK(small_error < 3e-16);  // one rounding at 1
  CHECK(atan_any(1e300) == Approx(bounded_trig::kPi / 2.0).epsilon(1e-15));
  CHECK(atan_any(0.0) == 0.0);
}

TEST_CASE("The slope of the force at free rolling is the slip stiffness", "[property]") {
  const Pac2002<double> p = make_symmetric_tire();
  for (const double load : {500.0, kLoad, 9000.0}) {
    constexpr double kStep = 1e-5;  // truncation (B step)^2/3 ~ 1e-8, rounding 1e-16/1e-5 B
    const double fx = calc_left(p, load, kStep, 0.0).fx - calc_left(p, load, -kStep, 0.0).fx;
    CHECK(fx / (2.0 * kStep) == Approx(calc_left(p, load, 0.0, 0.0).slip_stiffness).epsilon(1e-6));
  }
  // Closed form at the scaled nominal load, where df_z = 0.
  const double nominal = p.LFZO * p.FNOMIN;
  CHECK(calc_left(p, nominal, 0.0, 0.0).slip_stiffness == Approx(nominal * 22.303).epsilon(1e-14));
}

TEST_CASE("The cornering stiffness is greatest at PKY2 times the nominal load", "[property]") {
  Pac2002<double> p = make_symmetric_tire();
  p.FZMAX = 2e4;
  p.PDY2 = 0.0;
  const auto stiffness = [&](double load) {
    return (calc_left(p, load, 0.0, -1e-5).fy - calc_left(p, load, 0.0, 1e-5).fy) / 2e-5;
  };
  const double nominal = p.LFZO * p.FNOMIN, peak = p.PKY2 * nominal;
  CHECK(stiffness(peak) == Approx(21.92 * nominal).epsilon(1e-6));  // step 1e-5, as above
  CHECK(stiffness(0.9 * peak) < stiffness(peak));
  CHECK(stiffness(1.1 * peak) < stiffness(peak));
}

TEST_CASE("The greatest force is friction times load", "[property]") {
  const Pac2002<double> p = make_symmetric_tire();
  const double dfz = kLoad / (p.LFZO * p.FNOMIN) - 1.0;
  double fx = 0.0, fy = 0.0;
  for (int i = 0; i < 4000; ++i) {
    fx = std::max(fx, calc_left(p, kLoad, 1e-4 * i, 0.0).fx);
    fy = std::max(fy, calc_left(p, kLoad, 0.0, -1e-4 * i).fy);
  }
  // The scan misses the top by at most half a step: (B 5e-5)^2/2 < 1e-5.
  CHECK(fx == Approx((1.1739 - 0.16395 * dfz) * kLoad).epsilon(1e-5));
  CHECK(fy == Approx((1.0489 - 0.18033 * dfz) * kLoad).epsilon(1e-5));
}

TEST_CASE("A tire without load has no force", "[property]") {
  const Pac2002<double> p = read_paper_tire();
  for (const double kappa : {-1.0, 0.0, 0.02, 5.0}) {
    for (const double alpha : {-1.5, 0.0, 0.03}) {
      for (const double f : to_array(calc_left(p, 0.0, kappa, alpha, 0.05))) CHECK(f == 0.0);
    }
  }
}

TEST_CASE("A right tire is the mirror image of a left one", "[property]") {
  const Pac2002<double> p = read_paper_tire(), mirrored = mirror_tire(p);
  for (const double kappa : {-0.1, 0.0, 0.02}) {
    for (const double alpha : {-0.1, 0.003}) {
      const TireSlip<double> s{kLoad, kappa, alpha, 0.02, 20.0};
      const TireSlip<double> image{kLoad, kappa, -alpha, -0.02, 20.0};
      const auto right = to_array(calc_tire_force(p, s, -1.0));
      const auto left = to_array(calc_tire_force(p, image, 1.0));
      const auto other_file = to_array(calc_tire_force(mirrored, s, 1.0));
      const std::array<double, 6> sign = {1, -1, -1, 1, -1, 1};
      for (std::size_t i = 0; i < sign.size(); ++i) {
        CHECK(right[i] == sign[i] * left[i]);
        CHECK(right[i] == Approx(other_file[i]).epsilon(1e-13).margin(1e-13 * kLoad));
      }
    }
  }
}

TEST_CASE("Without shifts the forces are odd and take energy", "[property]") {
  const Pac2002<double> p = make_symmetric_tire();
  for (const double kappa : {0.001, 0.05, 0.4}) {
    for (const double alpha : {0.001, 0.05, 0.4}) {
      const auto f = calc_left(p, kLoad, kappa, alpha);
      const auto g = calc_left(p, kLoad, -kappa, -alpha);
      CHECK(f.fx > 0.0);
      CHECK(f.fy < 0.0);
      CHECK(g.fx == Approx(-f.fx).epsilon(1e-13));  // rounding of the reduced arguments
      CHECK(g.fy == Approx(-f.fy).epsilon(1e-13));
    }
  }
}

TEST_CASE("Combined slip stays near the friction ellipse", "[property]") {
  const Pac2002<double> p = make_symmetric_tire();
  const double dfz = kLoad / (p.LFZO * p.FNOMIN) - 1.0;
  const double peak_x = (p.PDX1 + p.PDX2 * dfz) * kLoad, peak_y = (p.PDY1 + p.PDY2 * dfz) * kLoad;
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const double kappa = 0.02 * i, alpha = 0.02 * j;
      const auto f = calc_left(p, kLoad, kappa, alpha);
      CHECK(std::hypot(f.fx / peak_x, f.fy / peak_y) < 1.08);  // the fit is no ellipse: 1.068
      CHECK(std::abs(f.fx) <= std::abs(calc_left(p, kLoad, kappa, 0.0).fx) * (1.0 + 1e-14));
      CHECK(std::abs(f.fy) <= std::abs(calc_left(p, kLoad, 0.0, alpha).fy) * (1.0 + 1e-14));
    }
  }
}

TEST_CASE("The aligning torque turns the wheel back at small slip angles", "[property]") {
  Pac2002<double> p = make_symmetric_tire();
  p.LRES = p.LS = p.QHZ1 = p.QHZ2 = 0.0;
  constexpr double kAngle = 1e-4;
  const auto f = calc_left(p, kLoad, 0.0, kAngle);
  // Closed form for alpha -> 0: the trail is its peak, D_t = (QDZ1 + QDZ2 df_z) R0 Fz/F'z0.
  const double ratio = kLoad / (p.LFZO * p.FNOMIN);
  const double trail = (p.QDZ1 + p.QDZ2 * (ratio - 1.0)) * p.UNLOADED_RADIUS * ratio;
  CHECK(f.mz > 0.0);
  CHECK(f.mz == Approx(-trail * f.fy).epsilon(1e-5));  // (C_t B_t alpha)^2/2 = 1e-6
}

TEST_CASE("Rolling resistance opposes the motion", "[property]") {
  const Pac2002<double> p = read_paper_tire();
  const auto torque = [&](double speed) {
    return calc_tire_force(p, {kLoad, 0.0, 0.0, 0.0, speed}, 1.0).my;
  };
  CHECK(torque(20.0) == Approx(-0.01 * kLoad * 0.4673).epsilon(1e-14));
  CHECK(torque(-20.0) == -torque(20.0));
  CHECK(torque(0.0) == 0.0);
}

TEST_CASE("Beyond the load range the force per load is held", "[property]") {
  const Pac2002<double> p = read_paper_tire();
  const auto at_limit = calc_left(p, p.FZMAX, 0.03, 0.02), beyond = calc_left(p, 1e5, 0.03, 0.02);
  CHECK(beyond.fx / 1e5 == Approx(at_limit.fx / p.FZMAX).epsilon(1e-14));
  CHECK(beyond.fy / 1e5 == Approx(at_limit.fy / p.FZMAX).epsilon(1e-14));
}

TEST_CASE("Curvature is limited to one", "[unit]") {
  Pac2002<double> p = make_symmetric_tire(), limited = p;
  p.PEX1 = 5.0;
  limited.PEX1 = 1.0;
  limited.PEX2 = limited.PEX3 = 0.0;
  CHECK(calc_left(p, kLoad, 0.2, 0.0).fx == calc_left(limited, kLoad, 0.2, 0.0).fx);
}

TEST_CASE("A part left out is a part with zero coefficients", "[property]") {
  Pac2002<double> p = read_paper_tire();
  CHECK(find_parts(p).combined);
  CHECK(find_parts(p).aligning);
  CHECK_FALSE(find_parts(p).overturning);
  CHECK(find_parts(p).small_shift);
  p.RBX1 = p.RBY1 = p.RVY1 = p.RVY2 = p.RVY3 = 0.0;
  p.QDZ1 = p.QDZ2 = p.QDZ6 = p.QDZ7 = p.QDZ8 = p.QDZ9 = 0.0;
  p.SSZ1 = p.SSZ2 = p.SSZ3 = p.SSZ4 = 0.0;
  const Pac2002Parts parts = find_parts(p);
  CHECK_FALSE(parts.combined);
  CHECK_FALSE(parts.aligning);
  const TireSlip<double> s{kLoad, 0.03, 0.02, 0.01, 20.0};
  const auto all = to_array(calc_tire_force(p, s, 1.0));
  const auto fewer = to_array(calc_tire_force(p, s, 1.0, parts));
  // cos(0)/cos(0) of the weights is one to a rounding.
  for (std::size_t i = 0; i < all.size(); ++i) CHECK(all[i] == Approx(fewer[i]).epsilon(1e-15));
  p.RHX1 = 0.1;  // B S_H = 1.3 with the paper's RBX1
  p.RBX1 = 13.0;
  CHECK_FALSE(find_parts(p).small_shift);
  CHECK((find_parts(p) | Pac2002Parts{}).aligning);
}

TEST_CASE("A tire in lanes is the tire in double", "[property]") {
  constexpr int kWidth = kLaneCount<NativeLanes>;
  std::array<Pac2002<double>, kWidth> tires;
  std::array<TireSlip<double>, kWidth> slips;
  for (int round = 0; round < 50; ++round) {
    for (int i = 0; i < kWidth; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double x = round + 0.37 * i;
      tires[k] = read_paper_tire();
      tires[k].LMUX = 1.0 - 0.02 * i;
      tires[k].LKY = 1.0 + 0.05 * i;
      slips[k] = {6000.0 * (1.0 + std::sin(x)), 0.3 * std::sin(3.1 * x), 0.2 * std::sin(1.7 * x),
                  0.05 * std::sin(0.9 * x), 20.0 * std::cos(x)};
    }
    const auto packed = pack_lanes<Pac2002, NativeLanes>(tires.data());
    const auto slip = pack_lanes<TireSlip, NativeLanes>(slips.data());
    const Pac2002Parts parts = find_parts(tires[0]);
    const TireForce<NativeLanes> f = calc_tire_force(packed, slip, NativeLanes(-1.0), parts);
    for (int i = 0; i < kWidth; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto expected = to_array(calc_tire_force(tires[k], slips[k], -1.0, parts));
      const std::array<double, 6> in_lane = {get_lane(f.fx, i), get_lane(f.fy, i),
                                             get_lane(f.mx, i), get_lane(f.my, i),
                                             get_lane(f.mz, i), get_lane(f.slip_stiffness, i)};
      for (std::size_t j = 0; j < in_lane.size(); ++j) {
        CHECK(in_lane[j] == Approx(expected[j]).epsilon(1e-12).margin(1e-12 * slips[k].load));
      }
    }
  }
}

TEST_CASE("A tire that is not a number stays one", "[unit]") {
  const Pac2002<double> p = read_paper_tire();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(calc_left(p, nan, 0.0, 0.0).fx));
  CHECK(std::isnan(calc_left(p, kLoad, nan, 0.0).fx));
  CHECK(std::isnan(calc_left(p, kLoad, 0.0, nan).fy));
  const TireSlip<NativeLanes> s{kLoad, nan, nan, 0.0, 20.0};
  Pac2002<NativeLanes> lanes;
  lanes.FNOMIN = NativeLanes(4000.0);
  const auto f = calc_tire_force(lanes, s, NativeLanes(1.0));
  CHECK(std::isnan(get_lane(f.fx, 0)));
  CHECK(std::isnan(get_lane(f.fy, 0)));
}

TEST_CASE("Relaxation lengths at the loads of their closed forms", "[reference]") {
  Pac2002<double> p = read_paper_tire();
  const double nominal = p.LFZO * p.FNOMIN;
  CHECK(calc_relaxation_length(p, nominal, 0.0).longitudinal ==
        Approx(0.81 * 2.3657 * 0.4673).epsilon(1e-14));
  CHECK(calc_relaxation_length(p, 1.9829 * nominal, 0.0).lateral ==
        Approx(2.1439 * 0.4673 * 0.81).epsilon(1e-14));
  CHECK(calc_relaxation_length(p, 0.0, 0.0).longitudinal == 0.0);
  CHECK(calc_relaxation_length(p, 0.0, 0.0).lateral == 0.0);
  // A carcass of constant stiffness: sigma = K/C_x at every load.
  p.PTX1 = 0.1 * p.PKX1, p.PTX2 = 0.1 * p.PKX2, p.PTX3 = -p.PKX3;
  for (const double load : {1000.0, 4000.0, 9000.0}) {
    const double stiffness = calc_left(p, load, 0.0, 0.0).slip_stiffness;
    CHECK(calc_relaxation_length(p, load, 0.0).longitudinal * p.FNOMIN ==
          Approx(0.1 * p.UNLOADED_RADIUS * stiffness).epsilon(1e-14));
  }
}

TEST_CASE("The rolling radius lies between the free and the loaded radius", "[property]") {
  Pac2002<double> p = read_paper_tire();
  constexpr double kRadius = 0.4673, kStiffness = 2e5;
  CHECK(calc_rolling_radius(p, kRadius, 0.0, kStiffness) == kRadius);
  CHECK(calc_rolling_radius(p, kRadius, -0.01, kStiffness) == kRadius);
  for (const double deflection :
       {0.02, 0.03, 0.05}) {  // below 12 mm this fit is under the loaded one
    const double rolling = calc_rolling_radius(p, kRadius, deflection, kStiffness);
    CHECK(rolling < kRadius);
    CHECK(rolling > kRadius - deflection);
  }
  // By hand at the nominal load: rho0 = 4850/2e5 = 0.02425 m.
  CHECK(calc_rolling_radius(p, kRadius, 0.02425, kStiffness) ==
        Approx(kRadius - 0.02425 * (0.27 * std::atan(8.4) + 0.07)).epsilon(1e-14));
  p.BREFF = p.DREFF = p.FREFF = 0.0;
  CHECK(calc_rolling_radius(p, kRadius, 0.03, kStiffness) == Approx(kRadius - 0.01).epsilon(1e-15));
}

}  // namespace
}  // namespace strut
