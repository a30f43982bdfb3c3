// What a simulated robot is and what it measures: SCENARIO.yaml. Paths in it are relative to it.
//
//   key             default   range          meaning
//   robot           required                 file of the nominal robot, copied into the data set
//   seed            1         0 to 2^31-1    the same seed gives the same files
//   target          none      0 to 1 m       end-position accuracy wanted, copied to dataset.yaml
//   errors          none                     1 sigma of what the true robot is off, normal draws:
//     length        0         0 to 1 m         d and r of the robot's own frames
//     angle         0         0 to 1 rad       alpha, theta and beta of the same
//     base_length   0         0 to 1 m         of the base frames
//     base_angle    0         0 to 1 rad
//     tool_length   0         0 to 1 m         of the tool frames
//     tool_angle    0         0 to 1 rad
//     gear          0         0 to 1           of the gear ratios
//     parameters    {}        m, rad, 1        NAME: ERROR, given instead of drawn ({d3: 0.0012})
//   encoder_step    0         0 to 0.1         readings are rounded to it (rad or m)
//   check           0.33      0 to 0.9         share of every set's configurations marked `check`
//   repeats         none                       immediate repeats, each with its own noise:
//     share         0         0 to 1           share of the configurations that are repeated
//     times         3         2 to 100         rows that each of these has
//   false_triggers  none                       touches that are off:
//     share         0         0 to 0.5         share of the rows of all methods with contact
//     size          [1e-3, 8e-3]  to 0.1 m     how far, uniform; early where a touch has a side
//   compliance      {}        0 to 1e-2        FRAME: COMPLIANCE of a joint (rad/(N m), m/N) under
//                                              gravity, which the model lacks
//   machine         {}                         how it moves and feels: sim/machine_scenario.h
//   sets            required                   NAME: {an entry of dataset.yaml's sets, and:
//     rows          100       1 to 1e6         rows, repeats among them
//     rows_per_group  4       2 to 1e4         of methods whose rows share a point or location
//     noise_true    `noise`   0 to 0.1 m       1 sigma of one scalar residual
//     noise_angle_true  `noise_angle`  0 to 0.1 rad  the same for angles
//     surface       random                     {point: [x, y, z], normal: [x, y, z]} of an unknown
//                                              plane; the normal points outwards, at the robot
//     outward       see below                  direction on whose side a plane is touched
//     truth         random                     nuisance parameters by their names in result.json
//                                              ({cx: 0.6, frame.x: 2}); what is left out is drawn
//     within        everywhere                 {center: [x, y, z], radius: R}, m: where rows lie
//     places        random                     where the sockets or nests really are, one a group:
//                                              [x, y, z] or [x, y, z, qw, qx, qy, qz]
//     locked        none                       joints that are held while the others move, each at
//                                              one reading for the whole set, drawn: [j2]
//   }
// A plane is touched from the side of the world's origin unless `surface` or `outward` says
// otherwise, a plane-normal from the side that its normal points at, a sphere from outside. A plane
// with `parallel_to` lies beyond the other one, seen from the origin, unless `truth` gives its d.
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "constraints/sampling/cell_geometry.h"
#include "kinematics/by_part.h"
#include "kinematics/description.h"
#include "sim/machine_scenario.h"
#include "sim/scenario_fields.h"

namespace selfcal {

struct Errors {
  ByPart sigma;
  double gear = 0;
  std::vector<NamedNumber> parameters;
};

struct Repeats {
  double share = 0;
  int times = 3;
};

struct FalseTriggers {
  double share = 0;
  double least = 1e-3, most = 8e-3;  // m
};

struct SetScenario {
  std::string name;
  Node entry;  ///< as dataset.yaml has it, without the scenario's own keys
  int rows = 100, rows_per_group = 4;
  double noise = 0, noise_angle = 0;      ///< true 1 sigma (m, rad)
  std::optional<Place> noise_angle_true;  ///< where it is given
  std::optional<Surface> surface;
  std::optional<Eigen::Vector3d> outward;  ///< unit
  std::vector<NamedNumber> truth;
  Patch within;
  std::vector<Location> places;
  std::vector<std::string> locked;    ///< names of joints
  std::optional<Place> locked_place;  ///< where they are named
};

/// Reads one entry of `sets`.
SetScenario read_set_scenario(const std::string& name, const Node& node, Problems& problems);

struct Scenario {
  std::string robot;
  int seed = 1;
  std::optional<double> target;
  Errors errors;
  double encoder_step = 0;
  double check = 0.33;
  Repeats repeats;
  FalseTriggers false_triggers;
  std::vector<NamedNumber> compliance;
  MachineScenario machine;
  std::vector<SetScenario> sets;
};

/// Reads a scenario; the result is meaningless after a problem. What needs the robot or the methods
/// (names of parameters, a set's own options) is judged when the data set is made.
Scenario read_scenario(const Node& node, Problems& problems);

/// dataset.yaml's content: the robot's file beside it, `observations.csv`, target and sets.
Node data_set_description(const Scenario& scenario, const std::string& robot_file);

}  // namespace selfcal
