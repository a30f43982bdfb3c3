// Where the simulated surfaces, balls and instruments really are.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "constraints/methods/data_set.h"
#include "kinematics/robot.h"
#include "sim/scenario.h"

namespace selfcal {

/// The scenario's sets with their methods, references resolved. Options that a method or the
/// simulation refuses are problems.
std::vector<Set> make_sets(const Scenario& scenario, Problems& problems);

/// True own values of every set, as its options, its scenario and chance have them. `xi` is the
/// true robot, which random surfaces are put within the reach of.
std::vector<Eigen::VectorXd> true_own_values(const Scenario& scenario, const std::vector<Set>& sets,
                                             const Robot& robot, const Eigen::VectorXd& xi,
                                             Problems& problems);

/// The touched plane of a set, n as its residual has it; nothing for other methods.
std::optional<Plane> true_plane(const std::vector<Set>& sets, std::size_t set,
                                const std::vector<Eigen::VectorXd>& nuisance);

/// Its normal turned to the side from which it is touched.
std::optional<Eigen::Vector3d> outward_normal(const Scenario& scenario,
                                              const std::vector<Set>& sets, std::size_t set,
                                              const std::vector<Eigen::VectorXd>& nuisance);

}  // namespace selfcal
