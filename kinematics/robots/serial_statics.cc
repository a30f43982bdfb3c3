// Where the links of a serial robot are and what gravity does to them.
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
    T = T * pose_in_parent(frame, add);
    poses.push_back(T);
  }
  return poses;
}

Mechanics mechanics(const Model& file) {
  const Model model = with_usual_masses(file);
  Mechanics mechanics{model.gravity, {}};
  mechanics.payload = file.payload;
  for (size_t i = 0; i < model.frames.size(); ++i)
    mechanics.masses_assumed |= model.frames[i].mass && !file.frames[i].mass;
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

}  // namespace selfcal::serial
