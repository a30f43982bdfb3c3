// Elements of a model for MuJoCo that a new one and the user's own get alike.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "io/models/mjcf_effects.h"

class TiXmlElement;

namespace selfcal {

/// "1 2 3".
std::string mjcf_numbers(const Eigen::VectorXd& v);

/// `pos` and `quat`.
void set_mjcf_pose(TiXmlElement& element, const Eigen::Isometry3d& X);

/// `stiffness`, and `damping` by which it comes to rest within a hundredth of a second.
void set_mjcf_spring(TiXmlElement& joint, double compliance);

/// A mass that spins as one of an arm's thickness; kNoMjcfMass where a body has none.
TiXmlElement mjcf_inertial(double mass, const Eigen::Vector3d& com);
inline constexpr double kNoMjcfMass = 1e-6;  ///< kg

/// A joint about or along z, or another axis.
TiXmlElement mjcf_joint(const std::string& name, serial::Motion motion, const char* axis = "0 0 1");

/// The equality of a follower.
TiXmlElement follow_element(const Following& following);

/// A body without mass that turns about its axes by springs.
struct SprungBody {
  std::string name;
  Eigen::Vector3d p, compliance;  ///< in the frame that it is of; rad/(N m)
};
TiXmlElement sprung_element(const SprungBody& body);

/// Those of a link that bends between its frame's origin and `next`: two points of Gauss.
std::vector<SprungBody> bending_bodies(const BodySpring& link, const Eigen::Vector3d& next);
/// That of what turns at its frame's origin.
SprungBody mounting_body(const BodySpring& tool);

/// The bodies under `parent`, each before those in it.
void list_mjcf_bodies(TiXmlElement& parent, std::vector<TiXmlElement*>& list);
/// The `kind` of element in `parent` that is called `name`; null without.
TiXmlElement* named_mjcf_child(TiXmlElement& parent, const char* kind, const std::string& name);
/// As set_mjcf_pose, in place of however the element says where it is.
void place_mjcf(TiXmlElement& element, const Eigen::Isometry3d& X);
/// A copy of the joint's element behind it, with a name and a rest of its own.
TiXmlElement* free_joint_copy(TiXmlElement& body, TiXmlElement& joint, const std::string& name);
/// What the file has angles in, of a radian: degrees where it says nothing.
double mjcf_angle_unit(TiXmlElement& root);

}  // namespace selfcal
