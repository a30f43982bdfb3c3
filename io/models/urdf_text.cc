// URDF written with TinyXML. An origin is Trans(xyz) Rot(z, yaw) Rot(y, pitch) Rot(x, roll), from
// the parent link to the joint's frame, which is the child link's.
#include "io/models/urdf_text.h"

#include <tinyxml.h>

#include <algorithm>
#include <cmath>

#include "kinematics/rotation.h"

namespace selfcal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kUnmoved = 1e-11;   // m, rad: an origin that keeps its digits
constexpr double kLastDigit = 1e15;  // of a metre, of a radian

// <calibration rising falling> is where a homing switch is (urdf's JointCalibration), which a
// corrected origin does not move.
constexpr const char* kWhereItIs =
    " Calibrated by selfcal: the origins of the joints hold all of it, their offsets included. "
    "Give the driver no kinematics file and no joint offsets beside them; a calibration element "
    "tells where a homing switch is, and is as it was. ";

/// Without what products of rotations leave behind the last digit.
std::string three_numbers(const Vector3d& v) {
  std::string text;
  for (const double each : v) {
    const double rounded = std::round(each * kLastDigit) / kLastDigit;
    text += (text.empty() ? "" : " ") + format_number(rounded + 0.0);  // no sign at zero
  }
  return text;
}

void set_origin(TiXmlElement& element, const Isometry3d& X) {
  TiXmlElement* origin = element.FirstChildElement("origin");
  if (!origin) origin = element.InsertEndChild(TiXmlElement("origin"))->ToElement();
  origin->SetAttribute("xyz", three_numbers(X.translation()));
  origin->SetAttribute("rpy", three_numbers(rpy_of(X.linear())));
}

std::string printed_xml(const TiXmlDocument& document) {
  TiXmlPrinter printer;
  printer.SetIndent("  ");
  document.Accept(&printer);
  return printer.Str();
}

TiXmlElement* find_joint_element(TiXmlDocument& document, const std::string& name) {
  TiXmlElement* root = document.RootElement();
  for (auto* e = root->FirstChildElement("joint"); e; e = e->NextSiblingElement("joint"))
    if (const char* found = e->Attribute("name"); found && name == found) return e;
  return nullptr;
}

bool unmoved(const Isometry3d& a, const Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() < kUnmoved;
}

/// Poses of the steps' child links with the corrections.
std::vector<Isometry3d> corrected_links(const UrdfChain& read, const CorrectedChain& corrected,
                                        std::vector<std::string>& left_out) {
  std::vector<Isometry3d> poses;
  size_t joint = 0, fixed = 0;
  for (const UrdfStep& step : read.steps)
    poses.push_back(step.moves ? corrected.chain.joints[joint++].X_WJ
                               : corrected.chain.fixed[fixed++].X_WF);
  if (!read.steps.back().moves)
    poses.back() = corrected.chain.X_WT;
  else if (!unmoved(poses.back(), corrected.chain.X_WT))
    left_out.push_back("the tool's correction, for " + read.ends.tip +
                       " is what the last joint moves: give a --tip that is fixed to it");
  return poses;
}

TiXmlElement named_element(const char* kind, const std::string& name) {
  TiXmlElement element(kind);
  element.SetAttribute("name", name);
  return element;
}

void add_reference(TiXmlElement& joint, const char* what, const std::string& link) {
  TiXmlElement element(what);
  element.SetAttribute("link", link);
  joint.InsertEndChild(element);
}

TiXmlElement link_element(const serial::Frame& frame) {
  TiXmlElement link = named_element("link", frame.name);
  if (!frame.mass || *frame.mass <= 0) return link;
  TiXmlElement inertial("inertial"), origin("origin"), mass("mass"), inertia("inertia");
  origin.SetAttribute("xyz", three_numbers(frame.com));
  mass.SetAttribute("value", format_number(*frame.mass));
  for (const char* moment : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
    inertia.SetAttribute(moment, "0");
  inertial.InsertEndChild(origin);
  inertial.InsertEndChild(mass);
  inertial.InsertEndChild(inertia);
  link.InsertEndChild(inertial);
  return link;
}

/// Between what a joint's position is, rad or m.
struct Range {
  double lower = 0, upper = 0;
  bool limited() const { return lower < upper; }
};

/// By frame, of those that move: coupling times gear times the readings within their limits;
/// without limits where one of these has none.
std::vector<Range> ranges_of(const serial::Model& robot) {
  const std::vector<int> moving = serial::moving_frames(robot);
  std::vector<Range> ranges(robot.frames.size());
  for (size_t j = 0; j < moving.size(); ++j) {
    Range range;
    bool limited = true;
    for (size_t k = 0; k < moving.size(); ++k) {
      const serial::Frame& by = robot.frames[static_cast<size_t>(moving[k])];
      const double factor =
          by.gear * (robot.coupling.size() > 0 ? robot.coupling(static_cast<Eigen::Index>(j),
                                                                static_cast<Eigen::Index>(k))
                                               : (j == k ? 1 : 0));
      if (factor == 0) continue;
      limited = limited && by.lower < by.upper;
      range.lower += std::min(factor * by.lower, factor * by.upper);
      range.upper += std::max(factor * by.lower, factor * by.upper);
    }
    if (limited) ranges[static_cast<size_t>(moving[j])] = range;
  }
  return ranges;
}

TiXmlElement joint_element(const serial::Frame& frame, const Range& range,
                           const std::string& parent) {
  using serial::Motion;
  TiXmlElement joint = named_element("joint", frame.name);
  const bool limited = range.limited();
  const bool moves = frame.motion != Motion::fixed;
  joint.SetAttribute("type", !moves                              ? "fixed"
                             : frame.motion == Motion::prismatic ? "prismatic"
                             : limited                           ? "revolute"
                                                                 : "continuous");
  add_reference(joint, "parent", parent);
  add_reference(joint, "child", frame.name);
  set_origin(joint, serial::pose_in_parent(frame, 0));
  if (!moves) return joint;
  TiXmlElement axis("axis"), limit("limit");
  axis.SetAttribute("xyz", "0 0 1");
  joint.InsertEndChild(axis);
  if (!limited && frame.motion == Motion::revolute) return joint;
  limit.SetAttribute("lower", format_number(limited ? range.lower : -1));
  limit.SetAttribute("upper", format_number(limited ? range.upper : 1));
  limit.SetAttribute("effort", "0");
  limit.SetAttribute("velocity", "0");
  joint.InsertEndChild(limit);
  return joint;
}

}  // namespace

Result<UrdfText> urdf_like(const std::string& text, const std::string& file, const UrdfChain& read,
                           const CorrectedChain& corrected) {
  for (const UrdfStep& step : read.steps)
    if (step.reversed)
      return bad_input(file + ": the chain from '" + read.ends.base + "' to '" + read.ends.tip +
                       "' goes up the tree at joint '" + step.joint +
                       "': its origins are given from the root, so take a --base above the --tip");
  UrdfText out{{}, corrected.left_out};
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  const std::vector<Isometry3d> poses = corrected_links(read, corrected, out.left_out);
  Isometry3d parent = Isometry3d::Identity(), parent_before = parent;
  for (size_t s = 0; s < poses.size(); ++s) {
    const Isometry3d X = parent.inverse() * poses[s];
    const Isometry3d before = parent_before.inverse() * read.steps[s].X_WC;
    TiXmlElement* element = find_joint_element(document, read.steps[s].joint);
    if (element && !unmoved(X, before)) set_origin(*element, X);
    parent = poses[s];
    parent_before = read.steps[s].X_WC;
  }
  if (TiXmlElement* root = document.RootElement()) {
    const TiXmlComment note(kWhereItIs);
    if (TiXmlNode* first = root->FirstChild())
      root->InsertBeforeChild(first, note);
    else
      root->InsertEndChild(note);
  }
  out.text = printed_xml(document);
  return out;
}

UrdfText urdf_of(const serial::Model& robot) {
  UrdfText out;
  TiXmlDocument document;
  document.InsertEndChild(TiXmlDeclaration("1.0", "UTF-8", ""));
  TiXmlElement root = named_element("robot", robot.name);
  std::string parent = "world";
  while (std::ranges::find(robot.frames, parent, &serial::Frame::name) != robot.frames.end())
    parent += "_";
  root.InsertEndChild(named_element("link", parent));
  bool masses = false;
  const std::vector<Range> ranges = ranges_of(robot);
  for (size_t f = 0; f < robot.frames.size(); ++f) {
    const serial::Frame& frame = robot.frames[f];
    root.InsertEndChild(link_element(frame));
    root.InsertEndChild(joint_element(frame, ranges[f], parent));
    parent = frame.name;
    masses = masses || frame.mass.has_value();
    if (frame.motion == serial::Motion::prismatic && !ranges[f].limited())
      out.left_out.push_back("limits of joint " + frame.name +
                             ", which a URDF asks for and the robot file lacks: -1 to 1 m written");
  }
  document.InsertEndChild(root);
  out.left_out.emplace_back(
      "greatest efforts and velocities, which a robot file lacks: 0 written, put yours");
  if (masses)
    out.left_out.emplace_back("moments of inertia, which a robot file lacks: 0 written, put yours");
  out.text = printed_xml(document);
  return out;
}

}  // namespace selfcal
