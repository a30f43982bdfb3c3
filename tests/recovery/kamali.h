// The experiment of Kamali et al. ("Elasto-geometrical calibration of an industrial robot under
// multidirectional external loads using a laser tracker"): 125 poses in a cube of 500 mm under
// seven wrenches each, on a machine whose truth is the elasto-geometric column of their Table II.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal::recovery {

/// What the machine and its measurement have beyond the model. All zero: nothing.
struct Disturbance {
  double tracker = 0;     ///< m, 1 sigma of one coordinate
  double force = 0;       ///< N, 1 sigma of one component of the wrench as it is recorded
  double moment = 0;      ///< N m, the same
  double repeat = 0;      ///< rad, 1 sigma of a joint's repeatability
  double play = 0;        ///< rad, of every joint; the side that it was approached from is random
  double stiffening = 0;  ///< share by which a spring gives less at its largest torque than at none
  double links = 0;       ///< compliance across a joint's axis, as a share of that about it
  double masses = 0;      ///< share by which every mass is off
};

class Kamali {
 public:
  /// `seed` draws the poses and the wrenches.
  explicit Kamali(unsigned long long seed = 1600);

  const Robot& robot() const { return *robot_; }
  /// True values of every parameter.
  const Eigen::VectorXd& truth() const { return truth_; }
  /// Marks of the 39 parameters of the paper.
  const std::vector<char>& candidates() const { return candidates_; }
  /// Names of all others.
  std::vector<std::string> others() const;

  /// The 875 rows, all of them `check`.
  DataSet measure(const Disturbance& disturbance, unsigned long long seed) const;

 private:
  std::unique_ptr<Robot> machine(const Disturbance& disturbance) const;
  /// Where the joints of row `row` really stand, as far as the real robot's model does not know.
  Eigen::VectorXd joint_angles(const Robot& real, Eigen::Index row, const Disturbance& disturbance,
                               std::mt19937_64& random) const;

  std::unique_ptr<Robot> robot_;
  Eigen::VectorXd truth_;
  std::vector<char> candidates_;
  Eigen::MatrixXd q_;       ///< 125 x 6
  Eigen::MatrixXd wrench_;  ///< 875 x 6
};

}  // namespace selfcal::recovery
