#include "tests/hidden/trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "tests/hidden/fault_range.h"
#include "tests/hidden/random_stream.h"

namespace strut::hidden {
namespace {

constexpr int kBlock = 39;
constexpr int kNone = 15, kOne = 14, kTwo = 5;
/// Magnitudes: 1.5 decades of the ratio, from 2 to 63, so that every grade occurs.
constexpr double kLowest = 5.0 * 0.39810717055349725, kHighest = 5.0 * 12.589254117941673;

bool is_known(const FaultInfo& info) { return *info.effect != '\0'; }

/// A hidden fault and what a fit without it leaves of the whitened runs.
struct Graded {
  HiddenFault fault;
  Eigen::VectorXd residual;
};

Graded grade_fault(const Detector& detector, const FaultSetting& setting, double target) {
  const Eigen::VectorXd residual = detector.fit(detector.calc_deviation({setting}));
  return {{setting, residual.norm(), target, {}}, residual};
}

Graded size_fault(const Detector& detector, FaultSetting setting, double target) {
  // Nearly in proportion; thresholds need the bracket, too.
  auto [low, high] = find_bracket(detector.kit(), setting.fault);
  setting.magnitude *= kSmall;
  setting.peak = find_peak(detector.kit(), detector.truth(), setting);
  Graded graded = grade_fault(detector, setting, target);
  for (int i = 0; i < 9; ++i) {
    const double size = std::fabs(setting.magnitude), ratio = graded.fault.ratio;
    if (std::fabs(ratio / target - 1.0) < 0.05) break;
    (ratio < target ? low : high) = size;
    double next = size * target / std::max(ratio, 1e-9 * target);
    if (next <= low || next >= high) next = std::sqrt(low * high);
    if (std::fabs(next / size - 1.0) < 1e-3) break;
    setting.magnitude = std::copysign(next, setting.magnitude);
    graded = grade_fault(detector, setting, target);
  }
  return graded;
}

/// Compares hidden faults with the causes that the catalogue knows.
void add_likeness(const Detector& detector, const std::vector<Graded>& graded, Trial& trial) {
  if (graded.empty()) return;
  const std::vector<KnownCause> causes = list_known_causes(detector);
  std::vector<Eigen::VectorXd> residuals;
  for (std::size_t i = 0; i < graded.size(); ++i) {
    residuals.push_back(graded[i].residual);
    trial.faults[i].twins =
        list_twins(detector.kit(), graded[i].fault.setting, residuals.back(), causes);
  }
  const Eigen::VectorXd all = graded.size() == 1
                                  ? residuals.front()
                                  : detector.fit(detector.calc_deviation(trial.truth.faults));
  trial.beyond_one = calc_beyond_one(all, causes);
  trial.beyond_two = calc_beyond_two(all, causes, residuals);
}

/// The trial of the detector's truth with its clocks, biases and bounds.
Trial make_trial(const Detector& detector, const std::vector<Graded>& graded) {
  const Kit& kit = detector.kit();
  Trial trial;
  trial.seed = detector.truth().seed;
  trial.category = draw_category(trial.seed);
  trial.truth = detector.truth();
  for (const Graded& g : graded) {
    trial.faults.push_back(g.fault);
    trial.truth.faults.push_back(g.fault.setting);
  }
  add_likeness(detector, graded, trial);
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    trial.bounds.push_back(kit.parameters[i].nominal * detector.bounds()[i]);
  }
  RandomStream clocks(trial.seed, "clocks");
  for (std::size_t r = 0; r < kit.runs.size(); ++r) {
    const double offset = kit.time_sigma * clocks.draw_normal();
    trial.clocks.push_back({offset, 2e-5 * clocks.draw_normal(), kit.jitter});
  }
  RandomStream biases(trial.seed, "biases");
  for (const Sensor& sensor : kit.sensors) {
    trial.bias.push_back(sensor.bias * biases.draw_normal());
  }
  return trial;
}

/// Hides what every machine has: up to two small effects of other kinds, together below the
/// detection limit, which no verdict needs to name.
void add_misfits(const Detector& detector, const std::vector<FaultSetting>& faults, Trial& trial) {
  constexpr double kSmallest = 1.0, kLargest = 2.5, kTooLarge = 3.0;
  constexpr int kMisfits = 2;
  const Kit& kit = detector.kit();
  std::vector<Fault> kinds;
  for (const Fault kind : {Fault::kSideFriction, Fault::kFriction, Fault::kKnee, Fault::kMount,
                           Fault::kHardening, Fault::kTirePower}) {
    const bool is_hidden = std::any_of(faults.begin(), faults.end(),
                                       [&](const FaultSetting& s) { return s.fault == kind; });
    if (!is_hidden && (get_info(kind).kits & kit.bit) != 0) kinds.push_back(kind);
  }
  RandomStream draws(trial.seed, "misfits");
  for (int i = 0; i < kMisfits; ++i) {
    const auto which = draws.draw_index(static_cast<int>(kinds.size()));
    FaultSetting s{kinds[static_cast<std::size_t>(which)], 0, 0.0, 0.0};
    kinds.erase(kinds.begin() + which);
    s.magnitude = get_start(kit, get_info(s.fault));
    if (kit.kind == KitKind::kCar) s.place = draws.draw_index(2);
    const HiddenFault misfit =
        size_fault(detector, s, draws.draw_log_uniform(kSmallest, kLargest)).fault;
    // The smallest size of some kinds is larger.
    if (misfit.ratio > kTooLarge) continue;
    trial.misfits.push_back(misfit);
    trial.truth.faults.push_back(misfit.setting);
  }
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
  for (const HiddenFault& f : faults) grade = std::max(grade, find_grade(f.ratio));
  return grade;
}

Truth draw_truth(const Kit& kit, std::uint64_t seed) {
  Truth truth = make_nominal_truth(kit);
  RandomStream draws(seed, "parameters");
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    const KitParameter& p = kit.parameters[i];
    truth.factors[i] =
        p.prior > 0.0 ? 1.0 + p.prior * draws.draw_normal() : draws.draw_uniform(p.low, p.high);
  }
  RandomStream speed(seed, "speed");
  for (double& e : truth.speed_error) e = kit.speed_sigma * speed.draw_normal();
  if (kit.kind == KitKind::kCar) {
    constexpr std::array<double, 3> kClasses = {1e-6, 16e-6, 64e-6};  // m^3
    RandomStream road(seed, "road class");
    truth.roughness = kClasses[static_cast<std::size_t>(road.draw_index(kClasses.size()))];
  }
  RandomStream errors(seed, "sensor errors");
  for (const Sensor& s : kit.sensors) {
    truth.sensor_gain.push_back(s.gain * errors.draw_normal());
    truth.sensor_skew.push_back(s.skew * errors.draw_normal());
  }
  truth.seed = seed;
  return truth;
}

std::vector<FaultSetting> draw_faults(const Kit& kit, std::uint64_t seed) {
  const Category category = draw_category(seed);
  if (category == Category::kNone) return {};
  std::vector<const FaultInfo*> candidates;
  for (const FaultInfo& info : list_faults()) {
    const bool wanted = is_known(info) != (category == Category::kUnknown);
    if (info.newer && seed < kNewerFaults) continue;
    if (wanted && (info.kits & kit.bit) != 0) candidates.push_back(&info);
  }
  RandomStream draws(seed, "faults");
  std::vector<FaultSetting> settings;
  const std::size_t count = category == Category::kTwo ? 2 : 1;
  while (settings.size() < count) {
    const auto which =
        static_cast<std::size_t>(draws.draw_index(static_cast<int>(candidates.size())));
    const FaultInfo& info = *candidates[which];
    FaultSetting s{info.fault, 0, get_start(kit, info), 0.0};
    const double side = draws.draw_uniform(), sign = draws.draw_sign();
    if (info.either_sign) s.magnitude *= sign;
    if (kit.kind == KitKind::kCar && (info.where == Where::kStrut || info.where == Where::kTire)) {
      s.place = side < 0.5 ? 0 : 1;
    }
    if (info.where == Where::kChannel) {
      const auto inputs = static_cast<int>(std::count_if(kit.sensors.begin(), kit.sensors.end(),
                                                         [](const Sensor& x) { return x.input; }));
      const int outputs = static_cast<int>(kit.sensors.size()) - inputs;
      s.place = inputs + static_cast<int>(side * outputs);
    }
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(which));
    settings.push_back(s);
  }
  return settings;
}

Trial draw_trial(const Kit& kit, std::uint64_t seed) {
  const Detector detector(kit, draw_truth(kit, seed));
  const bool is_machine = kit.regime == Regime::kMachine;
  RandomStream sizes(seed, "sizes"), growth(seed, "realistic sizes");
  std::vector<Graded> graded;
  const std::vector<FaultSetting> faults = draw_faults(kit, seed);
  for (const FaultSetting& s : faults) {
    const double target = sizes.draw_log_uniform(kLowest, kHighest);
    const double times = is_machine ? growth.draw_log_uniform(10.0, 30.0) : 1.0;
    graded.push_back(size_fault(detector, s, times * target));
  }
  Trial trial = make_trial(detector, graded);
  if (is_machine) add_misfits(detector, faults, trial);
  return trial;
}

Trial grade_trial(const Kit& kit, std::uint64_t seed, const std::vector<FaultSetting>& faults) {
  const Detector detector(kit, draw_truth(kit, seed));
  std::vector<Graded> graded;
  for (FaultSetting s : faults) {
    s.peak = find_peak(kit, detector.truth(), s);
    graded.push_back(grade_fault(detector, s, 0.0));
  }
  return make_trial(detector, graded);
}

}  // namespace strut::hidden
