// What the simulated robot really is: the nominal one with errors, and compliance that no model
// has.
#pragma once

#include <Eigen/Dense>
#include <optional>

#include "kinematics/robot.h"
#include "kinematics/robots/serial.h"
#include "sim/scenario.h"

namespace selfcal {

/// The nominal robot's parameters with drawn and given errors. A name that no parameter has is a
/// problem.
Eigen::VectorXd true_parameters(const Scenario& scenario, const Robot& robot, Problems& problems);

/// Joints that give way under gravity: variable = coupling diag(K) reading + c tau.
struct Compliance {
  serial::Model model;  ///< with the true parameters
  Eigen::VectorXd c;    ///< rad/(N m) or m/N, by joint
};

/// Nothing when the scenario asks for none; a robot without joints of these names, that is not
/// serial or has no masses is a problem.
std::optional<Compliance> true_compliance(const Scenario& scenario, const Robot& robot,
                                          const Eigen::VectorXd& xi, Problems& problems);

/// What the encoders read while the joints stand where readings `q` of a stiff robot would be.
Eigen::VectorXd reading_of(const Compliance& compliance, const Eigen::VectorXd& q);

}  // namespace selfcal
