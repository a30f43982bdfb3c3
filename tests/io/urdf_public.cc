// Arms from the figures that their makers and drivers publish, with all that drivers put beside
// them: the same locations as urdfdom's poses give, and the data sheets' numbers. Prints the table
// of round trips that tests/README.md has.
#include <gmock/gmock.h>

#include <cstdio>
#include <vector>

#include "io/models/urdf_text.h"
#include "tests/io/urdf_case.h"

namespace selfcal {
namespace {

constexpr double kTrip = 1e-9;  // m, rad: what is asked of a conversion and of the way back

/// One joint as URDFs have it: its origin in the link before, its axis there.
struct PublicJoint {
  const char *xyz, *rpy, *axis;
  bool fixed = false;
};

struct PublicArm {
  const char* name;
  std::vector<PublicJoint> joints;
};

/// What the descriptions of drivers have beside links and joints.
constexpr const char* kDriver =
    R"(<transmission name="t1"><type>transmission_interface/SimpleTransmission</type>
    <joint name="j1"><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>
    <actuator name="m1"><mechanicalReduction>100</mechanicalReduction></actuator></transmission>
  <ros2_control name="arm" type="system"><hardware><plugin>driver/Hardware</plugin><param name="robot_ip">${ip}</param></hardware>
    <joint name="j1"><command_interface name="position"/><state_interface name="position"/></joint></ros2_control>
  <gazebo reference="l1"><material>Gazebo/${colour}</material><plugin name="p" filename="$(find x)/lib.so" speed="${v}"/></gazebo>
  <!-- <safety_controller soft_lower_limit="${0.1 * deg_to_rad}"/> -->
)";

std::string public_urdf(const PublicArm& arm) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + std::string(arm.name) +
                     "\" xmlns:xacro=\"http://ros.org/wiki/xacro\">\n<link name=\"l0\"/>\n";
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const PublicJoint& j = arm.joints[i];
    const std::string at = std::to_string(i + 1);
    text += "<link name=\"l" + at +
            "\"><visual><geometry><mesh filename=\"package://arm/l.stl\"/></geometry></visual>"
            "</link>\n<joint name=\"j" +
            at + "\" type=\"" + (j.fixed ? "fixed" : "revolute") + "\"><origin rpy=\"" + j.rpy +
            "\" xyz=\"" + j.xyz + "\"/><parent link=\"l" + std::to_string(i) +
            "\"/><child link=\"l" + at + "\"/><axis xyz=\"" + j.axis +
            "\"/><limit effort=\"87\" lower=\"-2.9\" upper=\"2.9\" velocity=\"2\"/>"
            "<safety_controller k_position=\"100\" k_velocity=\"40\"/><dynamics damping=\"1\"/>"
            "</joint>\n";
  }
  return text + kDriver + "</robot>\n";
}

constexpr const char *kPi2 = "1.57079632679489661923 0 0",
                     *kMinusPi2 = "-1.57079632679489661923 0 0", *kNoTurn = "0 0 0",
                     *kZAxis = "0 0 1";

const std::vector<PublicArm>& public_arms() {
  static const std::vector<PublicArm> arms = {
      {"UR10e",  // ur_description, default_kinematics
       {{"0 0 0.1807", kNoTurn, kZAxis},
        {"0 0 0", kPi2, kZAxis},
        {"-0.6127 0 0", kNoTurn, kZAxis},
        {"-0.57155 0 0.17415", kNoTurn, kZAxis},
        {"0 -0.11985 0", kPi2, kZAxis},
        {"0 0.11655 0", kMinusPi2, kZAxis},
        {"0 0 0", kNoTurn, kZAxis, true}}},
      {"Panda",  // Franka's control parameters, after Craig
       {{"0 0 0.333", kNoTurn, kZAxis},
        {"0 0 0", kMinusPi2, kZAxis},
        {"0 -0.316 0", kPi2, kZAxis},
        {"0.0825 0 0", kPi2, kZAxis},
        {"-0.0825 0.384 0", kMinusPi2, kZAxis},
        {"0 0 0", kPi2, kZAxis},
        {"0.088 0 0", kPi2, kZAxis},
        {"0 0 0.107", kNoTurn, kZAxis, true}}},
      {"iiwa 14",  // 360, 420, 400 and 126 mm of its data sheet
       {{"0 0 0.1575", kNoTurn, kZAxis},
        {"0 0 0.2025", "1.57079632679489661923 0 3.14159265358979323846", kZAxis},
        {"0 0.2045 0", "1.57079632679489661923 0 3.14159265358979323846", kZAxis},
        {"0 0 0.2155", kPi2, kZAxis},
        {"0 0.1845 0", "-1.57079632679489661923 3.14159265358979323846 0", kZAxis},
        {"0 0 0.2155", kPi2, kZAxis},
        {"0 0.081 0", "-1.57079632679489661923 3.14159265358979323846 0", kZAxis},
        {"0 0 0.045", kNoTurn, kZAxis, true}}},
      {"TALOS, left arm",  // axes along x, y and z of links that all stand upright
       {{"0 0.1575 0.232", kNoTurn, kZAxis},
        {"0.00493 0.1365 0.04673", kNoTurn, "1 0 0"},
        {"0 0 0", kNoTurn, kZAxis},
        {"0.02 0 -0.273", kNoTurn, "0 1 0"},
        {"-0.02 0 -0.2643", kNoTurn, kZAxis},
        {"0 0 0", kNoTurn, "1 0 0"},
        {"0 0 0", kNoTurn, "0 1 0"},
        {"0 0 -0.051", "3.14159265358979323846 0 -1.57079632679489661923", kZAxis, true}}},
  };
  return arms;
}

TEST(PublicUrdfs, HaveTheLocationsOfUrdfdomThereAndBack) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> uniform(-2, 2), moved(-2e-3, 2e-3);
  for (const PublicArm& arm : public_arms()) {
    const std::string text = public_urdf(arm);
    const PoseGap there = gap_of_urdf(text, {}, 200, random);
    EXPECT_LT(there.length, kTrip) << arm.name;
    EXPECT_LT(there.angle, kTrip) << arm.name;
    const auto read = read_urdf(text, "arm.urdf", {});
    ASSERT_TRUE(read) << read.error().what;
    const auto nominal = robot_of(robot_file_of(*read), "nominal.yaml");
    Eigen::VectorXd xi = values(**nominal);
    for (Eigen::Index i = 0; i < xi.size(); ++i)
      if ((*nominal)->parameters()[static_cast<std::size_t>(i)].part != Part::gear)
        xi[i] += moved(random);
    const std::string file = robot_text(**nominal, xi);
    const auto calibrated = robot_of(file, "calibrated.yaml");
    Problems problems;
    const serial::Model model = serial::read(*parse_yaml(file, "calibrated.yaml"), problems);
    const auto made = urdf_like(text, "arm.urdf", *read, corrected_chain(read->chain, model));
    ASSERT_TRUE(made) << made.error().what;
    EXPECT_NE(made->text.find("<mechanicalReduction>100"), std::string::npos);
    const auto back = urdf::parseURDF(made->text);
    PoseGap gap;
    for (int i = 0; i < 200; ++i) {
      UrdfPositions q;
      Eigen::VectorXd readings(static_cast<Eigen::Index>((*calibrated)->joints().size()));
      for (Eigen::Index j = 0; j < readings.size(); ++j)
        q["j" + std::to_string(j + 1)] = readings[j] = uniform(random);
      gap.add(urdf_pose(*back, read->ends.base, q).inverse() * urdf_pose(*back, read->ends.tip, q),
              pose_of(locate(**calibrated, values(**calibrated), readings)));
    }
    EXPECT_LT(gap.length, kTrip) << arm.name;
    EXPECT_LT(gap.angle, kTrip) << arm.name;
    std::printf("| %s | URDF | %.1e m, %.1e rad | %.1e m, %.1e rad |\n", arm.name, there.length,
                there.angle, gap.length, gap.angle);
  }
}

TEST(PublicUrdfs, OfAPandaAreItsMakersDhTable) {
  const auto chain = read_urdf(public_urdf(public_arms()[1]), "panda.urdf", {});
  ASSERT_TRUE(chain);
  const serial::Model model = frames_of(chain->chain);
  const double q = M_PI / 2;
  const double table[7][3] = {{0, 0, 0},      {-q, 0, 0},           {q, 0, 0.316},
                              {q, 0.0825, 0}, {-q, -0.0825, 0.384}, {q, 0, 0},
                              {q, 0.088, 0}};
  for (int j = 0; j < 7; ++j) {  // alpha, a, d as Franka writes them; d of the first is in the base
    const serial::Frame& frame = model.frames[static_cast<std::size_t>(j + 1)];
    EXPECT_NEAR(frame.value[serial::kAlpha], table[j][0], 1e-12) << frame.name;
    EXPECT_NEAR(frame.value[serial::kD], table[j][1], 1e-12) << frame.name;
    EXPECT_NEAR(frame.value[serial::kR], table[j][2], 1e-12) << frame.name;
  }
}

TEST(PublicUrdfs, OfAnIiwaHaveItsDataSheetsLengths) {
  const auto read = read_urdf(public_urdf(public_arms()[2]), "iiwa.urdf", {});
  ASSERT_TRUE(read);
  const auto robot = robot_of(robot_file_of(*read), "iiwa.yaml");
  ASSERT_TRUE(robot);
  // Stretched up: 360 + 420 + 400 + 126 mm.
  const Eigen::Vector3d up = locate(**robot, values(**robot), Eigen::VectorXd::Zero(7)).p;
  EXPECT_LT((up - Eigen::Vector3d(0, 0, 1.306)).norm(), 1e-12);
}

}  // namespace
}  // namespace selfcal
