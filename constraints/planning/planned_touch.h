// What is asked of a plan of touches, and one of them.
#pragma once

#include <optional>
#include <vector>

#include "constraints/methods/data_set.h"
#include "constraints/planning/fence.h"
#include "constraints/planning/touch_choice.h"

namespace selfcal {

/// What is asked of one set.
struct TouchTarget {
  int set = 0;
  int touches = 0;
  Eigen::Vector3d outward;       ///< direction of the way out (world, unit); of a
                                 ///< lock, the leg's as seen from what carries it
  std::optional<Plane> plane;    ///< nominal, with its distance; nothing for sockets
  std::vector<Location> places;  ///< nominal sockets or nests, one a group; empty for planes
  Patch within;
  int obstacle = -1;  ///< what lies behind its surface, of the obstacles; -1 for sockets
};

struct TouchPlanOptions {
  double clearance = 0.03;      ///< m, how far out of the contact free ways end
  double slow = 0.013;          ///< m, how far out of it a touch begins, slowly; at most
                                ///< the clearance
  double search = 0.01;         ///< m, how far behind the nominal place it is given up
  double tilt = 1.2;            ///< rad, most between the stylus (z of the endpoint) and the way in
  double apart = 0.02;          ///< m, kept between the endpoint and every surface that
                                ///< is not touched
  double limit_margin = 0.005;  ///< kept from the joint limits, of each joint's range
  double check = 0.33;          ///< share kept aside to judge
  double spacing = 0;           ///< m, least between points of a surface that are touched
  double longest = 0;           ///< s, most that the motion of a session may take; 0: any time
  double touch_speed = 0.01;    ///< m/s, of the endpoint towards a surface
  int repeats = 1;              ///< touches of each configuration
  Fence fence = {};             ///< where no part of the robot may be
  KnownBefore known = {};
  Eigen::VectorXd home;  ///< readings from which every touch can be begun
  double speed = 0.5;    ///< rad/s or m/s, of the joints between touches
  unsigned long long seed = 1;
};

/// Readings all the same under a lock.
struct PlannedTouch {
  int set = 0, group = -1;
  bool check = false;
  bool slow = false;                 ///< into the contact at a share of the usual speed
  bool loaded = false;               ///< with the payload on the tool
  bool via_home = false;             ///< the way there leads through `home`
  std::vector<Eigen::VectorXd> way;  ///< readings that it leads through else; none: straight
  Eigen::VectorXd outside;           ///< readings at the clearance, where free ways end
  Eigen::VectorXd start, touch,
      end;  ///< readings: where it becomes slow, nominal contact, given up
};

}  // namespace selfcal
