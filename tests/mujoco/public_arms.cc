#include "tests/mujoco/public_arms.h"

#include <Eigen/Geometry>
#include <sstream>

#include "tests/mujoco/arm.h"

namespace selfcal::mujoco {
namespace {

constexpr const char* kNone = "0 0 0";
constexpr const char* kStraight = "1 0 0 0";
constexpr const char* kAboutX = "1 1 0 0";       // a quarter turn
constexpr const char* kBackAboutX = "1 -1 0 0";  // and back
constexpr const char* kAboutY = "1 0 1 0";
constexpr const char* kHalfAboutYz = "0 0 1 1";

PublicArm ur10e() {
  return {"ur10e",
          {{"shoulder_pan", "0 0 0.1807", "1 0 0 1", "0 0 1", -6.28, 6.28, 7.369, "0 0 0"},
           {"shoulder_lift", "0 0.176 0", kAboutY, "0 1 0", -6.28, 6.28, 13.051, "0 0 0.3065"},
           {"elbow", "0 -0.137 0.6127", kStraight, "0 1 0", -3.14, 3.14, 3.989, "0 0 0.2855"},
           {"wrist_1", "0 0 0.57155", kAboutY, "0 1 0", -6.28, 6.28, 2.1, "0 0.13515 0"},
           {"wrist_2", "0 0.13515 0", kStraight, "0 0 1", -6.28, 6.28, 1.98, "0 0 0.11985"},
           {"wrist_3", "0 0 0.11985", kStraight, "0 1 0", -6.28, 6.28, 0.615, "0 0.092 0"}},
          "0 0.11655 0",
          "-1 1 0 0",
          3500};
}

PublicArm iiwa14() {
  return {
      "iiwa14",
      {{"joint1", "0 0 0.1575", kStraight, "0 0 1", -2.967, 2.967, 5.76, "0 -0.03 0.12"},
       {"joint2", "0 0 0.2025", kHalfAboutYz, "0 0 1", -2.094, 2.094, 6.35, "0.0003 0.059 0.042"},
       {"joint3", "0 0.2045 0", kHalfAboutYz, "0 0 1", -2.967, 2.967, 3.5, "0 0.03 0.13"},
       {"joint4", "0 0 0.2155", kAboutX, "0 0 1", -2.094, 2.094, 3.5, "0 0.067 0.034"},
       {"joint5", "0 0.1845 0", kHalfAboutYz, "0 0 1", -2.967, 2.967, 3.5, "0.0001 0.021 0.076"},
       {"joint6", "0 0 0.2155", kAboutX, "0 0 1", -2.094, 2.094, 1.8, "0 0.0006 0.0004"},
       {"joint7", "0 0.081 0", kHalfAboutYz, "0 0 1", -3.054, 3.054, 1.2, "0 0 0.02"}},
      "0 0 0.045",
      kStraight,
      2000};
}

PublicArm panda() {
  return {
      "panda",
      {{"joint1", "0 0 0.333", kStraight, "0 0 1", -2.897, 2.897, 4.971,
        "0.003875 0.002081 -0.1750"},
       {"joint2", kNone, kBackAboutX, "0 0 1", -1.763, 1.763, 0.647, "-0.003141 -0.02872 0.003495"},
       {"joint3", "0 -0.316 0", kAboutX, "0 0 1", -2.897, 2.897, 3.229,
        "0.027518 0.039252 -0.066502"},
       {"joint4", "0.0825 0 0", kAboutX, "0 0 1", -3.072, -0.07, 3.588,
        "-0.05317 0.104419 0.027454"},
       {"joint5", "-0.0825 0.384 0", kBackAboutX, "0 0 1", -2.897, 2.897, 1.226,
        "-0.011953 0.041065 -0.038437"},
       {"joint6", kNone, kAboutX, "0 0 1", -0.017, 3.752, 1.667, "0.060149 -0.014117 -0.010517"},
       {"joint7", "0.088 0 0", kAboutX, "0 0 1", -2.897, 2.897, 0.736,
        "0.010517 -0.004252 0.061597"}},
      "0 0 0.107",
      "0.3826834 0 0 0.9238795",
      4500};
}

/// The body's frame with what it is off, in its own axes.
class Moved {
 public:
  Moved(const char* place, const char* turn, double shift, double angle, Random& random) {
    std::istringstream from_place(place), from_turn(turn);
    from_place >> place_.x() >> place_.y() >> place_.z();
    from_turn >> turn_.w() >> turn_.x() >> turn_.y() >> turn_.z();
    turn_.normalize();
    const auto drawn = [&](double sigma) {
      return Eigen::Vector3d(sigma * normal(random), sigma * normal(random),
                             sigma * normal(random));
    };
    place_ += turn_ * drawn(shift);
    const Eigen::Vector3d by = drawn(angle);
    if (by.norm() > 0)
      turn_ = turn_ * Eigen::Quaterniond(Eigen::AngleAxisd(by.norm(), by.normalized()));
  }

  void write(std::ostream& out) const {
    out << "pos='" << place_.transpose() << "' quat='" << turn_.w() << ' '
        << turn_.vec().transpose() << "'";
  }

 private:
  Eigen::Vector3d place_;
  Eigen::Quaterniond turn_;
};

void write_body(std::ostream& out, const ArmBody& body, const Moved& at, double compliance) {
  out << "<body name='" << body.joint << ".link' ";
  at.write(out);
  out << ">\n<inertial pos='" << body.com << "' mass='" << body.mass
      << "' diaginertia='0.1 0.1 0.1'/>\n<joint name='" << body.joint << "' axis='" << body.axis
      << "' range='" << body.lower << ' ' << body.upper << "' damping='100' armature='0.1'/>\n";
  if (compliance > 0)
    out << "<joint name='" << body.joint << ".gives' axis='" << body.axis << "' limited='false' "
        << "stiffness='" << 1 / compliance << "'/>\n";
}

}  // namespace

std::vector<PublicArm> public_arms() { return {ur10e(), iiwa14(), panda()}; }

std::string mjcf(const PublicArm& arm, const Hidden& hidden, unsigned seed) {
  Random random(seed);
  std::ostringstream out;
  out.precision(17);
  out << "<mujoco model='" << arm.name
      << "'>\n<compiler angle='radian' autolimits='true'/>\n<worldbody>\n";
  for (std::size_t i = 0; i < arm.bodies.size(); ++i) {
    const ArmBody& body = arm.bodies[i];
    const Moved at(body.place, body.turn, i == 0 ? hidden.base : hidden.place,
                   i == 0 ? hidden.base : hidden.turn, random);
    write_body(out, body, at, body.joint == hidden.joint ? hidden.compliance : 0);
  }
  const Moved tool(arm.tool_place, arm.tool_turn, hidden.place, 0, random);
  if (hidden.payload > 0) {
    out << "<body name='payload' ";
    tool.write(out);
    out << "><inertial pos='0 0 0' mass='" << hidden.payload
        << "' diaginertia='0.01 0.01 0.01'/></body>\n";
  }
  out << "<site name='tool' ";
  tool.write(out);
  out << "/>\n";
  for (std::size_t i = 0; i < arm.bodies.size(); ++i) out << "</body>\n";
  out << "</worldbody>\n<actuator>\n";
  for (const ArmBody& body : arm.bodies)
    out << "<position joint='" << body.joint << "' kp='" << arm.gain << "'/>\n";
  out << "</actuator>\n</mujoco>\n";
  return out.str();
}

}  // namespace selfcal::mujoco
