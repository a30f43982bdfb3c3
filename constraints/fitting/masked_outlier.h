// False rows of high leverage: one bends the fit towards itself, is then met as well as any, and
// makes others look false in its place; several hide each other, too, in the noise that they make.
#pragma once

#include <vector>

#include "constraints/fitting/noise.h"
#include "constraints/fitting/prior.h"

namespace selfcal {

/// The rows (of the data set) whose absence lets their set be met better than any good row's would,
/// once in a million: the externally studentised residual (Cook and Weisberg 1982, 2.2) against the
/// F distribution, of all rows in `noise` that are not put aside. The row that stands out most is
/// taken away, then that of those left, and so on, as far as the last that is so improbable (the
/// generalised extreme studentised deviate, Rosner 1983); at most `share` of the rows and two sigma
/// of that, or one. Several are false only if all others are then met far better, or nearly as the
/// data sheets say: else they are structure, and one is looked for alone. None where nothing is
/// free that a row could bend, or of so many equations that no row can bend the fit alone.
std::vector<int> masked_outliers(const Equations& equations, const State& state, const Noise& noise,
                                 const Prior& prior, double share);

}  // namespace selfcal
