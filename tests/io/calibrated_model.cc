// Calibrated robots for other programs: what is written, read back by urdfdom or worked out from
// the numbers of a firmware, puts the end where the calibrated robot has it.
#include <gmock/gmock.h>

#include <cmath>

#include "io/models/urdf_text.h"
#include "tests/io/calibrated_case.h"
#include "tests/io/urdf_case.h"

namespace selfcal {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

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

// Its joints' positions are coupling times gear times what the robot reads.
TEST(Urdf, OfARobotAloneHasTheLimitsOfItsPositions) {
  const UrdfText made = urdf_of(model_in(R"(robot: r
kind: serial
frames:
  - {name: j1, joint: revolute, limits: [-1, 2], gear: -1}
  - {name: j2, joint: revolute, alpha: -pi/2, limits: [0, 0.5]}
  - {name: j3, joint: revolute, d: 0.3}
coupling: [[1, 0, 0], [1, 2, 0], [0, 1, 1]]
)"));
  const auto chain = read_urdf(made.text, "r.urdf", {});
  ASSERT_TRUE(chain) << chain.error().what;
  const std::vector<ChainJoint>& joints = chain->chain.joints;
  EXPECT_EQ(std::pair(joints[0].lower, joints[0].upper), std::pair(-2.0, 1.0));
  EXPECT_EQ(std::pair(joints[1].lower, joints[1].upper), std::pair(-2.0, 2.0));
  EXPECT_EQ(joints[2].lower, joints[2].upper) << "j3 turns without end";
}

}  // namespace
}  // namespace selfcal
