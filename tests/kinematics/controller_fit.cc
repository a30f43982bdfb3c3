// What a controller is told when it holds less than a calibration finds.
#include "kinematics/inverse/controller_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "constraints/sampling/random_poses.h"
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

TEST(ControllerFit, LeavesWhatSaysAllOfItAsItStands) {
  const auto robot = robot_of(kPlaneArm);
  const auto numbers = numbers_of_parameters(*robot, named(*robot, {"d1", "d2"}));
  const ControllerFit fit =
      fit_controller(*robot, numbers, *robot, random_poses(*robot, nullptr, 200, 1));
  EXPECT_EQ((fit.xi - values(*robot)).cwiseAbs().maxCoeff(), 0);
  EXPECT_LT(fit.after.most, 1e-12);
  EXPECT_GT(fit.before.rms, 2e-3);
}

// Link and tool are off along themselves; with the tool's length alone to tell, p* - p is, in the
// axes of the second link, e1 (cos q2, -sin q2) + (e2 - s, 0): the best s is e2 + e1 mean(cos q2),
// and e1 sqrt(1 - mean(cos q2)^2) is left. The tolerance of the tool pulls by nothing here.
TEST(ControllerFit, SharesWhatItCannotTell) {
  const auto robot = robot_of(kPlaneArm);
  const Eigen::MatrixXd q = random_poses(*robot, nullptr, 20000, 1);
  const auto numbers = numbers_of_parameters(*robot, named(*robot, {"d2"}));
  const ControllerFit fit = fit_controller(*robot, numbers, *robot, q);
  const double c = (std::sin(2.5) - std::sin(0.5)) / 2, e = 1e-3;
  // 20 000 drawn poses tell a mean to a hundredth.
  EXPECT_NEAR(fit.xi[named(*robot, {"d2"})[0]], 0.502 + e * c, 0.02 * e);
  EXPECT_NEAR(fit.after.rms, e * std::sqrt(1 - c * c), 0.02 * e);
  // No other numbers are better.
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd other = fit.xi;
    for (Eigen::Index k = 0; k < numbers.basis.cols(); ++k)
      other += 1e-4 * normal(random) * numbers.basis.col(k);
    const Eigen::MatrixXd fitted = q(Eigen::seq(0, q.rows() - 1, Eigen::fix<2>), Eigen::all);
    EXPECT_GT(ends_apart(*robot, other, *robot, values(*robot), fitted).rms,
              ends_apart(*robot, fit.xi, *robot, values(*robot), fitted).rms);
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
  const ControllerFit fit =
      fit_controller(*geometry, numbers, *real, random_poses(*geometry, nullptr, 2000, 1));
  const EndsApart as_they_stand = ends_apart(*geometry, values(*geometry), *real, values(*real),
                                             random_poses(*geometry, nullptr, 500, 3));
  EXPECT_LT(fit.after.rms, 0.5 * as_they_stand.rms);
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
  const ControllerFit fit = fit_controller(*real, numbers_of_parameters(*real, all), *real, q);
  EXPECT_GT(fit.before.rms, 1e-4);
  EXPECT_LT(fit.after.rms, 0.5 * fit.before.rms);
}

}  // namespace
}  // namespace selfcal
