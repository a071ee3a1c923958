// A force map as a sum of shapes, the smooth ones first, whose factors a fit determines.
//
// Over one variable x with splines B and visited samples x_k the shapes u_i solve
//
//   D' D u_i = rho_i G u_i,   G = mean of B(x_k) B(x_k)',   u_i' G u_j = delta_ij,
//
// D: second differences. rho_i is the roughness of a shape of 1 N rms over the visited samples.
// rho = 0 belongs to the constant and the straight line, which preload, stiffness and damping
// explain: they are left out, and all other shapes are orthogonal to them (A. Demmler, C. Reinsch,
// Numer. Math. 24 (1975)). Over both variables: products of lines and shapes of either.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/baseline/visited_states.h"
#include "model/effects/force_map.h"

namespace strut {

/// The variables that a shape of a map depends on.
enum class MapShare : int { kVelocity, kDeflection, kJoint };
inline constexpr int kMapShares = 3;

struct MapShape {
  MapShare share = MapShare::kVelocity;
  double roughness = 1.0;        // relative to a straight line's
  Eigen::VectorXd coefficients;  // on the grid [N]; 1 N rms over independent samples of d and v
};

struct MapBasis {
  ForceMap grid;  // coefficients are all zero
  std::vector<MapShape> shapes;
};

struct MapGridOptions {
  int deflection_count = 10, velocity_count = 24;  // numbers of splines
  double margin = 0.05;  // of the grid on either side, as a fraction of the visited range
  int joint_deflection = 3, joint_velocity = 7;  // numbers of shapes in products, beside the line
};

/// Returns a basis without shapes where the strut hardly moves. `given`: an existing map whose grid
/// is kept, or null.
MapBasis make_map_basis(const VisitedStates& states, const ForceMap* given = nullptr,
                        const MapGridOptions& options = {});

/// The grid's map plus the sum of the shapes times their factors.
ForceMap add_shapes(const MapBasis& basis, const Eigen::VectorXd& factors);

}  // namespace strut
