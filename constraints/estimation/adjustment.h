// The fits of an identification in their order: the placed nominal robot, the free one, again from
// other starts when in doubt, with a length held when the scale is free, with wider priors when
// these fail.
#pragma once

#include <vector>

#include "constraints/estimation/options.h"
#include "constraints/fitting/fit.h"
#include "constraints/progress.h"
#include "constraints/solution.h"

namespace selfcal {

struct Adjusted {
  Fit before;  ///< base, tool and nuisance parameters alone, the robot as its maker says; from
               ///< `near` no fit, what is there
  Fit fitted;
  Prior prior;                  ///< as used in `fitted`
  std::vector<char> candidate;  ///< by parameter: not fixed by the user or by default
  std::vector<Note> gauge;      ///< parameters held, and why
  int scale = -1;               ///< the one of them that is held for the scale
  double scale_sigma = 0;    ///< of it (m), as all the maker's tolerances together know the scale
  Chi2 chi2;                 ///< with the maker's tolerances
  bool priors_fail = false;  ///< chi2 is beyond 99 %
  double widening = 1;       ///< common factor on the tolerances of the links and gears
};

/// True for parameters of base and tool frames, whose priors say where things were put up.
bool is_placed(const Parameter& p);

/// `near`: where the fit of the same rows by a model with fewer parameters ended, whose are the
/// first of this one. The fits set out from there and, if they get nowhere, from the maker's
/// figures.
Adjusted adjust(const Equations& equations, const Options& options, const Progress& progress,
                const State* near = nullptr);

}  // namespace selfcal
