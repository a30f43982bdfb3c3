// Where serial robots put their bodies: against KDL's chains and against numbers worked by hand.
#include <gtest/gtest.h>

#include <numbers>

#include "kinematics/make_robot.h"
#include "kinematics/robots/serial.h"
#include "tests/kinematics/random_robot.h"

#ifdef SELFCAL_HAVE_KDL
#include <kdl/chainfksolverpos_recursive.hpp>
#endif

namespace selfcal {
namespace {

constexpr double kLocationRounding = 1e-12;  // 20 frames, metres and radians: a few hundred epsilon

#ifdef SELFCAL_HAVE_KDL
/// A whole pose turned further by the parameters rx ry rz, in KDL's words.
KDL::Frame whole_pose(const std::array<double, 6>& v, const KDL::Vector& turn) {
  const KDL::Rotation R = KDL::Rotation::RPY(v[3], v[4], v[5]);
  return {turn.Norm() > 0 ? R * KDL::Rotation::Rot(turn, turn.Norm()) : R,
          KDL::Vector(v[0], v[1], v[2])};
}

/// Two segments a frame: what stands before the joint, then the joint with theta and r. Of a whole
/// pose the second is nothing.
KDL::Chain chain_of(const RandomRobot& made, const Eigen::VectorXd& xi) {
  KDL::Chain chain;
  for (size_t f = 0; f < made.frames.size(); ++f) {
    const FrameNumbers& frame = made.frames[f];
    if (frame.whole) {
      const int at = find_parameter(*made.robot, "f" + std::to_string(f) + ".rx");
      chain.addSegment(
          KDL::Segment(KDL::Joint(KDL::Joint::None),
                       whole_pose(*frame.whole, KDL::Vector(xi[at], xi[at + 1], xi[at + 2]))));
      chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None)));
      continue;
    }
    const auto& [alpha, d, theta, r, beta] = frame.v;
    const KDL::Frame before = KDL::Frame(KDL::Rotation::RotY(beta)) *
                              KDL::Frame(KDL::Rotation::RotX(alpha)) *
                              KDL::Frame(KDL::Vector(d, 0, 0));
    const KDL::Frame after(KDL::Rotation::RotZ(theta), KDL::Vector(0, 0, r));
    const KDL::Joint joint(frame.joint == "revolute"    ? KDL::Joint::RotZ
                           : frame.joint == "prismatic" ? KDL::Joint::TransZ
                                                        : KDL::Joint::None);
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), before));
    chain.addSegment(KDL::Segment(joint, after));
  }
  return chain;
}

int last_moving_frame(const RandomRobot& made) {
  int last = 0;
  for (size_t f = 0; f < made.frames.size(); ++f)
    if (made.frames[f].moves()) last = static_cast<int>(f);
  return last;
}

void expect_equal(const Locations& X, int lane, const KDL::Frame& frame) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(X.p(lane)[i], frame.p(i), kLocationRounding);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(X.R(lane)(i, k), frame.M(i, k), kLocationRounding);
  }
}

TEST(SerialLocation, AgreesWithKdlForRandomRobots) {
  std::mt19937_64 random(21);
  for (int i = 0; i < 50; ++i) {
    const RandomRobot made = random_robot(random);
    const ConfigurationBlock block = random_block(*made.robot, random);
    const Eigen::VectorXd xi = turned_values(*made.robot, random);
    const KDL::Chain chain = chain_of(made, xi);
    KDL::ChainFkSolverPos_recursive solver(chain);
    Locations end, link;
    made.robot->locate(block, xi, Body::endpoint, end, nullptr);
    made.robot->locate(block, xi, Body::last_link, link, nullptr);
    KDL::JntArray joints(static_cast<unsigned>(made.joints()));
    for (int lane = 0; lane < kLanes; ++lane) {
      joints.data = made.variables(block.q.row(lane).matrix().transpose());
      KDL::Frame frame;
      ASSERT_GE(solver.JntToCart(joints, frame), 0);
      expect_equal(end, lane, frame);
      ASSERT_GE(solver.JntToCart(joints, frame, 2 * (last_moving_frame(made) + 1)), 0);
      expect_equal(link, lane, frame);
    }
  }
}
#endif

TEST(SerialLocation, AgreesWithThePosesThatStaticsUses) {
  std::mt19937_64 random(22);
  const RandomRobot made = random_robot(random);
  const ConfigurationBlock block = random_block(*made.robot, random);
  Problems problems;
  const serial::Model model = serial::read(robot_node(made.frames, made.coupling), problems);
  Locations X;
  made.robot->locate(block, values(*made.robot), Body::endpoint, X, nullptr);
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto poses = serial::frame_poses(model, block.q.row(lane).matrix().transpose());
    EXPECT_LT((poses.back().linear() - X.R(lane)).norm(), kLocationRounding);
    EXPECT_LT((poses.back().translation() - X.p(lane)).norm(), kLocationRounding);
  }
}

/// Two parallel vertical axes, links of 0.4 m and 0.3 m, base 0.5 m high.
RandomRobot planar_arm() {
  RandomRobot arm;
  arm.frames = {
      {"fixed", {0, 0, 0, 0.5, 0}}, {"revolute"}, {"revolute", {0, 0.4}}, {"fixed", {0, 0.3}}};
  Problems problems;
  arm.robot = make_robot(robot_node(arm.frames, {}), problems);
  return arm;
}

TEST(SerialLocation, OfATwoJointArmIsTheOneWorkedByHand) {
  const RandomRobot arm = planar_arm();
  ASSERT_NE(arm.robot, nullptr);
  ConfigurationBlock block;
  block.q.setZero(kLanes, 2);
  block.count = 3;
  block.q.row(1) << std::numbers::pi / 6, std::numbers::pi / 2;
  block.q.row(2) << std::numbers::pi / 2, -std::numbers::pi / 2;
  Locations X;
  PsiBlock psi;
  arm.robot->locate(block, values(*arm.robot), Body::endpoint, X, &psi);
  // q = 0: stretched along x. 30 and 90 degrees: 0.4 (cos 30, sin 30) + 0.3 (cos 120, sin 120).
  EXPECT_LT((X.p(0) - Eigen::Vector3d(0.7, 0, 0.5)).norm(), kLocationRounding);
  const double root3 = std::sqrt(3.0);
  EXPECT_LT((X.p(1) - Eigen::Vector3d(0.2 * root3 - 0.15, 0.2 + 0.15 * root3, 0.5)).norm(),
            kLocationRounding);
  EXPECT_LT((X.p(2) - Eigen::Vector3d(0.3, 0.4, 0.5)).norm(), kLocationRounding);
  EXPECT_LT((X.R(2) - Eigen::Matrix3d::Identity()).norm(), kLocationRounding);
  // Stretched out: theta1 swings 0.7 m, theta2 0.3 m along y; both turn about z.
  const auto column = [&](const char* name) {
    const Eigen::VectorXd whole = psi.col(find_parameter(*arm.robot, name));
    return Eigen::VectorXd(whole(Eigen::seqN(0, 6, static_cast<int>(kLanes))));
  };
  EXPECT_TRUE(column("theta1").isApprox((Eigen::VectorXd(6) << 0, 0.7, 0, 0, 0, 1).finished()));
  EXPECT_TRUE(column("theta2").isApprox((Eigen::VectorXd(6) << 0, 0.3, 0, 0, 0, 1).finished()));
  EXPECT_TRUE(column("d2").isApprox((Eigen::VectorXd(6) << 1, 0, 0, 0, 0, 0).finished()));
  EXPECT_TRUE(column("alpha3").isApprox((Eigen::VectorXd(6) << 0, 0, 0, 1, 0, 0).finished()));
  EXPECT_TRUE(column("K1").isZero(0));  // at a reading of zero
}

TEST(SerialLocation, TurnsByGearTimesReading) {
  RandomRobot arm = planar_arm();
  Eigen::VectorXd xi = values(*arm.robot);
  xi[find_parameter(*arm.robot, "K2")] = 0.5;
  ConfigurationBlock block;
  block.q.setZero(kLanes, 2);
  block.q.col(1).setConstant(std::numbers::pi);
  block.count = 1;
  Locations X;
  arm.robot->locate(block, xi, Body::endpoint, X, nullptr);
  EXPECT_LT((X.p(0) - Eigen::Vector3d(0.4, 0.3, 0.5)).norm(), kLocationRounding);
}

}  // namespace
}  // namespace selfcal
