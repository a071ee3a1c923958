// A force map as a sum of shapes, the smooth ones first, that a fit can weigh one by one.
//
// Over one variable x with splines B and visited samples x_k the shapes u_i solve
//
//   D' D u_i = rho_i G u_i,   G = mean of B(x_k) B(x_k)',   u_i' G u_j = delta_ij,
//
// D: second differences. rho_i is the roughness of a shape that is 1 N rms where the strut was;
// rho = 0 belongs to the constant and the straight line, which preload, stiffness and damping
// explain: they are left out, and all others are orthogonal to them (A. Demmler, C. Reinsch, Numer.
// Math. 24 (1975)). Over both variables: products of lines and shapes of either.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/baseline/visited_states.h"
#include "model/effects/force_map.h"

namespace strut {

/// What a shape of a map depends on.
enum class MapShare : int { kVelocity, kDeflection, kJoint };
inline constexpr int kMapShares = 3;

struct MapShape {
  MapShare share = MapShare::kVelocity;
  double roughness = 1.0;        // over that of a straight line
  Eigen::VectorXd coefficients;  // N, of the grid; 1 N rms over independent samples of d and v
};

struct MapBasis {
  ForceMap grid;  // coefficients are all zero
  std::vector<MapShape> shapes;
};

struct MapGridOptions {
  int deflection_count = 10, velocity_count = 24;  // splines
  double margin = 0.05;  // of the range visited, by which the grid is wider on either side
  int joint_deflection = 3, joint_velocity = 7;  // shapes beside the line that products are made of
};

/// Without shapes where the strut hardly moves. `given`: a map that is there already, whose grid is
/// kept; or null.
MapBasis make_map_basis(const VisitedStates& states, const ForceMap* given = nullptr,
                        const MapGridOptions& options = {});

/// The sum of the shapes, each times its factor, upon the grid.
ForceMap add_shapes(const MapBasis& basis, const Eigen::VectorXd& factors);

}  // namespace strut
