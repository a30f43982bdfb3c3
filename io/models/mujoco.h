// Models that MuJoCo loads (MJCF, or a URDF by its reader): the chain to a tool, and where the
// model itself puts that tool at given readings, gravity, springs and contacts included.
//
// mujoco_engine.cc is built where libmujoco is found; mujoco_missing.cc, which refuses, where not.
//
// Of the joints between the world and the tool those are the robot's that an actuator drives or no
// spring holds; the others, springs that nothing drives, give way. A limited one without spring and
// actuator on one axis with the first of its body is that one's play: it lies where its load puts
// it, at an end of its range.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/result.h"
#include "kinematics/chains/joint_chain.h"

namespace selfcal {

/// One body on the way from the world to the tool.
struct MujocoBody {
  int place = 0;  ///< in the order in which the model's file has its bodies, from 0
  std::string name;
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();  ///< with all joints at zero
  /// The body as its file has it, its joints at their `ref`, seen from where X_WB has it.
  Eigen::Isometry3d X_BF = Eigen::Isometry3d::Identity();
  std::vector<int> joints = {};  ///< of the chain, that it has
};

struct MujocoChain {
  JointChain chain;                ///< W is the model's world, T the tool; springs at their rest
  std::vector<MujocoBody> bodies;  ///< that carry T, from the world on
  int every_body = 0;              ///< that the model has
  std::string tool;                ///< the site or body that T is, as found
  bool tool_is_site = false;
  std::vector<std::string> notices;  ///< what a person should know
};

/// The chain from the world to `tool`, a site or a body; empty: the model's only site or, without
/// sites, its only body that carries no other. Refuses what MuJoCo refuses, a tool that is not
/// there or not one, ball and free joints on the chain, joints that follow others by an equality,
/// and a chain without a joint of the robot.
Result<MujocoChain> read_mujoco(const std::filesystem::path& file, const std::string& tool);

/// One configuration at which the model is asked.
struct MujocoLoad {
  Eigen::VectorXd q;                                 ///< readings, by joint of the chain (rad or m)
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, on the tool, in its axes
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< N m, the same
};

struct MujocoPoses {
  std::vector<std::optional<Location>> tool;  ///< in the world; nothing where it came to no rest
  int driven = 0;                             ///< joints that a position actuator holds
  double sag = 0;                             ///< m, rms: how far off it is where these are told
                                              ///< the readings and give way under the load
  int touching = 0;                           ///< configurations with contacts
};

/// Where the tool stands at rest. The joints stand at their readings, as the encoders of a robot
/// say where its joints are, whatever drives them. Joints that follow these by an equality follow
/// exactly. Springs of the chain settle to the balance of all forces, by
/// Newton's method on the inverse dynamics at no acceleration; what is off the chain stays where
/// the model has it. With a `text`, that is the model in place of the file's, beside which the
/// files that it names lie.
Result<MujocoPoses> settled_poses(const std::filesystem::path& file, const std::string& tool,
                                  const std::vector<MujocoLoad>& loads,
                                  const std::string& text = {});

}  // namespace selfcal
