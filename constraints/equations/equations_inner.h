// What the two halves of the equations share; nobody else includes this.
#pragma once

#include "constraints/equations/equations.h"

namespace selfcal {

inline constexpr int kMotions = 6;  ///< columns of the world's motions

/// Everything about up to kLanes rows of one set.
struct Equations::Block {
  ConfigurationBlock now, before;
  Locations X_now, X_before, X_axes;
  Closure closure;  ///< of a lane that it leaves open all else is zero
  PsiBlock psi_now, psi_before, psi_axes;
  MethodOutput out;
  MethodOutput::Block G_axes;  ///< as G, to the axes of vectors; without columns: there are none
  const Eigen::MatrixXd* independent = nullptr;  ///< by lane, of sets with noise_joints
  std::vector<int> rows;
  std::vector<Quantity> quantities;
};

/// States a little ahead and behind along a step, and in between.
struct Equations::GeodesicStep {
  static constexpr double kPart = 0.1;  ///< of the step
  State ahead, middle, behind;
};

/// Of a lane that `closure` leaves open it is infinite.
RowResidual row_residual(const MethodOutput& out, const std::vector<Quantity>& quantities,
                         const Closure& closure, int lane, int row, int set, double factor);

/// The smallest shift of the method's body, in the world (m), that to first order makes the lengths
/// among the residuals of a lane zero (minimum norm).
Eigen::Vector3d shortest_way(const MethodOutput& out, const std::vector<Quantity>& quantities,
                             int lane);

}  // namespace selfcal
