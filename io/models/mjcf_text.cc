// Frames as bodies. MuJoCo takes no moving body without mass and inertia, which a robot file may
// lack: what it lacks is put small, or as of a link of an arm's thickness, and said.
#include "io/models/mjcf_text.h"

#include <tinyxml.h>

#include "io/models/mjcf_elements.h"

namespace selfcal {
namespace {

TiXmlElement motor_element(const serial::Frame& frame) {
  TiXmlElement element = mjcf_joint(frame.name, frame.motion);
  if (!(frame.lower < frame.upper)) return element;
  element.SetAttribute("limited", "true");
  element.SetAttribute("range", mjcf_numbers(Eigen::Vector2d(frame.lower, frame.upper)));
  return element;
}

TiXmlElement play_element(const serial::Frame& frame, double play) {
  TiXmlElement element = mjcf_joint(frame.name + ".play", frame.motion);
  element.SetAttribute("limited", "true");
  element.SetAttribute("range", mjcf_numbers(Eigen::Vector2d(-play / 2, play / 2)));
  return element;
}

TiXmlElement equality_element(const std::vector<Following>& all) {
  TiXmlElement equality("equality");
  for (const Following& each : all) equality.InsertEndChild(follow_element(each));
  return equality;
}

TiXmlElement body_element(const serial::Frame& frame, const std::vector<Following>& following,
                          const MjcfEffects& effects, const Eigen::Vector3d& parent) {
  TiXmlElement body("body");
  body.SetAttribute("name", frame.name);
  set_mjcf_pose(body, Eigen::Translation3d(-parent) * serial::pose_in_parent(frame, 0));
  const bool moves = frame.motion != serial::Motion::fixed, has_mass = frame.mass.value_or(0) > 0;
  if (moves || has_mass)
    body.InsertEndChild(
        mjcf_inertial(has_mass ? *frame.mass : kNoMjcfMass,
                      has_mass ? frame.com : Eigen::Vector3d(Eigen::Vector3d::Zero())));
  if (!moves) return body;
  body.InsertEndChild(motor_element(frame));
  for (const Following& each : following)
    if (each.joint == frame.name) body.InsertEndChild(mjcf_joint(each.name, frame.motion));
  for (const DeadBand& each : effects.plays)
    if (each.joint == frame.name) body.InsertEndChild(play_element(frame, each.play));
  for (const JointSpring& each : effects.joints) {
    if (each.joint != frame.name) continue;
    TiXmlElement spring = mjcf_joint(frame.name + ".spring", frame.motion);
    set_mjcf_spring(spring, each.compliance);
    body.InsertEndChild(spring);
  }
  return body;
}

/// The bodies that give way between a frame's own and the next one's, whose origin is at `next`.
/// `parent` becomes the last of them; where that stands in the frame's axes.
Eigen::Vector3d add_sprung(const std::string& frame, const MjcfEffects& effects,
                           const Eigen::Vector3d& next, TiXmlElement*& parent) {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  const auto add = [&](SprungBody body) {
    const Eigen::Vector3d place = body.p;
    body.p -= at;
    parent = parent->InsertEndChild(sprung_element(body))->ToElement();
    at = place;
  };
  for (const BodySpring& each : effects.tools)
    if (each.frame == frame) add(mounting_body(each));
  for (const BodySpring& each : effects.links)
    if (each.frame == frame)
      for (const SprungBody& body : bending_bodies(each, next)) add(body);
  return at;
}

}  // namespace

MjcfText mjcf_of(const serial::Model& robot, const MjcfEffects& effects) {
  MjcfText out{{}, effects.left_out};
  TiXmlDocument document;
  TiXmlElement root("mujoco"), compiler("compiler"), option("option");
  root.SetAttribute("model", robot.name);
  compiler.SetAttribute("angle", "radian");
  option.SetAttribute("gravity", mjcf_numbers(robot.gravity));
  root.InsertEndChild(compiler);
  root.InsertEndChild(option);
  TiXmlElement* parent = root.InsertEndChild(TiXmlElement("worldbody"))->ToElement();
  const std::vector<Following> following = followings(robot, effects.drags);
  std::string silent;
  Eigen::Vector3d sprung = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < robot.frames.size(); ++i) {
    const serial::Frame& frame = robot.frames[i];
    parent = parent->InsertEndChild(body_element(frame, following, effects, sprung))->ToElement();
    if (i + 1 < robot.frames.size())
      sprung = add_sprung(frame.name, effects,
                          serial::pose_in_parent(robot.frames[i + 1], 0).translation(), parent);
    if (frame.motion != serial::Motion::fixed && !frame.mass)
      silent += (silent.empty() ? "" : ", ") + frame.name;
  }
  TiXmlElement site("site");
  site.SetAttribute("name", "tool");
  parent->InsertEndChild(site);
  if (!following.empty()) root.InsertEndChild(equality_element(following));
  document.InsertEndChild(root);
  if (!silent.empty())
    out.left_out.push_back("masses of " + silent + ", which the robot file lacks: " +
                           format_number(1e3 * kNoMjcfMass) + " g written, put yours");
  out.left_out.emplace_back(
      "moments of inertia, which a robot file lacks: those of 0.1 m of gyration written, put "
      "yours");
  TiXmlPrinter printer;
  printer.SetIndent("  ");
  document.Accept(&printer);
  out.text = printer.Str();
  return out;
}

}  // namespace selfcal
