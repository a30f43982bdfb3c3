// Serial robots drawn at random, as plain numbers beside the robot that is made of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "kinematics/make_robot.h"
#include "kinematics/robot.h"

namespace selfcal {

/// One frame in numbers: alpha d theta r beta (rad, m), or a whole pose.
struct FrameNumbers {
  std::string joint = "fixed";
  std::array<double, 5> v{};
  double gear = 1;
  std::optional<std::array<double, 6>> whole = {};  ///< x y z roll pitch yaw, in place of v
  bool moves() const { return joint != "fixed"; }
};

struct RandomRobot {
  std::vector<FrameNumbers> frames;
  Eigen::MatrixXd coupling;  ///< empty when the file has none
  std::unique_ptr<Robot> robot;

  int joints() const { return static_cast<int>(robot->joints().size()); }
  /// What is added to theta or r of each moving frame.
  Eigen::VectorXd variables(const Eigen::VectorXd& q) const {
    Eigen::VectorXd K(q.size());
    Eigen::Index j = 0;
    for (const FrameNumbers& frame : frames)
      if (frame.moves()) K[j++] = frame.gear;
    const Eigen::VectorXd geared = K.cwiseProduct(q);
    return coupling.size() > 0 ? Eigen::VectorXd(coupling * geared) : geared;
  }
};

inline double uniform(std::mt19937_64& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

inline Node text_node(const std::string& text) { return Node::of(text); }

inline Node rows_node(const Eigen::MatrixXd& M) {
  Node rows = Node::list();
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    rows.items.push_back(Node::of(Eigen::VectorXd(M.row(i).transpose())));
  return rows;
}

/// The robot file that the numbers stand for.
inline Node robot_node(const std::vector<FrameNumbers>& frames, const Eigen::MatrixXd& coupling) {
  static constexpr const char* kFields[] = {"alpha", "d", "theta", "r", "beta"};
  Node list = Node::list();
  for (size_t f = 0; f < frames.size(); ++f) {
    Node frame = Node::map();
    frame.set("name", text_node("f" + std::to_string(f)));
    frame.set("joint", text_node(frames[f].joint));
    if (const auto& whole = frames[f].whole) {
      frame.set("xyz", Node::of(std::vector<double>(whole->begin(), whole->begin() + 3)));
      frame.set("rpy", Node::of(std::vector<double>(whole->begin() + 3, whole->end())));
    }
    for (size_t i = 0; !frames[f].whole && i < 5; ++i)
      frame.set(kFields[i], Node::of(frames[f].v[i]));
    if (frames[f].moves()) frame.set("gear", Node::of(frames[f].gear));
    list.items.push_back(std::move(frame));
  }
  Node node = Node::map();
  node.set("robot", text_node("random")).set("kind", text_node("serial"));
  node.set("frames", std::move(list));
  if (coupling.size() > 0) node.set("coupling", rows_node(coupling));
  return node;
}

inline FrameNumbers random_frame(const std::string& joint, std::mt19937_64& random) {
  FrameNumbers frame;
  frame.joint = joint;
  frame.v = {uniform(random, -3, 3), uniform(random, -0.6, 0.6), uniform(random, -3, 3),
             uniform(random, -0.6, 0.6), uniform(random, -0.8, 0.8)};
  if (frame.moves()) frame.gear = uniform(random, 0.95, 1.05);
  if (frame.moves() || uniform(random, 0, 1) < 0.5) return frame;
  frame.whole.emplace();
  for (size_t i = 0; i < 6; ++i)
    (*frame.whole)[i] = i < 3 ? uniform(random, -0.6, 0.6) : uniform(random, -3, 3);
  return frame;
}

/// 3 to 9 joints, one to three base and tool frames, fixed frames in between, gears near 1; every
/// second fixed frame is a whole pose, every second robot has a coupling matrix.
inline RandomRobot random_robot(std::mt19937_64& random) {
  const auto whole = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  RandomRobot made;
  const int joints = whole(3, 9), base = whole(1, 3), tool = whole(1, 3);
  for (int i = 0; i < base; ++i) made.frames.push_back(random_frame("fixed", random));
  for (int j = 0; j < joints; ++j) {
    if (j > 0 && whole(0, 3) == 0) made.frames.push_back(random_frame("fixed", random));
    made.frames.push_back(random_frame(whole(0, 3) == 0 ? "prismatic" : "revolute", random));
  }
  for (int i = 0; i < tool; ++i) made.frames.push_back(random_frame("fixed", random));
  if (whole(0, 1) == 1) {
    made.coupling = Eigen::MatrixXd::Identity(joints, joints);
    for (double& c : made.coupling.reshaped())  // rows add up to less than 1 / 2: regular
      c += uniform(random, -0.5, 0.5) / joints;
  }
  Problems problems;
  made.robot = make_robot(robot_node(made.frames, made.coupling), problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return made;
}

/// Values of `robot`'s parameters with its whole poses turned by up to half a radian from what the
/// file says: their rotations are about axes that move.
inline Eigen::VectorXd turned_values(const Robot& robot, std::mt19937_64& random) {
  Eigen::VectorXd xi = values(robot);
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    if (robot.parameters()[i].field.starts_with("r") && robot.parameters()[i].field.size() == 2)
      xi[i] += uniform(random, -0.5, 0.5);
  return xi;
}

/// A block of kLanes different readings within half a turn (half a metre for prismatic joints).
inline ConfigurationBlock random_block(const Robot& robot, std::mt19937_64& random) {
  ConfigurationBlock block;
  block.q.resize(kLanes, static_cast<Eigen::Index>(robot.joints().size()));
  for (Eigen::Index j = 0; j < block.q.cols(); ++j) {
    const double most = robot.joints()[j].quantity == Quantity::angle ? 3.1 : 0.5;
    for (int lane = 0; lane < kLanes; ++lane) block.q(lane, j) = uniform(random, -most, most);
  }
  block.count = kLanes;
  return block;
}

}  // namespace selfcal
