// Noise of markers that a camera sees.
#pragma once

#include <Eigen/Dense>
#include <random>

#include "constraints/methods/method.h"

namespace selfcal {

/// Of each coordinate, 1 sigma (m).
inline Eigen::Matrix3Xd marker_noise(Eigen::Index markers, double sigma, Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Matrix3Xd::NullaryExpr(3, markers, [&] { return sigma * normal(random); });
}

}  // namespace selfcal
