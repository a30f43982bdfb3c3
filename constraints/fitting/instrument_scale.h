// Whether the robot that an instrument measures is as large as its maker says.
#pragma once

#include <optional>

#include "constraints/equations/equations.h"
#include "constraints/fitting/prior.h"

namespace selfcal {

struct InstrumentScale {
  double excess = 0;    ///< of what it reads over the maker's lengths, relative
  double sigma = 0;     ///< to which these tell their common scale
  bool beyond() const;  ///< what the maker's lengths bear
};

/// `R` is whitened, at the robot's parameters `xi`; `prior` has the maker's own tolerances. Nothing
/// where some set leaves the scale free or gives a length of its own.
std::optional<InstrumentScale> instrument_scale(const Equations& equations, const Prior& prior,
                                                const Eigen::VectorXd& xi,
                                                const Eigen::MatrixXd& R);

}  // namespace selfcal
