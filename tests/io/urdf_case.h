// A URDF through the program's own way (read, frames, text, robot) against urdfdom's poses
// multiplied joint by joint.
#pragma once

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <functional>
#include <map>
#include <random>
#include <string>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/urdf.h"
#include "kinematics/rotation.h"

namespace selfcal {

/// How far two poses differ: m and rad.
struct PoseGap {
  double length = 0, angle = 0;
  void add(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    length = std::max(length, (a.translation() - b.translation()).norm());
    angle = std::max(angle, log_rotation(a.linear().transpose() * b.linear()).norm());
  }
};

/// Positions of all joints by name; a joint that mimics follows its leader.
using UrdfPositions = std::map<std::string, double>;

inline double urdf_position(const urdf::ModelInterface& model, const urdf::Joint& joint,
                            const UrdfPositions& q) {
  if (joint.mimic)
    return joint.mimic->offset +
           joint.mimic->multiplier *
               urdf_position(model, *model.getJoint(joint.mimic->joint_name), q);
  const auto found = q.find(joint.name);
  return found == q.end() ? 0 : found->second;
}

/// Pose of a link in the root.
inline Eigen::Isometry3d urdf_pose(const urdf::ModelInterface& model, const std::string& name,
                                   const UrdfPositions& q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (auto link = model.getLink(name); link && link->parent_joint; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    const urdf::Pose& origin = joint.parent_to_joint_origin_transform;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translate(Eigen::Vector3d(origin.position.x, origin.position.y, origin.position.z));
    T.rotate(Eigen::Quaterniond(origin.rotation.w, origin.rotation.x, origin.rotation.y,
                                origin.rotation.z));
    const Eigen::Vector3d axis =
        Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).normalized();
    const double position = urdf_position(model, joint, q);
    if (joint.type == urdf::Joint::PRISMATIC)
      T.translate(position * axis);
    else if (joint.type != urdf::Joint::FIXED)
      T.rotate(Eigen::AngleAxisd(position, axis));
    X = T * X;
  }
  return X;
}

inline Eigen::Isometry3d pose_of(const Location& location) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = location.R;
  X.translation() = location.p;
  return X;
}

/// The robot file that the URDF's chain comes to.
inline std::string robot_file_of(const UrdfChain& chain, FixedJoints fixed = FixedJoints::merged) {
  return write_yaml(serial::write(frames_of(chain.chain, fixed)));
}

/// Largest difference at `poses` random positions (up to 2 rad or m), the tip in the base, of the
/// robots with the fixed joints merged and kept.
inline PoseGap gap_of_urdf(const std::string& text, const UrdfEnds& ends, int poses,
                           std::mt19937_64& random) {
  PoseGap gap;
  const auto chain = read_urdf(text, "robot.urdf", ends);
  EXPECT_TRUE(chain) << (chain ? "" : chain.error().what);
  if (!chain) return gap;
  const auto merged = robot_of(robot_file_of(*chain), "merged.yaml");
  const auto kept = robot_of(robot_file_of(*chain, FixedJoints::kept), "kept.yaml");
  EXPECT_TRUE(merged) << (merged ? "" : merged.error().what);
  EXPECT_TRUE(kept) << (kept ? "" : kept.error().what);
  if (!merged || !kept) return gap;
  const auto model = urdf::parseURDF(text);
  std::uniform_real_distribution<double> uniform(-2, 2);
  const auto n = static_cast<Eigen::Index>((*merged)->joints().size());
  for (int i = 0; i < poses; ++i) {
    UrdfPositions q;
    Eigen::VectorXd readings = Eigen::VectorXd::Zero(n);
    Eigen::Index j = 0;
    for (const UrdfStep& step : chain->steps) {
      if (!step.moves) continue;
      if (!model->getJoint(step.joint)->mimic) q[step.joint] = readings[j] = uniform(random);
      ++j;
    }
    const Eigen::Isometry3d theirs =
        urdf_pose(*model, chain->ends.base, q).inverse() * urdf_pose(*model, chain->ends.tip, q);
    for (const Robot* robot : {merged->get(), kept->get()})
      gap.add(theirs, pose_of(locate(*robot, values(*robot), readings)));
  }
  return gap;
}

}  // namespace selfcal
