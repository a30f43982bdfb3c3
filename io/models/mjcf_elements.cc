#include "io/models/mjcf_elements.h"

#include <tinyxml.h>

#include <array>
#include <numbers>
#include <string_view>

namespace selfcal {
namespace {

constexpr double kGyration = 0.1;     // m, radius of gyration, which no robot file has
constexpr double kSpringTime = 0.01;  // s, in which a spring comes to rest by its damping
constexpr double kPiGrace = 1e-12;    // of a quaternion's sign
/// Where on a link's length it bends, by half of its compliance each.
constexpr double kGaussBends[] = {0.5 - 0.5 * std::numbers::inv_sqrt3,
                                  0.5 + 0.5 * std::numbers::inv_sqrt3};

}  // namespace

std::string mjcf_numbers(const Eigen::VectorXd& v) {
  std::string text;
  for (const double each : v) text += (text.empty() ? "" : " ") + format_number(each + 0.0);
  return text;
}

void set_mjcf_pose(TiXmlElement& element, const Eigen::Isometry3d& X) {
  Eigen::Quaterniond q(X.linear());
  if (q.w() < -kPiGrace) q.coeffs() *= -1;
  element.SetAttribute("pos", mjcf_numbers(X.translation()));
  element.SetAttribute("quat", mjcf_numbers(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z())));
}

void set_mjcf_spring(TiXmlElement& joint, double compliance) {
  joint.SetAttribute("stiffness", format_number(1 / compliance));
  joint.SetAttribute("damping", format_number(kSpringTime / compliance));
}

TiXmlElement mjcf_inertial(double mass, const Eigen::Vector3d& com) {
  TiXmlElement element("inertial");
  element.SetAttribute("pos", mjcf_numbers(com));
  element.SetAttribute("mass", format_number(mass));
  element.SetAttribute("diaginertia",
                       mjcf_numbers(Eigen::Vector3d::Constant(mass * kGyration * kGyration)));
  return element;
}

TiXmlElement mjcf_joint(const std::string& name, serial::Motion motion, const char* axis) {
  TiXmlElement element("joint");
  element.SetAttribute("name", name);
  element.SetAttribute("type", motion == serial::Motion::prismatic ? "slide" : "hinge");
  element.SetAttribute("axis", axis);
  return element;
}

TiXmlElement follow_element(const Following& following) {
  TiXmlElement joint("joint");
  joint.SetAttribute("joint1", following.name);
  joint.SetAttribute("joint2", following.leader);
  joint.SetAttribute("polycoef", "0 " + format_number(following.factor) + " 0 0 0");
  return joint;
}

TiXmlElement sprung_element(const SprungBody& body) {
  TiXmlElement element("body");
  element.SetAttribute("name", body.name);
  element.SetAttribute("pos", mjcf_numbers(body.p));
  element.InsertEndChild(mjcf_inertial(kNoMjcfMass, Eigen::Vector3d::Zero()));
  static constexpr std::array<const char*, 3> kAxes = {"1 0 0", "0 1 0", "0 0 1"};
  for (int axis = 0; axis < 3; ++axis) {
    if (!(body.compliance[axis] > 0)) continue;
    TiXmlElement joint =
        mjcf_joint(body.name + "." + "xyz"[axis], serial::Motion::revolute, kAxes[axis]);
    set_mjcf_spring(joint, body.compliance[axis]);
    element.InsertEndChild(joint);
  }
  return element;
}

std::vector<SprungBody> bending_bodies(const BodySpring& link, const Eigen::Vector3d& next) {
  std::vector<SprungBody> bodies;
  for (int k = 0; k < 2; ++k)
    bodies.push_back(
        {link.frame + ".bend" + std::to_string(k + 1), kGaussBends[k] * next, link.compliance / 2});
  return bodies;
}

SprungBody mounting_body(const BodySpring& tool) {
  return {tool.frame + ".mount", Eigen::Vector3d::Zero(), tool.compliance};
}

void list_mjcf_bodies(TiXmlElement& parent, std::vector<TiXmlElement*>& list) {
  for (auto* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    if (e->ValueStr() == "body") list.push_back(e);
    list_mjcf_bodies(*e, list);
  }
}

TiXmlElement* named_mjcf_child(TiXmlElement& parent, const char* kind, const std::string& name) {
  for (auto* e = parent.FirstChildElement(kind); e; e = e->NextSiblingElement(kind))
    if (const char* found = e->Attribute("name"); found && name == found) return e;
  return nullptr;
}

void place_mjcf(TiXmlElement& element, const Eigen::Isometry3d& X) {
  for (const char* other : {"axisangle", "xyaxes", "zaxis", "euler"})
    element.RemoveAttribute(other);
  set_mjcf_pose(element, X);
}

TiXmlElement* free_joint_copy(TiXmlElement& body, TiXmlElement& joint, const std::string& name) {
  TiXmlElement copy = joint;
  copy.SetAttribute("name", name);
  for (const char* other : {"range", "ref", "springref", "springdamper", "margin"})
    copy.RemoveAttribute(other);
  for (const char* none : {"stiffness", "damping", "armature", "frictionloss", "ref", "springref"})
    copy.SetAttribute(none, "0");
  copy.SetAttribute("limited", "false");
  return body.InsertAfterChild(&joint, copy)->ToElement();
}

double mjcf_angle_unit(TiXmlElement& root) {
  for (auto* e = root.FirstChildElement("compiler"); e; e = e->NextSiblingElement("compiler"))
    if (const char* angle = e->Attribute("angle"); angle && std::string_view(angle) == "radian")
      return 1;
  return 180 / std::numbers::pi;
}

}  // namespace selfcal
