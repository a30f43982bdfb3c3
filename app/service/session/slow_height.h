// How far before a surface a touch must begin slowly, once touches of its set tell where it lies.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "app/service/session/decoding.h"
#include "app/service/session/session.h"

namespace selfcal {

/// A contact that was felt: where it was expected (m, world), and how far out of it (m, along the
/// way out) it came.
struct FeltContact {
  Eigen::Vector3d expected;
  double out = 0;
};

/// How far before the contact expected at `p` (m, world) the robot slows down: `slow` where what
/// was felt does not tell of that place (fewer than eight contacts more than a plane has numbers,
/// or none around it); else as far as a plane through what the others were off by leaves it open
/// (five sigmas of a prediction), or a quadric where that leaves less; a quarter of `search` at
/// least, and what `slow` is more than `search`, for the robot's own way to stop.
double slow_height(const std::vector<FeltContact>& felt, const Eigen::Vector3d& p, double slow,
                   double search);

/// Readings on the straight way of a step, from its start to where it is given up, from which on it
/// is slow, as the good touches of the session's set tell. The start itself where nothing is
/// gained.
std::vector<double> slow_from(const Robot& robot, const Session& session, const Decoding& decoding,
                              const StepRecord& step, double search);

}  // namespace selfcal
