// A unit vector as an unknown: two freedoms along a fixed pair of tangents, never singular.
#pragma once

#include <Eigen/Dense>

#include "constraints/methods/method.h"

namespace selfcal {

/// Two unit vectors normal to `n` and to each other, columns of the result; a function of n alone.
Eigen::Matrix<double, 3, 2> tangents(const Eigen::Vector3d& n);

/// n moved along its tangents by `step` (two entries) and made a unit vector again.
Eigen::Vector3d tilted(const Eigen::Vector3d& n, const Eigen::Vector2d& step);

/// Normal of the plane through points that leaves the least squares of distances.
Eigen::Vector3d best_normal(const std::vector<Location>& X);

Eigen::Vector3d random_direction(Random& random);

}  // namespace selfcal
