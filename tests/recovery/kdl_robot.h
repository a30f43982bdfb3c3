// A robot whose forward kinematics and joint Jacobian are KDL's: truths that share no formula with
// ours.
#pragma once

#ifdef SELFCAL_HAVE_KDL
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include <map>
#include <string>

#include "kinematics/robot.h"

namespace selfcal::recovery {

/// Takes names and limits from `model`; parameters are alpha d theta r beta of each frame, or x y z
/// rx ry rz of a whole pose, then K, and the frames' motions are read off the joints' names and
/// quantities. Psi is zero: only joint_jacobian is used.
class KdlRobot final : public Robot {
 public:
  explicit KdlRobot(const Robot& model) : model_(model) {
    const Node written = model.text().describe(nominal_values(model));
    for (const Node& frame : written.find("frames")->items)
      if (const Node* rpy = frame.find("rpy"))
        turned_[frame.find("name")->text] =
            KDL::Rotation::RPY(*parse_number(rpy->items[0].text), *parse_number(rpy->items[1].text),
                               *parse_number(rpy->items[2].text));
  }
  std::string_view kind() const override { return "kdl"; }
  const std::string& name() const override { return model_.name(); }
  const std::vector<Joint>& joints() const override { return model_.joints(); }
  const std::vector<Parameter>& parameters() const override { return model_.parameters(); }
  const std::vector<int>& preference() const override { return model_.preference(); }
  const RobotText& text() const override { return model_.text(); }
  const Statics* statics() const override { return model_.statics(); }
  int variable_parameter(int j) const override { return model_.variable_parameter(j); }

  Closure locate(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                 Locations& X, PsiBlock* psi) const override {
    const KDL::Chain chain = make_chain(xi, body);
    KDL::ChainFkSolverPos_recursive forward(chain);
    X.resize(block.lanes());
    for (int lane = 0; lane < block.lanes(); ++lane) {
      KDL::Frame pose;
      forward.JntToCart(readings(block.q, lane), pose);
      for (int i = 0; i < 3; ++i) {
        X.position(lane, i) = pose.p(i);
        for (int j = 0; j < 3; ++j) X.rotation(lane, 3 * j + i) = pose.M(i, j);
      }
    }
    if (psi) psi->setZero(6 * block.lanes(), xi.size());
    return {};
  }

  void joint_jacobian(const ConfigurationBlock& block, const Eigen::VectorXd& xi, Body body,
                      const PsiBlock&, Eigen::MatrixXd& J) const override {
    const KDL::Chain chain = make_chain(xi, body);
    KDL::ChainJntToJacSolver solver(chain);
    J.setZero(6 * block.lanes(), static_cast<Eigen::Index>(joints().size()));
    for (int lane = 0; lane < block.lanes(); ++lane) {
      KDL::Jacobian jacobian(static_cast<unsigned>(joints().size()));
      solver.JntToJac(readings(block.q, lane), jacobian);
      for (int c = 0; c < 6; ++c) J.row(c * block.lanes() + lane) = jacobian.data.row(c);
    }
  }

 private:
  KDL::JntArray readings(const Eigen::ArrayXXd& q, int lane) const {
    KDL::JntArray array(static_cast<unsigned>(q.cols()));
    array.data = q.row(lane).matrix().transpose();
    return array;
  }

  /// A whole pose: what its maker says, turned by rx ry rz.
  KDL::Frame whole_pose(const std::string& frame, const Eigen::VectorXd& v) const {
    const KDL::Vector turn(v[3], v[4], v[5]);
    return {turned_.at(frame) * KDL::Rotation::Rot(turn, turn.Norm()),
            KDL::Vector(v[0], v[1], v[2])};
  }

  KDL::Chain make_chain(const Eigen::VectorXd& xi, Body body) const {
    KDL::Chain chain;
    const auto end = static_cast<Eigen::Index>(parameters().size() - joints().size());
    size_t joint = 0;
    for (Eigen::Index first = 0, fields = 0; first < end; first += fields) {
      const Parameter& one = parameters()[static_cast<size_t>(first)];
      fields = one.of_whole_pose ? 6 : 5;
      const Eigen::VectorXd v = xi.segment(first, fields);  // alpha d theta r beta
      if (one.of_whole_pose) {
        chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), whole_pose(one.frame, v)));
        continue;
      }
      KDL::Frame before(KDL::Rotation::RotY(v[4]) * KDL::Rotation::RotX(v[0]));
      before = before * KDL::Frame(KDL::Vector(v[1], 0, 0));
      chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), before));
      const KDL::Frame after = KDL::Frame(KDL::Rotation::RotZ(v[2]), KDL::Vector(0, 0, v[3]));
      const bool moves = joint < joints().size() && one.frame == joints()[joint].name;
      KDL::Joint motion(KDL::Joint::None);
      if (moves)
        motion = KDL::Joint(joints()[joint].quantity == Quantity::angle ? KDL::Joint::RotZ
                                                                        : KDL::Joint::TransZ);
      chain.addSegment(KDL::Segment(motion, after));
      joint += moves;
      if (body == Body::last_link && moves && joint == joints().size()) break;
      if (body == Body::first_link && moves) break;
    }
    return chain;
  }

  const Robot& model_;
  std::map<std::string, KDL::Rotation> turned_;  ///< by whole pose, as its maker says
};

}  // namespace selfcal::recovery
#endif
