// Simulation of cases: from specifications to results. Instruction sets are hidden behind Kernel.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "model/car/assemble.h"
#include "model/car/car_system.h"
#include "model/car/case.h"
#include "model/car/trim.h"
#include "model/rig/rigs.h"

namespace strut {

enum class Closure { kNewton, kTable };

struct IntegrateOptions {
  StepOptions step;  // stepper, step [s], contact events located or not
  Closure closure = Closure::kNewton;
  SpinTreatment spin = SpinTreatment::kExponential;
  bool symmetry = false;  // whether of a case that is_symmetric only the left side is computed
};

/// The expensive parts that many cases share: one car's mechanism and road.
struct Mechanism {
  VehicleSpec vehicle;
  ManeuverSpec maneuver;
  AssembledVehicle car;
  VehicleTables<double> tables;
  Surface surface;
  std::array<RoughTrack, 2> rough;  // the maneuver's profile as the tires follow it
};

/// Whether two mechanisms have the same tables, which gravity enters by the car's trim; the roads
/// may differ.
inline bool have_equal_tables(const Mechanism& a, const Mechanism& b) {
  return &a == &b || (a.vehicle == b.vehicle && a.maneuver.gravity == b.maneuver.gravity);
}

/// A case ready to run: its parameters, its trimmed start, its mechanism.
struct PreparedCase {
  std::shared_ptr<const Mechanism> mechanism;
  Vehicle<double> vehicle;
  State<double> start;        // NaN until find_starts
  double start_speed = 0.0;   // m/s
  bool starts_driven = true;  // with the drive torque
  double bump_center = 0.0;   // m, world x
  double trigger_x = 0.0;     // m, world x of the snapshot's line
  double duration = 0.0;      // s
  double longest_step = std::numeric_limits<double>::infinity();  // s, that its effects need
  EffectSettings sensors{};  // effects of channels, for ReadOut; the simulation ignores them
  CornerForceMaps force_maps{};
  std::array<RoughTrack, 2> rough{};  // left, right
};

/// Prepares cases; reuses the mechanism of the previous case where both share it (mechanism.h).
class CasePreparer {
 public:
  /// `snapshot_offset` [m] moves the snapshot's line from the bump's center. Throws ModelError.
  PreparedCase prepare(const Case& c, double snapshot_offset = 0.0);
  /// All of prepare but the start. Throws ModelError.
  PreparedCase assemble(const Case& c, double snapshot_offset = 0.0);

 private:
  std::shared_ptr<const Mechanism> mechanism_;
};

/// One instruction set's compiled simulation.
struct Kernel {
  const char* isa;  // "baseline", "avx2", "avx512"
  int lanes;        // W
  /// Finds the starts of up to W cases, all of which may share lanes (the caller's promise); bit i
  /// of the result is set where that of case i was found.
  unsigned (*find_starts)(PreparedCase* const* cases, int count);
  /// Runs up to W cases in lockstep; results have W lanes, those beyond `count` repeat the last
  /// case. Throws ModelError for cases that may not share lanes.
  LaneResults (*run_lanes)(const PreparedCase* const* cases, int count,
                           const IntegrateOptions& options, const SamplePlan& plan);
  /// Runs one case in plain double.
  LaneResults (*run_scalar)(const PreparedCase& c, const IntegrateOptions& options,
                            const SamplePlan& plan);
  /// Runs up to W rigs of one kind under the same inputs; lanes as in run_lanes. Throws ModelError
  /// as simulate_rigs does.
  LaneResults (*run_rigs)(const RigSpec* const* specs, int count,
                          const std::vector<InputSignal>& inputs, const StepOptions& options,
                          const SamplePlan& plan);
  /// Runs `rounds` of independent fused multiply-adds in registers, for timing the processor's
  /// peak. Returns the number of floating-point operations; `sink` keeps their result.
  double (*run_peak_loop)(long rounds, double& sink);
};

/// Kernels this processor can run, widest first; never empty.
const std::vector<Kernel>& list_kernels();

/// In the lanes of a kernel, by KINSOL where that finds none; or all by KINSOL, which is slower and
/// the rule of sweeps that an earlier version planned.
enum class StartMethod { kLanes, kKinsol };

/// Finds the starts of all cases, steady rolling. Returns the reason why a case has none, "" where
/// it has. A start does not depend on the other cases.
std::vector<std::string> find_starts(const Kernel& kernel, const std::vector<PreparedCase*>& cases,
                                     StartMethod method = StartMethod::kLanes);

/// The start of one case by the widest kernel, bit-identical to find_starts. Throws ModelError
/// where there is none.
void find_start(PreparedCase& c);

/// Whether the car is its own mirror image and starts and drives as one, to rounding (1e-12 of each
/// number): same struts, effects, drive and road left and right, no lateral center of mass, no
/// products of inertia with the lateral axis. Its motion then is symmetric.
bool is_symmetric(const PreparedCase& c);

/// True if the cases may share lanes: same layout, with Newton closure the same topology and
/// elimination order of the loops, with symmetry the same computed corners. Of cases of different
/// durations the shorter ones' samples end with NaN.
bool may_share_lanes(const PreparedCase& a, const PreparedCase& b, const IntegrateOptions& options);

struct ReferenceOptions {
  double relative_tolerance = 1e-12;
  double absolute_tolerance = 1e-12;
  Closure closure = Closure::kNewton;
};

/// Runs one case by CVODE, with BDF or Adams formulas by the stiffness at the start, and contact
/// events as roots; duration and channels are those of the case. Throws std::runtime_error where
/// SUNDIALS cannot be set up.
LaneResults run_cvode(const PreparedCase& c, const ReferenceOptions& options, SamplePlan plan);

enum class Solver { kLanes, kCvode };

/// Choice of the integrator and its options.
struct SolverOptions {
  Solver solver = Solver::kLanes;
  IntegrateOptions options;    // for kLanes
  ReferenceOptions reference;  // for kCvode
};

}  // namespace strut
