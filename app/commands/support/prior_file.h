// What an earlier result knows of a robot's parameters.
#pragma once

#include <Eigen/Dense>
#include <filesystem>

#include "io/result.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Covariance of all parameters of `robot`: that of result.json for those that it has, the makers'
/// tolerances for the other free ones, zero for what is not free. Refuses a file that is no result
/// of a robot with such parameters.
Result<Eigen::MatrixXd> read_prior(const std::filesystem::path& path, const Robot& robot);

}  // namespace selfcal
