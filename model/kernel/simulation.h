// Simulating cases: the door from specifications to results. Instruction sets stay behind it.
#pragma once

#include <memory>
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
};

/// What many cases share: one car's mechanism and road, expensive to make.
struct Mechanism {
  VehicleSpec vehicle;
  ManeuverSpec maneuver;
  AssembledVehicle car;
  VehicleTables<double> tables;
  Surface surface;
};

/// A case ready to run: its numbers, its trimmed start, its mechanism.
struct PreparedCase {
  std::shared_ptr<const Mechanism> mechanism;
  Vehicle<double> vehicle;
  State<double> start;
  double bump_center = 0.0;  // m, world x
  double trigger_x = 0.0;    // m, world x of the snapshot's line
  double duration = 0.0;     // s
  EffectSettings sensors{};  // effects of channels: nothing that runs asks for them
  CornerForceMaps force_maps{};
};

/// Prepares cases, reusing the mechanism while only springs, dampers, speed or torque change.
class CasePreparer {
 public:
  /// `snapshot_offset` [m] moves the snapshot's line from the bump's center. Throws ModelError.
  PreparedCase prepare(const Case& c, double snapshot_offset = 0.0);

 private:
  std::shared_ptr<const Mechanism> mechanism_;
};

/// One instruction set's compiled simulation.
struct Kernel {
  const char* isa;  // "baseline", "avx2", "avx512"
  int lanes;        // W
  /// Runs up to W cases in lockstep; results hold W lanes, those beyond `count` repeat the last.
  /// Throws ModelError for cases that may not share lanes.
  LaneResults (*run_lanes)(const PreparedCase* const* cases, int count,
                           const IntegrateOptions& options, const SamplePlan& plan);
  /// Runs one case in plain double.
  LaneResults (*run_scalar)(const PreparedCase& c, const IntegrateOptions& options,
                            const SamplePlan& plan);
  /// Runs up to W rigs of one kind under the same inputs; lanes as run_lanes'. Throws ModelError as
  /// simulate_rigs does.
  LaneResults (*run_rigs)(const RigSpec* const* specs, int count,
                          const std::vector<InputSignal>& inputs, const StepOptions& options,
                          const SamplePlan& plan);
  /// Nothing but independent fused multiply-adds in registers: `rounds` times over, for timing the
  /// processor's peak. Returns the number of floating-point operations; `sink` keeps their result.
  double (*run_peak_loop)(long rounds, double& sink);
};

/// Kernels this processor can run, widest first; never empty.
const std::vector<Kernel>& list_kernels();

/// True if the cases may share lanes: same layout, and for Newton closure the same hardpoints.
bool may_share_lanes(const PreparedCase& a, const PreparedCase& b, Closure closure);

/// Reference: CVODE (BDF or Adams as the problem asks) with contact events as roots.
struct ReferenceOptions {
  double relative_tolerance = 1e-12;
  double absolute_tolerance = 1e-12;
  Closure closure = Closure::kNewton;
};
LaneResults run_cvode(const PreparedCase& c, const ReferenceOptions& options,
                      const SamplePlan& plan);

enum class Solver { kLanes, kCvode };

/// Who integrates, and how.
struct SolverOptions {
  Solver solver = Solver::kLanes;
  IntegrateOptions options;    // of the lanes
  ReferenceOptions reference;  // of CVODE
};

}  // namespace strut
