#include "tests/hidden/trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "tests/hidden/random_stream.h"

namespace strut::hidden {
namespace {

constexpr int kBlock = 39;
constexpr int kNone = 15, kOne = 14, kTwo = 5;
/// Magnitudes: 1.5 decades of the ratio, from 2 to 63, so that every grade occurs.
constexpr double kLowest = 5.0 * 0.39810717055349725, kHighest = 5.0 * 12.589254117941673;

bool is_known(const FaultInfo& info) { return *info.effect != '\0'; }

double get_start(const Kit& kit, const FaultInfo& info) {
  // A dynamometer holds a car's strut.
  return kit.kind == KitKind::kQuarterCar ? info.rig : info.car;
}

/// The largest magnitude that is still the thing it is called.
double get_cap(const Kit& kit, const FaultInfo& info) {
  switch (info.fault) {
    case Fault::kAsymmetry:
    case Fault::kKnee:
    case Fault::kSelectiveDamper:
      return 0.8;
    case Fault::kSaturation:
    case Fault::kWarming:
      return 0.6;
    case Fault::kSpeedometer:
      return 0.06;
    case Fault::kParabola:
    case Fault::kTruncatedRamp:
      return 1.2;
    case Fault::kSensorGain:
    case Fault::kRoadGain:
    case Fault::kBumpHeight:
    case Fault::kBumpLength:
      return 0.3;
    default:
      return 10.0 * get_start(kit, info);
  }
}

/// Below it the equations become stiffer than the integrator likes, or nothing is left.
double get_floor(const Kit& kit, const FaultInfo& info) {
  const double start = get_start(kit, info);
  const bool is_stiff =
      info.fault == Fault::kMount || info.fault == Fault::kLag || info.fault == Fault::kPlay;
  return is_stiff ? 0.02 * start : 3e-4 * start;
}

/// Largest reading of a sensor in all runs.
double find_peak(const std::vector<std::vector<Signal>>& runs, int sensor) {
  double peak = 0.0;
  for (const std::vector<Signal>& run : runs) {
    for (const double v : run[static_cast<std::size_t>(sensor)].value) {
      peak = std::max(peak, std::fabs(v));
    }
  }
  return peak;
}

}  // namespace

const char* get_name(Category category) {
  constexpr std::array<const char*, 4> kNames = {"none", "one", "two", "unknown"};
  return kNames[static_cast<std::size_t>(category)];
}

Category draw_category(std::uint64_t seed) {
  std::array<int, kBlock> order{};
  std::array<double, kBlock> key{};
  std::iota(order.begin(), order.end(), 0);
  RandomStream draws(seed / kBlock, "categories");
  for (double& k : key) k = draws.draw_uniform();
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)];
  });
  const int place = order[seed % kBlock];
  if (place < kNone) return Category::kNone;
  if (place < kNone + kOne) return Category::kOne;
  return place < kNone + kOne + kTwo ? Category::kTwo : Category::kUnknown;
}

char Trial::get_grade() const {
  char grade = '-';
  for (const HiddenFault& f : faults) grade = std::max(grade, find_grade(f.noise.ratio));
  return grade;
}

char Trial::get_grade_beyond_survey() const {
  char grade = '-';
  for (const HiddenFault& f : faults) grade = std::max(grade, find_grade(f.beyond_survey));
  return grade;
}

Sampler::Sampler(const Kit& kit) : kit_(kit), classes_{0.0} {
  if (kit.kind == KitKind::kCar) classes_ = {1e-6, 16e-6, 64e-6};
  const std::vector<Nuisance> nuisances = make_nuisances(kit_);
  for (const double degree : classes_) {
    detectors_.push_back(std::make_unique<Detector>(kit_, nuisances, degree));
  }
}

const Detector& Sampler::get_detector(double roughness) const {
  const auto at = std::find(classes_.begin(), classes_.end(), roughness) - classes_.begin();
  return *detectors_[static_cast<std::size_t>(at)];
}

Truth Sampler::draw_truth(std::uint64_t seed) const {
  Truth truth = make_nominal_truth(kit_);
  RandomStream draws(seed, "parameters");
  for (std::size_t i = 0; i < kit_.parameters.size(); ++i) {
    const KitParameter& p = kit_.parameters[i];
    truth.factors[i] =
        p.prior > 0.0 ? 1.0 + p.prior * draws.draw_normal() : draws.draw_uniform(p.low, p.high);
  }
  RandomStream speed(seed, "speed");
  for (double& e : truth.speed_error) e = kit_.speed_sigma * speed.draw_normal();
  RandomStream road(seed, "road class");
  truth.roughness =
      classes_[static_cast<std::size_t>(road.draw_index(static_cast<int>(classes_.size())))];
  truth.seed = seed;
  return truth;
}

std::vector<FaultSetting> Sampler::draw_faults(std::uint64_t seed, Category category) const {
  if (category == Category::kNone) return {};
  std::vector<const FaultInfo*> candidates;
  for (const FaultInfo& info : list_faults()) {
    const bool wanted = is_known(info) != (category == Category::kUnknown);
    if (info.newer && seed < kNewerFaults) continue;
    if (wanted && (info.kits & kit_.bit) != 0) candidates.push_back(&info);
  }
  RandomStream draws(seed, "faults");
  std::vector<FaultSetting> settings;
  const std::size_t count = category == Category::kTwo ? 2 : 1;
  while (settings.size() < count) {
    const auto which =
        static_cast<std::size_t>(draws.draw_index(static_cast<int>(candidates.size())));
    const FaultInfo& info = *candidates[which];
    FaultSetting s{info.fault, 0, get_start(kit_, info), 0.0};
    const double side = draws.draw_uniform(), sign = draws.draw_sign();
    if (info.either_sign) s.magnitude *= sign;
    if (kit_.kind == KitKind::kCar && (info.where == Where::kStrut || info.where == Where::kTire)) {
      s.place = side < 0.5 ? 0 : 1;
    }
    if (info.where == Where::kChannel) {
      const auto inputs = static_cast<int>(std::count_if(kit_.sensors.begin(), kit_.sensors.end(),
                                                         [](const Sensor& x) { return x.input; }));
      const int outputs = static_cast<int>(kit_.sensors.size()) - inputs;
      s.place = inputs + static_cast<int>(side * outputs);
    }
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(which));
    settings.push_back(s);
  }
  return settings;
}

SignalToNoise Sampler::measure(const FaultSetting& setting, const Truth& without,
                               const std::vector<std::vector<Signal>>& base) const {
  if (get_info(setting.fault).seen_by_speeds) {
    const double stray = calc_speed_stray(kit_, setting);
    return {stray, stray, stray};
  }
  Truth with = without;
  with.faults = {setting};
  return get_detector(without.roughness).calc(subtract(simulate_fit_runs(kit_, with), base));
}

HiddenFault Sampler::size_fault(FaultSetting setting, double target, const Truth& without,
                                const std::vector<std::vector<Signal>>& base) const {
  // Nearly in proportion; thresholds need the bracket, too.
  auto [low, high] = find_bracket(kit_, setting.fault);
  HiddenFault hidden{setting, measure(setting, without, base), target, 0.0};
  for (int i = 0; i < 9; ++i) {
    const double size = std::fabs(hidden.setting.magnitude), ratio = hidden.noise.ratio;
    if (std::fabs(ratio / target - 1.0) < 0.05) break;
    (ratio < target ? low : high) = size;
    double next = size * target / std::max(ratio, 1e-9 * target);
    if (next <= low || next >= high) next = std::sqrt(low * high);
    if (std::fabs(next / size - 1.0) < 1e-3) break;
    hidden.setting.magnitude = std::copysign(next, setting.magnitude);
    hidden.noise = measure(hidden.setting, without, base);
  }
  hidden.beyond_survey = std::min(hidden.noise.ratio, calc_survey_stray(kit_, hidden.setting));
  return hidden;
}

Trial Sampler::draw(std::uint64_t seed) const {
  Trial trial;
  trial.seed = seed;
  trial.category = draw_category(seed);
  trial.truth = draw_truth(seed);
  RandomStream sizes(seed, "sizes");
  const std::vector<FaultSetting> settings = draw_faults(seed, trial.category);
  if (!settings.empty()) {
    const auto base = simulate_fit_runs(kit_, trial.truth);
    Truth without = trial.truth;
    for (FaultSetting s : settings) {
      if (s.fault == Fault::kSaturation) s.peak = find_peak(base, s.place);
      const double target = sizes.draw_log_uniform(kLowest, kHighest);
      trial.faults.push_back(size_fault(s, target, without, base));
      trial.truth.faults.push_back(trial.faults.back().setting);
    }
  }
  const std::vector<double>& bounds = get_detector(trial.truth.roughness).bounds();
  for (std::size_t i = 0; i < kit_.parameters.size(); ++i) {
    trial.bounds.push_back(kit_.parameters[i].nominal * bounds[i]);
  }
  RandomStream clocks(seed, "clocks");
  for (std::size_t r = 0; r < kit_.runs.size(); ++r) {
    const double offset = kit_.time_sigma * clocks.draw_normal();
    trial.clocks.push_back({offset, 2e-5 * clocks.draw_normal(), kit_.jitter});
  }
  RandomStream biases(seed, "biases");
  for (const Sensor& sensor : kit_.sensors) {
    trial.bias.push_back(sensor.bias * biases.draw_normal());
  }
  return trial;
}

std::pair<double, double> find_bracket(const Kit& kit, Fault fault) {
  const FaultInfo& info = get_info(fault);
  return {get_floor(kit, info), get_cap(kit, info)};
}

std::string get_place(const Kit& kit, const FaultSetting& setting) {
  const Where where = get_info(setting.fault).where;
  if (where == Where::kChannel) return kit.sensors[static_cast<std::size_t>(setting.place)].channel;
  if (kit.kind != KitKind::kCar) return "";
  if (where == Where::kBody) return "body";
  if (where == Where::kRoad) return "road";
  return setting.place == 0 ? "front" : "rear";
}

std::string get_where(const Kit& kit, const FaultSetting& setting) {
  std::string place = get_place(kit, setting);
  if (!place.empty()) return place;
  switch (get_info(setting.fault).where) {
    case Where::kTire:
      return "tire";
    case Where::kBody:
      return "body";
    case Where::kRoad:
      return "road";
    default:
      return "strut";
  }
}

}  // namespace strut::hidden
