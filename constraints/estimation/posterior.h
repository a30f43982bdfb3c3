// How sure the fitted unknowns are, what was taken as given being in doubt as well.
#pragma once

#include <Eigen/Dense>

#include "constraints/estimation/adjustment.h"

namespace selfcal {

/// Covariance of columns() at `adjusted.fitted`: of the free unknowns, and of the robot's
/// parameters that are fixed within their tolerances (considered parameters: each is as far off as
/// the rows say, and in no more doubt beside that than they leave it), with known lengths, planes,
/// normals and centres in doubt beside them (given_doubt.h). The rows' errors have
/// `structure` times the squares of their noise, and say the less against what was given. `R` is
/// whitened, with the columns beside the unknowns. With `considered` false what was given is exact.
/// A length held for the scale is as free as the maker's tolerances leave the scale.
Eigen::MatrixXd posterior(const Equations& equations, const Adjusted& adjusted,
                          const Eigen::MatrixXd& R, bool considered = true, double structure = 1);

}  // namespace selfcal
