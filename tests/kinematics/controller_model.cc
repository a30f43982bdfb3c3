// What a controller can take of a calibration.
#include "kinematics/inverse/controller_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "constraints/sampling/random_poses.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {
namespace {

TEST(ControllerModel, NamesWhatAControllerTakes) {
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

TEST(ControllerModel, GivesBackACalibrationThatAControllerCanHold) {
  const auto nominal = robot_of(kArm);
  Eigen::VectorXd xi = values(*nominal);
  for (const int i : controller_parameters(*nominal)) xi[i] += 1e-3;
  const auto calibrated = robot_of(robot_text(*nominal, xi));
  const Eigen::MatrixXd q = random_poses(*nominal, nullptr, 200, 1);
  const ControllerModel model = controller_model(*nominal, *calibrated, q);
  EXPECT_LT((model.xi - xi).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(controller_error(*nominal, model.xi, *calibrated, q).most, 1e-9);
}

TEST(ControllerModel, TakesMoreOfAnotherCalibrationThanItsParametersAsTheyStand) {
  const auto nominal = robot_of(kArm);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  Eigen::VectorXd xi = values(*nominal);
  for (std::size_t i = 0; i < nominal->parameters().size(); ++i)
    if (nominal->parameters()[i].free) xi[static_cast<Eigen::Index>(i)] += 1e-3 * normal(random);
  const auto calibrated = robot_of(robot_text(*nominal, xi));
  const ControllerModel model =
      controller_model(*nominal, *calibrated, random_poses(*nominal, nullptr, 300, 1));
  const Eigen::MatrixXd other = random_poses(*nominal, nullptr, 300, 2);
  const auto rms = [&](const Eigen::VectorXd& of) {
    return controller_error(*nominal, of, *calibrated, other).rms;
  };
  EXPECT_LT(rms(model.xi), 0.9 * rms(model.as_found));
  EXPECT_LT(rms(model.xi), 0.7 * rms(values(*nominal)));
  // The others are the maker's still.
  const std::vector<int> taken = controller_parameters(*nominal);
  for (int i = 0; i < static_cast<int>(xi.size()); ++i)
    if (std::ranges::count(taken, i) == 0) {
      EXPECT_EQ(model.xi[i], values(*nominal)[i]);
    }
}

}  // namespace
}  // namespace selfcal
