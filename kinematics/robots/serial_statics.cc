// Where the links of a serial robot are and what gravity does to them: what a person checks a robot
// file by.
#include <cstdio>

#include "kinematics/robots/serial.h"

namespace selfcal::serial {

std::vector<Eigen::Isometry3d> frame_poses(const Model& model, const Eigen::VectorXd& q) {
  const std::vector<int> moving = moving_frames(model);
  Eigen::VectorXd variable(q.size());
  for (Eigen::Index j = 0; j < q.size(); ++j) variable[j] = model.frames[moving[j]].gear * q[j];
  if (model.coupling.size() > 0) variable = model.coupling * variable;
  std::vector<Eigen::Isometry3d> poses;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  int joint = 0;
  for (const Frame& frame : model.frames) {
    const double add = frame.motion == Motion::fixed ? 0 : variable[joint++];
    const double theta = frame.value[kTheta] + (frame.motion == Motion::revolute ? add : 0);
    const double r = frame.value[kR] + (frame.motion == Motion::prismatic ? add : 0);
    T.rotate(Eigen::AngleAxisd(frame.value[kBeta], Eigen::Vector3d::UnitY()));
    T.rotate(Eigen::AngleAxisd(frame.value[kAlpha], Eigen::Vector3d::UnitX()));
    T.translate(Eigen::Vector3d(frame.value[kD], 0, 0));
    T.rotate(Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()));
    T.translate(Eigen::Vector3d(0, 0, r));
    poses.push_back(T);
  }
  return poses;
}

Mechanics mechanics(const Model& model) {
  Mechanics mechanics{model.gravity, {}};
  int joint = 0;
  for (const Frame& frame : model.frames) {
    const bool moves = frame.motion != Motion::fixed;
    mechanics.links.push_back({frame.name, moves ? joint++ : -1, frame.motion == Motion::revolute,
                               frame.mass, frame.com});
  }
  return mechanics;
}

Eigen::VectorXd gravity_torques(const Model& model, const Eigen::VectorXd& q) {
  const Mechanics links = mechanics(model);
  const std::vector<Eigen::Isometry3d> poses = frame_poses(model, q);
  Eigen::VectorXd torques(q.size());
  for (Eigen::Index j = 0; j < q.size(); ++j)
    torques[j] = joint_torque(links, poses, {}, static_cast<int>(j));
  return torques;
}

std::vector<std::string> remarks(const Model& model) {
  const std::vector<int> moving = moving_frames(model);
  Eigen::VectorXd middle(static_cast<Eigen::Index>(moving.size()));
  for (size_t j = 0; j < moving.size(); ++j)
    middle[j] = (model.frames[moving[j]].lower + model.frames[moving[j]].upper) / 2;
  const Eigen::Isometry3d first = frame_poses(model, middle)[moving.front()];
  const Eigen::Vector3d g = first.linear().transpose() * model.gravity;
  char text[160];
  std::snprintf(text, sizeof text, "gravity in %s's frame: %.3f %.3f %.3f m/s^2",
                model.frames[moving.front()].name.c_str(), g.x(), g.y(), g.z());
  std::vector<std::string> lines{text};
  if (!mechanics(model).masses_known()) {
    lines.push_back("no masses given: static torques are unknown");
    return lines;
  }
  const Eigen::VectorXd torques = gravity_torques(model, middle);
  lines.push_back("static torques with every joint in the middle of its limits:");
  for (size_t j = 0; j < moving.size(); ++j) {
    const Frame& frame = model.frames[moving[j]];
    std::snprintf(text, sizeof text, "  %s %.2f %s", frame.name.c_str(), torques[j],
                  frame.motion == Motion::revolute ? "N m" : "N");
    lines.push_back(text);
  }
  return lines;
}

}  // namespace selfcal::serial
