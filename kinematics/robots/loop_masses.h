// What a machine with loops weighs, as its file gives it (app/selfcal-data.5: masses, gravity).
#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string_view>
#include <vector>

#include "kinematics/description.h"
#include "kinematics/statics.h"

namespace selfcal {

/// Each is of one of its kind; a kind reads those that it has.
struct LoopMasses {
  double platform = 0;                            ///< kg
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< of the platform, in its frame (m)
  double carriage = 0, rod = 0;                   ///< kg; a rod's is spread along it evenly
  double cylinder = 0, cylinder_com = 0;          ///< kg; m from the base's joint
  double piston = 0, piston_com = 0;              ///< kg; m from the platform's joint
  bool known = false;                             ///< the file has `masses`
  std::optional<Eigen::Vector3d> gravity = {};    ///< m/s^2, world; as the file has it
};

/// A key of `masses`; lengths are metres, the others kilograms.
struct MassKey {
  std::string_view name;
  double LoopMasses::*figure;
  bool length = false;
};

/// Reads `gravity`, and of `masses` these keys and `com`.
LoopMasses read_masses(Fields& robot, const std::vector<MassKey>& keys, Problems& problems);
/// Adds them to the robot's mapping, if there are any.
void write_masses(const LoopMasses& masses, const std::vector<MassKey>& keys, Node& robot);

/// The platform's; nothing where the file has neither masses nor gravity. A kind adds what else it
/// has.
std::optional<PointMasses> point_masses(const LoopMasses& masses);

}  // namespace selfcal
