// Causes of deviations as a machine has them, each a little more than any model of it says:
// springs that stiffen, play that depends on the load, drifts that wander, gears with orders.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/trials/trial_world.h"

namespace selfcal {

struct TrialCause {
  std::string effect = {};                                   ///< "unknown" of one that no list has
  std::vector<std::string> where = {};                       ///< naming any of them is right
  std::string physics = {};                                  ///< in words
  std::function<void(const Instant&, Deviation&)> act = {};  ///< adds to the deviation, at size 1
  double size = 1;
};

/// The listed effects that a machine of this world can have.
std::vector<std::string> listed_causes(const TrialWorld& world);
/// One of them at places and in a shape that are drawn. `world` must outlive it.
TrialCause draw_cause(const std::string& effect, const TrialWorld& world, Random& random);
/// A cause outside the list.
TrialCause draw_unknown(const TrialWorld& world, Random& random);

using CauseMaker = TrialCause (*)(const TrialWorld&, Random&);
/// Of the joints and of links (trial_joint_causes.cc), of legs (trial_leg_causes.cc), and of what
/// is around (trial_context_causes.cc).
const std::map<std::string, CauseMaker>& joint_causes();
const std::map<std::string, CauseMaker>& leg_causes();
const std::map<std::string, CauseMaker>& site_causes();
const std::map<std::string, CauseMaker>& tracked_causes();
const std::map<std::string, CauseMaker>& touch_causes();

/// One or two joints, the second with a share of 0.4 to 1 of the first, and a random sign.
struct ActingJoint {
  int joint = 0;
  double share = 1;
  std::string name;
};
std::vector<ActingJoint> draw_joints(const TrialWorld& world, Random& random, double two);
std::vector<std::string> names_of(const std::vector<ActingJoint>& joints);

/// A smooth walk from 0 at time 0: the integral of a speed that forgets itself over a third of the
/// session; 1 in root mean square.
AirRecord smooth_walk(double duration, Random& random);

}  // namespace selfcal
