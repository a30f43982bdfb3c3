// Arms as their makers' public figures have them and as models for MuJoCo are usually written:
// bodies by place and quaternion, inertias, position actuators whose gains let them sag.
//
// UR10e: Universal Robots' DH table, masses and centres of mass; LBR iiwa 14 R820: KUKA's data
// sheet and the masses of its URDF; Panda: Franka Emika's DH table and identified masses (Gaz et
// al. 2019).
#pragma once

#include <string>
#include <vector>

namespace selfcal::mujoco {

/// One body with its joint, in the body before.
struct ArmBody {
  std::string joint;
  const char *place, *turn, *axis;  ///< as MJCF has them: m, a quaternion (any length), unit
  double lower, upper;              ///< rad
  double mass;                      ///< kg
  const char* com;                  ///< m, in the body
};

struct PublicArm {
  std::string name;
  std::vector<ArmBody> bodies;
  const char *tool_place, *tool_turn;  ///< in the last body
  double gain;                         ///< N m/rad, of every actuator
};

std::vector<PublicArm> public_arms();

/// How a machine is built, beside its model.
struct Hidden {
  double place = 0, turn = 0;  ///< m, rad: what each body and the tool are off, 1 sigma
  double base = 0;             ///< m and rad, the same of the first body
  std::string joint;           ///< gives way
  double compliance = 0;       ///< rad/(N m)
  double payload = 0;          ///< kg at the tool
};

/// The model, with what is hidden in the machine drawn from `seed`.
std::string mjcf(const PublicArm& arm, const Hidden& hidden = {}, unsigned seed = 0);

}  // namespace selfcal::mujoco
