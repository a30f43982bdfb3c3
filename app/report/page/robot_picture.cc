// Lines through the frames' origins: the joints' axes pass through them, whatever the links look
// like.
#include "app/report/page/robot_picture.h"

#include <algorithm>

#include "io/files/json_parts.h"

namespace selfcal {
namespace {

RobotLine serial_line(const Statics& statics, const Eigen::VectorXd& q) {
  RobotLine line{"links", {}};
  for (const Eigen::Isometry3d& pose : statics.link_poses(q))
    line.points.emplace_back(pose.translation());
  return line;
}

/// Of a platform: where its passive joints are.
std::vector<RobotLine> platform_lines(const Robot& robot, const Eigen::VectorXd& q) {
  const Eigen::VectorXd xi = values(robot);
  const Location platform = locate(robot, xi, q, Body::last_link);
  RobotLine base{"base", {}}, top{"platform", {}};
  std::vector<RobotLine> lines;
  for (const PassiveJoint& joint : robot.passive_joints()) {
    const Eigen::Vector3d p = locate(robot, xi, q, body_behind(joint.chain, joint.kind)).p;
    if (joint.kind == PassiveKind::universal)
      base.points.push_back(p);
    else
      top.points.emplace_back(platform.p + platform.R * p);
  }
  for (size_t leg = 0; leg < std::min(base.points.size(), top.points.size()); ++leg)
    lines.push_back({"leg " + std::to_string(leg + 1), {base.points[leg], top.points[leg]}});
  for (RobotLine* ring : {&base, &top}) {
    ring->points.push_back(ring->points.front());
    lines.push_back(*ring);
  }
  return lines;
}

/// Of links that reach the tool each by a rod of its own: a linear delta's carriages.
std::vector<RobotLine> rod_lines(const Robot& robot, const Eigen::VectorXd& q) {
  const Eigen::VectorXd xi = values(robot);
  const Eigen::Vector3d effector = locate(robot, xi, q, Body::last_link).p;
  std::vector<RobotLine> lines;
  for (int k = 0; k < static_cast<int>(robot.links().size()); ++k)
    lines.push_back(
        {robot.links()[static_cast<size_t>(k)], {locate(robot, xi, q, link_body(k)).p, effector}});
  lines.push_back({"tool", {effector, locate(robot, xi, q, Body::endpoint).p}});
  return lines;
}

bool closes(const Robot& robot, const Eigen::VectorXd& q) {
  if (!robot.has_loops()) return true;
  Locations X;
  return robot.locate(block_of(q), values(robot), Body::endpoint, X, nullptr).closes();
}

}  // namespace

std::vector<RobotLine> robot_lines(const Robot& robot, const Eigen::VectorXd& q) {
  if (const Statics* statics = robot.statics()) return {serial_line(*statics, q)};
  if (!closes(robot, q)) return {};
  if (!robot.passive_joints().empty()) return platform_lines(robot, q);
  return robot.links().empty() ? std::vector<RobotLine>() : rod_lines(robot, q);
}

nlohmann::ordered_json robot_picture(const Robot& robot, const Eigen::MatrixXd& q, int most) {
  auto rows = nlohmann::ordered_json::array(), poses = nlohmann::ordered_json::array();
  const auto count = static_cast<int>(std::min<Eigen::Index>(q.rows(), most));
  for (int i = 0; i < count; ++i) {
    const Eigen::Index row = i * q.rows() / count;
    const std::vector<RobotLine> lines = robot_lines(robot, q.row(row).transpose());
    if (lines.empty()) continue;
    rows.push_back(row + 1);
    poses.push_back(array_of(lines, [](const RobotLine& line) {
      return nlohmann::ordered_json{{"name", line.name},
                                    {"points", array_of(line.points, [](const Eigen::Vector3d& p) {
                                       return array_of(p, finite);
                                     })}};
    }));
  }
  return {{"rows", rows}, {"poses", poses}};
}

}  // namespace selfcal
