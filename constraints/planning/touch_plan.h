// Which configurations a session visits, and how it gets into each contact and out again.
//
// Many random configurations touch each surface or sit in each socket of the model; of these the
// ones are taken that tell most together (touch_choice.h). Each is entered along a straight joint
// path from a free configuration, and no way between them may cross another surface (free_way.h).
#pragma once

#include <string>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/planning/free_way.h"
#include "constraints/progress.h"
#include "constraints/sampling/configurations.h"
#include "constraints/solution.h"

namespace selfcal {

/// What is asked of one set.
struct TouchTarget {
  int set = 0;
  int touches = 0;
  Eigen::Vector3d outward;       ///< direction of the way out (world, unit); of a lock, the
                                 ///< leg's as seen from what carries it
  std::optional<Plane> plane;    ///< nominal, with its distance; nothing for sockets
  std::vector<Location> places;  ///< nominal sockets or nests, one a group; empty for planes
  Patch within;
  int obstacle = -1;  ///< what lies behind its surface, of the obstacles; -1 for sockets
};

struct TouchPlanOptions {
  double clearance = 0.03;  ///< m, how far out of the contact a touch begins
  double search = 0.01;     ///< m, how far behind the nominal place it is given up
  double tilt = 1.2;        ///< rad, most between the stylus (z of the endpoint) and the way in
  double apart = 0.02;      ///< m, kept between the endpoint and every surface that is not touched
  double limit_margin = 0.02;  ///< rad or m, kept from the joint limits
  double check = 0.33;         ///< share kept aside to judge
  Eigen::VectorXd home;        ///< readings from which every touch can be begun
  double speed = 0.5;          ///< rad/s or m/s, of the joints between touches
  unsigned long long seed = 1;
};

struct PlannedTouch {
  int set = 0, group = -1;
  bool check = false;
  bool slow = false;                  ///< into the contact at a share of the usual speed
  bool loaded = false;                ///< with the payload on the tool
  bool via_home = false;              ///< the way there leads through `home`
  std::vector<Eigen::VectorXd> way;   ///< readings that it leads through else; none: straight
  Eigen::VectorXd start, touch, end;  ///< readings: free, nominal contact, given up; all the
                                      ///< same under a lock
};

struct TouchPlan {
  std::vector<PlannedTouch> touches;  ///< in the order in which they are visited
  std::string unreached;  ///< which set has no or too few reachable places; empty when all has
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
std::vector<std::vector<PlannedTouch>> usable_touches(
    const Robot& robot, const Eigen::VectorXd& xi, const std::vector<Set>& sets,
    const std::vector<TouchTarget>& targets, const std::vector<Obstacle>& obstacles,
    const TouchPlanOptions& options, Random& random, const Progress& progress = {});

/// Usable touches in an order of short ways, begun at home, one set after the other, with the ways
/// between them.
std::vector<PlannedTouch> in_short_order(const Surroundings& cell, const std::vector<Set>& sets,
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
/// unknown.
ExpectedSigma expected_sigma(const Robot& robot, const Eigen::VectorXd& xi,
                             const std::vector<Set>& sets, const std::vector<TouchTarget>& targets,
                             const TouchPlan& plan, const Workspace& workspace,
                             const Progress& progress = {});

/// How long the motion of a session takes (s): between the touches, from home and back to it, and
/// into the contacts and out.
struct MotionTime {
  double travel = 0, touching = 0;
};

/// Out of a contact the robot moves so much faster than into it.
inline constexpr double kRetreatFaster = 2;

/// `touch_speed` is the endpoint's towards a surface (m/s), each touch made `repeats` times.
MotionTime motion_time(const Robot& robot, const Eigen::VectorXd& xi, const TouchPlan& plan,
                       const TouchPlanOptions& options, double touch_speed, int repeats);

}  // namespace selfcal
