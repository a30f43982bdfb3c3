// A model of MuJoCo's as a robot: the joints on the way from the world to what is measured, those
// that follow, give way or have play, and their places. Included where libmujoco is there.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/models/mujoco.h"

namespace selfcal {

/// What is measured: a site, or a body where there is none of the name.
struct MujocoTool {
  std::string name;
  int site = -1, body = -1;
};

struct MujocoJoint {
  int id = 0, actuator = -1;  ///< actuator: one that holds a position; -1 without
};

/// A joint that an equality ties to one of the robot's: y = y0 + sum of a_k (x - x0)^k.
struct MujocoFollower {
  int id = 0, leader = 0;        ///< leader: its joint
  std::array<double, 5> a = {};  ///< rad or m
};

class MujocoModel {
 public:
  static Result<MujocoModel> load(const std::filesystem::path& file, const std::string& tool);
  /// The model whose text is `text`, with the file's folder for what it names.
  static Result<MujocoModel> load_text(const std::filesystem::path& file, const std::string& text,
                                       const std::string& tool);

  const mjModel& model() const { return *model_; }
  mjData& data() { return *data_; }
  const MujocoTool& tool() const { return tool_; }
  /// Of the robot, from the world to the tool.
  const std::vector<MujocoJoint>& joints() const { return joints_; }
  const std::vector<MujocoFollower>& followers() const { return followers_; }
  const std::vector<int>& springs() const { return springs_; }  ///< joints that give way
  /// Joints that lie where their load puts them.
  const std::vector<int>& plays() const { return plays_; }
  /// Degrees of freedom of the springs, and of the joints that a position actuator drives.
  const std::vector<int>& springy() const { return springy_; }
  const std::vector<int>& driven() const { return driven_; }
  int every_body() const { return model_->nbody - 1; }

  /// At zero readings, springs at their rest.
  JointChain chain();
  /// Where chain() has them.
  std::vector<MujocoBody> bodies() const;
  Eigen::Isometry3d tool_pose() const;  ///< in the world, as the data have it

  /// Joints at their readings and commanded to stay there, springs at their rest.
  void stand(const Eigen::VectorXd& q);
  /// An equality of MuJoCo's is soft; here it holds.
  void follow();
  /// How far the follower goes as its leader does.
  double slope(const MujocoFollower& follower) const;
  double& position(int joint) { return data_->qpos[model_->jnt_qposadr[joint]]; }
  double position(int joint) const { return data_->qpos[model_->jnt_qposadr[joint]]; }
  double zero(int joint) const { return model_->qpos0[model_->jnt_qposadr[joint]]; }

 private:
  struct ModelEnd {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct DataEnd {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  static Result<MujocoModel> load(const std::filesystem::path& file, const mjVFS* files,
                                  const std::string& tool);
  Result<void> find_tool(std::string name);
  Result<void> find_joints();
  /// Names of the sites, or of the bodies that carry no other.
  std::vector<std::string> ends(bool sites) const;
  std::string joint_name(int id) const;
  /// The actuator that brings the joint to what it is told, in proportion to what it is off.
  int position_actuator(int joint) const;
  bool is_driven(int joint) const;
  /// On one axis with the body's first joint, free within a range: what that joint has play by.
  bool is_play(int joint) const;
  /// The last joint of the robot that moves `body`; -1 where none does.
  int carrier_of(int body) const;
  ChainJoint chain_joint(int id) const;
  /// The masses that no joint of the robot parts from what a joint moves, springs at rest.
  void add_masses(JointChain& chain) const;

  std::string file_;
  std::unique_ptr<mjModel, ModelEnd> model_;
  std::unique_ptr<mjData, DataEnd> data_;
  MujocoTool tool_;
  std::vector<MujocoJoint> joints_;
  std::vector<MujocoFollower> followers_;
  std::vector<int> springs_, plays_, springy_, driven_;
};

}  // namespace selfcal
