// Robots as models for MuJoCo and back, against MuJoCo's own forward kinematics; what a model says
// at rest, against statics worked by hand; the loop from a simulator to its mended self.
#include <gmock/gmock.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "io/files/robot_file.h"
#include "io/files/yaml.h"
#include "io/models/mjcf_text.h"
#include "io/models/mujoco.h"
#include "kinematics/rotation.h"
#include "tests/io/scratch.h"
#include "tests/support/program.h"
#include "tests/support/text.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kSamePlace = 1e-9;  // m, rad: what is asked of a conversion

/// MuJoCo with one model, asked for what is in it alone.
class Engine {
 public:
  explicit Engine(const std::filesystem::path& file) {
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
    if (!model_) throw std::runtime_error(error.data());
    data_.reset(mj_makeData(model_.get()));
  }
  void set(const std::string& joint, double position) {
    const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.c_str());
    ASSERT_GE(id, 0) << joint;
    data_->qpos[model_->jnt_qposadr[id]] = position;
  }
  Eigen::Isometry3d site(const std::string& name) {
    mj_kinematics(model_.get(), data_.get());
    const int id = mj_name2id(model_.get(), mjOBJ_SITE, name.c_str());
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Map<const Eigen::Vector3d>(data_->site_xpos + 3 * id);
    X.linear() =
        Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(data_->site_xmat + 9 * id);
    return X;
  }

 private:
  struct End {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, End> model_;
  std::unique_ptr<mjData, End> data_;
};

void expect_same(const Eigen::Isometry3d& X, const Location& location) {
  EXPECT_LT((X.translation() - location.p).norm(), kSamePlace);
  EXPECT_LT(log_rotation(X.linear().transpose() * location.R).norm(), kSamePlace);
}

/// Skew axes, a slide, a whole pose, gears and a coupling.
constexpr const char* kGeared = R"(robot: geared
kind: serial
coupling: [[1, 0, 0, 0], [0.2, 1, 0, 0], [0, -0.5, 1, 0], [0, 0, 0, 1]]
frames:
  - {name: base, joint: fixed, xyz: [0.1, 0.2, 0.3], rpy: [0.1, -0.2, 0.4]}
  - {name: a, joint: revolute, r: 0.4, gear: 1.003}
  - {name: b, joint: revolute, alpha: -1.2, d: 0.15, beta: 0.02, gear: -1, mass: 5, com: [0.1, 0, 0]}
  - {name: c, joint: prismatic, alpha: 0.3, d: 0.5, theta: 0.7, r: 0.1}
  - {name: d, joint: revolute, alpha: 1.5, r: 0.2, limits: [-3, 3]}
  - {name: tool, joint: fixed, d: 0.05, theta: 0.4, r: 0.15}
)";

TEST(MujocoModels, OfARobotFileHaveItsLocations) {
  const Scratch scratch;
  const auto node = parse_yaml(kGeared, "geared.yaml");
  Problems problems;
  const serial::Model model = serial::read(*node, problems);
  ASSERT_FALSE(problems.any()) << problems.list.front();
  const auto robot = robot_of(kGeared, "geared.yaml");
  ASSERT_TRUE(robot);
  MjcfEffects effects;
  effects.joints = {{"b", 1e-5}};
  Engine engine(scratch.write("geared.xml", mjcf_of(model, effects).text));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector4d q(uniform(random), uniform(random), uniform(random), uniform(random));
    for (int j = 0; j < 4; ++j) engine.set(std::string(1, "abcd"[j]), q[j]);
    // variables = coupling diag(K) readings, of which the joint itself does the reading.
    engine.set("a.of.a", 0.003 * q[0]);
    engine.set("b.of.a", 0.2 * 1.003 * q[0]);
    engine.set("b.of.b", -2 * q[1]);
    engine.set("c.of.b", 0.5 * q[1]);
    expect_same(engine.site("tool"), locate(**robot, values(**robot), q));
  }
}

TEST(MujocoModels, AtRestFollowGearsAndCoupling) {
  const Scratch scratch;
  const auto node = parse_yaml(kGeared, "geared.yaml");
  Problems problems;
  const auto file = scratch.write("geared.xml", mjcf_of(serial::read(*node, problems), {}).text);
  const auto robot = robot_of(kGeared, "geared.yaml");
  const Eigen::Vector4d q(0.3, -0.7, 0.2, 1.1);
  const auto poses = settled_poses(file, "", {{q}});
  ASSERT_TRUE(poses) << poses.error().what;
  EXPECT_LT((poses->tool[0]->p - locate(**robot, values(**robot), q).p).norm(), kSamePlace);
}

/// Bodies and joints where a person puts them: anchors off the bodies' origins, any axes, a
/// reference, a slide, a tool that two bodies without joints part from the last link.
constexpr const char* kArm = R"(<mujoco model="arm">
  <compiler angle="radian"/>
  <worldbody>
    <body name="foot" pos="0.1 -0.2 0.3" euler="0.1 0.2 0.3">
      <body name="one" pos="0 0 0.4" quat="0.9 0.1 -0.2 0.3">
        <joint name="j1" pos="0.05 0.02 -0.1" axis="0 0 -1" range="-2.5 2.5" limited="true"/>
        <geom size="0.05" mass="3"/>
        <body name="two" pos="0.5 0.02 0" euler="0 1.57079632679 0">
          <joint name="j2" axis="0 1 0"/>
          <joint name="j2.spring" axis="0 1 0" stiffness="1e5"/>
          <geom size="0.05" mass="2" pos="0.2 0 0"/>
          <body name="three" pos="0.4 0 0.1">
            <joint name="j3" axis="0.3 0.4 1.2" ref="0.25"/>
            <geom size="0.05" mass="1"/>
            <body name="four" pos="0 0.1 0.2">
              <joint name="j4" type="slide" axis="0.2 0 1"/>
              <geom size="0.02" mass="0.5"/>
              <body name="flange" pos="0.1 0 0" euler="0.4 0.5 0.6"><site name="tcp" pos="0 0 0.1" euler="1 0 0"/></body>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
)";

TEST(MujocoModels, BecomeRobotFilesWithTheirLocations) {
  const Scratch scratch;
  const auto file = scratch.write("arm.xml", kArm);
  const auto read = read_mujoco(file, "");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->tool, "tcp");
  EXPECT_EQ(read->notices.size(), 1U);
  const auto robot = robot_of(write_yaml(serial::write(frames_of(read->chain))), "arm.yaml");
  ASSERT_TRUE(robot) << robot.error().what;
  ASSERT_EQ((*robot)->joints().size(), 4U);
  EXPECT_EQ((*robot)->joints()[0].lower, -2.5);
  Engine engine(file);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector4d q(uniform(random), uniform(random), uniform(random), uniform(random));
    for (int j = 0; j < 4; ++j) engine.set("j" + std::to_string(j + 1), q[j]);
    expect_same(engine.site("tcp"), locate(**robot, values(**robot), q));
  }
}

/// A beam of 2 kg, its centre 0.5 m out, its tip 1 m out, that turns about y.
std::string beam(const std::string& joints, const std::string& more = "",
                 const std::string& ground = "") {
  return "<mujoco><compiler angle='radian'/><option gravity='0 0 -10'/><worldbody>" + ground +
         "<body name='beam'><inertial pos='0.5 0 0' mass='2' diaginertia='0.1 0.1 0.1'/>" + joints +
         "<geom name='tip' type='sphere' size='0.01' pos='1 0 0' mass='0'/>"
         "<site name='tip' pos='1 0 0'/></body></worldbody>" +
         more + "</mujoco>";
}

double settled_height(const std::string& text,
                      const MujocoLoad& load = {Eigen::VectorXd::Zero(1)}) {
  const Scratch scratch;
  const auto poses = settled_poses(scratch.write("beam.xml", text), "tip", {load});
  EXPECT_TRUE(poses) << (poses ? "" : poses.error().what);
  return poses && poses->tool[0] ? poses->tool[0]->p.z() : NAN;
}

/// The angle at which a spring of `stiffness` (N m/rad) bears `torque` cos(angle) (N m).
double sag(double torque, double stiffness) {
  double angle = 0;
  for (int i = 0; i < 100; ++i) angle = torque * std::cos(angle) / stiffness;
  return angle;
}

constexpr const char* kMotor = "<joint name='j' axis='0 -1 0'/>";
constexpr const char* kSpring = "<joint name='j.spring' axis='0 -1 0' stiffness='1000'/>";

TEST(MujocoModels, StandAtTheReadingsWhereNothingGivesWay) {
  EXPECT_NEAR(settled_height(beam(kMotor), {Eigen::VectorXd::Constant(1, 0.2)}), std::sin(0.2),
              1e-12);
}

TEST(MujocoModels, HangInTheirSpringsAtRest) {
  const std::string text = beam(std::string(kMotor) + kSpring);
  EXPECT_NEAR(settled_height(text), -std::sin(sag(10, 1000)), 1e-9);
  // 5 N down at the tip, in its axes, which have turned by some 15 mrad with the beam: to first
  // order of this the torque is 5 N times 1 m, whatever the angle.
  MujocoLoad load{Eigen::VectorXd::Zero(1)};
  load.force.z() = -5;
  EXPECT_NEAR(settled_height(text, load), -std::sin(sag(10, 1000) + 5e-3), 1e-6);
}

// A controller that gives way is no joint that does: its encoder sees it.
TEST(MujocoModels, SayHowFarTheirPositionActuatorsSag) {
  const std::string text = beam(kMotor, "<actuator><position joint='j' kp='500'/></actuator>");
  EXPECT_NEAR(settled_height(text), 0, 1e-12);
  const Scratch scratch;
  const auto poses =
      settled_poses(scratch.write("beam.xml", text), "tip", {{Eigen::VectorXd::Zero(1)}});
  ASSERT_TRUE(poses) << poses.error().what;
  EXPECT_NEAR(poses->sag, 2 * std::sin(sag(10, 500) / 2), 1e-9);  // of a beam of 1 m
}

TEST(MujocoModels, RestOnWhatTheyTouch) {
  // The floor is 5 mm below; without it the tip would hang by 10 mm. A contact is soft: the tip
  // sinks into it by less than a millimetre under its share of 5 N.
  const std::string floor = "<geom name='floor' type='plane' size='0 0 1' pos='0 0 -0.015'/>";
  const double height = settled_height(beam(std::string(kMotor) + kSpring, "", floor));
  EXPECT_LT(height, -0.005 + 1e-9);
  EXPECT_GT(height, -0.006);
}

std::string refusal(const std::string& text, const std::string& tool = "") {
  const Scratch scratch;
  const auto read = read_mujoco(scratch.write("model.xml", text), tool);
  return read ? "" : read.error().what;
}

TEST(MujocoModels, AreRefusedWithTheReason) {
  EXPECT_THAT(refusal("<mujoco><worldbody><bdy/></worldbody></mujoco>"), HasSubstr("MuJoCo: "));
  EXPECT_THAT(refusal(kArm, "gripper"), HasSubstr("has no site and no body 'gripper'"));
  std::string text = kArm;
  replace(text, "<site name=\"tcp\"", "<site name=\"camera\"/><site name=\"tcp\"");
  EXPECT_THAT(refusal(text), HasSubstr("which site or body is the tool? It has camera, tcp"));
  EXPECT_THAT(refusal(kArm, "foot"), HasSubstr("no joint of a robot moves 'foot'"));
  EXPECT_THAT(refusal(beam("<joint type='ball'/>")), HasSubstr("neither a hinge nor a slide"));
  const Scratch scratch;
  const auto poses =
      settled_poses(scratch.write("arm.xml", kArm), "", {{Eigen::VectorXd::Zero(6)}});
  ASSERT_FALSE(poses);
  EXPECT_THAT(poses.error().what, HasSubstr("4 joints of a robot move 'tcp', and the rows have 6"));
}

constexpr const char* kMachine = R"(robot: arm.robot.yaml
seed: 5
errors: {length: 0.7e-3, angle: 0.7e-3, base_length: 5.0e-3, base_angle: 5.0e-3, tool_length: 5.0e-3, tool_angle: 5.0e-3}
compliance: {j2: 3.0e-6}
check: 0.33
sets:
  tracker: {method: position, frame: unknown, point: unknown, noise: 2.0e-5, rows: 120}
)";

/// The example with masses, without which nothing bends.
std::string heavy_irb1600() {
  std::string text = text_of(SELFCAL_SOURCE_DIR "/app/examples/irb1600.robot.yaml");
  replace(text, "limits: [-1.10, 1.91]}", "limits: [-1.10, 1.91], mass: 50, com: [0.35, 0, 0.1]}");
  replace(text, "limits: [-4.10, 0.96]}", "limits: [-4.10, 0.96], mass: 40, com: [0.02, 0.1, 0]}");
  replace(text, "limits: [-3.49, 3.49]}", "limits: [-3.49, 3.49], mass: 15, com: [0, 0, -0.2]}");
  replace(text, "limits: [-2.01, 2.01]}", "limits: [-2.01, 2.01], mass: 6, com: [0, 0, 0]}");
  return text;
}

/// The figure (mm) after the simulator's name.
double told_gap(const std::string& text, const std::string& model) {
  const std::string begin = "Against " + model + ": ";
  const auto at = text.find(begin);
  return at == std::string::npos ? NAN : std::strtod(text.c_str() + at + begin.size(), nullptr);
}

TEST(MujocoModels, AreMendedByWhatTheRobotShowsThatTheyLack) {
  const Scratch scratch;
  const std::string folder = scratch.folder().string() + "/";
  scratch.write("arm.robot.yaml", heavy_irb1600());
  scratch.write("machine.yaml", kMachine);
  ASSERT_EQ(run_selfcal("simulate " + folder + "machine.yaml --out " + folder + "real").status, 0);
  ASSERT_EQ(run_selfcal("robot convert " + folder + "arm.robot.yaml --to mjcf --out " + folder +
                        "arm.xml")
                .status,
            0);
  const Ran first = run_selfcal(
      "diagnose " + folder + "real --sim " + folder + "arm.xml --out " + folder + "found", true);
  ASSERT_EQ(first.status, 0) << first.out;
  EXPECT_THAT(first.out, HasSubstr("its simulation lacks: joint compliance at j2"));
  EXPECT_GT(told_gap(first.out, "arm.xml"), 1) << first.out;
  const std::string again = "mended by what was found in the robot and run again, ";
  ASSERT_THAT(first.out, HasSubstr(again));
  // As below, where the same is done by hand.
  EXPECT_LT(std::stod(first.out.substr(first.out.find(again) + again.size())), 0.05) << first.out;
  const Ran mended =
      run_selfcal("robot convert " + folder + "found/corrected.robot.yaml --to mjcf --out " +
                  folder + "mended.xml");
  ASSERT_EQ(mended.status, 0) << mended.out;
  EXPECT_THAT(mended.out, Not(HasSubstr("left out: the effect")));
  const Ran second =
      run_selfcal("diagnose " + folder + "real --sim " + folder + "mended.xml", true);
  EXPECT_THAT(second.out, Not(HasSubstr("its simulation lacks")));
  EXPECT_THAT(second.out, Not(HasSubstr("the geometry differs")));
  // The noise of three coordinates is 20 um times sqrt(3), 35 um; what the fit leaves of 30
  // parameters from 240 numbers is a third of this.
  EXPECT_LT(told_gap(second.out, "mended.xml"), 0.05) << second.out;
}

}  // namespace
}  // namespace selfcal
