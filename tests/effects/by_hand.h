// Robots so simple that each effect's numbers can be worked by hand.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kinematics/corrected_robot.h"
#include "kinematics/rotation.h"
#include "tests/kinematics/parsed_robot.h"

namespace selfcal {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A horizontal arm of 1 m along x, turning about y (positive: down), 10 kg at its end. At q = 0
/// the tool's axes are x along the arm, y down, z along the world's y.
inline const char* const kPendulum =
    "robot: pendulum\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute, alpha: -1.5707963267948966}\n"
    "  - {name: tool, joint: fixed, d: 1, mass: 10}\n";

/// A vertical axis at the world's origin with a tip 1 m out along x: at q = 0 every frame has the
/// world's axes.
inline const char* const kTurntable =
    "robot: turntable\nkind: serial\nframes:\n"
    "  - {name: j1, joint: revolute}\n"
    "  - {name: tool, joint: fixed, d: 1}\n";

/// What held when the one row was taken.
struct Held {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(1);
  Eigen::VectorXd velocity = {}, wrench = {};  ///< empty: not known
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);
  double temperature = kUnknown, time = kUnknown;
  int set = -1;
};

inline Eigen::VectorXd numbers(std::initializer_list<double> list) {
  return Eigen::Map<const Eigen::VectorXd>(list.begin(), static_cast<Eigen::Index>(list.size()));
}

/// How far the tip is from where the geometry alone puts it, world axes (m; rotation vector).
struct Moved {
  Eigen::Vector3d p, turn;
};

/// The robot of a file's text with the effects of `entries` ("[{...}]").
inline Moved moved(const std::string& robot, const std::string& entries, const Held& held,
                   const MeasurementContext& context = {}) {
  const auto geometry = std::shared_ptr<const Robot>(robot_of(robot));
  Problems problems;
  const Node list = parsed("effects: " + entries);
  const auto corrected = correct(geometry, list.items[0].items, context, problems);
  for (const std::string& problem : problems.list) ADD_FAILURE() << problem;
  if (!corrected) return {};
  ConfigurationBlock block = block_of(held.q);
  MeasurementConditions& at = block.conditions;
  if (held.velocity.size() > 0) at.velocity = held.velocity.transpose();
  if (held.wrench.size() > 0) at.wrench = held.wrench.transpose();
  at.normal = held.normal.transpose();
  at.temperature = numbers({held.temperature});
  at.time = numbers({held.time});
  at.set = {held.set};
  Locations X, Y;
  geometry->locate(block, values(*geometry), Body::endpoint, X, nullptr);
  corrected->locate(block, values(*corrected), Body::endpoint, Y, nullptr);
  return {Y.p(0) - X.p(0), log_rotation(Y.R(0) * X.R(0).transpose())};
}

/// Sizes below are 1e-4 of a metre or radian: what is of second order in them is 1e-8.
inline constexpr double kSecondOrder = 2e-8;

inline void expect_near(const Eigen::Vector3d& v, double x, double y, double z,
                        double tolerance = kSecondOrder) {
  EXPECT_NEAR(v.x(), x, tolerance);
  EXPECT_NEAR(v.y(), y, tolerance);
  EXPECT_NEAR(v.z(), z, tolerance);
}

}  // namespace selfcal
