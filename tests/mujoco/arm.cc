#include "tests/mujoco/arm.h"

#include <algorithm>
#include <numbers>
#include <sstream>

namespace selfcal::mujoco {
namespace {

using Eigen::Vector3d;

constexpr double kRight = std::numbers::pi / 2;

// Of the servos: so stiff and so damped that the arm follows in some 10 ms without swinging.
constexpr double kServoStiffness = 1e6, kServoDamping = 6e3;  // N m/rad, N m s/rad
constexpr double kRotor = 1;                                  // kg m^2, behind the gear
// Damps the swinging of 15 kg m^2 on a spring of 2e5 N m/rad to 0.7.
constexpr double kSpringDamping = 2400;
// Contacts are reported from here on (m), without force until the bodies meet.
constexpr double kReported = 1e-3;

std::ostringstream writer() {
  std::ostringstream out;
  out.precision(17);
  return out;
}

std::string place(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Vector3d p = X.translation();
  std::ostringstream out = writer();
  out << "pos='" << p.x() << ' ' << p.y() << ' ' << p.z() << "' quat='" << q.w() << ' ' << q.x()
      << ' ' << q.y() << ' ' << q.z() << '\'';
  return out.str();
}

std::string body(const ArmFrame& frame) {
  std::ostringstream out = writer();
  out << "<body name='" << frame.name << "' " << place(frame.pose()) << ">\n";
  if (frame.mass > 0) {
    const double inertia = 0.01 * frame.mass;  // 0.1 m of gyration: a touch is all but static
    out << "<inertial pos='" << frame.com.transpose() << "' mass='" << frame.mass
        << "' diaginertia='" << inertia << ' ' << inertia << ' ' << inertia << "'/>\n";
  }
  if (frame.turns)
    out << "<joint name='" << frame.name << "' axis='0 0 1' armature='" << kRotor << "' damping='"
        << kServoDamping << "'/>\n";
  if (frame.compliance > 0)
    out << "<joint name='" << frame.name << ".spring' axis='0 0 1' stiffness='"
        << 1 / frame.compliance << "' springref='0' damping='" << kSpringDamping << "'/>\n";
  return out.str();
}

std::string plane(const Plate& plate) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = plate.distance * plate.normal;
  X.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), plate.normal)
                   .normalized()
                   .toRotationMatrix();
  std::ostringstream out = writer();
  out << "<geom name='" << plate.name << "' type='plane' size='0 0 1' " << place(X) << " margin='"
      << kReported << "' gap='" << kReported << "'/>\n";
  return out.str();
}

}  // namespace

double uniform(Random& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}
double normal(Random& random) { return std::normal_distribution<double>()(random); }

Eigen::Isometry3d ArmFrame::pose() const {
  return Eigen::AngleAxisd(beta, Vector3d::UnitY()) * Eigen::AngleAxisd(alpha, Vector3d::UnitX()) *
         Eigen::Translation3d(d, 0, 0) * Eigen::AngleAxisd(theta, Vector3d::UnitZ()) *
         Eigen::Translation3d(0, 0, r);
}

ArmFrame& Arm::frame(const std::string& name) {
  return *std::find_if(frames.begin(), frames.end(),
                       [&](const ArmFrame& each) { return each.name == name; });
}

Arm draw_arm(Random& random) {
  const auto about = [&](double length) { return length * uniform(random, 0.9, 1.1); };
  ArmFrame base, tool;
  base.name = "base";
  tool.name = "tool";
  base.turns = tool.turns = false;
  tool.alpha = uniform(random, 0.2, 1);
  tool.d = uniform(random, 0.03, 0.15);
  tool.theta = uniform(random, 0, 1.5);
  tool.r = uniform(random, 0.12, 0.2);
  tool.mass = uniform(random, 1, 4);
  tool.com = {0, 0, -0.05};
  // Name, turns; alpha d theta r beta; limits; mass and its centre.
  return {{base,
           {"j1", true, 0, 0, 0, about(0.1273), 0, -3.1, 3.1, 7.8, {0, 0.02, 0}},
           {"j2", true, kRight, 0, 0, 0, 0, -2.6, -0.28, 12.9, {-0.24, 0, 0.16}},
           {"j3", true, 0, -about(0.612), 0, 0, 0, -2.4, 2.4, 3.9, {-0.29, 0, 0.07}},
           {"j4", true, 0, -about(0.5723), 0, about(0.1639), 0, -3.1, 3.1, 2, {0, -0.01, 0.02}},
           {"j5", true, kRight, 0, 0, about(0.1157), 0, -2.6, 2.6, 2, {0, 0.01, 0.02}},
           {"j6", true, -kRight, 0, 0, about(0.0922), 0, -3.1, 3.1, 0.4, {0, 0, -0.02}},
           tool}};
}

Arm draw_built(Arm arm, Random& random) {
  for (ArmFrame& frame : arm.frames) {
    const double off = frame.turns ? 5e-4 : 3e-3;
    for (double* each : {&frame.alpha, &frame.d, &frame.theta, &frame.r, &frame.beta})
      *each += off * normal(random);
    frame.mass *= 1 + 0.03 * normal(random);
    for (double& each : frame.com) each += 3e-3 * normal(random);
  }
  return arm;
}

std::vector<Plate> draw_plates(Random& random) {
  std::vector<Plate> plates = {{"floor", {0.05, -0.09, 1}, uniform(random, 0.1, 0.3)},
                               {"front", {-1, -0.11, -0.09}, -uniform(random, 0.6, 0.8)},
                               {"left", {-0.1, -1, 0.15}, -uniform(random, 0.6, 0.8)},
                               {"right", {0.6, 0.7, -0.38}, -uniform(random, 0.6, 0.8)}};
  for (Plate& plate : plates) {
    for (double& each : plate.normal) each += 0.06 * normal(random);
    plate.normal.normalize();
  }
  return plates;
}

std::string robot_yaml(const Arm& arm) {
  std::ostringstream out = writer();
  out << "robot: arm\nkind: serial\ngravity: [0, 0, -9.81]\nframes:\n";
  for (const ArmFrame& f : arm.frames) {
    out << "  - {name: " << f.name << ", joint: " << (f.turns ? "revolute" : "fixed")
        << ", alpha: " << f.alpha << ", d: " << f.d << ", theta: " << f.theta << ", r: " << f.r
        << ", beta: " << f.beta;
    if (f.turns) out << ", limits: [" << f.lower << ", " << f.upper << "]";
    if (f.mass > 0)
      out << ", mass: " << f.mass << ", com: [" << f.com.x() << ", " << f.com.y() << ", "
          << f.com.z() << "]";
    out << "}\n";
  }
  return out.str();
}

std::string mjcf(const Arm& arm, const std::vector<Plate>& plates) {
  std::ostringstream out = writer();
  out << "<mujoco model='arm'>\n<compiler angle='radian'/>\n"
      << "<option timestep='0.001' gravity='0 0 -9.81'/>\n<worldbody>\n";
  for (const Plate& plate : plates) out << plane(plate);
  for (const ArmFrame& frame : arm.frames) out << body(frame);
  out << "<geom name='tip' type='sphere' size='" << kBall << "'/>\n";
  for (size_t i = 0; i < arm.frames.size(); ++i) out << "</body>";
  out << "\n</worldbody>\n<actuator>\n";
  for (const ArmFrame& frame : arm.frames)
    if (frame.turns)
      out << "<position name='" << frame.name << "' joint='" << frame.name << "' kp='"
          << kServoStiffness << "'/>\n";
  out << "</actuator>\n</mujoco>\n";
  return out.str();
}

}  // namespace selfcal::mujoco
