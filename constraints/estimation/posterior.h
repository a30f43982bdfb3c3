// How sure the fitted unknowns are, what was taken as given being in doubt as well.
#pragma once

#include <Eigen/Dense>

#include "constraints/estimation/adjustment.h"

namespace selfcal {

/// By how much the squares of the rows' errors are more than those of their noise: such rows say
/// the less against what was given.
struct Structure {
  double halves = 1;  ///< as halves of the rows differ
  double stated = 1;  ///< as data sheets or repeats tell their noise
};

/// Covariance of columns() at `adjusted.fitted`: of the free unknowns, and of the robot's
/// parameters that are fixed within their tolerances (considered parameters: each is as far off as
/// the rows say, and in no more doubt beside that than they leave it), with known lengths, planes,
/// normals and centres in doubt beside them (given_doubt.h). `R` is whitened, with the columns
/// beside the unknowns. With `considered` false what was given is exact. A length held for the
/// scale is as free as the maker's tolerances leave the scale.
Eigen::MatrixXd posterior(const Equations& equations, const Adjusted& adjusted,
                          const Eigen::MatrixXd& R, bool considered = true,
                          const Structure& structure = {});

}  // namespace selfcal
