// How well the rows see the identified parameters, by the usual measures.
#pragma once

#include "constraints/solution.h"

namespace selfcal {

/// Measures of W (columns of the identified parameters in m, rad and ratios; rows in units of the
/// set's noise over that of the quietest set, so that several sets compare). With singular values
/// s_1 >= ... >= s_L and n rows:
///   condition = s_1 / s_L (11.30),  o1 = (s_1 ... s_L)^(1/L) / sqrt(n) (Borm and Menq),
///   o2 = s_L / s_1,  o3 = s_L (Nahvi),  o4 = s_L^2 / s_1,  o5 = 1 / sum(1 / s_i) (Sun and
///   Hollerbach).
Observability observability(const Eigen::MatrixXd& W, int rows);

}  // namespace selfcal
