// A Hexa Slide: six carriages on rails, from each a link of fixed length to the platform (PRRS;
// Rauf, Kim and Ryu, Calibration of parallel manipulators using a new measurement device):
//   c_i = s_i + q_i a_i,   |p + R b_i - c_i| = l_i, i = 1 … 6
// s is the start of the rail, a its unit direction by two components, the third the negative root.
// The base frame is the world's, the platform's frame the tool's; 54 parameters.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kinematics/robots/figures.h"
#include "kinematics/robots/loop_masses.h"
#include "kinematics/robots/platform.h"

namespace selfcal::hexaslide {

/// Place of a chain's parameters within its nine.
enum Field {
  kStart,
  kDirection = kStart + 3,
  kJoint = kDirection + 2,
  kLink = kJoint + 3,
  kFields
};

inline constexpr int kChains = platform::kChains, kParameters = kFields * kChains;

inline int index(int chain, int field) { return kFields * chain + field; }

struct Hexaslide : PartFigures {
  Hexaslide() : PartFigures(kParameters) {}

  std::string name;
  std::array<double, kChains> lower{}, upper{};  ///< of the readings; equal: none in the file
  std::array<platform::Swing, kChains> swing{};  ///< of the passive joints
  std::optional<platform::HomePose> home;        ///< from which the assembly mode is found
  LoopMasses masses;                             ///< platform, carriages and links
};

/// Reads a robot file of kind "hexaslide"; the result is meaningless after a problem.
Hexaslide read(const Node& node, Problems& problems);
/// The file content of `model`.
Node write(const Hexaslide& model);

/// Name of a chain's frame and joint: "chain1".
std::string chain_name(int chain);
/// Parameters in the file's order.
std::vector<Parameter> parameters(const Hexaslide& model);
/// Order of preference of the columns as indices into parameters().
std::vector<int> preference(const Hexaslide& model);

/// Unit direction of a rail.
Eigen::Vector3d direction(const Eigen::VectorXd& xi, int chain);

}  // namespace selfcal::hexaslide
