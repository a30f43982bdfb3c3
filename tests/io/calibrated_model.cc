// Calibrated robots for other programs: what is written, read back by urdfdom or worked out from
// the numbers of a firmware, puts the end where the calibrated robot has it.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <sstream>

#include "io/models/delta_firmware.h"
#include "io/models/ur_kinematics.h"
#include "io/models/urdf_text.h"
#include "tests/io/urdf_case.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kAsGood = 1e-9;  // m, rad: what is asked of a conversion

/// A base that is fixed, skew, parallel, opposed and nearly parallel axes, a slide, a joint that
/// mimics, fixed joints between and behind.
constexpr const char* kArm = R"(<robot name="arm">
  <!-- kept -->
  <link name="world"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
  <link name="e"/><link name="f"/><link name="g"/><link name="tip"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="a"/><origin xyz="1 2 0" rpy="0 0 0.3"/></joint>
  <joint name="j1" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 0.4"/><axis xyz="0 0 -1"/></joint>
  <joint name="j2" type="continuous"><parent link="b"/><child link="c"/><origin xyz="0.1 0 0" rpy="0.1 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="j3" type="continuous"><parent link="c"/><child link="d"/><origin xyz="0.5 0 0.02" rpy="0 0 0.002"/><axis xyz="0 2 0"/></joint>
  <joint name="weld" type="fixed"><parent link="d"/><child link="e"/><origin xyz="0.1 0.1 0.1" rpy="1 0.5 0.2"/></joint>
  <joint name="j4" type="prismatic"><parent link="e"/><child link="f"/><axis xyz="0.2 0.3 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="j5" type="continuous"><parent link="f"/><child link="g"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/><mimic joint="j2" multiplier="0.5" offset="0.1"/></joint>
  <joint name="end" type="fixed"><parent link="g"/><child link="tip"/><origin xyz="0 0 0.1"/></joint>
</robot>
)";

/// Every parameter but the gears moved by up to 5 mm or mrad, as a calibration would.
Eigen::VectorXd moved_values(const Robot& robot, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-5e-3, 5e-3);
  Eigen::VectorXd xi = values(robot);
  for (Eigen::Index i = 0; i < xi.size(); ++i)
    if (robot.parameters()[i].part != Part::gear) xi[i] += uniform(random);
  return xi;
}

serial::Model model_in(const std::string& text) {
  Problems problems;
  serial::Model model = serial::read(*parse_yaml(text, "calibrated.yaml"), problems);
  EXPECT_THAT(problems.list, IsEmpty());
  return model;
}

/// Largest difference between `robot` and the tip of the URDF `text` at random readings.
PoseGap gap_between(const Robot& robot, const std::string& text, const std::string& base,
                    const std::string& tip, const std::vector<std::string>& joints,
                    std::mt19937_64& random) {
  const auto model = urdf::parseURDF(text);
  std::uniform_real_distribution<double> uniform(-2, 2);
  PoseGap gap;
  for (int i = 0; i < 50; ++i) {
    UrdfPositions q;
    Eigen::VectorXd readings = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(joints.size()));
    for (size_t j = 0; j < joints.size(); ++j)
      if (!model->getJoint(joints[j])->mimic)
        q[joints[j]] = readings[static_cast<Eigen::Index>(j)] = uniform(random);
    gap.add(urdf_pose(*model, base, q).inverse() * urdf_pose(*model, tip, q),
            pose_of(locate(robot, values(robot), readings)));
  }
  return gap;
}

TEST(CalibratedUrdf, PutsTheTipWhereTheCalibratedRobotHasIt) {
  std::mt19937_64 random(11);
  const auto read = read_urdf(kArm, "arm.urdf", {});
  ASSERT_TRUE(read) << read.error().what;
  PoseGap worst;
  for (int i = 0; i < 40; ++i) {
    const FixedJoints fixed = i % 2 == 0 ? FixedJoints::merged : FixedJoints::kept;
    const auto nominal = robot_of(robot_file_of(*read, fixed), "nominal.yaml");
    ASSERT_TRUE(nominal);
    const std::string text = robot_text(**nominal, moved_values(**nominal, random));
    const auto robot = robot_of(text, "calibrated.yaml");
    ASSERT_TRUE(robot);
    const CorrectedChain chain = corrected_chain(read->chain, model_in(text));
    ASSERT_EQ(chain.problem, "");
    const auto made = urdf_like(kArm, "arm.urdf", *read, chain);
    ASSERT_TRUE(made);
    EXPECT_THAT(made->left_out, IsEmpty());
    EXPECT_THAT(made->text, HasSubstr("<!-- kept -->"));
    const PoseGap gap =
        gap_between(**robot, made->text, "world", "tip", {"j1", "j2", "j3", "j4", "j5"}, random);
    worst.length = std::max(worst.length, gap.length);
    worst.angle = std::max(worst.angle, gap.angle);
  }
  EXPECT_LT(worst.length, kAsGood);
  EXPECT_LT(worst.angle, kAsGood);
  std::printf("calibrated URDF: %.1e m, %.1e rad at most\n", worst.length, worst.angle);
}

/// The URDF with what moved one frame of the robot that keeps its fixed joints.
std::string urdf_with_moved(const std::string& frame, int field, double by) {
  const auto read = read_urdf(kArm, "arm.urdf", {});
  serial::Model model = frames_of(read->chain, FixedJoints::kept);
  const auto moved = std::ranges::find(model.frames, frame, &serial::Frame::name);
  Eigen::VectorXd value = moved->value;
  value[field] += by;
  serial::set_values(*moved, value);
  return urdf_like(kArm, "arm.urdf", *read, corrected_chain(read->chain, model))->text;
}

TEST(CalibratedUrdf, CorrectsAFixedJointInItsOwnOrigin) {
  const auto origin = [](const std::string& text, const std::string& joint) {
    return urdf::parseURDF(text)->getJoint(joint)->parent_to_joint_origin_transform.position;
  };
  for (const std::string frame : {"stand", "weld", "end"}) {
    const std::string made = urdf_with_moved(frame, serial::kZ, 0.002);
    for (const std::string joint : {"stand", "j1", "j2", "j3", "weld", "j4", "j5", "end"}) {
      const urdf::Vector3 before = origin(kArm, joint), after = origin(made, joint);
      const double moved = std::hypot(after.x - before.x, after.y - before.y, after.z - before.z);
      EXPECT_NEAR(moved, joint == frame ? 0.002 : 0, kAsGood) << frame << " " << joint;
    }
  }
}

TEST(CalibratedUrdf, KeepsTheOriginsThatNothingMoves) {
  const auto read = read_urdf(kArm, "arm.urdf", {});
  const CorrectedChain chain = corrected_chain(read->chain, frames_of(read->chain));
  const auto made = urdf_like(kArm, "arm.urdf", *read, chain);
  ASSERT_TRUE(made);
  EXPECT_THAT(made->text, HasSubstr("<origin xyz=\"0.5 0 0.02\" rpy=\"0 0 0.002\""));
  EXPECT_THAT(made->text, HasSubstr("the origins of the joints hold all of it"));
}

TEST(CalibratedUrdf, LeavesTheHomingSwitchesWhereTheyAre) {
  std::string text = kArm;
  text.insert(text.find("<axis xyz=\"0 1 0\"/>"), "<calibration rising=\"0.25\"/>");
  const auto read = read_urdf(text, "arm.urdf", {});
  ASSERT_TRUE(read);
  serial::Model model = frames_of(read->chain);
  for (serial::Frame& frame : model.frames)
    if (frame.motion == serial::Motion::revolute) frame.value[serial::kTheta] += 0.01;
  const auto made = urdf_like(text, "arm.urdf", *read, corrected_chain(read->chain, model));
  ASSERT_TRUE(made);
  EXPECT_THAT(made->text, HasSubstr("<calibration rising=\"0.25\" />"));
  EXPECT_EQ(*urdf::parseURDF(made->text)->getJoint("j2")->calibration->rising, 0.25);
}

TEST(CalibratedUrdf, LeavesOutTheToolOfAnotherRobotAndSaysSo) {
  const auto read = read_urdf(kArm, "arm.urdf", {});
  serial::Model model = frames_of(read->chain);
  serial::Frame& tool = model.frames.back();
  tool.value[0] = tool.nominal[0] = 0.3;  // a probe
  tool.value[1] += 0.002;
  const CorrectedChain chain = corrected_chain(read->chain, model);
  EXPECT_EQ(chain.problem, "");
  EXPECT_THAT(chain.left_out,
              Contains(HasSubstr("the tool, which is another than the chain's end: 2 mm")));
  EXPECT_LT((chain.chain.X_WT.matrix() - read->chain.X_WT.matrix()).norm(), 1e-9);
}

TEST(CalibratedUrdf, IsRefusedForAnotherRobot) {
  const auto read = read_urdf(kArm, "arm.urdf", {});
  serial::Model model = frames_of(read->chain);
  model.frames[3].value[serial::kD] = model.frames[3].nominal[serial::kD] = 0.45;
  EXPECT_THAT(corrected_chain(read->chain, model).problem,
              HasSubstr("nominal figures are not those"));
  model.frames.erase(model.frames.begin() + 2);
  EXPECT_THAT(corrected_chain(read->chain, model).problem, HasSubstr("4 joints, the chain 5"));
  const auto up = read_urdf(kArm, "arm.urdf", {"tip", "world"});
  ASSERT_TRUE(up);
  const auto made =
      urdf_like(kArm, "arm.urdf", *up, corrected_chain(up->chain, frames_of(up->chain)));
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().what, HasSubstr("goes up the tree at joint 'end'"));
}

TEST(Urdf, OfARobotAloneHasItsLocations) {
  const std::string text = R"(robot: r
kind: serial
frames:
  - {name: stand, joint: fixed, xyz: [1, 2, 3], rpy: [0.1, 0.2, 0.3]}
  - {name: j1, joint: revolute, alpha: 0.1, r: 0.4, limits: [-1, 2], mass: 4, com: [0.1, 0, 0]}
  - {name: j2, joint: revolute, alpha: -pi/2, d: 0.2, theta: 0.3, beta: 0.02}
  - {name: j3, joint: prismatic, alpha: 1, d: 0.3, theta: 1, r: 0.2, limits: [-1, 2]}
  - {name: tool, joint: fixed, d: 0.1, alpha: 0.2, r: 0.3}
)";
  const auto robot = robot_of(text, "r.yaml");
  ASSERT_TRUE(robot) << robot.error().what;
  const UrdfText made = urdf_of(model_in(text));
  std::mt19937_64 random(12);
  const PoseGap gap = gap_between(**robot, made.text, "world", "tool", {"j1", "j2", "j3"}, random);
  EXPECT_LT(gap.length, kAsGood);
  EXPECT_LT(gap.angle, kAsGood);
  EXPECT_THAT(made.left_out, Contains(HasSubstr("moments of inertia")));
}

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

/// The number behind `word` in `text`.
double number_after(const std::string& text, const std::string& word, size_t from = 0) {
  const size_t at = text.find(word, from);
  EXPECT_NE(at, std::string::npos) << word;
  return std::stod(text.substr(at + word.size()));
}

TEST(DeltaFirmware, HasTheCarriagesWhereTheRobotHasThem) {
  const std::string text = R"(robot: d
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.667, rod: 0.2153, endstop: 0.5821, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 5.7596, rod: 0.2155, endstop: 0.5825, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 1.57, rod: 0.2151, endstop: 0.5818, limits: [-0.35, 0]}
)";
  Problems problems;
  const auto delta = linear_delta::read(*parse_yaml(text, "d.yaml"), problems);
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  EXPECT_THAT(made->left_out, IsEmpty());
  const auto robot = robot_of(text, "d.yaml");
  const Eigen::Vector3d q(-0.20, -0.21, -0.19);
  const Eigen::Vector3d p = 1e3 * locate(**robot, values(**robot), q).p;
  const size_t line = made->text.find("M665");
  const double R = number_after(made->text, " R", line), H = number_after(made->text, " H", line);
  const size_t stops = made->text.find("M666"), klipper = made->text.find("# Klipper");
  std::istringstream arms(made->text.substr(made->text.find("M665 L") + 6));
  for (int t = 0; t < 3; ++t) {
    std::string arm;
    std::getline(arms, arm, t < 2 ? ':' : ' ');
    const double L = std::stod(arm);
    const std::string axis = std::string(" ") + "XYZ"[t];
    const double angle =
        (std::array{210, 330, 90}[t] + number_after(made->text, axis, line)) * M_PI / 180;
    const double root = std::sqrt(L * L - R * R);
    const Eigen::Vector3d c(R * std::cos(angle), R * std::sin(angle),
                            H + root + number_after(made->text, axis, stops) + 1e3 * q[t]);
    EXPECT_NEAR((p - c).norm(), L, 2e-4) << "written to 0.1 um";
    const size_t stepper = made->text.find(std::string("[stepper_") + "abc"[t], klipper);
    EXPECT_NEAR(number_after(made->text, "position_endstop: ", stepper) + root + 1e3 * q[t], c.z(),
                2e-4);
    EXPECT_NEAR(number_after(made->text, "arm_length: ", stepper), L, 1e-9);
  }
}

// By Marlin's own sums (module/delta.cpp, motion.cpp): each carriage meets its endstop, backs off
// by M666, and all three then stand where the nozzle is at (0, 0, H).
TEST(DeltaFirmware, HasTheCarriagesWhereMarlinPutsThem) {
  const std::string text = R"(robot: d
kind: linear-delta
towers:
  - {radius: 0.105, angle: 3.667, rod: 0.2153, endstop: 0.5821, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 5.7596, rod: 0.2155, endstop: 0.5825, limits: [-0.35, 0]}
  - {radius: 0.105, angle: 1.57, rod: 0.2151, endstop: 0.5818, limits: [-0.35, 0]}
)";
  Problems problems;
  auto delta = linear_delta::read(*parse_yaml(text, "d.yaml"), problems);
  delta.nominal[linear_delta::index(0, linear_delta::kRod)] = 0.2140;
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  const auto robot = robot_of(text, "d.yaml");
  const Eigen::Vector3d q(-0.20, -0.21, -0.19);
  const Eigen::Vector3d p = 1e3 * locate(**robot, values(**robot), q).p;
  const size_t marlin = made->text.find("; Marlin"), line = made->text.find("\nM665", marlin),
               stops = made->text.find("\nM666", line);
  ASSERT_NE(stops, std::string::npos);
  const double L = number_after(made->text, " L", line), R = number_after(made->text, " R", line),
               H = number_after(made->text, " H", line);
  for (int t = 0; t < 3; ++t) {
    const std::string axis = std::string(" ") + "XYZ"[t], arm = std::string(" ") + "ABC"[t];
    const double rod = L + number_after(made->text, arm, line);
    const double angle =
        (std::array{210, 330, 90}[t] + number_after(made->text, axis, line)) * M_PI / 180;
    const double adjustment = number_after(made->text, axis, stops);
    EXPECT_LE(adjustment, 0) << "Marlin refuses positive ones";
    const double at_endstop = H + std::sqrt(rod * rod - R * R) - adjustment;
    const Eigen::Vector3d c(R * std::cos(angle), R * std::sin(angle), at_endstop + 1e3 * q[t]);
    EXPECT_NEAR((p - c).norm(), rod, 3e-4) << "three numbers written to 0.1 um";
  }
  const size_t undo = made->text.find("; To undo it", stops);
  EXPECT_NEAR(number_after(made->text, " A", undo), 214.0 - (214.0 + 215.5 + 215.1) / 3, 1e-4);
}

TEST(DeltaFirmware, NamesWhatItLacksAndRefusesOtherTowers) {
  linear_delta::Delta delta;
  for (int t = 0; t < 3; ++t) {
    delta.value.segment<7>(linear_delta::index(t, 0)) << 0.1,
        std::array{210, 330, 90}[t] * M_PI / 180, 0.2, 0.4, 0, 0, 1;
  }
  delta.value[linear_delta::index(1, linear_delta::kTiltX)] = 0.002;
  delta.value[linear_delta::index(1, linear_delta::kScale)] = 1.0001;
  const auto made = delta_firmware(delta, delta.value, "", "d.yaml");
  ASSERT_TRUE(made);
  EXPECT_THAT(made->left_out, Contains(HasSubstr("up to 2.0000 mrad")));
  EXPECT_THAT(made->left_out, Contains(HasSubstr("up to 100.0000 ppm")));
  std::swap(delta.value[linear_delta::index(0, linear_delta::kAngle)],
            delta.value[linear_delta::index(1, linear_delta::kAngle)]);
  EXPECT_FALSE(delta_firmware(delta, delta.value, "", "d.yaml"));
}

}  // namespace
}  // namespace selfcal
