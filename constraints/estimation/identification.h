// The identification: which parameters, from which rows, with what certainty.
//
// Minimises, over the free parameters xi and the sets' nuisance parameters,
//   sum over rows of rho(|r / sigma_set|) + sum over xi of ((xi - nominal) / tolerance)^2
// by Gauss-Newton steps on R of a streamed QR of W (11.31, 11.32), with Levenberg-Marquardt damping
// behind it when a step fails. The estimate is the mean of the posterior: a direction that the rows
// do not determine stays where the prior puts it.
#pragma once

#include "constraints/estimation/options.h"
#include "constraints/methods/data_set.h"
#include "constraints/progress.h"
#include "constraints/solution.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Identifies. `data` must fit `robot` (as io's reader makes sure); names in `options` must exist.
Solution identify(const Robot& robot, const DataSet& data, const Options& options = {},
                  const Progress& progress = {});

/// What the rows say of the robot as it is: nothing of it may move, surfaces and instruments are
/// fitted. The verdict says nothing then; the figures, sets and outliers do.
Solution judge_as_it_is(const Robot& robot, const DataSet& data, const Progress& progress = {});

}  // namespace selfcal
