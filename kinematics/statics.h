// What loads a machine of any structure, chain or with closed loops: weights at points of its
// bodies. By virtual work, with p_k the point of mass m_k and g gravity,
//   work per parameter = sum over k of m_k g . d p_k / d xi
// and a joint's torque is the work per change of its variable, a leg's pull that per its length.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "kinematics/robot.h"

namespace selfcal {

struct PointMass {
  std::string name;
  Body body = Body::last_link;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< in the body's axes (m)
  /// kg; negative where only the sum with others of its name is a mass: a piston at b from the
  /// platform's joint weighs there, less at b and more at 0 along its leg.
  double mass = 0;
};

struct PointMasses {
  Eigen::Vector3d gravity{0, 0, -9.81};  ///< m/s^2, world frame
  std::vector<PointMass> points;         ///< empty where the masses are not known
};

/// m/s^2, world; of a robot that says nothing of it that of the earth, along -z.
Eigen::Vector3d gravity_of(const Robot& robot);

/// Some of the masses are known.
bool weighs(const Robot& robot);

/// Location of a frame in `body` at `at` (in its axes, m), and its derivatives, as Robot::locate.
Closure locate_point(const Robot& robot, const ConfigurationBlock& block, const Eigen::VectorXd& xi,
                     Body body, const Eigen::Vector3d& at, Locations& X, PsiBlock* psi);

/// Virtual work of all weights per parameter (N, N m), lanes x parameters; zero of a robot without
/// masses and where the loops do not close.
Eigen::MatrixXd work_of_weights(const Robot& robot, const ConfigurationBlock& block,
                                const Eigen::VectorXd& xi);

}  // namespace selfcal
