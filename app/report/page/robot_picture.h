// A robot as lines in space, at some of the configurations of a data set.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

/// Lines of the robot (m, world) at readings `q`: of a serial robot its frames in order, of a
/// platform its legs and both rings; empty where the kind does not say where its links are. With
/// the file's own values.
struct RobotLine {
  std::string name;
  std::vector<Eigen::Vector3d> points;
};
std::vector<RobotLine> robot_lines(const Robot& robot, const Eigen::VectorXd& q);

/// {"rows": [1, …], "poses": [[{"name", "points"}, …], …]} at up to `most` rows of `q` (rows x
/// joints), evenly chosen; rows from 1.
nlohmann::ordered_json robot_picture(const Robot& robot, const Eigen::MatrixXd& q, int most);

}  // namespace selfcal
