#include "kinematics/chains/corrected_chain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/rotation.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using serial::Frame;

/// The robot as its maker says it is.
serial::Model as_made(serial::Model model) {
  for (Frame& frame : model.frames) {
    frame.value = frame.nominal;
    frame.rpy = frame.rpy_nominal;
  }
  return model;
}

/// Poses of the base, of each frame and of the tool's end; joints at `variables`.
struct Placement {
  Isometry3d base = Isometry3d::Identity();
  std::vector<Isometry3d> joints;
  std::vector<FixedJoint> fixed;             ///< every frame that does not move
  Isometry3d tool = Isometry3d::Identity();  ///< in the last joint's frame
};

Placement place(const serial::Model& model, const Eigen::VectorXd& variables) {
  Placement at;
  Isometry3d X = Isometry3d::Identity();
  for (const Frame& frame : model.frames) {
    const bool moves = frame.motion != serial::Motion::fixed;
    const auto joint = static_cast<Eigen::Index>(at.joints.size());
    if (moves && joint == 0) at.base = X;
    X = X * serial::pose_in_parent(frame, moves ? variables[joint] : 0);
    if (moves)
      at.joints.push_back(X);
    else
      at.fixed.push_back({frame.name, at.joints.size(), X});
  }
  at.tool = at.joints.back().inverse() * X;
  return at;
}

double difference(const Isometry3d& a, const Isometry3d& b) {
  return std::max((a.translation() - b.translation()).norm(),
                  log_rotation(a.linear().transpose() * b.linear()).norm());
}

std::string size_of(const Isometry3d& X) {
  return format_number(std::round(X.translation().norm() * 1e6) / 1e3) + " mm, " +
         format_number(std::round(log_rotation(X.linear()).norm() * 1e6) / 1e3) + " mrad";
}

/// The joint in the frame whose z is its axis, up to a turn about it and a shift along it; what is
/// left between the two in `off`.
Isometry3d on_axis(const Isometry3d& F, const ChainJoint& joint, const Isometry3d& X_WJ,
                   double& off) {
  Isometry3d G = F.inverse() * X_WJ;
  const Vector3d axis = G.linear() * joint.axis;
  off = std::acos(std::clamp(axis.z(), -1.0, 1.0));
  G.linear() = turn_onto(axis, Vector3d::UnitZ()) * G.linear();
  if (joint.motion == serial::Motion::revolute) {
    off = std::max(off, G.translation().head<2>().norm());
    G.translation().head<2>().setZero();
  }
  return G;
}

/// The robot's world in the chain's, and the joints on the robot's frames.
struct Match {
  Isometry3d X_WR = Isometry3d::Identity();
  std::vector<Isometry3d> G;
  double off = 0;  ///< m or rad, of the joint that fits least
  size_t worst = 0;
};

Match match(const JointChain& chain, const Placement& made, const Isometry3d& X_WR) {
  Match found{X_WR, {}, 0, 0};
  for (size_t j = 0; j < chain.joints.size(); ++j) {
    double off = 0;
    found.G.push_back(
        on_axis(made.joints[j], chain.joints[j], X_WR.inverse() * chain.joints[j].X_WJ, off));
    if (off > found.off) found.worst = j;
    found.off = std::max(found.off, off);
  }
  return found;
}

std::string unlike(const JointChain& chain, const serial::Model& robot) {
  const std::vector<int> moving = serial::moving_frames(robot);
  if (moving.size() != chain.joints.size())
    return "the robot has " + std::to_string(moving.size()) + " joints, the chain " +
           std::to_string(chain.joints.size());
  for (size_t j = 0; j < moving.size(); ++j)
    if (robot.frames[moving[j]].motion != chain.joints[j].motion)
      return "joint " + robot.frames[moving[j]].name + " turns in one and slides in the other";
  const Eigen::MatrixXd coupling = coupling_of(chain).matrix;
  const Eigen::MatrixXd own =
      robot.coupling.size() > 0
          ? robot.coupling
          : Eigen::MatrixXd(Eigen::MatrixXd::Identity(coupling.rows(), coupling.cols()));
  if ((own - coupling).cwiseAbs().maxCoeff() > 1e-9)
    return "the robot's coupling is not what mimics in the chain";
  return {};
}

/// The fixed joints of the chain, each carried along by the joint before it, or where the robot's
/// own frame of that name stands.
void correct_fixed(const JointChain& original, const Placement& made, const Placement& now,
                   const Isometry3d& X_WR, CorrectedChain& corrected) {
  for (FixedJoint& joint : corrected.chain.fixed) {
    const Isometry3d X_WF = joint.X_WF;
    const size_t j = joint.behind;
    joint.X_WF =
        j == 0 ? corrected.base * X_WF
               : corrected.chain.joints[j - 1].X_WJ * original.joints[j - 1].X_WJ.inverse() * X_WF;
    for (size_t f = 0; f < made.fixed.size(); ++f)
      if (made.fixed[f].name == joint.name && made.fixed[f].behind == j)
        joint.X_WF =
            X_WR * now.fixed[f].X_WF * made.fixed[f].X_WF.inverse() * X_WR.inverse() * X_WF;
  }
}

}  // namespace

CorrectedChain corrected_chain(const JointChain& original, const serial::Model& robot) {
  CorrectedChain corrected{original, Isometry3d::Identity(), {}, unlike(original, robot)};
  if (!corrected.problem.empty()) return corrected;
  const Eigen::VectorXd variables = -coupling_of(original).offset;
  const Placement made = place(as_made(robot), variables);
  Placement now = place(robot, variables);
  Isometry3d half = Isometry3d::Identity();
  half.rotate(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()));
  Match found = match(original, made, Isometry3d::Identity());
  if (found.off > kSameAxis) found = match(original, made, half);
  if (found.off > kSameAxis) {
    found = match(original, made, axis_frame(original.joints.front()) * made.joints[0].inverse());
    const Isometry3d back = made.base * now.base.inverse();
    if (found.off < kSameAxis)
      corrected.left_out.push_back("the base, which is another than the chain's: " +
                                   size_of(made.base.inverse() * now.base));
    for (Isometry3d& X : now.joints) X = back * X;
    for (size_t f = 0; f < now.fixed.size(); ++f)
      now.fixed[f].X_WF = now.fixed[f].behind == 0 ? made.fixed[f].X_WF : back * now.fixed[f].X_WF;
    now.base = made.base;
  }
  if (found.off > kSameAxis) {
    corrected.problem = "the robot's nominal figures are not those of the chain: the axis of " +
                        original.joints[found.worst].name + " is off by " +
                        format_number(found.off) + " m or rad";
    return corrected;
  }
  for (size_t j = 0; j < original.joints.size(); ++j)
    corrected.chain.joints[j].X_WJ = found.X_WR * now.joints[j] * found.G[j];
  corrected.base = found.X_WR * now.base * made.base.inverse() * found.X_WR.inverse();
  const Isometry3d X_WN = found.X_WR * now.joints.back();
  const Isometry3d end = made.joints.back().inverse() * found.X_WR.inverse() * original.X_WT;
  const bool same_tool = difference(made.tool, end) < kSameAxis;
  if (!same_tool && difference(made.tool, now.tool) > 0)
    corrected.left_out.push_back("the tool, which is another than the chain's end: " +
                                 size_of(made.tool.inverse() * now.tool));
  for (size_t f = 0; !same_tool && f < now.fixed.size(); ++f)
    if (now.fixed[f].behind == original.joints.size())
      now.fixed[f].X_WF = now.joints.back() * made.joints.back().inverse() * made.fixed[f].X_WF;
  corrected.chain.X_WT = X_WN * (same_tool ? now.tool : end);
  correct_fixed(original, made, now, found.X_WR, corrected);
  return corrected;
}

}  // namespace selfcal
