// The frames of a chain one after another, for a block of configurations at once: where the last
// one is put and what its parameters do to it (11.3, 11.10 to 11.15).
//
// For a rotation parameter about axis a through O the column is [a x L; a], L from O to the body;
// for a translation along a it is [a; 0]. beta turns about y of the frame before; alpha and d act
// along x after that turn (the chapter has x before it, equal at its nominal beta of zero); theta
// and r along z of the frame itself. x y z of a whole pose act along the axes of the frame before;
// its rotation R_0 exp(phi), phi = (rx ry rz), turns by R_0 Jl(phi) dphi about its own origin.
#pragma once

#include <span>
#include <vector>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {

/// The first frames of a chain: parameters of frame f from first[f] on, behind the last those of
/// the gears; joint variables are coupling diag(K) readings.
struct Chain {
  std::span<const Frame> frames;
  const std::vector<int>& first;
  const Eigen::MatrixXd& coupling;
};

/// Puts the last frame in the world with parameters `xi`. Unless `psi` is null, which has its size,
/// writes the columns of the frames' parameters.
void follow(const Chain& chain, const ConfigurationBlock& block, const Eigen::VectorXd& xi,
            Locations& X, PsiBlock* psi);

}  // namespace selfcal::serial
