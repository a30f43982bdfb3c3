// Structure of no known cause at one joint: how its errors may depend on what it reads, on its load
// and on the warmth. Errors of two equations share
//   J(1) J(2) k(q1, q2),
// J (of mean square 1 over all equations) what the joint's reading, its giving way to its load, or
// its reading times the warmth moves an equation; an equation of two rows has one of each.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/equations/resolution.h"
#include "diagnosis/evidence/kernel_domain.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Readings `q` (rows x joints) as angles: of a joint that slides, half a turn for all that it
/// moves in these rows.
Eigen::MatrixXd comparable_readings(const Robot& robot, Eigen::MatrixXd q);

/// What errors of the joints do to the equations, and what they may depend on.
struct JointErrors {
  ReadingErrors readings;
  Eigen::MatrixXd alike;  ///< rows x joints, rad: comparable_readings
  /// Equations x joints: what giving way to its load moves, to any scale; a joint of which nothing
  /// tells has zeros. Empty: of none.
  Eigen::MatrixXd by_load = {};
  /// Of equations of two rows: the former of them, by equation (-1 of none), and what of
  /// `readings.by_joint` is its share; empty: there are none.
  std::vector<int> before = {};
  Eigen::MatrixXd by_before = {};
};

/// A covariance by its root.
struct JointKernel {
  KernelDomain domain = KernelDomain::turned;
  int joint = 0;
  Eigen::MatrixXd root;  ///< equations x directions: F of F F'
};

/// Of every joint that moves an equation: `turned`, `kinked`, `load` where the load is told,
/// `warmth` where it changes; the last two without what is the same at each reading, which is a
/// spring or a zero that goes with the temperature.
std::vector<JointKernel> joint_kernels(const Observations& data, const DenseEquations& rows,
                                       const JointErrors& joints);

/// Root of the mean over all pairs a, b of joints of (1 + bell_a) (1 + bell_b) / 4, bell_a that of
/// the difference of reading a: functions of one reading and of two, all of them smooth.
/// `readings`: rows x joints, rad.
Eigen::MatrixXd smooth_in_two_readings(const Eigen::MatrixXd& readings);

/// Root of exp(-|q1 - q2| / length), linear between knots: a function of one reading with steps and
/// kinks (Ornstein and Uhlenbeck).
Eigen::MatrixXd kinked_in_reading(const Eigen::VectorXd& reading);

/// Root of a smooth function of one reading that is the same a turn later:
///   exp((cos(q1 - q2) - 1) / length^2) = exp(-z) (I_0(z) + 2 sum over n of I_n(z) cos n(q1 - q2)),
/// z = 1 / length^2 (Abramowitz and Stegun, 9.6.34). The first column is its constant part.
Eigen::MatrixXd periodic_in_reading(const Eigen::VectorXd& reading);

}  // namespace selfcal
