// The same task by Ceres, as its users write it.
#pragma once

#include <Eigen/Dense>
#include <functional>

#include "tests/bench/arm.h"

namespace selfcal::bench {

enum class Derivatives { automatic, analytic };
enum class Solver { qr, normal_equations };

/// The unknowns of the task, from its start to a relative change of the cost of 1e-10. One thread.
Eigen::VectorXd solve_by_ceres(const Task& task, Derivatives derivatives, Solver solver);

/// Evaluates residual and Jacobian of the first row by automatic derivatives; answers something
/// that needs both. The task outlives it.
std::function<double()> automatic_row(const Task& task);

}  // namespace selfcal::bench
