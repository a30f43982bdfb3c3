#include "io/models/ur_kinematics.h"

#include "io/files/yaml.h"
#include "kinematics/rotation.h"

namespace selfcal {
namespace {

constexpr const char* kUrJoints[] = {"shoulder", "upper_arm", "forearm",
                                     "wrist_1",  "wrist_2",   "wrist_3"};

Eigen::Isometry3d read_ur_pose(Fields& joints, const char* name, Problems& problems) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const Node* node = joints.node(name);
  if (!node) {
    joints.fail(name, "x, y, z, roll, pitch and yaw");
    return X;
  }
  Fields fields(*node, name, problems);
  for (int i = 0; i < 3; ++i) X.translation()[i] = fields.number(std::string(1, "xyz"[i]));
  const Eigen::Vector3d rpy(fields.number("roll"), fields.number("pitch"), fields.number("yaw"));
  X.linear() = rpy_rotation(rpy);
  fields.refuse_unknown();
  return X;
}

}  // namespace

Result<UrKinematics> read_ur_kinematics(const std::string& text, const std::string& file) {
  const Result<Node> node = parse_yaml(text, file);
  if (!node) return tl::unexpected(node.error());
  Problems problems;
  Fields whole(*node, "file", problems);
  const Node* kinematics = whole.node("kinematics");
  if (!kinematics) {
    whole.fail("kinematics", "the joints of a Universal Robots arm");
    return bad_input(problems);
  }
  UrKinematics read;
  read.chain.name = "ur";
  Fields joints(*kinematics, "kinematics", problems);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (const char* name : kUrJoints) {
    X = X * read_ur_pose(joints, name, problems);
    ChainJoint joint;
    joint.name = name;
    joint.X_WJ = X;
    read.chain.joints.push_back(joint);
  }
  read.chain.X_WT = X;
  read.hash = joints.text("hash");
  joints.refuse_unknown();
  if (problems.any()) return bad_input(problems);
  return read;
}

std::string ur_kinematics_text(const JointChain& chain, const std::string& hash) {
  Node joints = Node::map();
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  for (const ChainJoint& joint : chain.joints) {
    const Eigen::Isometry3d X = before.inverse() * joint.X_WJ;
    const Eigen::Vector3d p = X.translation(), rpy = rpy_of(X.linear());
    Node pose = Node::map();
    pose.set("x", Node::of(p.x())).set("y", Node::of(p.y())).set("z", Node::of(p.z()));
    pose.set("roll", Node::of(rpy[0])).set("pitch", Node::of(rpy[1])).set("yaw", Node::of(rpy[2]));
    joints.set(joint.name, std::move(pose));
    before = joint.X_WJ;
  }
  joints.set("hash", Node::of(hash));
  return write_yaml(Node::map().set("kinematics", std::move(joints)));
}

}  // namespace selfcal
