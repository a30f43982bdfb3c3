// How far fits of parts of the rows differ, beside what their noise explains: residuals that rows
// near each other share make the posterior of independent rows too sure of itself.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "constraints/estimation/adjustment.h"

namespace selfcal {

/// Means over the splits of the squares.
struct HalfSamples {
  /// Of half the differences of the fits of either half, columns() x columns().
  Eigen::MatrixXd seen;
  /// The same where the rows err apart and the priors hold, robot_columns() x robot_columns().
  Eigen::MatrixXd expected;
};

/// Linearised at `adjusted.fitted`. The first parts each set's rows in four stretches in the order
/// of their times, and every way to make two halves of them is one split. The others are one split
/// each, where a joint's reading, or a coordinate of where the body was, is less or more than in
/// the middle of the set; a group stays whole.
std::vector<HalfSamples> half_samples(const Equations& equations, const Adjusted& adjusted);

}  // namespace selfcal
