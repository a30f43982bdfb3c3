// What a metrologist asks of a result: freedoms, coverage, where the doubt comes from, whether the
// residuals look like noise, how it is spread over the workspace.
#pragma once

#include <vector>

#include "constraints/estimation/covariance_sources.h"
#include "constraints/estimation/judgement.h"

namespace selfcal {

/// `sources` add up to the covariance; `question` is of the workspace, its covariance is not looked
/// at; `after` are the residuals of the calibrated robot.
Uncertainty uncertainty(const Equations& equations, const Adjusted& adjusted,
                        const std::vector<CovarianceSource>& sources, const Judged& after,
                        EndpointQuestion question);

}  // namespace selfcal
