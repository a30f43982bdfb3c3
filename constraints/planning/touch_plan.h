// Which configurations a session visits, and how it gets into each contact and out again.
//
// Many random configurations touch each surface or sit in each socket of the model
// (touch_candidates.h); of these the ones are taken that tell most together, and moved along their
// surfaces (touch_choice.h). No way between them may cross another surface or the fence
// (free_way.h).
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/planning/free_way.h"
#include "constraints/planning/planned_touch.h"
#include "constraints/planning/touch_candidates.h"
#include "constraints/progress.h"
#include "constraints/sampling/configurations.h"
#include "constraints/solution.h"

namespace selfcal {

struct TouchPlan {
  std::vector<PlannedTouch> touches;  ///< in the order in which they are visited
  std::string unreached = {};  ///< which set has no or too few reachable places; empty when all has
  /// Of which set some are missing, for no straight way leads to them with its lock engaged; empty
  /// when none is.
  std::string left_out = {};
};

/// `xi` are the parameters that are believed; `sets` have their methods (touched ones); the end
/// position counts in the box of `workspace`, without one over all that the joints can do. Tells
/// its progress between its stages and rounds of sampling, where it can be given up.
TouchPlan plan_touches(const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
                       const std::vector<TouchTarget>& targets,
                       const std::vector<Obstacle>& obstacles, const Workspace& workspace,
                       const TouchPlanOptions& options, const Progress& progress = {});

/// Usable touches of each target, four for each that it asks for where there are as many, in no
/// order; without `way`.
std::vector<std::vector<PlannedTouch>> usable_touches(const TouchCandidates& candidates,
                                                      const std::vector<TouchTarget>& targets,
                                                      Random& random,
                                                      const Progress& progress = {});

/// Usable touches in an order of short ways, begun at home, one set after the other, with the ways
/// between them; without those that an engaged lock does not get to.
TouchPlan in_short_order(const Surroundings& cell, const std::vector<Set>& sets,
                         const std::vector<PlannedTouch>& touches);

/// Into and out of a slow contact the robot moves so much slower.
inline constexpr double kSlower = 3;

/// How sure the end position will be, a rigid motion removed.
struct ExpectedSigma {
  EndpointSigma endpoint;   ///< over all that the joints can do
  EndpointSigma workspace;  ///< where it counts
  /// Of `workspace` the rms (m) after fewer touches, always without those that tell least: by count
  /// of those that identify, from 0; empty where no pose of the workspace is reached.
  std::vector<double> curve;
};

/// After those of the planned touches that are not kept aside, with every surface and socket
/// unknown; `prior` as in KnownBefore.
ExpectedSigma expected_sigma(const Robot& robot, const Eigen::VectorXd& xi,
                             const std::vector<Set>& sets, const std::vector<TouchTarget>& targets,
                             const TouchPlan& plan, const Workspace& workspace,
                             const Progress& progress = {}, const Eigen::MatrixXd& prior = {});

/// How long the motion of a session takes (s): between the touches, from home and back to it, and
/// into the contacts and out.
struct MotionTime {
  double travel = 0, touching = 0;
  double total() const { return travel + touching; }
};

/// Out of a socket the robot moves so much faster than into it; off a surface as between touches.
inline constexpr double kRetreatFaster = 2;

MotionTime motion_time(const Robot& robot, const Eigen::VectorXd& xi, const TouchPlan& plan,
                       const TouchPlanOptions& options);

}  // namespace selfcal
