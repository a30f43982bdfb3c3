// Angles at which trigonometric polynomials of the first degree in each of them vanish.
//
// Two equations u(a)^T M_k u(b) = 0, u(t) = (1, cos t, sin t): for each a they are linear in cos b
// and sin b, and what these leave of cos² + sin² = 1 is a trigonometric polynomial of degree four
// in a, whose roots on the unit circle are eigenvalues of a companion matrix. Where a combination
// of both leaves one angle out, that is solved first.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <vector>

namespace selfcal {

/// The one or two roots of c_0 + c_1 cos t + c_2 sin t, in (-pi, pi]; none where there is none, or
/// where all angles are.
std::vector<double> roots_of(const Eigen::Vector3d& c);

/// M of a function that is u(a)^T M u(b).
Eigen::Matrix3d coefficients(const std::function<double(double, double)>& f);

/// All pairs (a, b), each once.
std::vector<Eigen::Vector2d> common_roots(const Eigen::Matrix3d& M_1, const Eigen::Matrix3d& M_2);

}  // namespace selfcal
