// Frames as bodies. MuJoCo takes no moving body without mass and inertia, which a robot file may
// lack: what it lacks is put small, or as of a link of an arm's thickness, and said.
#include "io/models/mjcf_text.h"

#include <tinyxml.h>

namespace selfcal {
namespace {

constexpr double kNoMass = 1e-6;      // kg, of a link whose mass the robot file lacks
constexpr double kGyration = 0.1;     // m, radius of gyration, which no robot file has
constexpr double kSpringTime = 0.01;  // s, in which a spring comes to rest by its damping
constexpr double kPiGrace = 1e-12;    // of a quaternion's sign

std::string numbers(const Eigen::VectorXd& v) {
  std::string text;
  for (const double each : v) text += (text.empty() ? "" : " ") + format_number(each + 0.0);
  return text;
}

void set_pose(TiXmlElement& element, const Eigen::Isometry3d& X) {
  Eigen::Quaterniond q(X.linear());
  if (q.w() < -kPiGrace) q.coeffs() *= -1;
  element.SetAttribute("pos", numbers(X.translation()));
  element.SetAttribute("quat", numbers(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z())));
}

TiXmlElement inertial_element(double mass, const Eigen::Vector3d& com) {
  TiXmlElement element("inertial");
  element.SetAttribute("pos", numbers(com));
  element.SetAttribute("mass", format_number(mass));
  element.SetAttribute("diaginertia",
                       numbers(Eigen::Vector3d::Constant(mass * kGyration * kGyration)));
  return element;
}

TiXmlElement moving_element(const std::string& name, serial::Motion motion) {
  TiXmlElement element("joint");
  element.SetAttribute("name", name);
  element.SetAttribute("type", motion == serial::Motion::prismatic ? "slide" : "hinge");
  element.SetAttribute("axis", "0 0 1");
  return element;
}

TiXmlElement motor_element(const serial::Frame& frame) {
  TiXmlElement element = moving_element(frame.name, frame.motion);
  if (!(frame.lower < frame.upper)) return element;
  element.SetAttribute("limited", "true");
  element.SetAttribute("range", numbers(Eigen::Vector2d(frame.lower, frame.upper)));
  return element;
}

TiXmlElement spring_element(const serial::Frame& frame, double compliance) {
  TiXmlElement element = moving_element(frame.name + ".spring", frame.motion);
  element.SetAttribute("stiffness", format_number(1 / compliance));
  element.SetAttribute("damping", format_number(kSpringTime / compliance));
  return element;
}

/// What a joint moves beside its own reading, in proportion to the reading of one (11.16).
struct Following {
  std::string joint, leader, name;
  double factor = 0;
};

std::vector<Following> followings(const serial::Model& robot) {
  const std::vector<int> moving = serial::moving_frames(robot);
  const auto n = static_cast<Eigen::Index>(moving.size());
  const Eigen::MatrixXd coupling =
      robot.coupling.size() > 0 ? robot.coupling : Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n));
  const auto frame = [&](Eigen::Index j) -> const serial::Frame& {
    return robot.frames[static_cast<size_t>(moving[static_cast<size_t>(j)])];
  };
  std::vector<Following> list;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double factor = coupling(j, i) * frame(i).gear - (i == j ? 1 : 0);
      if (factor != 0)
        list.push_back(
            {frame(j).name, frame(i).name, frame(j).name + ".of." + frame(i).name, factor});
    }
  return list;
}

TiXmlElement equality_element(const std::vector<Following>& all) {
  TiXmlElement equality("equality");
  for (const Following& each : all) {
    TiXmlElement joint("joint");
    joint.SetAttribute("joint1", each.name);
    joint.SetAttribute("joint2", each.leader);
    joint.SetAttribute("polycoef", "0 " + format_number(each.factor) + " 0 0 0");
    equality.InsertEndChild(joint);
  }
  return equality;
}

TiXmlElement body_element(const serial::Frame& frame, const std::vector<Following>& following,
                          const std::vector<JointSpring>& springs) {
  TiXmlElement body("body");
  body.SetAttribute("name", frame.name);
  set_pose(body, serial::pose_in_parent(frame, 0));
  const bool moves = frame.motion != serial::Motion::fixed, has_mass = frame.mass.value_or(0) > 0;
  if (moves || has_mass)
    body.InsertEndChild(
        inertial_element(has_mass ? *frame.mass : kNoMass,
                         has_mass ? frame.com : Eigen::Vector3d(Eigen::Vector3d::Zero())));
  if (!moves) return body;
  body.InsertEndChild(motor_element(frame));
  for (const Following& each : following)
    if (each.joint == frame.name) body.InsertEndChild(moving_element(each.name, frame.motion));
  for (const JointSpring& spring : springs)
    if (spring.joint == frame.name) body.InsertEndChild(spring_element(frame, spring.compliance));
  return body;
}

}  // namespace

MjcfText mjcf_of(const serial::Model& robot, const std::vector<JointSpring>& springs) {
  MjcfText out;
  TiXmlDocument document;
  TiXmlElement root("mujoco"), compiler("compiler"), option("option");
  root.SetAttribute("model", robot.name);
  compiler.SetAttribute("angle", "radian");
  option.SetAttribute("gravity", numbers(robot.gravity));
  root.InsertEndChild(compiler);
  root.InsertEndChild(option);
  TiXmlElement* parent = root.InsertEndChild(TiXmlElement("worldbody"))->ToElement();
  const std::vector<Following> following = followings(robot);
  std::string silent;
  for (const serial::Frame& frame : robot.frames) {
    parent = parent->InsertEndChild(body_element(frame, following, springs))->ToElement();
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
                           format_number(1e3 * kNoMass) + " g written, put yours");
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
