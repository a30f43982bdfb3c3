// A Gough-Stewart platform: six legs of a length that is driven and read, each from a universal
// joint in the base to a spherical one in the platform (Khalil and Dombre 11.7):
//   q_i + offset_i = |p + R b_i - a_i|, i = 1 … 6    (11.58, 11.59)
// The base frame is the world's, the platform's frame the tool's; 42 parameters.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/robots/figures.h"
#include "kinematics/robots/loop_masses.h"
#include "kinematics/robots/platform.h"

namespace selfcal::gough_stewart {

/// Place of a leg's parameters within its seven: a, b and the offset of its length sensor.
enum Field { kBase, kPlatform = kBase + 3, kOffset = kPlatform + 3, kFields };

inline constexpr int kLegs = platform::kChains, kParameters = kFields * kLegs;

inline int index(int leg, int field) { return kFields * leg + field; }

struct GoughStewart : PartFigures {
  GoughStewart() : PartFigures(kParameters) {}

  std::string name;
  std::array<double, kLegs> lower{}, upper{};  ///< of the readings
  std::array<platform::Swing, kLegs> swing{};  ///< of the passive joints
  std::optional<platform::HomePose> home;      ///< from which the assembly mode is found
  LoopMasses masses;                           ///< platform, cylinders and pistons of the legs
};

/// Reads a robot file of kind "gough-stewart"; the result is meaningless after a problem.
GoughStewart read(const Node& node, Problems& problems);
/// The file content of `model`.
Node write(const GoughStewart& model);

/// Name of a leg's frame and joint: "leg1".
std::string leg_name(int leg);
/// Parameters in the file's order.
std::vector<Parameter> parameters(const GoughStewart& model);
/// Order of preference of the columns as indices into parameters().
std::vector<int> preference(const GoughStewart& model);

}  // namespace selfcal::gough_stewart
