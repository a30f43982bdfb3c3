// A six-joint arm in the manner of a UR10, as a robot file of the product's and as a model of
// MuJoCo's (MJCF). Nothing of the product is used: the geometry is worked out here once more.
//
// Each joint of the model is a motor's hinge, driven by a position servo, whose angle is what the
// encoder reads; a joint that gives way has a second hinge behind it, with a spring of 1 / c:
//   angle of the link = reading + c (torque of gravity)
#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <random>
#include <string>
#include <vector>

namespace selfcal::mujoco {

using Random = std::mt19937_64;

double uniform(Random& random, double least, double most);
double normal(Random& random);

/// A frame after Khalil and Kleinfinger with the mass of its link.
struct ArmFrame {
  std::string name;
  bool turns = true;
  double alpha = 0, d = 0, theta = 0, r = 0, beta = 0;  ///< rad, m
  double lower = 0, upper = 0;                          ///< rad
  double mass = 0;                                      ///< kg
  Eigen::Vector3d com = Eigen::Vector3d::Zero();        ///< m, in the frame
  double compliance = 0;                                ///< rad/(N m); 0: rigid

  /// In the frame before, with the joint at zero.
  Eigen::Isometry3d pose() const;
};

struct Arm {
  std::vector<ArmFrame> frames;  ///< from the world to the tool
  ArmFrame& frame(const std::string& name);
};

/// As its maker describes it; lengths and tool are drawn.
Arm draw_arm(Random& random);

/// As it is built: 0.5 mm and mrad off, base and tool 3 mm and mrad, masses 3 % and 3 mm.
Arm draw_built(Arm arm, Random& random);

/// A fixed plane that is touched from its outer side.
struct Plate {
  std::string name;
  Eigen::Vector3d normal;  ///< outward, unit, world
  double distance = 0;     ///< n . p = distance (m)
};

/// A floor and three walls around the arm: all of them are touched from within.
std::vector<Plate> draw_plates(Random& random);

/// Radius of the probe's ball (m). Its centre is the endpoint: what is touched is the plate moved
/// outwards by the radius, which an unknown plane takes up.
inline constexpr double kBall = 1e-3;

std::string robot_yaml(const Arm& arm);
std::string mjcf(const Arm& arm, const std::vector<Plate>& plates);

}  // namespace selfcal::mujoco
