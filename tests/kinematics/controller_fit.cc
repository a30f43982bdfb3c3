// What a controller is told when it holds less than a calibration finds.
#include "kinematics/inverse/controller_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "constraints/sampling/random_poses.h"
#include "io/files/robot_file.h"
#include "tests/kinematics/kind_examples.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

/// A plane arm of two links of 0.5 m and its lengths' errors: 1 mm of the first link, 2 mm of the
/// tool, as a calibration has found them.
constexpr const char* kPlaneArm = R"(robot: plane
kind: serial
frames:
  - {name: j1, joint: revolute, limits: [-1.5, 1.5]}
  - {name: j2, joint: revolute, d: 0.501, limits: [0.5, 2.5], nominal: {d: 0.5}}
  - {name: tool, joint: fixed, d: 0.502, nominal: {d: 0.5}}
)";

std::vector<int> named(const Robot& robot, const std::vector<std::string>& names) {
  std::vector<int> list;
  for (const std::string& name : names) list.push_back(find_parameter(robot, name));
  return list;
}

TEST(ControllerFit, NamesWhatAControllerTakes) {
  const auto robot = robot_of(
      "robot: arm\nkind: serial\nframes:\n"
      "  - {name: base, joint: fixed, r: 0.5}\n"
      "  - {name: j1, joint: revolute, d: 0.3}\n"
      "  - {name: j2, joint: revolute, alpha: 1.5707963267948966, r: 0.4}\n"
      "  - {name: j3, joint: revolute, alpha: 0.3}\n");
  std::vector<std::string> names;
  for (const int i : controller_parameters(*robot)) {
    const Parameter& p = robot->parameters()[static_cast<std::size_t>(i)];
    if (p.part != Part::base) names.push_back(p.frame + "." + p.field);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"j1.d", "j1.theta", "j2.theta", "j2.r", "j3.alpha",
                                             "j3.theta"}));
}

TEST(ControllerFit, LeavesWhatSaysAllOfItAsItStands) {
  const auto robot = robot_of(kPlaneArm);
  const auto numbers = numbers_of_parameters(*robot, named(*robot, {"d1", "d2"}));
  const Eigen::MatrixXd q = random_poses(*robot, nullptr, 200, 1);
  const Eigen::VectorXd told = fit_controller(*robot, numbers, *robot, q);
  EXPECT_LT((told - values(*robot)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT(ends_apart(*robot, told, *robot, q).most, 1e-12);
  EXPECT_GT(ends_apart(*robot, numbers.start, *robot, q).rms, 2e-3);
}

// Link and tool are off along themselves; with the tool's length alone to tell, p* - p is, in the
// axes of the second link, e1 (cos q2, -sin q2) + (e2 - s, 0): the best s is e2 + e1 mean(cos q2),
// and e1 sqrt(1 - mean(cos q2)^2) is left. The tolerance of the tool pulls by nothing here.
TEST(ControllerFit, SharesWhatItCannotTell) {
  const auto robot = robot_of(kPlaneArm);
  const Eigen::MatrixXd q = random_poses(*robot, nullptr, 8000, 1);
  const auto numbers = numbers_of_parameters(*robot, named(*robot, {"d2"}));
  const Eigen::VectorXd told = fit_controller(*robot, numbers, *robot, q);
  const double c = (std::sin(2.5) - std::sin(0.5)) / 2, e = 1e-3;
  // 8000 drawn poses tell a mean to a hundredth.
  EXPECT_NEAR(told[named(*robot, {"d2"})[0]], 0.502 + e * c, 0.02 * e);
  EXPECT_NEAR(ends_apart(*robot, told, *robot, q).rms, e * std::sqrt(1 - c * c), 0.02 * e);
  // No other numbers are better.
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd other = told;
    for (Eigen::Index k = 0; k < numbers.basis.cols(); ++k)
      other += 1e-4 * normal(random) * numbers.basis.col(k);
    EXPECT_GT(ends_apart(*robot, other, *robot, q).rms, ends_apart(*robot, told, *robot, q).rms);
  }
}

TEST(ControllerFit, TakesAnEffectIntoWhatItCan) {
  const std::string text = kPlaneArm;
  const auto geometry = robot_of(text);
  const auto real =
      robot_of(text + "effects: [{effect: transmission_error, at: j2, sin1: 2.0e-3, cos1: 0}]\n");
  std::vector<int> offsets{geometry->variable_parameter(0), geometry->variable_parameter(1)};
  for (const int i : named(*geometry, {"d1", "d2"})) offsets.push_back(i);
  const auto numbers = numbers_of_parameters(*geometry, offsets);
  const Eigen::VectorXd told =
      fit_controller(*geometry, numbers, *real, random_poses(*geometry, nullptr, 1000, 1));
  const Eigen::MatrixXd judged = random_poses(*geometry, nullptr, 500, 3);
  EXPECT_LT(ends_apart(*geometry, told, *real, judged).rms,
            0.5 * ends_apart(*geometry, values(*geometry), *real, judged).rms);
}

TEST(ControllerFit, WorksForLoops) {
  const auto robot = robot_of(kind_examples().at("linear-delta"));
  Eigen::VectorXd xi = values(*robot);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (double& each : xi) each += 1e-4 * normal(random);
  const auto real = robot_of(robot->text().describe(xi));
  std::vector<int> all;
  for (std::size_t i = 0; i < robot->parameters().size(); ++i)
    if (robot->parameters()[i].field != "endstop") all.push_back(static_cast<int>(i));
  const Eigen::MatrixXd q = closing_poses(*real, xi, random_poses(*robot, nullptr, 300, 1));
  const Eigen::MatrixXd fitted = q.topRows(q.rows() / 2), judged = q.bottomRows(q.rows() / 2);
  const Eigen::VectorXd told =
      fit_controller(*real, numbers_of_parameters(*real, all), *real, fitted);
  const double before = ends_apart(*real, nominal_values(*real), *real, judged).rms;
  EXPECT_GT(before, 1e-4);
  EXPECT_LT(ends_apart(*real, told, *real, judged).rms, 0.5 * before);
}

const char* const kArm =
    "robot: arm\nkind: serial\nframes:\n"
    "  - {name: base, joint: fixed, r: 0.1}\n"
    "  - {name: j1, joint: revolute, r: 0.4, limits: [-2.5, 2.5]}\n"
    "  - {name: j2, joint: revolute, alpha: -1.5707963267948966, d: 0.15, limits: [-2, 1]}\n"
    "  - {name: j3, joint: revolute, d: 0.45, limits: [-1, 2]}\n"
    "  - {name: j4, joint: revolute, alpha: -1.5707963267948966, r: 0.45, limits: [-3, 3]}\n"
    "  - {name: j5, joint: revolute, alpha: 1.5707963267948966, limits: [-2, 2]}\n"
    "  - {name: j6, joint: revolute, alpha: -1.5707963267948966, limits: [-3, 3]}\n"
    "  - {name: tool, joint: fixed, r: 0.1, d: 0.05}\n";

TEST(ControllerFit, GivesBackACalibrationThatAControllerCanHold) {
  const auto nominal = robot_of(kArm);
  Eigen::VectorXd xi = values(*nominal);
  const std::vector<int> taken = controller_parameters(*nominal);
  for (const int i : taken) xi[i] += 1e-3;
  const auto calibrated = robot_of(robot_text(*nominal, xi));
  const Eigen::MatrixXd q = random_poses(*nominal, nullptr, 200, 1);
  const Eigen::VectorXd told =
      fit_controller(*nominal, numbers_of_parameters(*nominal, taken), *calibrated, q);
  EXPECT_LT((told - xi).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(ends_apart(*nominal, told, *calibrated, q).most, 1e-9);
}

TEST(ControllerFit, TakesMoreOfAnotherCalibrationThanItsParametersAsTheyStand) {
  const auto nominal = robot_of(kArm);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = values(*nominal);
  for (std::size_t i = 0; i < nominal->parameters().size(); ++i)
    if (nominal->parameters()[i].free) xi[static_cast<Eigen::Index>(i)] += 1e-3 * normal(random);
  const auto calibrated = robot_of(robot_text(*nominal, xi));
  const std::vector<int> taken = controller_parameters(*nominal);
  const ControllerNumbers numbers = numbers_of_parameters(*nominal, taken);
  const Eigen::VectorXd told =
      fit_controller(*nominal, numbers, *calibrated, random_poses(*nominal, nullptr, 300, 1));
  const Eigen::MatrixXd other = random_poses(*nominal, nullptr, 300, 2);
  const auto rms = [&](const Eigen::VectorXd& of) {
    return ends_apart(*nominal, of, *calibrated, other).rms;
  };
  EXPECT_LT(rms(told), 0.9 * rms(as_found(*nominal, numbers, *calibrated)));
  EXPECT_LT(rms(told), 0.7 * rms(values(*nominal)));
  // The others are the maker's still.
  for (int i = 0; i < static_cast<int>(xi.size()); ++i)
    if (std::ranges::count(taken, i) == 0) {
      EXPECT_EQ(told[i], values(*nominal)[i]);
    }
}

// What the tool carries bends the second joint, which only who asks with the load can tell.
TEST(ControllerFit, TakesWhatTheRobotCarries) {
  std::string heavy = kArm;
  for (std::size_t at = 0; (at = heavy.find("]}", at)) != std::string::npos; at += 2)
    heavy.insert(at + 1, ", com: [0, 0, 0], mass: 1");
  const auto nominal = robot_of(heavy);
  const auto real = robot_of(heavy + "effects: [{effect: joint_compliance, at: j2, c: 2.0e-6}]\n");
  const std::vector<int> taken = controller_parameters(*nominal);
  const ControllerNumbers numbers = numbers_of_parameters(*nominal, taken);
  const Eigen::MatrixXd q = random_poses(*nominal, nullptr, 300, 1);
  OperatingPoint at;
  at.mass = 5;
  const Eigen::VectorXd told = fit_controller(*nominal, numbers, *real, q, at);
  const auto rms = [&](const Eigen::VectorXd& of) {
    return ends_apart(*nominal, of, *real, q, at).rms;
  };
  EXPECT_LT(rms(told), 0.7 * rms(values(*nominal)));
  EXPECT_LT(rms(told), 0.7 * rms(fit_controller(*nominal, numbers, *real, q)));
}

}  // namespace
}  // namespace selfcal
