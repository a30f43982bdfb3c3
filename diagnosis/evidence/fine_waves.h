// Waves a turn that are too many to be asked for one by one: a scan of what a model leaves.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace selfcal {

/// Waves a turn, whole numbers above those asked one by one, by which an error of one joint would
/// explain more than chance makes of what is left: of the periodogram
///   |sum of by_i left_i exp(i k q_i)|^2 / (mean of left^2 sum of by^2 / 2),
/// which is chi-square of two freedoms where noise is all (Lomb 1976), the highest that
/// all waves together show in one of a hundred joints, each without those before it. `q`: the
/// joint's reading, by equation (rad); `by`: what an error of it moves the equation, `left` what is
/// left of it, both over its noise.
std::vector<double> fine_waves(const Eigen::VectorXd& q, const Eigen::VectorXd& by,
                               const Eigen::VectorXd& left);

}  // namespace selfcal
