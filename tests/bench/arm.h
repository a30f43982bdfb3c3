// A serial arm as a user would write it: one configuration at a time, for automatic derivatives or
// with its own. What the contenders compute, on the same robot, rows and unknowns as selfcal.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"

namespace selfcal::bench {

/// Index of FRAME.FIELD among the robot's parameters.
int parameter_of(const Robot& robot, const std::string& frame, const std::string& field);

/// One frame of Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta + K q) Trans(z, r), by indices
/// into the values.
struct ArmFrame {
  int beta, alpha, d, theta, r;
  int joint, K;  ///< revolute; -1 of a fixed one
};

struct Arm {
  std::vector<ArmFrame> frames;
  explicit Arm(const Robot& robot);
};

/// Position of the endpoint (m, world); `xi` answers an index with a value.
template <class T, class Values>
Eigen::Matrix<T, 3, 1> endpoint_of(const Arm& arm, const Values& xi, const double* q) {
  using std::cos;
  using std::sin;
  Eigen::Matrix<T, 3, 3> R = Eigen::Matrix<T, 3, 3>::Identity();
  Eigen::Matrix<T, 3, 1> p = Eigen::Matrix<T, 3, 1>::Zero();
  const auto turn = [&](int a, int b, const T& angle) {  // column a towards column b
    const T c = cos(angle), s = sin(angle);
    const Eigen::Matrix<T, 3, 1> x = R.col(a), y = R.col(b);
    R.col(a) = c * x + s * y;
    R.col(b) = c * y - s * x;
  };
  for (const ArmFrame& each : arm.frames) {
    turn(2, 0, xi(each.beta));
    turn(1, 2, xi(each.alpha));
    p += xi(each.d) * R.col(0);
    turn(0, 1,
         each.joint < 0 ? T(xi(each.theta)) : T(xi(each.theta) + xi(each.K) * T(q[each.joint])));
    p += xi(each.r) * R.col(2);
  }
  return p;
}

/// The same with its derivatives to every value, 3 x values: of an angle axis x (p - origin), of a
/// length its axis.
Eigen::Vector3d endpoint_and_jacobian(const Arm& arm, const Eigen::VectorXd& xi, const double* q,
                                      Eigen::Matrix3Xd& J);

/// What every contender starts from and is given.
struct Task {
  DataSet data;               ///< positions by an instrument whose frame is the world
  std::vector<int> unknowns;  ///< parameters that the rows tell
  Eigen::VectorXd xi;         ///< where it starts: the maker's figures
  Eigen::VectorXd truth;
};

/// The example RX-90, 1 mm and 1 mrad off, at `rows` random configurations measured to 20 um.
const Task& task_of(int rows);
const Robot& example_robot();

inline constexpr double kMeasured = 2e-5;  ///< m, 1 sigma of a coordinate

/// As many as Task::unknowns has.
inline constexpr int kUnknowns = 33;

}  // namespace selfcal::bench
