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

/// Splits by the order of the times; one apart from the other.
inline constexpr int kHalvesInTime = 3;

struct HalfSampling {
  /// Each set's rows in four stretches in the order of their times: every way to make two halves of
  /// these is a split.
  HalfSamples in_time;
  /// One split each, by the reading of a joint that moves or a coordinate of where the body was:
  /// the less half of each set's rows and the rest. Groups and repeats stay whole.
  std::vector<HalfSamples> by_configuration;
};

/// Linearised at `adjusted.fitted`. What no row carries (links between groups) is in both halves,
/// which makes them the blunter.
HalfSampling half_samples(const Equations& equations, const Adjusted& adjusted);

}  // namespace selfcal
