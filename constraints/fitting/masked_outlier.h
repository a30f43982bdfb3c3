// A false row of high leverage: it bends the fit towards itself, is then met as well as any, and
// makes others look false in its place.
#pragma once

#include <optional>
#include <vector>

#include "constraints/fitting/noise.h"
#include "constraints/fitting/prior.h"

namespace selfcal {

/// The row (of the data set) whose absence lets its set be met better than any good row's would,
/// once in a million: its externally studentised residual (Cook and Weisberg 1982, 2.2) against the
/// F distribution, of all rows in `noise` that are not put aside. The one that stands out most;
/// nothing where there is none, where nothing is free that it could bend, or of so many equations
/// that no row can bend the fit alone.
std::optional<int> masked_outlier(const Equations& equations, const State& state,
                                  const Noise& noise, const Prior& prior);

}  // namespace selfcal
