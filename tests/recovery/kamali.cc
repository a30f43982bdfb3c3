// The machine: Table II as truth, and beyond it what `Disturbance` says. Springs that stiffen give
// c tau (1 - share |tau| / largest); links give way as link_compliance does, about x and y of their
// frames.
#include "tests/recovery/kamali.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "io/files/robot_file.h"
#include "kinematics/make_robot.h"
#include "tests/recovery/kamali_plan.h"

namespace selfcal::recovery {
namespace {

struct True {
  const char* name;
  double error;  ///< from nominal (mm, degrees, degrees/(N m))
  double unit;
};

/// Table II, elasto-geometric less nominal; the seven dependent ones, which it lacks, are zero.
constexpr True kTableTwo[] = {
    {"w3.d", 1.583, 1e-3},
    {"w4.d", 1.337, 1e-3},
    {"w3.r", 0.444, 1e-3},
    {"w1.alpha", -0.312, kDegree},
    {"w2.beta", 0.494, kDegree},
    {"w2.theta", -0.596, kDegree},
    {"t3.d", 0.193, 1e-3},
    {"t4.d", 0.024, 1e-3},
    {"t3.r", -1.095, 1e-3},
    {"j2.alpha", 0.028, kDegree},
    {"j3.alpha", -0.011, kDegree},
    {"j4.alpha", -0.009, kDegree},
    {"j5.alpha", -0.015, kDegree},
    {"j6.alpha", 0.092, kDegree},
    {"j2.d", 0.971, 1e-3},
    {"j3.d", -1.017, 1e-3},
    {"j4.d", -0.804, 1e-3},
    {"j5.d", 0.122, 1e-3},
    {"j6.d", -0.067, 1e-3},
    {"j2.r", 1.048, 1e-3},
    {"j4.r", -0.649, 1e-3},
    {"j5.r", 0.028, 1e-3},
    {"j2.theta", -0.069, kDegree},
    {"j3.theta", -0.126, kDegree},
    {"j4.theta", -0.014, kDegree},
    {"j5.theta", -0.032, kDegree},
    {"j1.c", 0.00028, kDegree},
    {"j2.c", 0.00023, kDegree},
    {"j3.c", 0.00049, kDegree},
    {"j4.c", 0.01126, kDegree},
    {"j5.c", 0.01297, kDegree},
    {"j6.c", 0.04147, kDegree},
    // dependent
    {"j1.theta", 0, 1},
    {"j6.theta", 0, 1},
    {"j3.r", 0, 1},
    {"j6.r", 0, 1},
    {"t1.alpha", 0, 1},
    {"t2.beta", 0, 1},
    {"t2.theta", 0, 1},
};

void replace(Node& map, std::string_view key, Node value) {
  for (size_t i = 0; i < map.keys.size(); ++i)
    if (map.keys[i] == key) map.items[i] = std::move(value);
}

}  // namespace

Kamali::Kamali(unsigned long long seed) {
  auto loaded =
      load_robot(std::string(SELFCAL_SOURCE_DIR) + "/tests/recovery/irb1600_kamali.robot.yaml");
  if (!loaded) throw std::runtime_error(loaded.error().what);
  robot_ = std::move(*loaded);
  truth_ = nominal_values(*robot_);
  candidates_.assign(robot_->parameters().size(), 0);
  for (const True& each : kTableTwo) {
    const int i = find_parameter(*robot_, each.name);
    EXPECT_GE(i, 0) << each.name;
    truth_[i] += each.error * each.unit;
    candidates_[i] = 1;
  }
  std::mt19937_64 random(seed);
  q_ = poses_in_the_cube(*robot_, random);
  wrench_ = random_wrenches(q_.rows() * kWrenches, random);
}

std::vector<std::string> Kamali::others() const {
  std::vector<std::string> names;
  for (size_t i = 0; i < candidates_.size(); ++i)
    if (!candidates_[i]) names.push_back(robot_->parameters()[i].name);
  return names;
}

std::unique_ptr<Robot> Kamali::machine(const Disturbance& disturbance) const {
  Node node = robot_->text().describe(truth_);
  for (size_t k = 0; k < node.keys.size(); ++k) {
    if (node.keys[k] == "frames")
      for (Node& frame : node.items[k].items)
        if (const Node* mass = frame.find("mass"))
          replace(frame, "mass", Node::of(*parse_number(mass->text) * (1 + disturbance.masses)));
    if (node.keys[k] != "effects") continue;
    for (int j = 1; j <= 6; ++j) {
      const std::string joint = "j" + std::to_string(j);
      const double c = disturbance.links * truth_[find_parameter(*robot_, joint + ".c")];
      Node link = Node::map();
      link.set("effect", Node::of(std::string("link_compliance"))).set("at", Node::of(joint));
      link.set("bend_x", Node::of(c)).set("bend_y", Node::of(c));
      node.items[k].items.push_back(std::move(link));
    }
  }
  Problems problems;
  auto robot = make_robot(node, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  return robot;
}

Eigen::VectorXd Kamali::joint_angles(const Robot& real, Eigen::Index row,
                                     const Disturbance& disturbance,
                                     std::mt19937_64& random) const {
  std::normal_distribution<double> normal;
  Eigen::VectorXd q = q_.row(row / kWrenches).transpose();
  const std::vector<Eigen::Isometry3d> links = real.statics()->link_poses(q);
  const Eigen::Matrix3d R = links.back().linear();
  const Load load{R * wrench_.row(row).head<3>().transpose(),
                  R * wrench_.row(row).tail<3>().transpose()};
  for (int j = 0; j < 6; ++j) {
    const double torque = joint_torque(real.statics()->mechanics(), links, load, j);
    const double c = truth_[find_parameter(*robot_, "j" + std::to_string(j + 1) + ".c")];
    const double largest = j < 3 ? 400 : 30;  // N m, about what the shoulder and the wrist carry
    q[j] += disturbance.repeat * normal(random) +
            disturbance.play / 2 * (normal(random) > 0 ? 1 : -1) -
            disturbance.stiffening * c * torque * std::abs(torque) / largest;
  }
  return q;
}

DataSet Kamali::measure(const Disturbance& disturbance, unsigned long long seed) const {
  const auto real = machine(disturbance);
  DataSet data;
  Problems problems;
  Node set = Node::map();
  set.set("method", Node::of(std::string("position")));
  data.sets.push_back(make_set("tracker", set, problems));
  Observations& rows = data.rows;
  const Eigen::Index n = wrench_.rows();
  rows.q.resize(n, 6);
  rows.position.resize(n, 3);
  rows.wrench = wrench_;
  rows.set.assign(static_cast<size_t>(n), 0);
  rows.group.assign(static_cast<size_t>(n), -1);
  rows.check.assign(static_cast<size_t>(n), 1);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Locations X;
  for (Eigen::Index i = 0; i < n; ++i) {
    rows.q.row(i) = q_.row(i / kWrenches);
    ConfigurationBlock block = block_of(joint_angles(*real, i, disturbance, random));
    block.conditions.wrench = wrench_.row(i);
    real->locate(block, values(*real), Body::endpoint, X, nullptr);
    for (int c = 0; c < 3; ++c) {
      rows.position(i, c) = X.p(0)[c] + disturbance.tracker * normal(random);
      rows.wrench(i, c) += disturbance.force * normal(random);
      rows.wrench(i, 3 + c) += disturbance.moment * normal(random);
    }
  }
  return data;
}

}  // namespace selfcal::recovery
