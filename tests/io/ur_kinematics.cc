// The kinematics file of Universal Robots' driver, of a calibrated robot and as one.
#include "io/models/ur_kinematics.h"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include "tests/io/calibrated_case.h"
#include "tests/io/urdf_case.h"

namespace selfcal {
namespace {

using testing::HasSubstr;

/// ur_description's default_kinematics of the UR10e, in full digits, with a hash.
constexpr const char* kUr = R"(kinematics:
  shoulder: {x: 0, y: 0, z: 0.1807, roll: 0, pitch: 0, yaw: 0}
  upper_arm: {x: 0, y: 0, z: 0, roll: 1.5707963267948966, pitch: 0, yaw: 0}
  forearm: {x: -0.6127, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}
  wrist_1: {x: -0.57155, y: 0, z: 0.17415, roll: 0, pitch: 0, yaw: 0}
  wrist_2: {x: 0, y: -0.11985, z: 0, roll: 1.5707963267948966, pitch: 0, yaw: 0}
  wrist_3: {x: 0, y: 0.11655, z: 0, roll: -1.5707963267948966, pitch: 0, yaw: 0}
  hash: calib_12788084448423163542
)";

/// The maker's table in our frames, calibrated: alpha d theta r beta.
constexpr const char* kUrRobot = R"(robot: ur10e
kind: serial
frames:
  - {name: j1, joint: revolute, r: 0.1807, theta: 0.002, nominal: {theta: 0}}
  - {name: j2, joint: revolute, alpha: 1.5718, nominal: {alpha: pi/2}}
  - {name: j3, joint: revolute, d: -0.6131, beta: 0.001, nominal: {d: -0.6127, beta: 0}}
  - {name: j4, joint: revolute, d: -0.57155, r: 0.1743, theta: -0.003, nominal: {r: 0.17415, theta: 0}}
  - {name: j5, joint: revolute, alpha: pi/2, r: 0.11985}
  - {name: j6, joint: revolute, alpha: -1.5702, r: 0.1168, nominal: {alpha: -pi/2, r: 0.11655}}
)";

/// The product of the poses of a kinematics file, each turned about its z.
Eigen::Isometry3d ur_pose(const YAML::Node& file, const Eigen::VectorXd& q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  int j = 0;
  for (const char* name : {"shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"}) {
    const auto at = [&](const char* key) { return file[name][key].as<double>(); };
    X.translate(Eigen::Vector3d(at("x"), at("y"), at("z")));
    X.rotate(Eigen::AngleAxisd(at("yaw"), Eigen::Vector3d::UnitZ()) *
             Eigen::AngleAxisd(at("pitch"), Eigen::Vector3d::UnitY()) *
             Eigen::AngleAxisd(at("roll"), Eigen::Vector3d::UnitX()));
    X.rotate(Eigen::AngleAxisd(q[j++], Eigen::Vector3d::UnitZ()));
  }
  return X;
}

TEST(UrKinematics, PutsWrist3WhereTheCalibratedRobotHasItAndKeepsTheHash) {
  const auto original = read_ur_kinematics(kUr, "ur.yaml");
  ASSERT_TRUE(original) << original.error().what;
  const CorrectedChain chain = corrected_chain(original->chain, model_in(kUrRobot));
  ASSERT_EQ(chain.problem, "");
  const YAML::Node file = YAML::Load(ur_kinematics_text(chain.chain, original->hash))["kinematics"];
  EXPECT_EQ(file["hash"].as<std::string>(), "calib_12788084448423163542");
  const auto robot = robot_of(kUrRobot, "ur.robot.yaml");
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(-3, 3);
  PoseGap gap;
  for (int i = 0; i < 50; ++i) {
    Eigen::VectorXd q(6);
    for (double& each : q) each = uniform(random);
    gap.add(ur_pose(file, q), pose_of(locate(**robot, values(**robot), q)));
  }
  EXPECT_LT(gap.length, kAsGood);
  EXPECT_LT(gap.angle, kAsGood);
}

TEST(UrKinematics, AsARobotFileHasWrist3WhereItsPosesHaveIt) {
  // As a controller's calibration is: elbow and shoulder parallel to a few mrad only.
  const std::string calibrated = R"(kinematics:
  shoulder: {x: 0, y: 0, z: 0.1809, roll: 0, pitch: 0, yaw: 2.1e-05}
  upper_arm: {x: 0.0002, y: 0, z: 0, roll: 1.5712, pitch: 0, yaw: -3.0e-05}
  forearm: {x: -0.6131, y: 0, z: 0, roll: 3.13854, pitch: 3.14008, yaw: 3.14148}
  wrist_1: {x: -0.5717, y: 0.00042, z: 0.1739, roll: 0.00241, pitch: 0.00107, yaw: 1.1e-05}
  wrist_2: {x: 4.4e-05, y: -0.1199, z: 0.00011, roll: 1.5699, pitch: 0, yaw: 2.3e-05}
  wrist_3: {x: -7.9e-05, y: 0.1164, z: -0.00023, roll: -1.5705, pitch: -3.14159, yaw: 3.14155}
  hash: calib_1
)";
  for (const std::string& text : {std::string(kUr), calibrated}) {
    const auto read = read_ur_kinematics(text, "ur.yaml");
    ASSERT_TRUE(read) << read.error().what;
    const auto robot = robot_of(write_yaml(serial::write(frames_of(read->chain))), "ur.robot.yaml");
    ASSERT_TRUE(robot) << robot.error().what;
    const YAML::Node file = YAML::Load(text)["kinematics"];
    std::mt19937_64 random(14);
    std::uniform_real_distribution<double> uniform(-3, 3);
    PoseGap gap;
    for (int i = 0; i < 50; ++i) {
      Eigen::VectorXd q(6);
      for (double& each : q) each = uniform(random);
      gap.add(ur_pose(file, q), pose_of(locate(**robot, values(**robot), q)));
    }
    EXPECT_LT(gap.length, kAsGood);
    EXPECT_LT(gap.angle, kAsGood);
  }
}

TEST(UrKinematics, IsRefusedWithTheLine) {
  std::string text = kUr;
  text.replace(text.find("pitch: 0"), 8, "pitch: x");
  const auto read = read_ur_kinematics(text, "ur.yaml");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("ur.yaml:2: shoulder: key 'pitch'"));
  EXPECT_THAT(read_ur_kinematics("robot: x\n", "ur.yaml").error().what, HasSubstr("'kinematics'"));
}

}  // namespace
}  // namespace selfcal
