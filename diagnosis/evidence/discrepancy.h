// What structure of an unknown cause may look like: residuals that configurations close to each
// other share.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/equations/resolution.h"
#include "diagnosis/evidence/evidence_rows.h"
#include "diagnosis/evidence/kernel_domain.h"
#include "kinematics/robot.h"

namespace selfcal {

/// Noise alone first (and noise that repeats share a part of), then every domain at several
/// sizes over the noise. `of_visits` is the noise from visit to visit over that of immediate
/// repeats, see noise_of_visits. `rows` are the equations that are weighed, `ends` the
/// endpoint's pose by row of the data set, `size` the robot's (m, see size_of). The rounding
/// of a reading is shared by rows of one reading, however often they are repeated.
/// `alike` (rows x joints) are the readings as they are compared, see comparable_readings.
std::vector<DiscrepancyCovariance> structures(const Observations& data, const DenseEquations& rows,
                                              const std::vector<Eigen::Isometry3d>& ends,
                                              double size, const ReadingErrors& readings,
                                              const Eigen::MatrixXd& alike, double of_visits = 0);

/// Readings `q` (rows x joints) as angles: of a joint that slides, half a turn for all that it
/// moves in these rows.
Eigen::MatrixXd comparable_readings(const Robot& robot, Eigen::MatrixXd q);

/// Only noise, its visits' own included.
std::vector<DiscrepancyCovariance> noise_alone(const Observations& data, const DenseEquations& rows,
                                               const ReadingErrors& readings, double of_visits = 0);

}  // namespace selfcal
