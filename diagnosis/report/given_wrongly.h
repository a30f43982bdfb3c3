// Figures of the files that are wrong, where a cause far beyond its usual size makes up for them.
#pragma once

#include <string>

#include "constraints/solution.h"
#include "diagnosis/evidence/linearised_model.h"
#include "diagnosis/findings.h"

namespace selfcal {

/// Something moved farther than any machine errs may be so, and a cause far beyond its usual size;
/// a length given wrongly looks the same; not what makes lengths contradict each other itself (a
/// scale, a growth). `calibrated` is of the same rows. In words; empty where
/// nothing speaks for it.
std::string length_given_wrongly(const Diagnosis& diagnosis, const Solution& calibrated);

/// One joint's gear ratio far from what the robot's file says, by which calibration leaves no more
/// than causes do that are far beyond their usual sizes. In words; empty where it does not.
std::string ratio_given_wrongly(const LinearisedModel& linearised, const DataSet& data,
                                const Diagnosis& diagnosis);

/// A transmission error that is named at a joint without a gear ratio to be free and, over the
/// readings `q` (rows x joints), is nearly a straight line: the unit that the joint is read in is
/// off. In words; empty where none is so.
std::string reading_scaled_wrongly(const Robot& robot, const Eigen::MatrixXd& q,
                                   const std::vector<CauseResult>& named);

}  // namespace selfcal
