// What structure of an unknown cause may look like: residuals that configurations close to each
// other share.
#pragma once

#include <vector>

#include "constraints/equations/equations.h"
#include "constraints/equations/resolution.h"
#include "diagnosis/evidence/evidence_rows.h"
#include "diagnosis/evidence/joint_kernels.h"
#include "diagnosis/evidence/kernel_domain.h"

namespace selfcal {

/// Noise alone first (and noise that repeats share a part of), then every domain at several
/// sizes over the noise. `of_visits` is the noise from visit to visit over that of immediate
/// repeats, see noise_of_visits. `rows` are the equations that are weighed, `ends` the
/// endpoint's pose by row of the data set, `size` the robot's (m, see size_of). The rounding
/// of a reading is shared by rows of one reading, however often they are repeated.
std::vector<DiscrepancyCovariance> structures(const Observations& data, const DenseEquations& rows,
                                              const std::vector<Eigen::Isometry3d>& ends,
                                              double size, const JointErrors& joints,
                                              double of_visits = 0);

/// Only noise, its visits' own included.
std::vector<DiscrepancyCovariance> noise_alone(const Observations& data, const DenseEquations& rows,
                                               const ReadingErrors& readings, double of_visits = 0);

}  // namespace selfcal
