// Gravity on a serial robot: what a person checks a robot file by.
//   torque_j = z_j . sum over carried masses of (c - O_j) x m g   (revolute)
//   force_j  = z_j . sum over carried masses of m g               (prismatic)
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

Eigen::VectorXd gravity_torques(const Model& model, const Eigen::VectorXd& q) {
  const std::vector<Eigen::Isometry3d> poses = frame_poses(model, q);
  const std::vector<int> moving = moving_frames(model);
  Eigen::VectorXd torques = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(moving.size()));
  for (size_t j = 0; j < moving.size(); ++j) {
    const Eigen::Vector3d z = poses[moving[j]].linear().col(2);
    const Eigen::Vector3d O = poses[moving[j]].translation();
    for (size_t f = moving[j]; f < model.frames.size(); ++f) {
      const Eigen::Vector3d weight = model.frames[f].mass.value_or(0) * model.gravity;
      const bool turns = model.frames[moving[j]].motion == Motion::revolute;
      torques[j] +=
          turns ? z.dot((poses[f] * model.frames[f].com - O).cross(weight)) : z.dot(weight);
    }
  }
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
  double mass = 0;
  for (const Frame& frame : model.frames) mass += frame.mass.value_or(0);
  if (mass == 0) {
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
