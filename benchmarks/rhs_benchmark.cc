// Compares lane types: the car's right-hand side with each candidate, and its maximum difference
// from `double`. One program per instruction set. Results: docs/design/0002-lanes.md.
//
//   rhs_benchmark_avx512 --benchmark_enable_random_interleaving=true --benchmark_repetitions=15
//
// "spin" is a fixed chain of dependent operations: on a noisy machine compare ratios to it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "base/math/xsimd_backend.h"
#include "benchmarks/lane_backends/stdx_backend.h"
#include "benchmarks/lane_backends/vector_backend.h"
#include "model/kernel/run_cases.h"
#include "model_files/read_vehicle.h"
#ifdef STRUT_HAS_HIGHWAY
#include "benchmarks/lane_backends/highway_backend.h"
#endif

namespace strut {
namespace {

using Rates = std::array<double, StateIndex::kCount>;

const PreparedCase& get_case() {
  static const PreparedCase prepared =
      CasePreparer().prepare({read_vehicle(STRUT_VEHICLE_FILE), ManeuverSpec{}});
  return prepared;
}

/// A state near the trimmed start, different in each lane.
double calc_entry(std::size_t entry, int lane) {
  return get_case().start[entry] + 0.01 * std::sin(7.0 * static_cast<double>(entry) + 3.0 * lane);
}

/// The right-hand side of W cars with `Closure`, prepared for calls.
template <class T, template <class> class Closure>
struct alignas(4096) RightHandSide {  // the same offset in a page for all: offsets cost up to 20 %
  Vehicle<T> vehicle;
  Workspace<T> workspace{};
  State<T> x{}, dx{};  // rates of states that the car does not have stay zero

  explicit RightHandSide(int first_lane = 0) : vehicle(make_vehicle()) {
    workspace.segment.fill(T(0.0));
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (int lane = 0; lane < kLaneCount<T>; ++lane) {
        set_lane(x[i], lane, calc_entry(i, first_lane + lane));
      }
    }
  }
  static Vehicle<T> make_vehicle() {
    const std::vector<const PreparedCase*> cases(kLaneCount<T>, &get_case());
    return pack_vehicle<Sides::kBoth, T>(cases.data());
  }
  void calc() {
    calc_derivative(vehicle, Closure<T>::make(vehicle), TireMode::kRolling, x.data(), dx.data(),
                    workspace);
  }
};

template <class T>
struct Newton {
  static NewtonClosure<T> make(const Vehicle<T>& v) { return {&v.layout, &v.numbers}; }
};

template <class T>
struct Table {
  static TableClosure<T, double> make(const Vehicle<T>&) { return {&get_case().mechanism->tables}; }
};

template <class T, template <class> class Closure>
void run_right_hand_side(benchmark::State& state) {
  const auto rhs = std::make_unique<RightHandSide<T, Closure>>();
  for (auto _ : state) {
    rhs->calc();
    benchmark::ClobberMemory();
  }
  state.counters["W"] = kLaneCount<T>;
}

/// The elementary functions alone: sine and cosine, arctangent, exponential of one vector.
template <class T>
void run_functions(benchmark::State& state) {
  T x(0.0);
  for (int lane = 0; lane < kLaneCount<T>; ++lane) set_lane(x, lane, 0.1 + 0.3 * lane);
  for (auto _ : state) {
    benchmark::DoNotOptimize(x);
    T s, c;
    sin_cos(x, s, c);
    T sum = s + c + atan(x) + exp(x);
    benchmark::DoNotOptimize(sum);
  }
}

/// 1000 dependent multiplications and additions.
void spin(benchmark::State& state) {
  for (auto _ : state) {
    double x = 1.0;
    for (int i = 0; i < 1000; ++i) {
      x = x * 1.0000001 + 1e-9;
      benchmark::DoNotOptimize(x);
    }
  }
}

/// Maximum difference between lanes and double over all rates, relative to the larger of the rate
/// and 1.
template <class T, template <class> class Closure>
double find_difference() {
  const auto rhs = std::make_unique<RightHandSide<T, Closure>>();
  rhs->calc();
  double max = 0.0;
  for (int lane = 0; lane < kLaneCount<T>; ++lane) {
    const auto one = std::make_unique<RightHandSide<double, Closure>>(lane);
    one->calc();
    for (std::size_t i = 0; i < one->dx.size(); ++i) {
      const double difference = std::abs(get_lane(rhs->dx[i], lane) - one->dx[i]);
      max = std::max(max, difference / std::max(1.0, std::abs(one->dx[i])));
    }
  }
  return max;
}

template <class T>
void add_candidate(const char* name) {
  std::printf("%-8s W = %d, difference from double: table %.1e, newton %.1e\n", name, kLaneCount<T>,
              find_difference<T, Table>(), find_difference<T, Newton>());
  const std::string prefix = std::string(name) + "/";
  benchmark::RegisterBenchmark((prefix + "table").c_str(), &run_right_hand_side<T, Table>);
  benchmark::RegisterBenchmark((prefix + "functions").c_str(), &run_functions<T>);
  benchmark::RegisterBenchmark((prefix + "newton").c_str(), &run_right_hand_side<T, Newton>);
}

}  // namespace

void run_benchmarks() {
  benchmark::RegisterBenchmark("spin", &spin);
  add_candidate<double>("double");
  add_candidate<NativeLanes>("xsimd");
  add_candidate<Lanes<StdxBackend>>("stdx");
#ifdef STRUT_HAS_HIGHWAY
  add_candidate<Lanes<HighwayBackend>>("highway");
#endif
  add_candidate<Lanes<VectorBackend>>("vector");
  benchmark::RunSpecifiedBenchmarks();
}

}  // namespace strut

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  strut::run_benchmarks();
  return 0;
}
