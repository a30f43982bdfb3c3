// Closed forms of the inverse kinematics against the robots' own forward kinematics.
#include "kinematics/inverse/exact_inverse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "constraints/sampling/random_poses.h"
#include "io/files/robot_file.h"
#include "kinematics/inverse/trigonometric_roots.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

std::shared_ptr<const Robot> example_of(const std::string& name) {
  auto robot = load_robot(SELFCAL_SOURCE_DIR "/app/examples/" + name + ".robot.yaml");
  EXPECT_TRUE(robot) << robot.error().what;
  return std::move(*robot);
}

double far_apart(const Location& a, const Location& b) {
  return std::max((a.p - b.p).norm(), log_rotation(a.R * b.R.transpose()).norm());
}

/// At poses of random readings: every solution gets there, the readings are among them, no two are
/// the same. Returns the most that one pose had.
std::size_t expect_all_solutions(const std::shared_ptr<const Robot>& robot, int poses) {
  const Eigen::VectorXd xi = values(*robot);
  const ExactInverse inverse = exact_inverse(robot, xi);
  EXPECT_TRUE(inverse) << robot->name();
  if (!inverse) return 0;
  std::size_t most = 0;
  const Eigen::MatrixXd list = closing_poses(*robot, xi, random_poses(*robot, nullptr, poses, 5));
  for (Eigen::Index i = 0; i < list.rows(); ++i) {
    const Eigen::VectorXd q = list.row(i).transpose();
    const Location wanted = locate(*robot, xi, q);
    const std::vector<Eigen::VectorXd> found = inverse(wanted, q);
    double nearest = HUGE_VAL;
    for (std::size_t a = 0; a < found.size(); ++a) {
      EXPECT_LT(far_apart(locate(*robot, xi, found[a]), wanted), 1e-6);
      nearest = std::min(nearest, (found[a] - q).cwiseAbs().maxCoeff());
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_GT((found[a] - found[b]).cwiseAbs().maxCoeff(), 1e-6);
    }
    // Near a singular place readings follow from the pose to half of the digits.
    EXPECT_LT(nearest, 1e-6) << robot->name() << " at " << q.transpose();
    most = std::max(most, found.size());
  }
  return most;
}

TEST(ExactInverse, FindsAllEightPosturesOfAnArmWithASphericalWrist) {
  EXPECT_EQ(expect_all_solutions(example_of("rx90"), 500), 8U);
  EXPECT_EQ(expect_all_solutions(example_of("irb1600"), 500), 8U);
}

/// A light arm: axes 2, 3 and 4 parallel, no three of the last ones meet. The maker's figures of a
/// UR5 (standard DH: d1 0.089159, a2 -0.425, a3 -0.39225, d4 0.10915, d5 0.09465, d6 0.0823).
const char* const kLightArm =
    "robot: light arm\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute, r: 0.089159, limits: [-6.2, 6.2]}\n"
    "  - {name: j2, joint: revolute, alpha: 1.5707963267948966, limits: [-3.1, 3.1]}\n"
    "  - {name: j3, joint: revolute, d: -0.425, limits: [-3.1, 3.1]}\n"
    "  - {name: j4, joint: revolute, d: -0.39225, r: 0.10915, limits: [-3.1, 3.1]}\n"
    "  - {name: j5, joint: revolute, alpha: 1.5707963267948966, r: 0.09465, limits: [-3.1, 3.1]}\n"
    "  - {name: j6, joint: revolute, alpha: -1.5707963267948966, r: 0.0823, limits: [-6.2, 6.2]}\n"
    "  - {name: tool, joint: fixed, d: 0.02, r: 0.1, theta: 0.3}\n";

TEST(ExactInverse, FindsAllPosturesOfAnOffsetWrist) {
  EXPECT_EQ(expect_all_solutions(robot_of(kLightArm), 500), 8U);
}

TEST(ExactInverse, TakesAnOffsetAtEveryJointBeforeASphericalWrist) {
  // No two axes of the arm are parallel or meet: four arms for a wrist centre at most, two wrists.
  const std::size_t most = expect_all_solutions(
      robot_of("robot: crooked arm\nkind: serial\nframes:\n"
               "  - {name: j1, joint: revolute, r: 0.4, limits: [-3, 3]}\n"
               "  - {name: j2, joint: revolute, d: 0.15, alpha: -1.4, r: 0.1, limits: [-3, 3]}\n"
               "  - {name: j3, joint: revolute, d: 0.5, alpha: 0.3, r: 0.05, limits: [-3, 3]}\n"
               "  - {name: j4, joint: revolute, d: 0.1, alpha: 1.6, r: 0.45, limits: [-3, 3]}\n"
               "  - {name: j5, joint: revolute, alpha: -1.2, limits: [-3, 3]}\n"
               "  - {name: j6, joint: revolute, alpha: 1.3, limits: [-3, 3]}\n"
               "  - {name: tool, joint: fixed, d: 0.03, r: 0.12, theta: 0.4}\n"),
      500);
  EXPECT_GE(most, 4U);
  EXPECT_LE(most, 8U);
}

TEST(ExactInverse, ReadsThePoseOfParallelRobotsOffTheirChains) {
  for (const char* kind : {"linear-delta", "gough-stewart", "hexaslide"})
    EXPECT_EQ(expect_all_solutions(robot_of(kind_examples().at(kind)), 100), 1U);
}

TEST(ExactInverse, FindsNothingOutOfReachAndKeepsWhatMayStandAnywhere) {
  const auto robot = example_of("rx90");
  const ExactInverse inverse = exact_inverse(robot, values(*robot));
  const Eigen::VectorXd q = (Eigen::VectorXd(6) << 0.3, -0.5, 0.9, 0.7, 0, 0.4).finished();
  Location far = locate(*robot, values(*robot), q);
  far.p += Eigen::Vector3d(10, 0, 0);
  EXPECT_TRUE(inverse(far, q).empty());
  // The wrist is stretched: joints 4 and 6 turn about one axis, and joint 4 stays.
  const std::vector<Eigen::VectorXd> found = inverse(locate(*robot, values(*robot), q), q);
  const bool same = std::ranges::any_of(
      found, [&](const Eigen::VectorXd& each) { return (each - q).cwiseAbs().maxCoeff() < 1e-6; });
  EXPECT_TRUE(same);
}

TEST(ExactInverse, IsNotThereForOtherMachines) {
  EXPECT_FALSE(exact_inverse(robot_of(kind_examples().at("serial")),
                             values(*robot_of(kind_examples().at("serial")))));
  // A calibrated arm has no spherical wrist any more.
  const auto robot = example_of("rx90");
  Eigen::VectorXd xi = values(*robot);
  xi[find_parameter(*robot, "j5.d")] += 1e-3;
  EXPECT_FALSE(exact_inverse(robot, xi));
}

TEST(TrigonometricRoots, AreThoseOfEquationsMadeToHaveThem) {
  // (cos a - cos 0.7)(…): f = cos(a - b) - cos(0.3), g = sin(a + b) - sin(1.1) vanish at a = 0.7,
  // b = 0.4 among others.
  const auto f = [](double a, double b) { return std::cos(a - b) - std::cos(0.3); };
  const auto g = [](double a, double b) { return std::sin(a + b) - std::sin(1.1); };
  const auto pairs = common_roots(coefficients(f), coefficients(g));
  // a - b = ±0.3, a + b = 1.1 or pi - 1.1, each modulo 2 pi: eight pairs.
  EXPECT_EQ(pairs.size(), 8U);
  for (const Eigen::Vector2d& each : pairs) {
    EXPECT_NEAR(f(each[0], each[1]), 0, 1e-9);
    EXPECT_NEAR(g(each[0], each[1]), 0, 1e-9);
  }
  EXPECT_TRUE(roots_of(Eigen::Vector3d(2, 1, 1)).empty());
  EXPECT_EQ(roots_of(Eigen::Vector3d(1, 1, 0)).size(), 1U);
}

}  // namespace
}  // namespace selfcal
