// What a metrologist asks of a result: freedoms, coverage, where the doubt comes from, whether the
// residuals look like noise, how it is spread over the workspace.
#pragma once

#include <vector>

#include "constraints/estimation/covariance_sources.h"
#include "constraints/estimation/judgement.h"
#include "constraints/identifiability/endpoint_sigma.h"

namespace selfcal {

/// `sources` add up to the covariance; `question` is of the workspace, `deviations` are its and
/// `sigma` is what they say of that covariance; `after` are the residuals of the calibrated robot.
Uncertainty uncertainty(const Equations& equations, const Adjusted& adjusted,
                        const std::vector<CovarianceSource>& sources, const Judged& after,
                        const EndpointQuestion& question, const EndpointDeviations& deviations,
                        const EndpointSigma& sigma);

}  // namespace selfcal
