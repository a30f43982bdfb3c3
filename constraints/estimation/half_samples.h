// How far fits of parts of the rows differ, beside what their noise explains: residuals that rows
// near each other share make the posterior of independent rows too sure of itself.
#pragma once

#include <Eigen/Dense>

#include "constraints/estimation/adjustment.h"

namespace selfcal {

/// Half the difference of the parameters that either half of the rows gives alone, a split a row
/// and columns() wide, linearised at `adjusted.fitted`. Each set's rows are taken as kStretches
/// stretches in their order, and every way to make two halves of them is one split. Without noise
/// shared by rows the mean of the squares is the posterior of all rows without the priors' part.
Eigen::MatrixXd half_sample_differences(const Equations& equations, const Adjusted& adjusted);

}  // namespace selfcal
