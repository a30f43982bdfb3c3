// Frame after frame of a chain, for a block of configurations at once: where each is put and which
// axes its parameters act about (11.3, 11.10 to 11.15).
//
// For a rotation parameter about axis a through O the column is [a x L; a], L from O to the body;
// for a translation along a it is [a; 0]. beta turns about y of the frame before; alpha and d act
// along x after that turn (the chapter has x before it, equal at its nominal beta of zero); theta
// and r along z of the frame itself. x y z of a whole pose act along the axes of the frame before;
// its rotation R_0 exp(phi), phi = (rx ry rz), turns by R_0 Jl(phi) dphi about its own origin.
#pragma once

#include <array>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {

/// A vector a lane.
struct LaneVector {
  Lanes x, y, z;
};

/// Axes and origin of a frame in the world.
struct LanePose {
  LaneVector x, y, z, p;
};

/// What a frame's parameters act about, in the world; unit vectors but for whole poses that are
/// turned from their maker's orientation.
struct Axes {
  std::array<LaneVector, 3> turn;   ///< of beta, alpha and theta; of rx, ry and rz
  std::array<LaneVector, 3> shift;  ///< of x, y and z of a whole pose
  LaneVector before, at;            ///< origins of the frame before and of z's foot (after d)
};

/// The world itself.
LanePose lane_world();

/// Goes from one frame to the next: `values` are its parameters, `variable` is added to theta or r.
/// Keeps the axes unless `axes` is null.
void step(const Frame& frame, const Eigen::Ref<const Eigen::VectorXd>& values,
          const Lanes& variable, LanePose& pose, Axes* axes);

/// Columns of Psi of the frame's parameters, the first of which is `first`; `end` is the body's
/// origin.
void fill_columns(const Frame& frame, const Axes& axes, const LaneVector& end, int first,
                  PsiBlock& psi);

}  // namespace selfcal::serial
