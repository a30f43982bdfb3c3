// What the scatter of touches takes off the size of a robot that a given length carries.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/fitting/fit.h"

namespace selfcal {

/// The common relative change of the free link lengths in `step` (a column each), weighed as the
/// maker knows them.
double growth(const Robot& robot, const std::vector<char>& free, const Eigen::VectorXd& step);

/// Touches leave less of a smaller robot: `fitted`, whose scale is free, at the size that the given
/// lengths and the priors say. The same where no length is given, or where an instrument reads
/// lengths, too.
Fit without_shrinkage(const Equations& equations, const Prior& prior, Fit fitted);

}  // namespace selfcal
